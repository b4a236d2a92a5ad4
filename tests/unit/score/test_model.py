"""Bars and notes."""

import numpy as np
import pytest

from app.score.metre_map import Metre
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap


def score(*metres: Metre, pickup_ticks: int = 0, end_tick: int = 1, ticks_per_quarter: int = 480) -> Score:
    part = Part("1.1.1", "", 0, 0, 0, None, None, "any", (Note("1:1", 0, end_tick, 60, 64),))
    return Score(
        "", ticks_per_quarter, TempoMap(ticks_per_quarter), metres=metres, pickup_ticks=pickup_ticks, parts=(part,)
    )


def test_bars_count_from_one() -> None:
    four_four = score(Metre(0, 4, 4))
    assert [four_four.metre_map.tick_of_bar(bar) for bar in (1, 2, 10)] == [0, 1920, 17280]
    assert [four_four.metre_map.bar_of_tick(tick) for tick in (0, 1919, 1920, 17280)] == [1, 1, 2, 10]


def test_before_the_first_bar_the_metre_goes_on_backwards() -> None:
    three_four = score(Metre(0, 3, 4))
    assert [three_four.metre_map.bar_of_tick(tick) for tick in (-1, -1440, -1441)] == [0, 0, -1]
    assert three_four.metre_map.tick_of_bar(0) == -1440


def test_a_pickup_is_bar_zero() -> None:
    piece = score(Metre(0, 1, 4), Metre(480, 4, 4), pickup_ticks=480, end_tick=480 + 2 * 1920)
    assert [piece.metre_map.tick_of_bar(bar) for bar in (0, 1, 2)] == [0, 480, 2400]
    assert [piece.metre_map.bar_of_tick(tick) for tick in (0, 479, 480, 2399, 2400)] == [0, 0, 1, 1, 2]
    assert piece.bar_starts.tolist() == [0, 480, 2400]


def test_bars_go_through_changes_of_metre_and_a_change_within_a_bar_begins_a_new_one() -> None:
    piece = score(Metre(0, 6, 8), Metre(2880, 3, 2), Metre(2880 + 3000, 2, 4), end_tick=8000)
    # Two bars of 6/8, two of 3/2 of which the second is cut short, then 2/4.
    assert piece.bar_starts.tolist() == [0, 1440, 2880, 5760, 5880, 6840, 7800]
    assert [piece.metre_map.bar_of_tick(int(tick)) for tick in piece.bar_starts] == [1, 2, 3, 4, 5, 6, 7]


@pytest.mark.parametrize("ticks_per_quarter", [1, 7, 25, 96])
def test_bars_that_are_no_whole_number_of_ticks_neither_drift_nor_overlap(ticks_per_quarter: int) -> None:
    piece = score(Metre(0, 5, 16), end_tick=500, ticks_per_quarter=ticks_per_quarter)
    starts = piece.bar_starts
    exact = np.arange(len(starts)) * ticks_per_quarter * 5 / 4
    assert np.all(np.abs(starts - exact) < 1)
    numbers = [piece.metre_map.bar_of_tick(tick) for tick in range(500)]
    slow = [int(np.sum(starts <= tick)) for tick in range(500)]
    assert numbers == slow
