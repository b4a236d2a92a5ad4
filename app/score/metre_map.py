"""Metre map: converts ticks to bars, beats and felt beats and back, exactly; `app.score.tempo` does so for seconds.

Bars count from 1; a pickup is bar 0. The first metre extends before the first bar, the last one past the end. Bars and
beats need not be whole numbers of ticks: each begins at the last tick not after its exact place, so errors do not add
up.
"""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_right
from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import TypeAlias, overload

import msgspec
import numpy as np
import numpy.typing as npt

from app.arrays import IntArray

FeltBeats: TypeAlias = tuple[tuple[int, int], ...]
"""Felt beats as (tick, length in ticks) from each tick on, in ascending order; at least one."""

_PLACE = re.compile(r"^\s*([-−]?\d+)(?:\s*[.|:]\s*(\d+)(?:\s*[.|:]\s*(\d+))?)?\s*$")
_MOST_KEPT = 16
"""Number of ranges whose bars and beats are cached."""
_MOST_BAR, _MOST_BEAT = 1_000_000, 10_000
"""Greatest numbers of a bar and a beat that can be entered."""


class Metre(msgspec.Struct, frozen=True):
    """A time signature from a tick on; a new bar begins there."""

    tick: int
    numerator: int
    denominator: int


def beat_ticks_at(beats: FeltBeats, ticks: npt.ArrayLike) -> IntArray:
    """Length in ticks of the felt beat at each tick, in the shape of ``ticks``; before the first entry of ``beats`` its
    length applies."""
    if len(beats) == 1:
        return np.full(np.shape(ticks), beats[0][1])
    starts, lengths = _edges(beats)
    return np.asarray(lengths[np.maximum(np.searchsorted(starts, ticks, side="right") - 1, 0)])


@lru_cache(maxsize=64)
def _edges(beats: FeltBeats) -> IntArray:
    """Return the felt beats as an array (2, N): ticks from which each applies, and their lengths in ticks."""
    edges = np.ascontiguousarray(np.array(beats, np.int64).T)
    edges.flags.writeable = False
    return edges


class MetreMap(msgspec.Struct, frozen=True, dict=True):
    """Converts ticks to bars and beats, and back.

    Attributes
    ----------
    metres : tuple of Metre
        The metres by tick, at least one. The first also applies before its tick, for the pre-roll.
    has_pickup : bool
        Whether the bars before the second metre are one incomplete bar, whose beats are counted back from its end.
    felt : tuple of (tick, ticks)
        Length of the felt beat from each tick on, by tick (see `app.score.felt_beat`); empty: a quarter.
    """

    ticks_per_quarter: int
    metres: tuple[Metre, ...] = (Metre(0, 4, 4),)
    has_pickup: bool = False
    felt: FeltBeats = ()

    @cached_property
    def _ticks(self) -> tuple[int, ...]:
        return tuple(metre.tick for metre in self.metres)

    @cached_property
    def _first_bars(self) -> tuple[int, ...]:
        """Number of the first bar of each metre change; a pickup is bar 0."""
        numbers = [0 if self.has_pickup else 1]
        for metre, following in zip(self.metres, self.metres[1:], strict=False):
            length = following.tick - metre.tick
            bars = -(-length * metre.denominator // (4 * self.ticks_per_quarter * metre.numerator))
            numbers.append(numbers[-1] + bars)
        return tuple(numbers)

    @cached_property
    def _table(self) -> tuple[IntArray, IntArray, IntArray, IntArray]:
        """Arrays that describe the metres: start tick, first bar, and the length of a bar in ticks as numerator and
        denominator.
        """
        wholes = [4 * self.ticks_per_quarter * metre.numerator for metre in self.metres]
        denominators = [metre.denominator for metre in self.metres]
        return tuple(np.array(row, np.int64) for row in (self._ticks, self._first_bars, wholes, denominators))  # type: ignore[return-value]

    # Bars

    @overload
    def bar_of_tick(self, ticks: int) -> int: ...
    @overload
    def bar_of_tick(self, ticks: IntArray) -> IntArray: ...
    def bar_of_tick(self, ticks: int | IntArray) -> int | IntArray:
        """Number of the bar in which each tick lies; accepts a number or an array of them."""
        # The largest k with floor(k * bar) <= tick - start.
        if not isinstance(ticks, np.ndarray):
            index = max(bisect_right(self._ticks, ticks) - 1, 0)
            metre = self.metres[index]
            whole = 4 * self.ticks_per_quarter * metre.numerator
            return self._first_bars[index] + ((ticks - metre.tick + 1) * metre.denominator - 1) // whole
        starts, bars, wholes, denominators = self._table
        place = np.maximum(np.searchsorted(starts, ticks, side="right") - 1, 0)
        numbers: IntArray = bars[place] + ((ticks - starts[place] + 1) * denominators[place] - 1) // wholes[place]
        return numbers

    @overload
    def tick_of_bar(self, bars: int) -> int: ...
    @overload
    def tick_of_bar(self, bars: IntArray) -> IntArray: ...
    def tick_of_bar(self, bars: int | IntArray) -> int | IntArray:
        """Tick at which each bar begins, by bar number; accepts a number or an array of them."""
        # The first bar line after a pickup is the tick of the second metre, not one bar after the start.
        if not isinstance(bars, np.ndarray):
            index = max(bisect_right(self._first_bars, bars) - 1, 0)
            metre = self.metres[index]
            whole = 4 * self.ticks_per_quarter * metre.numerator
            return metre.tick + (bars - self._first_bars[index]) * whole // metre.denominator
        starts, first_bars, wholes, denominators = self._table
        place = np.maximum(np.searchsorted(first_bars, bars, side="right") - 1, 0)
        ticks: IntArray = starts[place] + (bars - first_bars[place]) * wholes[place] // denominators[place]
        return ticks

    def span_of_bar(self, bar: int) -> tuple[int, int]:
        """Return the ticks at which a bar begins and ends."""
        return self.tick_of_bar(bar), self.tick_of_bar(bar + 1)

    def bars(self, first_tick: int, last_tick: int) -> IntArray:
        """Ticks at which bars begin, from the bar that holds ``first_tick`` to the last before ``last_tick``."""
        first, stop = self.bar_of_tick(first_tick), self.bar_of_tick(last_tick - 1) + 1
        return self._kept("bars", (first, max(stop, first)), self._starts)

    def _starts(self, first: int, stop: int) -> IntArray:
        return self.tick_of_bar(np.arange(first, stop, dtype=np.int64))

    def _kept(self, name: str, span: tuple[int, int], make: Callable[[int, int], IntArray]) -> IntArray:
        """Return the array that ``make`` computes for a span of ticks, cached by ``name`` and span, since all players
        of a piece need the same arrays.
        """
        found = self._known.get((name, *span))
        if found is None:
            found = make(*span)
            if len(self._known) >= _MOST_KEPT:
                self._known.clear()
            self._known[name, *span] = found
        return found.copy()

    @cached_property
    def _known(self) -> dict[tuple[str, int, int], IntArray]:
        return {}

    def metre_at(self, tick: float) -> Metre:
        """Return the metre in force at a tick."""
        return self.metres[max(bisect_right(self._ticks, tick) - 1, 0)]

    def bar_ticks_at(self, tick: int) -> int:
        """Length in ticks of a complete bar in the metre at a tick, at least 1, even if the bar there is cut short."""
        metre = self.metre_at(tick)
        return max(4 * self.ticks_per_quarter * metre.numerator // metre.denominator, 1)

    # Written beats

    def beat_length(self, tick: int) -> float:
        """Length in ticks of the metre's unit (its denominator) at a tick; may be fractional."""
        return 4 * self.ticks_per_quarter / self.metre_at(tick).denominator

    def place_of_tick(self, tick: int) -> tuple[int, int, int]:
        """Convert a tick to bar, beat in the bar (from 1), and ticks after the beat."""
        bar, start, early = self._bar_at(tick)
        since = tick - start - early
        if since < 0:
            return bar, 1, tick - start
        whole, denominator = 4 * self.ticks_per_quarter, self.metre_at(start).denominator
        beat = ((since + 1) * denominator - 1) // whole
        return bar, beat + 1 + (early > 0), since - beat * whole // denominator

    def tick_of_place(self, bar: int, beat: int = 1, ticks: int = 0) -> int:
        """Inverse of `place_of_tick`; a beat number beyond the bar continues into the next bars."""
        bar, start, early = self._bar_at(self.tick_of_bar(bar)) if bar == 0 else (bar, self.tick_of_bar(bar), 0)
        whole, denominator = 4 * self.ticks_per_quarter, self.metre_at(start).denominator
        if early and beat == 1:
            return start + ticks
        return start + early + (beat - 1 - (early > 0)) * whole // denominator + ticks

    def beats_of_bar(self, bar: int) -> IntArray:
        """Ticks of the beats of a bar, the first at the bar line."""
        ticks, _ = self._written(bar, bar + 1)
        start = self.tick_of_bar(bar)
        return ticks if len(ticks) and ticks[0] == start else np.concatenate(([start], ticks))

    def label(self, tick: int) -> str:
        """Position as bar, beat and ticks, ``"12.3.096"``, as displayed everywhere. The ticks are padded to the digits
        of the longest beat, so that the width is constant during playback.
        """
        bar, beat, rest = self.place_of_tick(tick)
        return f"{bar}.{beat}.{rest:0{self._tick_digits}d}".replace("-", "−")

    @cached_property
    def _tick_digits(self) -> int:
        """Digits needed for the ticks within the longest beat, at least 3."""
        longest = 4 * self.ticks_per_quarter // min(metre.denominator for metre in self.metres)
        return max(len(str(longest - 1)), 3)

    def tick_of_label(self, text: str) -> int | None:
        """Parse a position as `label` formats it; None if the text is invalid. A bar number alone means its
        first beat.
        """
        match = _PLACE.match(unicodedata.normalize("NFKC", text))
        if match is None:
            return None
        bar, beat, rest = (int(group.replace("−", "-")) for group in match.groups("1"))
        rest = 0 if match.group(3) is None else rest
        if abs(bar) > _MOST_BAR or not 0 < beat <= _MOST_BEAT:
            return None
        return self.tick_of_place(bar, beat, rest)

    # Felt beats

    @property
    def felt_beats(self) -> FeltBeats:
        """The felt beats; a quarter throughout if none were set."""
        return self.felt or ((0, self.ticks_per_quarter),)

    @overload
    def felt_ticks_at(self, ticks: float) -> int: ...
    @overload
    def felt_ticks_at(self, ticks: IntArray) -> IntArray: ...
    def felt_ticks_at(self, ticks: float | IntArray) -> int | IntArray:
        """Length in ticks of the felt beat at each tick; accepts a number or an array."""
        beats = self.felt_beats
        if isinstance(ticks, np.ndarray):
            return beat_ticks_at(beats, ticks)
        return beats[max(bisect_right(beats, ticks, key=lambda beat: beat[0]) - 1, 0)][1]

    def felt_between(self, first_tick: int, last_tick: int) -> IntArray:
        """Ticks of the felt beats, which restart at each bar line, from the last before ``first_tick`` to the first
        after ``last_tick``.
        """
        return self._kept("felt", (first_tick, last_tick), self._felt)

    def _felt(self, first_tick: int, last_tick: int) -> IntArray:
        bars = self.bars(first_tick, last_tick + 1)
        beats = self.felt_ticks_at(bars)
        lengths = np.diff(bars, append=max(int(bars[-1]) + 1, last_tick + int(beats[-1])))
        ticks, _ = _beats(bars, -(-lengths // beats), beats, np.ones_like(beats))
        return ticks

    def counted(self, first_bar: int, end_bar: int) -> tuple[IntArray, IntArray]:
        """Beats that are counted aloud in some bars: the felt beats if they divide the bar (a 6/8 in two), else the
        beats of the metre; in a pickup they are counted back from the bar line.

        Returns
        -------
        ticks, numbers : (N,) int64
            Tick of each beat, and its number in the bar, from 0.
        """
        starts = self.tick_of_bar(np.arange(first_bar, end_bar + 1, dtype=np.int64))
        felt = self.felt_ticks_at(starts[:-1])
        return self._written(first_bar, end_bar, np.where(np.diff(starts) % felt == 0, felt, 0))

    def _bar_at(self, tick: int) -> tuple[int, int, int]:
        """Return for the bar at a tick its number, its start tick, and the length of its first beat if that beat is
        incomplete, as in a pickup.
        """
        bar = self.bar_of_tick(tick)
        start = self.tick_of_bar(bar)
        if bar != 0 or not self.has_pickup:
            return bar, start, 0
        length, whole, denominator = self.tick_of_bar(1) - start, 4 * self.ticks_per_quarter, self.metres[0].denominator
        return bar, start, length - length * denominator // whole * whole // denominator

    def _written(
        self, first_bar: int, end_bar: int, instead_ticks: IntArray | None = None
    ) -> tuple[IntArray, IntArray]:
        """Ticks of the beats from ``first_bar`` to before ``end_bar``, and their numbers in the bar. Where
        ``instead_ticks`` (one value per bar) is not 0, it replaces the metre's beat length.
        """
        numbers = np.arange(first_bar, end_bar + 1, dtype=np.int64)
        starts = self.tick_of_bar(numbers)
        lengths, starts = np.diff(starts), starts[:-1]
        place = np.maximum(np.searchsorted(self._table[0], starts, side="right") - 1, 0)
        wholes, denominators = np.full(len(starts), 4 * self.ticks_per_quarter), self._table[3][place]
        if instead_ticks is not None:
            wholes = np.where(instead_ticks > 0, instead_ticks, wholes)
            denominators = np.where(instead_ticks > 0, 1, denominators)
        counts = -(-lengths * denominators // wholes)
        if self.has_pickup and first_bar <= 0 < end_bar:
            counts[-first_bar] = lengths[-first_bar] * denominators[-first_bar] // wholes[-first_bar]
            early = lengths[-first_bar] - counts[-first_bar] * wholes[-first_bar] // denominators[-first_bar]
            starts[-first_bar] += early
        return _beats(starts, counts, wholes, denominators)


def _beats(starts: IntArray, counts: IntArray, wholes: IntArray, denominators: IntArray) -> tuple[IntArray, IntArray]:
    """Return the ticks (N,) of ``counts`` beats of ``wholes / denominators`` ticks after each start, and their numbers
    (N,) from 0 within each."""
    before = np.cumsum(counts) - counts
    numbers = np.arange(counts.sum()) - np.repeat(before, counts)
    ticks: IntArray = np.repeat(starts, counts) + numbers * np.repeat(wholes, counts) // np.repeat(denominators, counts)
    return ticks, numbers
