"""Rests of the score are distinguished from the ends of detached notes."""

from __future__ import annotations

import pytest

from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from app.plan.music.rests import rest_ticks
from app.plan.parameters import PlayerParameters
from app.score.felt_beat import felt_beat_ticks
from app.score.metre_map import Metre
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480


def rests(notes: tuple[PlainNote, ...], bpm: float = 120.0) -> list[int]:
    clock = PlainClock(((0, bpm),))
    times = line_times(MonophonicPart("p", notes, valves()), clock)
    return rest_ticks(times, piece_of(clock).beat_ticks_at(times.onset_tick)).tolist()[1:]


def line(*pairs: tuple[float, float]) -> tuple[PlainNote, ...]:
    """Notes with the silences after them in quarters."""
    at, rows = 0.0, []
    for length, silence in pairs:
        rows.append((round(at * Q), round(length * Q), 65))
        at += length + silence
    return line_of(*rows)


@pytest.mark.parametrize("gate", [0.3, 0.5, 0.8, 0.95])
def test_detached_notes_have_no_rests_between_them(gate: float) -> None:
    assert rests(line_of(*((beat * Q, round(gate * Q), 65) for beat in range(8)))) == [0] * 7


def test_the_silence_after_detached_notes_is_a_rest() -> None:
    beats = [0, 1, 2, 3, 5, 6, 7, 8]
    found = rests(line_of(*((beat * Q, Q // 2, 65) for beat in beats)))
    assert found == [0, 0, 0, 3 * Q // 2, 0, 0, 0]


def test_a_rest_between_notes_that_touch_is_one() -> None:
    assert rests(line_of((0, Q, 65), (Q, Q // 2, 67), (2 * Q, Q, 65), (3 * Q, Q, 65))) == [0, Q // 2, 0]


def test_a_beat_of_silence_is_always_a_rest() -> None:
    assert rests(line_of(*((2 * beat * Q, Q, 65) for beat in range(6)))) == [Q] * 5


def test_notes_of_any_length_that_keep_the_habit_of_the_line_have_no_rests() -> None:
    steps = [1, 3, 2, 2, 1, 4, 1, 3]
    onset, notes = 0, []
    for step in steps:
        notes.append((onset, round(0.8 * step * Q / 2), 65))
        onset += step * Q // 2
    assert rests(line_of(*notes)) == [0] * 7


@pytest.mark.parametrize("bpm", [60.0, 96.0, 144.0, 200.0])
@pytest.mark.parametrize("gate", [0.3, 0.5, 0.7])
@pytest.mark.parametrize("steps", [(1.0,), (0.5,), (0.5, 0.5, 1.0), (0.75, 0.25, 1.0), (1.0, 0.5)])
def test_a_staccato_run_at_one_gate_has_no_rests(steps: tuple[float, ...], gate: float, bpm: float) -> None:
    """Alone, and with equal steps also among other notes; the last note of a run may have a rest."""
    run = [(gate * step, (1.0 - gate) * step) for step in steps * 8]
    assert not any(rests(line(*run, (1, 0)), bpm))
    if len(steps) == 1:
        assert not any(rests(line(*[(1, 0)] * 40, *run, (1, 0)), bpm))


@pytest.mark.parametrize(("count", "found"), [(4, True), (5, True), (12, False)])
def test_a_few_slow_notes_with_half_a_second_of_rest_each_are_no_staccato_run(count: int, found: bool) -> None:
    assert rests(line((2, 0), *[(0.5, 0.5)] * count, (2, 0)), bpm=60.0) == [0, *[found * Q // 2] * count]
    assert not any(rests(line((2, 0), *[(0.5, 0.5)] * count, (2, 0)), bpm=66.0))


@pytest.mark.parametrize("bpm", [48.0, 72.0, 96.0])
@pytest.mark.parametrize("count", [3, 8, 30])
def test_equal_rests_after_long_notes_are_rests(bpm: float, count: int) -> None:
    """One and a half beats and half a beat of rest: a staccato note does not last 0.8 s."""
    assert rests(line(*[(1.5, 0.5)] * count, (1, 0)), bpm) == [Q // 2] * count


def test_rests_that_grow_between_equal_notes_are_no_run() -> None:
    """Each step differs little from the next, and much from the last."""
    silences = [0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9]
    found = rests(line(*((0.5, silence) for silence in silences), (0.5, 0)))
    assert found == [round(silence * Q) for silence in silences]


def test_a_silence_of_three_quarters_of_a_second_is_a_rest() -> None:
    assert rests(line(*[(0.125, 0.875)] * 8, (1, 0)), bpm=60.0) == [round(0.875 * Q)] * 8
    assert not any(rests(line(*[(0.125, 0.875)] * 8, (1, 0)), bpm=100.0))


@pytest.mark.parametrize(
    ("numerator", "denominator", "quarters_bpm", "quarters"),
    [
        (4, 4, 120.0, 1.0),
        (4, 4, 200.0, 1.0),
        (6, 8, 150.0, 1.5),  # a dotted quarter of 100
        (6, 8, 45.0, 0.5),  # slow enough to be counted in six
        (12, 8, 120.0, 1.5),
        (9, 16, 60.0, 0.75),
        (2, 2, 160.0, 2.0),
        (2, 2, 60.0, 1.0),
        (3, 4, 180.0, 3.0),
        (3, 4, 120.0, 1.0),
        (3, 8, 60.0, 0.5),
        (3, 8, 100.0, 1.5),
        (3, 16, 36.0, 0.75),
        (2, 4, 60.0, 1.0),
        (4, 4, 240.0, 2.0),
        (5, 8, 100.0, 0.5),
    ],
)
def test_the_felt_beat(numerator: int, denominator: int, quarters_bpm: float, quarters: float) -> None:
    assert felt_beat_ticks(numerator, denominator, quarters_bpm, Q) == quarters * Q


def test_a_rest_is_breathed_in_when_enough_air_is_spent() -> None:
    # Bars of three beats and a rest of one at 120: 1.5 s of the 9 s that there are, each.
    notes = line_of(*((bar * 4 * Q + beat * Q, Q, 65 + beat) for bar in range(12) for beat in range(3)))
    clock = PlainClock()

    def breaths(need: float) -> list[int]:
        line = MonophonicPart("p", notes, valves(), PlayerParameters(breath_need=need))
        plan = make_plans(piece_of(clock, (Metre(0, 4, 4),)), (line,), time_frame((line,), clock))["p"]
        return [event.end_tick // (4 * Q) for event in plan.breaths if event.kind == "breath"]

    assert breaths(0.0) == list(range(12))
    assert breaths(0.3) == [0, 2, 4, 6, 8, 10]
    assert breaths(0.5) == [0, 3, 6, 9]
