"""Players who dance while playing: contacts with the bundled choreography, checked by the program's own judge."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.contacts.judge import ContactJudge
from app.export.request import ExportRequest
from app.export.run import export
from app.messages import text
from app.motion.model import Motion
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.performance.span import bars_span, whole_span
from app.project.choreography_files import choreography_path
from app.project.edit.dancers import set_body_dance, vary_body_dances
from app.project.edit.players import set_parameters
from app.project.model import Project, map_choices, project_from_score
from app.project.performers import Player
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.performed import in_seventh, performance_curves, player_motion
from tests.unit.choreography.performed.test_dancers import played

pytestmark = pytest.mark.slow

ENSEMBLES = Path(__file__).parents[3] / "data" / "midi" / "ensemble"
LUTKIN = "brass_quartet_lutkin_2tpt_tbn_tuba"
MARCH = "concert_band_hall_tenth_regiment_march"
FPS = Fraction(60)


@cache
def piece(name: str) -> Project:
    maps = bundled_maps()
    return project_from_score(read_midi(ENSEMBLES / f"{name}.mid", maps=map_choices(maps.values())), maps)


def player_of(project: Project, instrument: str) -> Player:
    return next(player for player in project.players if player.instrument_id.startswith(instrument))


def dancing(project: Project, player: Player, amount: float = 1.0, variation: int = 0, **parameters: str) -> Project:
    project = set_body_dance(project, (player.id,), "salsa")
    return set_parameters(project, (player.id,), dance_amount=amount, dance_variation=variation, **parameters)


def motion_of(project: Project, player_id: str, count: int | None = None) -> Motion:
    performance = Performance(project)
    span = whole_span(performance.time_frame, FPS)
    count = span.count if count is None else count
    return performance_curves(performance, project.player(player_id)).motion(FPS, span.first, count)


def bits(motion: Motion) -> tuple[bytes, ...]:
    arrays = (motion.rotations, motion.hips_m, motion.instrument_position_m, motion.instrument_rotation)
    return tuple(array.tobytes() for array in (*arrays, *motion.morphs.values(), *motion.controls.values()))


@pytest.mark.parametrize(
    ("name", "instrument", "posture"),
    [
        (LUTKIN, "trumpet", "standing"),
        (LUTKIN, "trombone", "standing"),
        (LUTKIN, "tuba", "seated"),
        (MARCH, "clarinet", "seated"),
    ],
)
def test_no_contact_is_broken_by_a_dance(name: str, instrument: str, posture: str) -> None:
    project = piece(name)
    player = player_of(project, instrument)
    project = dancing(project, player, posture=posture)
    if instrument == "trombone":
        project = in_seventh(project, player)
    performance, player = Performance(project), project.player(player.id)
    motion = player_motion(performance, player, whole_span(performance.time_frame, FPS))
    judge = ContactJudge(
        performance_curves(performance, player), character_of(player), model_of(performance.instrument(player))
    )
    assert judge.breaks(motion) == ()
    generated = (
        motion_of(piece(name), player.id) if posture == player_of(piece(name), instrument).parameters.posture else None
    )
    assert generated is None or bits(generated) != bits(motion)


def test_nothing_of_a_dance_is_the_generated_motion_to_the_bit() -> None:
    project = piece(LUTKIN)
    player = player_of(project, "trumpet")
    generated = bits(motion_of(project, player.id, 900))
    assert bits(motion_of(dancing(project, player, 0.0), player.id, 900)) == generated
    assert bits(motion_of(dancing(project, player, 0.5), player.id, 900)) != generated


def test_the_same_dance_again_and_others_by_variation() -> None:
    project = piece(LUTKIN)
    player = player_of(project, "trumpet")

    def made(variation: int) -> tuple[bytes, ...]:
        return bits(motion_of(dancing(project, player, 1.0, variation), player.id, 900))

    assert made(3) == made(3)
    assert len({made(0), made(3), made(4)}) == 3


def test_players_and_dancers_of_one_variation_dance_in_unison_else_each_alone() -> None:
    from app.choreography.performed.body_dance import layer_of

    project = piece(LUTKIN)
    ids = [player.id for player in project.players]
    project = set_body_dance(project, ids, "salsa")
    bodies = set_parameters(project, ids, dance_variation=7)
    bodies = replace(
        bodies, players=tuple(msgspec.structs.replace(player, character_id="man_adult") for player in bodies.players)
    )
    together = Performance(bodies)
    one, two, *_ = (layer_of(together, player) for player in bodies.players)
    assert one is two
    alone = Performance(project)
    layers = [layer_of(alone, player).values for player in project.players]
    assert not any(np.array_equal(a, b) for at, a in enumerate(layers) for b in layers[:at])
    thrown = vary_body_dances(bodies, ids[:2])
    variations = [player.parameters.dance_variation for player in thrown.players]
    assert len(set(variations)) == 3
    assert variations[2:] == [7, 7]
    assert all(variations)


def test_a_player_without_the_choreography_moves_as_is_generated_and_is_reported(tmp_path: Path) -> None:
    project = piece(LUTKIN)
    player = player_of(project, "trumpet")
    damaged = tmp_path / "damaged.choreography"
    damaged.write_text("{}")
    generated = bits(motion_of(project, player.id, 300))
    for choreography, id in (
        ("not_bundled", "project.choreography_missing"),
        (tmp_path / "gone.choreography", "project.choreography_file_missing"),
        (damaged, "choreography.damaged"),
    ):
        requested = set_body_dance(project, (player.id,), choreography)
        performance = Performance(requested)
        assert id in [problem.message.id for problem in performance.problems(player.id)]
        assert not performance.unseen
        assert bits(motion_of(requested, player.id, 300)) == generated


def test_what_is_shown_follows_an_edit_and_undo() -> None:
    project = played()
    player = project.players[0]
    live = LiveMotion(Performance(project))
    time_s = 3.0

    def pose(project: Project, name: str = "rotations") -> bytes:
        live.show(Performance(project, live.performance))
        while live.work():
            pass
        found = live.pose(player.id, time_s)
        assert found is not None
        return bytes(getattr(found, name).tobytes())

    generated = pose(project)
    danced = pose(dancing(project, player))
    assert danced != generated
    # An edit elsewhere changes nothing, another amount does, and back is back.
    muted = replace(dancing(project, player), preroll_beats=project.preroll_beats)
    assert pose(muted) == danced
    assert pose(dancing(project, player, 0.4)) not in (danced, generated)
    assert pose(project) == generated


def test_the_exported_file_keeps_fingers_lips_feet_and_bones(tmp_path: Path) -> None:
    """Two bars at full amount and two without dance, read from FBX, are within the bounds of every player's report."""
    base = piece(LUTKIN)
    player = player_of(base, "trumpet")
    measures = []
    for amount in (0.0, 1.0):
        project = dancing(base, player, amount)
        performance = Performance(project)
        span = bars_span(performance, Fraction(30), (4, 5), 1.0)
        chosen = (project.player(player.id),)
        request = ExportRequest(
            performance, chosen, tmp_path / f"{amount}", frozenset(("fbx",)), span, (4, 5), "piece.mid", "test"
        )
        report = export(request, text)
        measures.append(report.players[0].measures)
    without, danced = measures
    assert without is not None
    assert all(control.right == control.judged > 0 for control in danced.controls.values())
    touches = [
        name for name, touch in danced.contacts.items() if touch.max_mm > max(2.0, without.contacts[name].max_mm)
    ]
    assert touches == []
    assert danced.lips.max_mm < 0.1
    assert danced.upper_lip_in_breaths.kept
    assert all(foot.max_mm < 0.1 for foot in danced.feet.values())
    assert danced.bones.kept
    assert danced.penetration.kept
    assert danced.limits.beyond == danced.acceleration.beyond == 0
    # Breaths are seen in the trunk that dances.
    assert danced.breaths.shown == danced.breaths.planned > 0


def test_nothing_long_is_done_at_once_in_the_window(tmp_path: Path) -> None:
    """The window's thread neither reads a choreography nor generates a dance: a worker plans, and the previous motion
    is shown meanwhile.
    """
    copy = tmp_path / "copy.choreography"
    copy.write_bytes(choreography_path("salsa").read_bytes())
    project = played()
    player = project.players[0]
    first = Performance(project)
    live = LiveMotion(first)
    while live.work():
        pass
    seen = live.pose_now(player.id, 3.0)
    dances = Performance(set_body_dance(project, (player.id,), copy), first)
    assert not dances.prepare_within(60.0)
    dances.prepare()
    live.show(dances)
    live.make_now(player.id, 3.0)
    assert seen is not None
    for pose in (live.pose_now(player.id, 3.0), live.pose(player.id, 3.0)):
        assert np.array_equal(pose.rotations, seen.rotations)
    while live.work():
        pass
    danced = live.pose_now(player.id, 3.0)
    assert not np.array_equal(danced.rotations, seen.rotations)
    # From now on it is known.
    assert Performance(set_parameters(dances.project, (player.id,), sway=0.5), dances).prepare_within(60.0)
