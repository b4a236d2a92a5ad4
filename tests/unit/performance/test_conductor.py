"""A conductor gives entries, and players look up at times but mostly read; measured on computed motion."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import msgspec
import numpy as np
import pytest

from app.performance.ensemble import CONDUCTOR_EYES_M, Performance
from app.plan.model import CONDUCTOR, GlanceEvent
from app.project.casting import MOST_IN_ARC, ConductorPlace, conductor_place, stage_arc
from app.project.edit.piece import piece_settings, set_piece_settings, usual_settings
from app.project.model import Project, project_from_score
from app.rig import quaternion
from app.rig.skeleton import forward
from app.score.model import Note, Part, Score
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.load import bundled_maps
from tests.support.performed import performance_curves

FPS = 60
QUARTER = 480
PLACE = ConductorPlace(0.0, 1.6, on_stage=True)


def ensemble(count: int, *, slower_from: int | None = None) -> Project:
    """Trumpets that play eight bars of quarters, rest two bars, and play two more."""
    steps = [*range(32), *range(40, 48)]
    changes = [TempoChange(0, 500_000)]
    if slower_from is not None:
        changes += [TempoChange((slower_from + step) * QUARTER, 500_000 + 60_000 * (step + 1)) for step in range(4)]
    clock = TempoMap(QUARTER, tuple(changes))
    parts = tuple(
        Part(
            f"{number}.1.1", f"Trumpet {number}", number, 0, 0, None, None, "trumpet_Bb",
            tuple(Note(f"{number}:{step}", step * QUARTER, QUARTER - 60, 60 + step % 5, 80) for step in steps),
        )
        for number in range(1, count + 1)
    )  # fmt: skip
    return project_from_score(Score("conducted", QUARTER, clock, parts=parts), bundled_maps())


def looks(performance: Performance, player_id: str) -> list[GlanceEvent]:
    return [glance for glance in performance.plans[player_id].glances if glance.at == CONDUCTOR]


@pytest.mark.parametrize("place", [None, ConductorPlace(0.0, 2.0)])
def test_where_no_conductor_stands_a_band_leads_itself(place: ConductorPlace | None) -> None:
    band = ensemble(MOST_IN_ARC + 1)
    assert band.conductor is None
    assert usual_settings("x", band).conductor is None
    performance = Performance(replace(band, conductor=place))
    assert [len(plan.cues) for plan in performance.plans.values()] == [2] + [0] * MOST_IN_ARC
    assert all(not looks(performance, player_id) for player_id in performance.plans)


def test_the_usual_place_is_in_the_middle_before_the_players() -> None:
    stages = stage_arc(5)
    place = conductor_place(stages)
    assert abs(place.x_m) < 0.01
    assert place.z_m > np.mean([stage.z_m for stage in stages])
    assert min(math.hypot(stage.x_m - place.x_m, stage.z_m - place.z_m) for stage in stages) >= 1.88


def test_it_is_set_with_the_other_settings_of_the_piece() -> None:
    project = ensemble(2)
    changed = set_piece_settings(project, msgspec.structs.replace(piece_settings(project), conductor=PLACE))
    assert changed.conductor == PLACE
    assert set_piece_settings(changed, piece_settings(project)) == project


def test_entries_come_from_the_conductor_and_all_breathe_as_before() -> None:
    project = ensemble(4)
    alone, conducted = Performance(project), Performance(replace(project, conductor=PLACE))
    assert any(plan.cues for plan in alone.plans.values())
    for player_id, plan in conducted.plans.items():
        assert plan.cues == ()
        nods = [event for event in plan.gestures if event.kind == "nod"]
        assert len(nods) == 2, "at the start and after the rest"
        assert max(nod.amount for nod in nods) < 0.4
        assert [(one.start_s, one.end_s) for one in plan.breaths] == [
            (one.start_s, one.end_s) for one in alone.plans[player_id].breaths
        ]


def test_who_is_chosen_to_lead_gives_the_entries_also_under_a_conductor() -> None:
    project = replace(ensemble(3), conductor=PLACE)
    first, *others = project.players
    leading = msgspec.structs.replace(first, parameters=msgspec.structs.replace(first.parameters, cue_leader=True))
    performance = Performance(replace(project, players=(leading, *others)))
    assert len(performance.plans[first.id].cues) == 2


def test_players_look_up_where_they_need_the_beat_and_mostly_read() -> None:
    performance = Performance(replace(ensemble(4, slower_from=44), conductor=PLACE))
    entry_s = 20.0
    for player_id in performance.plans:
        found = looks(performance, player_id)
        assert found == sorted(found, key=lambda glance: glance.start_s)
        # The first note, the entry after the rest, the slowing beats and the last note.
        for at_s in (-0.02, entry_s - 0.05, 22.4, 23.6):
            assert any(glance.start_s <= at_s < glance.end_s for glance in found), (player_id, at_s)
        up_s = sum(min(glance.end_s, 16.0) - glance.start_s for glance in found if 1.0 < glance.start_s < 16.0)
        assert up_s < 0.3 * 15.0
    whole = {
        player_id: [round(glance.start_s, 3) for glance in looks(performance, player_id)]
        for player_id in performance.plans
    }
    assert len({tuple(starts) for starts in whole.values()}) == 4, "each at times of their own"


def test_without_a_conductor_no_one_looks_there() -> None:
    performance = Performance(ensemble(3))
    assert all(not looks(performance, player_id) for player_id in performance.plans)


@pytest.mark.parametrize("number", [0, 1, 2])
def test_eyes_meet_the_conductor_and_lead_the_head(number: int) -> None:
    project = replace(ensemble(3), conductor=ConductorPlace(0.0, 2.0, on_stage=True))
    player = project.players[number]
    performance = Performance(project)
    playing = performance_curves(performance, player)
    glance = next(one for one in looks(performance, player.id) if 17.0 < one.start_s < 20.0)
    skeleton = playing.player.skeleton
    first = round((glance.start_s - 0.5 - playing.start_s) * FPS)
    motion = playing.motion(Fraction(FPS), first, round((glance.end_s - glance.start_s + 0.5) * FPS))
    joints = [skeleton.index(name) for name in ("leftEye", "rightEye", "head")]
    moved = forward(skeleton, motion.rotations, motion.hips_m, joints)
    eyes_m = 0.5 * (moved.of(joints[0])[0] + moved.of(joints[1])[0])
    gaze = quaternion.rotate(moved.of(joints[0])[1], np.array([0.0, 0.0, 1.0]))
    # The conductor's eyes in the player's frame.
    turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), -player.stage.turn_rad)
    there = np.array([0.0 - player.stage.x_m, CONDUCTOR_EYES_M, 2.0 - player.stage.z_m])
    asked = quaternion.rotate(turn, there) - eyes_m
    asked /= np.linalg.norm(asked, axis=1, keepdims=True)
    looking = slice(round(0.5 * FPS) + 20, -6)
    off_deg = np.degrees(np.arccos(np.clip(np.einsum("fi,fi->f", gaze, asked), -1.0, 1.0)))
    assert off_deg[looking].max() < 8.0
    assert off_deg[: round(0.4 * FPS)].min() > 10.0, "before it the music is read"
    # The eyes are there long before the head has turned.
    yaw = np.unwrap(np.arctan2(*(moved.of(joints[2])[1] @ np.eye(4))[:, [1, 3]].T) * 2.0)
    towards = np.abs(yaw - yaw[: round(0.4 * FPS)].mean())
    if towards[looking].max() > math.radians(5.0):
        arrives = int(np.argmax(off_deg < 8.0))
        assert towards[arrives] < 0.6 * towards[looking].max()
