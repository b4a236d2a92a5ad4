"""Phrases, leans, accents, stillness and foot gestures: planned places and differences between players."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from app.plan.generate import MonophonicPart
from app.plan.gestures.feet import FOOT_KINDS, lifted_s
from app.plan.gestures.sways import BLOCK, pulse, swings_of
from app.plan.model import ACCENT_AT, GestureEvent, PlayerPlan, TimeFrame
from app.plan.music.dynamics import dynamics_of
from app.plan.music.piece import Seeds
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, PlainNote, even, line_of, make_plans, piece_of, time_frame, valves

Q = 480
CLOCK = PlainClock()
PIECE = piece_of(CLOCK, (Metre(0, 4, 4),))


def plan_of(notes: tuple[PlainNote, ...], player: str = "p") -> PlayerPlan:
    line = MonophonicPart(player, notes, valves())
    return make_plans(PIECE, (line,), time_frame((line,), CLOCK))[player]


def of_kind(plan: PlayerPlan, *kinds: str) -> list[GestureEvent]:
    return [event for event in plan.gestures if event.kind in kinds]


def song(phrases: int = 12) -> tuple[PlainNote, ...]:
    """Phrases of 14 beats that rise to the tenth, with a rest of two beats after each."""
    rows = []
    for phrase in range(phrases):
        for beat in range(14):
            pitch = 60 + beat if beat < 10 else 69 - 2 * (beat - 9)
            rows.append(((16 * phrase + beat) * Q, Q, pitch))
    return line_of(*rows)


def test_a_phrase_is_leant_into_to_its_climax_and_left_at_its_end() -> None:
    leans = of_kind(plan_of(song()), "lean")
    pairs = list(zip(leans[::2], leans[1::2], strict=True))
    assert len(pairs) >= 10
    for up, back in pairs:
        assert up.end_s == back.start_s
        assert 0.2 <= abs(up.amount) <= 1.0
        # The climax is the highest note, 9 beats in.
        assert (up.end_tick - up.start_tick) == 9 * Q
        assert abs(back.amount) < 0.2 * abs(up.amount)
        assert (back.end_tick // Q) % 16 == 14
    # Most lean in, some open up.
    assert np.mean([up.amount > 0.0 for up, _ in pairs]) > 0.5


def test_accents_are_on_strong_notes_and_not_on_every_beat() -> None:
    accents = of_kind(plan_of(song(24)), "accent")
    peaks_s = np.array([event.start_s + ACCENT_AT * (event.end_s - event.start_s) for event in accents])
    beats = np.arange(0.0, 24 * 16 * 0.5, 0.5)
    assert np.abs(peaks_s[:, None] - beats).min(axis=1).max() < 1e-6
    assert 0.02 < len(accents) / len(beats) < 0.35
    # No two distances in a row are a metronome's.
    apart = np.round(np.diff(peaks_s) / 0.5)
    assert len(set(apart.tolist())) >= 4


def test_what_is_played_louder_than_its_neighbours_is_accented() -> None:
    notes = tuple(
        PlainNote(f"1:{i}", i * Q, Q, 65, 118 if i in (7, 18, 29, 46) else 70 + i % 3) for i in range(64)
    )  # fmt: skip
    accents = {event.id: event for event in of_kind(plan_of(notes), "accent")}
    for beat in (7, 18, 29, 46):
        assert accents[f"accent:@{beat * Q}"].amount > 0.5
        assert accents[f"accent:@{beat * Q}"].reason.id == "gesture.accent_loud"


def test_swings_are_of_several_lengths_with_stillness_between() -> None:
    plan = plan_of(even([65, 67, 69, 70] * 120, Q))
    sways = of_kind(plan, "sway")
    lengths = [event.reason.arguments.get("beats", 0) for event in sways]
    assert {0, *(count * lengths_of(lengths) for count in (1, 2, 4))} == set(lengths)
    still = [event for event, length in zip(sways, lengths, strict=True) if length == 0]
    assert 0.08 < len(still) / len(sways) < 0.35
    for event, following in itertools.pairwise(sways):
        if following.reason.id == "gesture.still" and event.reason.id == "gesture.still":
            assert following.amount == pytest.approx(event.amount, abs=0.02)


def lengths_of(lengths: list[object]) -> int:
    return min(length for length in lengths if isinstance(length, int) and length > 0)


def test_stillness_is_a_share_that_can_be_set() -> None:
    line = MonophonicPart("p", even([65, 67, 69, 70] * 200, Q), valves())
    from app.plan.music.piece import note_times

    times = note_times(line.notes, (), CLOCK)
    frame = TimeFrame(-2.0, 400.0)
    made = [
        swings_of(times.rhythm, pulse(PIECE, frame, 0.0), frame, Seeds(("p",)), dynamics_of(times, None), share)
        for share in (0.0, 0.5, 1.0)
    ]
    shares = [float(np.mean(one.lasts == 0)) for one in made]
    assert shares[0] == 0.0
    assert 0.2 < shares[1] < 0.55
    assert shares[2] > (BLOCK - 1) / BLOCK - 0.05
    assert made[0].still_at(np.array([0, 8 * Q])).sum() == 0


def test_feet_are_never_both_off_the_ground_and_each_does_one_thing_at_a_time() -> None:
    plans = [plan_of(song(40), f"player {number}") for number in range(6)]
    kinds = {event.kind for plan in plans for event in plan.gestures}
    assert set(FOOT_KINDS) <= kinds
    for plan in plans:
        spans = sorted(span for foot in ("left", "right") for span in lifted_s(plan.gestures, foot, 0.55))
        for (_, end_s), (start_s, _) in itertools.pairwise(spans):
            assert start_s >= end_s - 1e-9


def test_taps_end_on_beats_and_steps_begin_where_a_phrase_ends() -> None:
    for number in range(6):
        plan = plan_of(song(40), f"player {number}")
        for tap in of_kind(plan, "tap"):
            assert (tap.end_s / 0.5) % 1.0 == pytest.approx(0.0, abs=1e-6) or (tap.end_s / 0.5) % 1.0 > 1.0 - 1e-6
        for step in of_kind(plan, "step"):
            beat = step.start_tick / Q % 16
            assert 13.0 < beat < 14.1
            assert step.end_s - step.start_s > 2.0


def test_a_player_of_several_instruments_only_taps() -> None:
    lines = tuple(
        MonophonicPart(f"p{number}", song(40), valves(), musician="p0") for number in range(2)
    )  # fmt: skip
    plans = make_plans(PIECE, lines, time_frame(lines, CLOCK))
    assert not [event for plan in plans.values() for event in of_kind(plan, "step", "heel")]
