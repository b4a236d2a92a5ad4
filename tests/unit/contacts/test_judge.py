"""Broken contacts are reported exactly where the motion breaks them, compared with vertices deformed one by one."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.contacts.bounds import LIPS_MM
from app.contacts.breaks import Break, contact_problems, joined
from app.contacts.judge import ContactJudge
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.performance.span import whole_span
from app.plan.by_hand.corrections import AddGesture, Correction, PoseCorrection
from app.plan.model import Problem
from app.project.edit.corrections import with_corrections
from app.project.model import Project, map_choices, project_from_score
from app.project.performers import Player
from app.rig import quaternion
from app.rig.grip.grip_pose import StationTable
from app.rig.skeleton import forward
from app.rig.skinning import mesh_named, patch
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.deformed import deform
from tests.support.performed import in_seventh, performance_curves, player_motion

ENSEMBLES = Path(__file__).parents[2] / "data" / "midi" / "ensemble"
AIR = ENSEMBLES / "trombone_quartet_bach_air.mid"
LUTKIN = ENSEMBLES / "brass_quartet_lutkin_2tpt_tbn_tuba.mid"
FPS = Fraction(30)
BENT = PoseCorrection("bent", "torso", 4000, 9000, up_deg=-60.0)
LOWERED = AddGesture("low", "lower_instrument", 8000, 9000, 1.0)


def project_of(path: Path, character_id: str = "man_adult") -> Project:
    maps = bundled_maps()
    project = project_from_score(read_midi(path, maps=map_choices(maps.values())), maps)
    players = tuple(msgspec.structs.replace(player, character_id=character_id) for player in project.players)
    return replace(project, players=players)


def judged(
    performance: Performance, player: Player, motion: Motion | None = None, playing: PerformanceCurves | None = None
) -> tuple[Problem, ...]:
    playing = playing or performance_curves(performance, player)
    motion = motion or playing.motion(FPS, 0, whole_span(performance.time_frame, FPS).count)
    judge = ContactJudge(playing, character_of(player), model_of(performance.instrument(player)))
    return contact_problems(judge.breaks(motion), performance.plan(player).grips, performance.problems(player.id))


@pytest.mark.parametrize("path", [AIR, LUTKIN], ids=["slides", "valves"])
@pytest.mark.parametrize("character_id", ["man_adult", "woman_adult"])
def test_what_the_generator_makes_breaks_nothing_that_is_not_reported_already(path: Path, character_id: str) -> None:
    performance = Performance(project_of(path, character_id))
    assert {player.name: judged(performance, player) for player in performance.project.players} == {
        player.name: () for player in performance.project.players
    }


@pytest.mark.parametrize(("path", "index", "correction"), [(AIR, 3, BENT), (LUTKIN, 0, LOWERED)])
def test_a_correction_that_breaks_a_contact_is_reported_where_it_does(
    path: Path, index: int, correction: Correction
) -> None:
    project = project_of(path)
    player = project.players[index]
    performance = Performance(with_corrections(in_seventh(project, player), player.id, [correction]))
    problems = judged(performance, player)
    assert problems
    seconds = project.score.tempo_map.seconds
    for problem in problems:
        assert problem.start_s >= seconds(correction.start_tick) - 1.0
        assert problem.end_s <= seconds(correction.end_tick) + 1.0
        assert problem.note_id in {note.id for note in project.part(player).notes}


def test_the_lips_gap_is_that_of_the_vertices() -> None:
    """The distance of the deformed vertices of the lips from the rim equals the reported one, and no other sounding
    frame has a gap.
    """
    project = project_of(LUTKIN)
    player = project.players[0]
    performance = Performance(with_corrections(project, player.id, [LOWERED]))
    problems = [item for item in judged(performance, player) if item.message.id == "contact.lips_off"]
    motion = player_motion(performance, player, whole_span(performance.time_frame, FPS))
    character, plan = character_of(player), performance.plan(player)
    mark = character.landmarks["lips.contact"]
    joints = forward(character.skeleton, motion.rotations, motion.hips_m)
    lips_m = deform(
        patch(character, mesh_named(character, mark.mesh), mark.vertices), joints, motion.morphs
    ).mean(axis=1)  # fmt: skip
    rim = np.asarray(performance.instrument(player).mouthpiece.position_m)
    rim_m = motion.instrument_position_m + quaternion.rotate(motion.instrument_rotation.astype(np.float64), rim)
    gaps_mm = 1000.0 * np.linalg.norm(lips_m - rim_m, axis=1)
    times_s = motion.first_frame_s + np.arange(motion.frames) / float(FPS)
    assert [item.message.arguments["gap_mm"] for item in problems] == [
        pytest.approx(gaps_mm[(times_s >= item.start_s) & (times_s < item.end_s)].max(), abs=15.0) for item in problems
    ]
    breathes = np.zeros(motion.frames, dtype=bool)
    for breath in plan.breaths:
        breathes |= (times_s >= breath.start_s - 0.001) & (times_s <= breath.end_s + 0.001)
    reported = np.zeros(motion.frames, dtype=bool)
    for item in problems:
        reported |= (times_s >= item.start_s - 0.07) & (times_s <= item.end_s + 0.07)
    sounds = np.zeros(motion.frames, dtype=bool)
    for note in plan.fingerings:
        sounds |= (times_s > note.start_s) & (times_s < note.end_s)
    assert gaps_mm[sounds & ~breathes & ~reported].max() < LIPS_MM
    assert reported.any()


def straight(station: StationTable) -> StationTable:
    return replace(station, rotations=np.tile(quaternion.IDENTITY, (*station.rotations.shape[:2], 1)))


def test_a_finger_that_misses_its_valve_is_reported_alone() -> None:
    """The index finger is stretched away from its valve, and only its touch is reported."""
    project = project_of(LUTKIN)
    player = project.players[0]
    performance = Performance(project)
    playing = performance_curves(performance, player)
    hold = playing.player.grip
    hands = []
    for hand in hold.hands:
        tables = [
            replace(table, stations=tuple(straight(station) for station in table.stations))
            if table.finger == "right.index"
            else table
            for table in hand.fingers
        ]
        hands.append(replace(hand, fingers=tuple(tables)))
    stiff = replace(playing, player=replace(playing.player, grip=replace(hold, hands=tuple(hands))))
    reported = {
        (item.message.id, item.message.arguments["touch"]) for item in judged(performance, player, playing=stiff)
    }
    assert reported == {("contact.finger_off", "right.index.pad")}


def test_a_body_that_leaves_its_place_takes_its_feet_along() -> None:
    project = project_of(LUTKIN)
    player = project.players[0]
    performance = Performance(project)
    motion = player_motion(performance, player, whole_span(performance.time_frame, FPS))
    flying = replace(motion, hips_m=motion.hips_m + np.array([0.0, 0.02, 0.0], np.float32))
    problems = judged(performance, player, flying)
    feet = [item for item in problems if item.message.id == "contact.foot_off"]
    assert {item.message.arguments["side"] for item in feet} == {"left", "right"}
    assert all(item.message.arguments["gap_mm"] == 20 and item.note_id is None for item in feet)
    assert len(feet) == 2


def test_breaks_near_one_another_are_one() -> None:
    def at(start_s: float, end_s: float, gap_m: float) -> Break:
        return Break("hand", "left", "", start_s, end_s, gap_m)

    assert joined([at(4.0, 5.0, 0.01), at(1.0, 2.0, 0.02), at(5.2, 5.4, 0.03)]) == [
        at(1.0, 2.0, 0.02),
        at(4.0, 5.4, 0.03),
    ]


def all_made(live: LiveMotion) -> None:
    while live.work():
        pass
    while live.judge():
        pass


@pytest.mark.parametrize("budget_bytes", [1 << 28, 1 << 20], ids=["room for all", "hardly any room"])
def test_live_motion_reports_as_it_is_made_and_again_after_an_edit(budget_bytes: int) -> None:
    project = project_of(LUTKIN)
    player = project.players[0]
    first = Performance(project)
    live = LiveMotion(first, budget_bytes)
    all_made(live)
    assert live.broken == {}
    lowered = Performance(with_corrections(project, player.id, [LOWERED]), first)
    live.show(lowered)
    assert live.broken == {}
    all_made(live)
    reported = live.broken
    whole = performance_curves(lowered, player).motion(
        Fraction(60), 0, whole_span(lowered.time_frame, Fraction(60)).count
    )
    assert reported == {player.id: judged(lowered, player, whole)}
    # Results unaffected by an edit are kept and not computed again.
    other = project.players[1]
    again = Performance(with_corrections(lowered.project, other.id, [LOWERED]), lowered)
    live.show(again)
    assert live.broken is reported
    all_made(live)
    assert live.broken[player.id] is reported[player.id]
    assert set(live.broken) == {player.id, other.id}
    live.show(Performance(project, again))
    all_made(live)
    assert live.broken == {}


def test_what_an_edit_shows_at_once_is_judged_first() -> None:
    project = project_of(LUTKIN)
    player, at_s = project.players[0], project.score.tempo_map.seconds(8500.0)
    first = Performance(project)
    live = LiveMotion(first)
    live.request(at_s, 1.0, (player.id,))
    all_made(live)
    live.show(Performance(with_corrections(project, player.id, [LOWERED]), first))
    live.make_now(player.id, at_s)
    live.work()
    assert player.id in live.broken
