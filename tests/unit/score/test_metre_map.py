"""Bars, beats and felt beats of ticks compared with counting them one by one."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.score.metre_map import Metre, MetreMap

MAP = MetreMap(480, (Metre(0, 4, 4), Metre(3840, 6, 8)))


@pytest.mark.parametrize(
    ("tick", "text"),
    [
        (0, "1.1.000"),
        (480, "1.2.000"),
        (2040, "2.1.120"),
        (3840, "3.1.000"),
        (4080, "3.2.000"),
        (4081, "3.2.001"),
        (-480, "0.4.000"),
    ],
)
def test_places_are_written_and_read(tick: int, text: str) -> None:
    assert MAP.label(tick) == text
    assert MAP.tick_of_label(text) == tick


def test_ticks_have_the_digits_of_the_longest_beat() -> None:
    """In a quarter of 1920 ticks a position has as many digits at the beginning of a beat as at its end."""
    fine = MetreMap(1920, (Metre(0, 4, 4), Metre(15360, 6, 8)))
    assert [fine.label(tick) for tick in (0, 96, 1919, 15361)] == ["1.1.0000", "1.1.0096", "1.1.1919", "3.1.0001"]
    assert fine.tick_of_label("1.1.0096") == fine.tick_of_label("1.1.96") == 96


@pytest.mark.parametrize(
    ("text", "tick"), [("2", 1920), (" 2 | 3 ", 2880), ("２．１", 1920), ("3:2:5", 4085), ("x", None), ("1.0", None)]
)
def test_what_is_typed_is_understood(text: str, tick: int | None) -> None:
    assert MAP.tick_of_label(text) == tick


def test_the_beats_of_a_pickup_are_counted_back_from_the_bar_line() -> None:
    pickup = MetreMap(480, (Metre(0, 4, 4), Metre(720, 4, 4)), has_pickup=True)
    places = {0: "0.1.000", 239: "0.1.239", 240: "0.2.000", 719: "0.2.479", 720: "1.1.000"}
    assert {tick: pickup.label(tick) for tick in places} == places
    assert pickup.beats_of_bar(0).tolist() == [0, 240]
    assert [row.tolist() for row in pickup.counted(0, 2)] == [[240, 720, 1200, 1680, 2160], [0, 0, 1, 2, 3]]
    # A bar that another metre cuts short is counted from its beginning.
    cut = MetreMap(480, (Metre(0, 4, 4), Metre(720, 4, 4)))
    assert cut.counted(1, 2)[0].tolist() == [0, 480]


class Counted:
    """Bars and beats of a map, counted with fractions from the first metre to a tick."""

    def __init__(self, given: MetreMap, end_tick: int) -> None:
        stops = [*(metre.tick for metre in given.metres[1:]), end_tick]
        number = 0 if given.has_pickup else 1
        self.bars: list[tuple[int, int, int]] = []
        """Number, first tick, denominator."""
        for metre, stop in zip(given.metres, stops, strict=True):
            bar = Fraction(4 * given.ticks_per_quarter * metre.numerator, metre.denominator)
            at = Fraction(metre.tick)
            while int(at) < stop:
                self.bars.append((number, int(at), metre.denominator))
                at, number = at + bar, number + 1
        self.end_tick = end_tick
        self.ticks_per_quarter = given.ticks_per_quarter
        self.has_pickup = given.has_pickup

    def beats(self, index: int) -> list[int]:
        """Return the ticks at which the beats of a bar begin."""
        number, start, denominator = self.bars[index]
        end = self.bars[index + 1][1]
        beat = Fraction(4 * self.ticks_per_quarter, denominator)
        whole = [int(beat * k) for k in range(int((end - start) / beat) + 2)]
        if number == 0 and self.has_pickup:
            count = (end - start) // beat
            early = end - start - int(beat * count)
            return sorted({start, *(start + early + at for at in whole[:count])})
        return [start + at for at in whole if start + at < end]


@st.composite
def maps(draw: st.DrawFn) -> MetreMap:
    """Metres that change anywhere, also within a bar or beat; with or without a pickup, at resolutions that
    fit no bar.
    """
    ticks_per_quarter = draw(st.sampled_from([1, 5, 24, 96, 480]))
    ticks = sorted({0, *draw(st.lists(st.integers(1, 60 * ticks_per_quarter), max_size=4))})
    kinds = st.tuples(st.integers(1, 13), st.sampled_from([1, 2, 4, 8, 16]))
    metres = [Metre(tick, *draw(kinds)) for tick in ticks]
    first = metres[0]
    within = len(metres) > 1 and metres[1].tick * first.denominator <= 4 * ticks_per_quarter * first.numerator
    felt = draw(st.sampled_from([(), ((0, 3 * ticks_per_quarter),), ((0, ticks_per_quarter), (ticks[-1], 7))]))
    return MetreMap(ticks_per_quarter, tuple(metres), within and draw(st.booleans()), felt)


@given(maps())
def test_bars_and_beats_are_those_that_are_counted_out(given_map: MetreMap) -> None:
    end = given_map.metres[-1].tick + 20 * given_map.ticks_per_quarter
    slow = Counted(given_map, end)
    if any(one[1] == two[1] for one, two in pairwise(slow.bars)):
        return  # Several bars in a tick: a file of a tick to the quarter. Which of them it is no one can say.
    ticks = np.arange(end, dtype=np.int64)
    starts = np.array([start for _, start, _ in slow.bars])
    place = np.searchsorted(starts, ticks, side="right") - 1
    numbers = np.array([number for number, _, _ in slow.bars])
    np.testing.assert_array_equal(given_map.bar_of_tick(ticks), numbers[place])
    np.testing.assert_array_equal(given_map.tick_of_bar(numbers), starts)
    np.testing.assert_array_equal(given_map.bars(0, end), starts)
    for index in range(len(slow.bars) - 1):
        number, start, _ = slow.bars[index]
        beats = slow.beats(index)
        assert given_map.span_of_bar(number) == (start, slow.bars[index + 1][1])
        assert sorted(set(given_map.beats_of_bar(number).tolist())) == sorted(set(beats))
        for tick in range(start, min(slow.bars[index + 1][1], start + 40)):
            bar, beat, rest = given_map.place_of_tick(tick)
            assert (bar, max(at for at in beats if at <= tick)) == (number, tick - rest)
            assert beats[beat - 1] == tick - rest
            assert given_map.tick_of_place(bar, beat, rest) == tick
            assert given_map.tick_of_label(given_map.label(tick)) == tick


@given(maps(), st.integers(-5000, 40000))
def test_one_tick_is_placed_as_many_are(given_map: MetreMap, tick: int) -> None:
    bar = given_map.bar_of_tick(tick)
    assert given_map.bar_of_tick(np.array([tick]))[0] == bar
    assert given_map.tick_of_bar(np.array([bar]))[0] == given_map.tick_of_bar(bar)
    assert given_map.felt_ticks_at(np.array([tick]))[0] == given_map.felt_ticks_at(tick)
    start, end = given_map.span_of_bar(bar)
    assert start <= tick < max(end, start + 1)
    assert given_map.bar_of_tick(tick + 1) in (bar, bar + 1) or given_map.ticks_per_quarter < 24


@given(maps(), st.integers(-3000, 20000), st.integers(1, 9000))
def test_felt_beats_begin_anew_in_every_bar(given_map: MetreMap, first_tick: int, length: int) -> None:
    beats = given_map.felt_between(first_tick, first_tick + length)
    bars = given_map.bars(first_tick, first_tick + length + 1)
    expected = []
    for start, stop in pairwise(
        [*bars.tolist(), max(bars[-1] + 1, first_tick + length + given_map.felt_ticks_at(int(bars[-1])))]
    ):
        expected += range(start, stop, given_map.felt_ticks_at(start))
    assert beats.tolist() == expected
    assert beats[0] <= first_tick
    assert beats[-1] >= first_tick + length or given_map.ticks_per_quarter < 24


@given(maps())
def test_counted_beats_are_the_felt_ones_where_they_divide_the_bar(given_map: MetreMap) -> None:
    last = given_map.bar_of_tick(given_map.metres[-1].tick) + 3
    ticks, numbers = given_map.counted(0, last)
    expected: list[tuple[int, int]] = []
    for bar in range(last):
        start, end = given_map.span_of_bar(bar)
        felt = given_map.felt_ticks_at(start)
        beats = given_map.beats_of_bar(bar).tolist()
        if (end - start) % felt == 0:
            beats = list(range(start, end, felt))
        elif given_map.has_pickup and bar == 0 and [*beats, end][1] - start < int(given_map.beat_length(start)):
            # What is left over of a beat is not counted.
            beats = beats[1:]
        expected += zip(beats, range(len(beats)), strict=True)
    assert list(zip(ticks.tolist(), numbers.tolist(), strict=True)) == expected


def test_a_long_file_is_mapped_at_once() -> None:
    """A million bars and a hundred metres: exact to the last bar, with loops over metres only."""
    metres = tuple(Metre(1920 * 100 * index + index, 4 + index % 3, 4) for index in range(10_000))
    long = MetreMap(480, metres)
    bars = np.arange(1, 1_000_000, dtype=np.int64)
    ticks = long.tick_of_bar(bars)
    assert np.all(np.diff(ticks) > 0)
    np.testing.assert_array_equal(long.bar_of_tick(ticks), bars)
    assert long.tick_of_bar(999_999) == ticks[-1]
