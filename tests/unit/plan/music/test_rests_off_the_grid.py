"""Rests are judged by their seconds, independently of the file's grid."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from app.plan.generate import MonophonicPart
from tests.support.plan import PlainClock, line_of, make_plans, piece_of, time_frame, valves

Q = 480

_lengths_s = st.floats(0.1, 3.0)
_rests_s = st.one_of(st.just(0.0), st.floats(0.76, 1.49), st.floats(1.51, 3.0))


def breathed(rows: list[tuple[float, float]], bpm: float) -> set[int]:
    """Numbers of the notes preceded by a breath in the line with these lengths and rests in seconds."""
    at_s, notes = 0.0, []
    per_s = Q * bpm / 60.0
    for index, (length_s, rest_s) in enumerate(rows):
        onset = round(at_s * per_s)
        notes.append((onset, round((at_s + length_s) * per_s) - onset, 60 + index % 7))
        at_s += length_s + rest_s
    clock, part = PlainClock(((0, bpm),)), MonophonicPart("p", line_of(*notes), valves())
    plan = make_plans(piece_of(clock), (part,), time_frame((part,), clock))["p"]
    return {int(event.id.split(":")[-1]) for event in plan.breaths if event.kind == "breath"}


@given(st.lists(st.tuples(_lengths_s, _rests_s), min_size=2, max_size=12), st.floats(40.0, 180.0))
@example([(2.0, 0.8)] * 6, 60.0)
@example([(1.0, 0.0), (0.4, 0.77)] * 8, 97.0)
def test_rests_of_three_quarters_of_a_second_after_a_second_are_used(
    rows: list[tuple[float, float]], bpm: float
) -> None:
    found = breathed(rows, bpm)
    played_s = 0.0
    for number, (length_s, rest_s) in enumerate(rows[:-1], start=2):
        played_s += length_s
        if rest_s >= 1.5 or (rest_s >= 0.75 and played_s >= 1.02):
            assert number in found
        if number in found:
            played_s = 0.0


@pytest.mark.parametrize(("length_s", "rest_s"), [(3.0, 0.55), (2.7, 0.52), (4.3, 0.61)])
@pytest.mark.parametrize("bpm", [60.0, 67.0, 141.0])
def test_equal_rests_of_half_a_second_after_long_notes_are_used_alike(
    length_s: float, rest_s: float, bpm: float
) -> None:
    assert breathed([(length_s, rest_s)] * 6, bpm) == set(range(1, 7))
