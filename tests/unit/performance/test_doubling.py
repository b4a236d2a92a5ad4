"""One body with several instruments: nothing is lost, nothing jumps, and instruments put aside do not move."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import msgspec
import numpy as np
import pytest

from app.contacts.judge import ContactJudge
from app.motion.model import Motion
from app.performance.bodies import character_of, lies_at
from app.performance.cast import performer_of
from app.performance.ensemble import Performance, changes_of
from app.performance.live import LiveMotion
from app.performance.motion import performance_curves, player_motion
from app.performance.play_along import PlayAlong
from app.performance.span import FrameSpan, whole_span
from app.plan.doubling import NEEDED_S, USUAL_S
from app.project.edit import players as edit
from app.rig import quaternion
from app.rig.skeleton import forward
from instrument_maps.load import bundled_maps
from tests.support.doubled import flutist

FPS = Fraction(30)
MOST_RAD_S = 7.0
"""Greatest speed in rad/s of trunk and arms in a change of instrument; musicians can move an arm three times
as fast.
"""


@cache
def performed(rest_bars: int = 2) -> Performance:
    return Performance(flutist(rest_bars))


def motion_of(performance: Performance, number: int, span: FrameSpan | None = None) -> Motion:
    player = performance.project.players[number]
    return player_motion(
        performance, performer_of(performance, player), span or whole_span(performance.time_frame, FPS)
    )


def seconds(performance: Performance) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    span = whole_span(performance.time_frame, FPS)
    return span.first_frame_s + np.arange(span.count) / float(FPS)


def test_both_instruments_are_played_by_one_body_that_does_not_jump() -> None:
    performance = performed()
    flute, piccolo = (motion_of(performance, number) for number in (0, 1))
    assert np.array_equal(flute.rotations, piccolo.rotations)
    assert np.array_equal(flute.hips_m, piccolo.hips_m)
    turns = flute.rotations.astype(np.float64)
    speeds = np.linalg.norm(
        quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(turns[:-1]), turns[1:])), axis=2
    ) * float(FPS)
    names = character_of(performance.project.players[0]).skeleton.names
    # Fingers and eyes are as quick as ever.
    large = [
        index for index, name in enumerate(names)
        if name.endswith(("Arm", "Shoulder", "Hand", "Leg", "Foot")) or name in ("hips", "spine", "chest", "head")
    ]  # fmt: skip
    times_s = seconds(performance)[:-1]
    _, found = changes_of(performance, performance.project.players[:2])
    assert len(found) == 2
    for change in found:
        here = (times_s >= change.start_s - 0.2) & (times_s <= change.end_s + 0.2)
        assert speeds[here][:, large].max() < MOST_RAD_S


def test_contacts_of_both_are_kept_and_feet_stay() -> None:
    performance = performed()
    for number in (0, 1):
        performer = performer_of(performance, performance.project.players[number])
        playing = performance_curves(performance, performer)
        judge = ContactJudge(playing, performer.character, performer.model)
        assert judge.breaks(motion_of(performance, number)) == ()


def test_what_is_not_in_the_hands_lies_still_where_it_is_said_and_the_hand_takes_it_there() -> None:
    performance, times_s = performed(), seconds(performed())
    players = performance.project.players[:2]
    _, (there, back) = changes_of(performance, players)
    away = [(there.put_s, back.taken_s), (-np.inf, there.taken_s)]
    for number, player in enumerate(players):
        found = lies_at(player, bundled_maps()[player.instrument_id], number)
        assert found is not None
        motion = motion_of(performance, number)
        lies = (times_s >= away[number][0]) & (times_s <= away[number][1])
        assert np.abs(motion.instrument_position_m[lies] - found[0]).max() < 1e-6
        assert np.abs(motion.instrument_rotation[lies] - found[1]).max() < 1e-6
        # On its way it is in the hand that bears it: it is as far from that hand as while it is played.
        performer = performer_of(performance, player)
        side = performer.instrument.hold.support_hand
        wrist = performer.character.skeleton.index(f"{side}Hand")
        posed = forward(performer.character.skeleton, motion.rotations, motion.hips_m, [wrist])
        gap_m = np.linalg.norm(posed.of(wrist)[0] - motion.instrument_position_m, axis=1)
        carried = (
            (times_s >= there.start_s) & (times_s <= there.put_s)
            if number == 0
            else ((times_s >= there.taken_s) & (times_s <= there.end_s))
        )
        assert np.ptp(gap_m[carried]) < 0.001


def test_a_change_is_made_in_the_rest_and_before_the_breath() -> None:
    performance = performed()
    flute, piccolo = performance.project.players[:2]
    _, (there, back) = changes_of(performance, (flute, piccolo))
    for change, before, after in ((there, flute, piccolo), (back, piccolo, flute)):
        last = max(e.end_s for e in performance.plan(before).fingerings if e.end_s <= change.end_s)
        first = min(e.start_s for e in performance.plan(after).fingerings if e.start_s >= change.start_s)
        breath = max(
            (e.start_s for e in performance.plan(after).breaths if e.kind == "breath" and e.start_s < first),
        )
        assert last < change.start_s < change.put_s < change.taken_s < change.end_s <= breath
        assert change.rest_s == pytest.approx(first - last)
        assert NEEDED_S <= change.end_s - change.start_s <= USUAL_S


def test_nothing_is_planned_for_what_lies_aside_and_no_one_cues_themselves() -> None:
    performance = performed()
    flute, piccolo = (performance.plan(player) for player in performance.project.players[:2])
    _, (there, back) = changes_of(performance, performance.project.players[:2])
    for event in (*flute.expressions, *(one for one in flute.gestures if one.kind != "lower_instrument")):
        assert event.start_s < there.put_s or event.end_s > back.taken_s  # type: ignore[attr-defined]
    for event in (*piccolo.expressions, *(one for one in piccolo.gestures if one.kind != "lower_instrument")):
        assert event.end_s > there.taken_s  # type: ignore[attr-defined]
        assert event.start_s < back.put_s  # type: ignore[attr-defined]
    # After two bars of rest a soloist needs no cue; two players would have been given one here.
    assert piccolo.cues == ()
    apart = Performance(edit.separate(performance.project, (performance.project.players[1].id,)))
    assert apart.plan(apart.project.players[1]).cues


def test_too_short_a_rest_is_reported_at_the_note_that_suffers() -> None:
    performance = performed(0)
    problems = performance.problems(performance.project.players[1].id)
    assert [problem.message.id for problem in problems] == ["doubling.rest_short"]
    assert problems[0].note_id == "1:9"
    assert not any(
        problem.message.id.startswith("doubling") for player in performed().project.players
        for problem in performed().problems(player.id)
    )  # fmt: skip
    assert np.isfinite(motion_of(performance, 0).rotations).all()


def test_the_same_frames_are_the_same_in_every_span() -> None:
    performance = performed()
    span = whole_span(performance.time_frame, FPS)
    _, (there, _) = changes_of(performance, performance.project.players[:2])
    first = round((there.start_s + 0.4 - span.first_frame_s) * FPS)
    part = FrameSpan(span.fps, span.first + first, 70, span.first_frame_s + first / float(FPS))
    for number in (0, 1):
        whole, some = motion_of(performance, number), motion_of(performance, number, part)
        assert np.array_equal(whole.rotations[first : first + 70], some.rotations)
        assert np.array_equal(whole.hips_m[first : first + 70], some.hips_m)
        assert np.array_equal(whole.instrument_position_m[first : first + 70], some.instrument_position_m)
        for name, values in some.morphs.items():
            assert np.array_equal(whole.morphs.get(name, np.zeros(len(whole.hips_m)))[first : first + 70], values)


def test_after_an_edit_of_one_instrument_the_other_shows_it_too() -> None:
    before = Performance(replace(flutist(), fps=FPS))
    live = LiveMotion(before)
    while live.work():
        pass
    flute, piccolo, oboe = before.project.players
    notes = before.project.part(piccolo).notes
    shorter = msgspec.structs.replace(before.project.part(piccolo), notes=notes[1:])
    parts = (before.project.score.parts[0], shorter, before.project.score.parts[2])
    project = replace(before.project, score=msgspec.structs.replace(before.project.score, parts=parts))
    after = Performance(project, before)
    after.prepare()
    live.show(after)
    while live.work():
        pass
    fresh = LiveMotion(Performance(project))
    while fresh.work():
        pass
    at_s = before.plan(piccolo).fingerings[0].start_s
    for player in (flute, piccolo, oboe):
        for time_s in (at_s - 1.0, at_s - 0.2, at_s + 0.1):
            shown, right = live.pose(player.id, time_s), fresh.pose(player.id, time_s)
            assert np.array_equal(shown.rotations, right.rotations)
            assert np.array_equal(shown.instrument_position_m, right.instrument_position_m)


def test_who_plays_along_on_one_has_put_the_other_aside() -> None:
    performance = performed()
    flute, piccolo = performance.project.players[:2]
    along = PlayAlong(performance_curves(performance, performer_of(performance, piccolo), danced=False))
    found = lies_at(flute, bundled_maps()["flute"], 0)
    assert found is not None
    assert list(along.lying) == [flute.id]
    assert np.allclose(along.lying[flute.id][0], found[0], atol=1e-6)


def test_an_instrument_that_cannot_be_seen_leaves_the_other_its_body() -> None:
    project = flutist()
    piccolo = project.players[1]
    unknown = Performance(edit.change(project, (piccolo.id,), instrument_id="no_such_thing"))
    assert np.isfinite(motion_of(unknown, 0).rotations).all()
