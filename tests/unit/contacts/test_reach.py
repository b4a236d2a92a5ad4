"""Players who cannot reach a place are reported note by note, compared with the hands in the exported motion."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.contacts import reach
from app.errors import FileError
from app.performance.bodies import character_of, hold_of
from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.plan.by_hand.corrections import PinFingering
from app.project.edit.corrections import with_corrections
from app.project.model import Project, map_choices, project_from_score
from app.project.performers import Player
from app.rig.grip.grip_pose import GripPose, hand_targets
from app.rig.skeleton import forward
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.performed import in_seventh, player_motion

AIR = Path(__file__).parents[2] / "data" / "midi" / "ensemble" / "trombone_quartet_bach_air.mid"
FPS = Fraction(25)


def played_by(character_id: str) -> Project:
    maps = bundled_maps()
    project = project_from_score(read_midi(AIR, maps=map_choices(maps.values())), maps)
    players = tuple(msgspec.structs.replace(player, character_id=character_id) for player in project.players)
    return replace(project, players=players)


def short_arms() -> Project:
    """Players with short arms, the last of whom has notes in seventh position."""
    project = played_by("woman_adult")
    return in_seventh(project, project.players[3])


def unreached(project: Project, player_id: str) -> set[str | None]:
    return unreached_at(Performance(project), project.player(player_id))


def unreached_at(performance: Performance, player: Player) -> set[str | None]:
    return set(reach.notes_out_of_reach(performance.problems(player.id)))


def test_long_arms_reach_everything() -> None:
    project = played_by("man_adult")
    assert all(unreached(project, player.id) == set() for player in project.players)


@pytest.mark.parametrize("index", [0, 3])
def test_what_is_reported_is_what_the_motion_shows(index: int) -> None:
    """In the motion, the slide stops at the reported place at these notes only, with the hand on it."""
    project = short_arms()
    player = project.players[index]
    performance = Performance(project)
    motion = player_motion(performance, player, whole_span(performance.time_frame, FPS))
    hold = hold_of(player, performance.instrument(player))
    skeleton = character_of(player).skeleton
    for hand in hold.hands:
        wrist = skeleton.index(f"{hand.side}Hand")
        reached_m, _ = forward(skeleton, motion.rotations, motion.hips_m, (wrist,)).of(wrist)
        requested_m, _ = hand_targets(hand, motion.instrument_position_m, motion.instrument_rotation, motion.controls)
        assert np.linalg.norm(reached_m - requested_m, axis=1).max() < 0.001
    problems = performance.problems(player.id)
    reported = {item.note_id: item.message.arguments for item in problems if item.message.id == "contact.out_of_reach"}
    assert bool(reported) == (index == 3)
    travel_mm = 1000.0 * performance.instrument(player).control("slide").travel_m
    for event in performance.plan(player).fingerings:
        frame = int(np.ceil((event.start_s - motion.first_frame_s) * FPS))
        short_mm = travel_mm * (event.controls.get("slide", 0.0) - float(motion.controls["slide"][frame]))
        if event.note_id in reported:
            assert reported[event.note_id]["control"] == "slide"
            # The report assumes a motionless body, but after a breath the body leans back.
            assert short_mm == pytest.approx(reported[event.note_id]["gap_mm"], abs=20.0)
        else:
            assert abs(short_mm) < 5.0


def test_another_fingering_settles_it() -> None:
    project = short_arms()
    player = project.players[3]
    instrument = Performance(project).instrument(player)
    pitches = {note.id: note.pitch for note in project.part(player).notes}
    before = unreached(project, player.id)
    near = {
        note_id: fingering.label
        for note_id in before
        if note_id is not None
        for fingering in instrument.fingerings
        if fingering.written_pitch - instrument.transposition_semitones == pitches[note_id]
        and fingering.label.startswith("T")
    }
    assert near
    pinned = with_corrections(project, player.id, [PinFingering(note_id, label) for note_id, label in near.items()])
    assert unreached(pinned, player.id) == before - set(near)


def test_a_model_that_cannot_be_read_is_a_problem_of_its_player_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    project = played_by("man_adult")
    ill = project.players[1].id

    def hold(player: Player, instrument: InstrumentMap) -> GripPose:
        if player.id == ill:
            raise FileError("model.invalid", file="x.glb", detail="damaged")
        return hold_of(player, instrument)

    monkeypatch.setattr("app.performance.body_problems.hold_of", hold)
    performance = Performance(project)
    reported = {
        player.id: [problem.message.id for problem in performance.problems(player.id)] for player in project.players
    }
    assert reported == {player.id: ["model.invalid"] if player.id == ill else [] for player in project.players}
    assert all(plan.fingerings for plan in performance.plans.values())


def test_after_an_edit_no_one_is_posed_again_for_places_that_were_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    project = short_arms()
    performance = Performance(project)
    player = next(player for player in project.players if unreached_at(performance, player))
    reported = unreached_at(performance, player)
    other = next(note for note in project.part(player).notes if note.id not in reported)
    monkeypatch.setattr(reach, "_gaps_m", lambda *given: pytest.fail("these places are known"))
    event = next(event for event in performance.plan(player).fingerings if event.note_id == other.id)
    pinned = with_corrections(project, player.id, [PinFingering(other.id, event.label)])
    edited = Performance(pinned, performance)
    assert edited.plan(player).fingerings is not performance.plan(player).fingerings
    assert unreached_at(edited, player) == reported
    monkeypatch.undo()
    assert unreached_at(Performance(pinned), player) == reported
