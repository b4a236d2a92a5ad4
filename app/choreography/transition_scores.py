"""Scores of moving from one segment to the next between two places of a piece.

Terms independent of the phrase and of hits are computed once for each time between places, and only for the best
predecessors of each segment.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from app.arrays import BoolArray, FloatArray, IntArray, SingleArray
from app.choreography.accent_grid import AccentGrid

SPEEDS: Final = (0.67, 1.5)
"""Slowest and fastest speed of a motion between arrivals relative to the capture; the speed varies smoothly and may
reach 1.75 for a moment.
"""
NEVER: Final = -1e9
MOST_STARTS: Final = 48
"""Number of best-fitting predecessors of a segment."""
SHARES: Final = 64
"""Resolution of the point at which two segments meet, as parts of the time between accents."""
NEAR_S: Final = 0.1
"""Standard deviation in seconds of an arrival that still meets a beat, since it can be shifted slightly."""
_TOGETHER: Final = 1 << 16
"""Number of values that are computed at a time."""


_Beats: TypeAlias = tuple[tuple[int, float], ...]


@dataclass(frozen=True, eq=False)
class SegmentMeets:
    """Further moments of S segments that may meet beats: arrivals of the body and footfalls, besides the accent itself.

    Attributes
    ----------
    times_s : (S, E) float64
        Time of each moment in seconds after the segment's accent; NaN pads shorter rows.
    worths : (S, E) float64
        Value of each moment if it is on a beat.
    falls : (S, E) bool
        Whether each is a footfall. Footfalls off the beats cost what those on them are worth, so that dancers step as
        often as captured at every tempo; arrivals off the beats cost more at slow tempi.
    accents : (S,) float64
        Value of the accent itself as an arrival.
    """

    times_s: FloatArray
    worths: FloatArray
    falls: BoolArray
    accents: FloatArray


def no_meets(segments: int) -> SegmentMeets:
    """Return a table for segments without further arrivals and footfalls."""
    return SegmentMeets(
        np.zeros((segments, 0)), np.zeros((segments, 0)), np.zeros((segments, 0), bool), np.zeros(segments)
    )


@dataclass(frozen=True, eq=False)
class MoveTable:
    """Scores of moves to each of S segments from K predecessors.

    Attributes
    ----------
    scores : (S, K) float32
        Score of the move from each predecessor.
    starts : (S, K) int
        Indices of the predecessors, ascending in each row.
    of_start, of_end : (S, K) int
        Flat indices in tables (`SHARES`, S) of the predecessor and of the segment at their meeting point.
    taken : (S, K) float32
        Buffer for looked-up values.
    """

    scores: SingleArray
    starts: IntArray
    of_start: IntArray
    of_end: IntArray
    taken: SingleArray

    @cached_property
    def rows(self) -> IntArray:
        """Index (S,) of the first element of each row in the flattened table."""
        return np.asarray(np.arange(len(self.starts)) * self.starts.shape[1])

    @cached_property
    def places(self) -> npt.NDArray[np.unsignedinteger]:
        """Index (S + 1, S) of each predecessor in the row of each segment; K where it is none, as in the last row."""
        count, most = self.starts.shape
        result = np.full((count + 1, count), most, np.min_scalar_type(most))
        np.put_along_axis(result[:-1], self.starts, np.arange(most, dtype=result.dtype)[None], axis=1)
        return result

    def best(
        self, before: SingleArray, heard: SingleArray | None, danced: IntArray | None = None, repeats: float = 0.0
    ) -> tuple[IntArray, SingleArray]:
        """Return the best predecessor (S,) of each segment, and its score.

        Parameters
        ----------
        before : (S,) float32
            Score of the best path up to each segment as predecessor.
        heard : (SHARES, S) float32, optional
            Log odds of hits until the change of segments. The total log odds of hits, which are equal for all
            predecessors, are not included.
        danced : (S, N) int64, optional
            Segments danced before each segment as predecessor; one of them that is danced again costs ``repeats``.
        """
        scores = before.take(self.starts, mode="clip")
        scores += self.scores
        if heard is not None:
            scores += heard.take(self.of_start, out=self.taken, mode="clip")
            scores -= heard.take(self.of_end, out=self.taken, mode="clip")
        if danced is not None:
            # The last row of places serves a segment of -1: none.
            count, most = self.starts.shape
            places = self.places.take(danced * count + np.arange(count)[:, None], mode="wrap")
            again = places < most
            np.subtract.at(scores.ravel(), danced[again] * most + places[again], np.float32(repeats))
        chosen = scores.argmax(axis=1) + self.rows
        return np.asarray(self.starts.take(chosen)), np.asarray(scores.take(chosen))


@dataclass(frozen=True, eq=False)
class MoveCosts:
    """Costs from which scores of moves are calculated.

    Attributes
    ----------
    base : (S, S) float64
        Cost of each move at any speed.
    before_s, after_s : (S,) float64
        Seconds from start to accent and from accent to end, as captured.
    speed : float
        Cost of a speed that differs from ``pace`` by a factor of `SPEEDS`; it grows quadratically with the difference.
    usual : (S,) float64
        Value of each segment as a predecessor; those with high values are examined first.
    meets : SegmentMeets
        Arrivals and footfalls of the segments, with their values in units of these costs.
    least_before_s, least_after_s : (S,) float64, optional
        Shortest times in seconds in which ``before_s`` and ``after_s`` may be danced; by default by `SPEEDS`.
    pace : float
        Speed relative to the captures at which motions are danced best.
    """

    base: FloatArray
    before_s: FloatArray
    after_s: FloatArray
    speed: float
    usual: FloatArray
    meets: SegmentMeets
    least_before_s: FloatArray | None = None
    least_after_s: FloatArray | None = None
    pace: float = 1.0


class SegmentMoves:
    """Tables of the scores of moves between segments for all distances of accents in a grid, made on first use."""

    def __init__(self, grid: AccentGrid, costs: MoveCosts) -> None:
        self._grid, self._costs = grid, costs
        self._base = costs.base.T.copy()
        np.fill_diagonal(self._base, NEVER)
        self._lasts_s = np.maximum(costs.after_s[None, :] + costs.before_s[:, None], 1e-9)
        self._log_lasts = np.log(self._lasts_s)
        self._most_off = np.full_like(self._lasts_s, np.log(SPEEDS[1]))
        if costs.least_before_s is not None and costs.least_after_s is not None:
            least_s = np.maximum(costs.least_after_s[None, :] + costs.least_before_s[:, None], 1e-9)
            self._most_off = np.minimum(self._most_off, self._log_lasts - np.log(least_s))
        self._times_s, self._strengths = grid.times_s.tolist(), grid.strengths.tolist()
        self._tables: dict[tuple[int, _Beats, bool], MoveTable] = {}
        self._longest_s = float(self._lasts_s.max(initial=0.0)) / SPEEDS[0]
        self._shortest_s = float(self._lasts_s.min(initial=np.inf)) / SPEEDS[1]

    def possible(self, gap_s: float) -> bool:
        """Return whether any pair of segments can fill a time of ``gap_s`` between accents within the
        limits of speed.
        """
        return self._shortest_s <= gap_s <= self._longest_s

    def table(self, earlier: int, place: int, *, every: bool) -> MoveTable:
        """Return the scored moves to all segments between the accents ``earlier`` and ``place``; with ``every`` from
        all predecessors instead of only the best ones.
        """
        key, beats = self._key(earlier, place)
        full = (key, beats, every)
        if full not in self._tables:
            self._tables[full] = self._made(self._starts(key, every), key, beats)
        return self._tables[full]

    def table_from(self, start: int, earlier: int, place: int) -> MoveTable:
        """Return the moves from the single segment ``start`` to every segment, shape (S, 1), between the accents
        ``earlier`` and ``place``.
        """
        return self._made(np.full((len(self._base), 1), start, np.intp), *self._key(earlier, place))

    def _key(self, earlier: int, place: int) -> tuple[int, _Beats]:
        """Key of cached tables for a pair of accents: logarithm of the seconds between them, rounded to steps of 2 %,
        and time (in hundredths of the way) and strength of each beat between them.
        """
        start_s = self._times_s[earlier]
        gap_s = self._times_s[place] - start_s
        beats = tuple(
            (round(100.0 * (self._times_s[at] - start_s) / gap_s), self._strengths[at])
            for at in range(earlier, place + 1)
            if self._strengths[at]
        )
        return round(50.0 * math.log(gap_s)), beats

    def _starts(self, key: int, every: bool) -> IntArray:
        """Indices (S, K) of the K best predecessors of each of S segments at a pace; of all segments if ``every``."""
        count = len(self._base)
        if every or count <= MOST_STARTS:
            return np.broadcast_to(np.arange(count), (count, count))
        values = self._base + self._costs.usual - self._speed_cost(self._log_lasts - key / 50.0, self._most_off)
        best = np.argpartition(values, count - MOST_STARTS, axis=1)[:, count - MOST_STARTS :]
        return np.asarray(np.sort(best, axis=1))

    def _speed_cost(self, off: FloatArray, most_off: FloatArray) -> FloatArray:
        limit = float(np.log(SPEEDS[1]))
        outside = (off < -limit - 0.02) | (off > most_off + 0.02)
        apart = (off - math.log(self._costs.pace)) / limit
        return np.asarray(self._costs.speed * np.square(apart) - np.where(outside, NEVER, 0.0))

    def _made(self, starts: IntArray, key: int, beats: _Beats) -> MoveTable:
        ends = np.arange(len(starts))[:, None]
        lasts_s = self._lasts_s[ends, starts]
        scores = self._base[ends, starts] - self._speed_cost(
            self._log_lasts[ends, starts] - key / 50.0, self._most_off[ends, starts]
        )
        scores += self._met(starts, lasts_s, math.exp(key / 50.0), beats)
        met = np.minimum((SHARES * self._costs.after_s[starts] / lasts_s).astype(np.intp), SHARES - 1) * len(starts)
        taken = np.empty(starts.shape, np.float32)
        return MoveTable(scores.astype(np.float32), np.ascontiguousarray(starts), met + starts, met + ends, taken)

    def _met(self, starts: IntArray, lasts_s: FloatArray, gap_s: float, beats: _Beats) -> FloatArray:
        """Value (S, K) of the beats between two accents that arrivals and footfalls meet if each of S segments follows
        each of its K predecessors at an even pace.
        """
        meets = self._costs.meets
        total = np.zeros(starts.shape)
        if not meets.times_s.size:
            return total
        hundredths, strengths = np.array(beats, np.float64).reshape(-1, 2).T
        off_s = gap_s * (np.arange(SHARES + 1)[:, None] / SHARES - hundredths / 100.0)
        near = (np.exp(-np.square(off_s / NEAR_S) / 2.0) * strengths).max(axis=1, initial=0.0)
        cost = np.where(meets.falls, min(0.5, float(near.mean())), 0.5) * meets.worths
        rows = meets.times_s.T, meets.worths.T, cost.T
        together = max(1, _TOGETHER // starts.size)
        for first in range(0, len(rows[0]), together):
            times_s, worths, costs = (values[first : first + together] for values in rows)
            after, before = times_s > 0.0, times_s < 0.0
            # Moments after the accent of the first segment and before that of the second one, in turns.
            terms = np.empty((len(times_s), 2, *starts.shape))
            at = np.rint(SHARES * np.where(after, times_s, 0.0)[:, starts] / lasts_s).astype(np.intp)
            terms[:, 0] = near[at] * np.where(after, worths, 0.0)[:, starts] - np.where(after, costs, 0.0)[:, starts]
            at = np.rint(SHARES * (1.0 + np.where(before, times_s, 0.0)[:, :, None] / lasts_s)).astype(np.intp)
            own_worths, own_costs = (np.where(before, values, 0.0)[:, :, None] for values in (worths, costs))
            terms[:, 1] = near[at] * own_worths - own_costs
            total += terms.reshape(-1, *starts.shape).sum(axis=0)
        return total
