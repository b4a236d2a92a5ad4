"""Local changes of a dance's speed, so that its arrivals are on the beats.

A body arrives where the summed speed of its points has a minimum, that is, where it stops or turns. These are the beats
of a motion (Li et al., "AI Choreographer: Music Conditioned 3D Dance Generation with AIST++", ICCV 2021), so that they,
and not the moments of greatest acceleration, must meet those of the music. The assignment of arrivals to beats is
optimised for the whole dance within the limits of speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from app.arrays import BoolArray, FloatArray, IntArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.segment_arrivals import STEPPED_S
from app.choreography.transition_scores import SPEEDS

REST_S: Final = 0.4
"""Seconds of motion before and after a dance, increasingly slow, that lead from and to standing."""
MOST_S: Final = 0.6
"""Greatest shift of an arrival in seconds."""
LOOK_BACK: Final = 10
"""Greatest number of consecutive unchanged arrivals and footfalls."""
ARRIVES: Final = 1.0
ARRIVES_BETWEEN: Final = -0.1
ANCHOR: Final = 0.05
"""Values of an arrival on a beat, in the middle between beats, and of a segment that stays in place."""
HELD: Final = 6.0
"""Value of a segment that stays in a place set by hand, above those of all arrivals that it may keep from beats."""
STEPPED: Final = 0.1
"""Additional value of an arrival on a beat with a footfall."""
SPEED: Final = 0.2
"""Cost of a speed at a limit of `SPEEDS`; quadratic between."""
MOVED: Final = 0.2
"""Cost of an arrival shifted by `MOST_S`; quadratic for less, so that motions stay near their sounds."""
_TOLERANCE: Final = 0.06
"""Relative tolerance of the limits of speed, which allows choices based on rounded times."""
_STEP_S: Final = 0.002
_TOGETHER: Final = 256
"""Number of moments whose costs are computed at a time."""


@dataclass(frozen=True, eq=False)
class TimeMap:
    """Map from time to moments of a dance's concatenated motions: smooth, and never backwards.

    Attributes
    ----------
    times_s : (N,) float64
        Ascending times in the piece in seconds.
    along_s : (N,) float64
        Position along the captured motions in seconds, ascending.
    held : (N,) bool, optional
        Knots set by hand, which stay when arrivals are put on beats.
    """

    times_s: FloatArray
    along_s: FloatArray
    held: BoolArray | None = None

    @cached_property
    def _inside(self) -> PchipInterpolator:
        return PchipInterpolator(self.times_s, self.along_s)

    @cached_property
    def _samples(self) -> tuple[FloatArray, FloatArray]:
        count = max(2, int(np.ptp(self.times_s) / _STEP_S))
        times_s = np.linspace(self.times_s[0], self.times_s[-1], count)
        return times_s, np.maximum.accumulate(self._inside(times_s))

    def at(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Position along the motions at given times, and the speed there: 1 as captured, 0 at rest."""
        slope = self._inside.derivative()
        first_s, last_s = float(self.times_s[0]), float(self.times_s[-1])
        inside = np.clip(times_s, first_s, last_s)
        along, speeds = self._inside(inside), slope(inside)
        early, late = times_s < first_s, times_s > last_s
        for outside, edge_s, sign in ((early, first_s, 1.0), (late, last_s, -1.0)):
            left = np.exp(sign * (times_s[outside] - edge_s) / REST_S)
            along[outside] -= sign * float(slope(edge_s)) * REST_S * (1.0 - left)
            speeds[outside] = float(slope(edge_s)) * left
        return along, speeds

    def when(self, along_s: FloatArray) -> FloatArray:
        """Performance time (N,) at which each position along the motions is shown."""
        times_s, along = self._samples
        return np.asarray(np.interp(along_s, along, times_s))


def map_with_arrivals(
    plain: TimeMap,
    arrivals: FloatArray,
    grid: AccentGrid,
    footfalls: FloatArray | None = None,
) -> TimeMap:
    """Build the time map that puts arrivals on beats, preferably those with footfalls, within the limits of speed.

    Parameters
    ----------
    plain : TimeMap
        Map with a knot at each segment's place; its first and last knot are the ends of the dance.
    arrivals : (A,) float64
        Positions of the arrivals along the motions in seconds, ascending.
    footfalls : (N,) float64, optional
        Positions of the footfalls along the motions in seconds, ascending.
    """
    held = np.zeros(len(plain.times_s), bool) if plain.held is None else plain.held
    knots = _Items(plain.along_s[1:-1], plain.times_s[1:-1, None], np.where(held, HELD, ANCHOR)[1:-1, None])
    falls = np.zeros(0) if footfalls is None else footfalls
    stepped = nearest_s(arrivals, falls) <= STEPPED_S
    items = [
        knots,
        _to_meet(plain, arrivals[stepped], grid, ARRIVES + STEPPED),
        _to_meet(plain, arrivals[~stepped], grid, ARRIVES),
    ]
    met = _met(_in_order(items))
    if not met:
        return plain
    (first_s, first_along), (last_s, last_along) = met[0], met[-1]
    # Before the first and after the last matched beat the captured speed is kept.
    ends = (
        (first_s - (first_along - plain.along_s[0]), plain.along_s[0]),
        (last_s + (plain.along_s[-1] - last_along), plain.along_s[-1]),
    )
    all_met = np.array([ends[0], *met, ends[1]])
    apart = np.ones(len(all_met), bool)
    apart[0], apart[-1] = first_along - all_met[0, 1] > 1e-3, all_met[-1, 1] - last_along > 1e-3
    return TimeMap(all_met[apart, 0], all_met[apart, 1]) if apart.sum() > 1 else plain


class _Items(NamedTuple):
    """Moments along the motions, with the times in the piece at which each may be shown.

    Attributes
    ----------
    along_s : (N,) float64
        Position of each moment in seconds.
    times_s : (N, K) float64
        Possible times in seconds; NaN pads shorter rows.
    worths : (N, K) float64
        Value of each time.
    """

    along_s: FloatArray
    times_s: FloatArray
    worths: FloatArray


def nearest_s(moments: FloatArray, others: FloatArray) -> FloatArray:
    """Return the distance (N,) of each moment from the nearest of the others, both ascending; infinite without any."""
    if not len(others):
        return np.full(len(moments), np.inf)
    after = np.searchsorted(others, moments)
    before_s, after_s = others[np.maximum(after - 1, 0)], others[np.minimum(after, len(others) - 1)]
    return np.minimum(np.abs(moments - before_s), np.abs(moments - after_s))


def _to_meet(plain: TimeMap, moments: FloatArray, grid: AccentGrid, on_beat: float) -> _Items:
    """Collect the moments along the motions that may be put on accents of the grid, with the possible times and values
    of each.
    """
    times_s = plain.when(moments)
    first, stop = np.searchsorted(grid.times_s, times_s[None] + np.array([[-MOST_S], [MOST_S]]))
    most = int((stop - first).max(initial=0))
    at = first[:, None] + np.arange(most)
    possible = at < stop[:, None]
    at = np.where(possible, at, 0)
    places_s, strengths = grid.times_s[at], grid.strengths[at]
    moved = MOVED * ((places_s - times_s[:, None]) / MOST_S) ** 2
    worths = strengths * on_beat + (1.0 - strengths) * ARRIVES_BETWEEN - moved
    return _Items(moments, np.where(possible, places_s, np.nan), np.where(possible, worths, 0.0))


def _in_order(parts: Sequence[_Items]) -> _Items:
    """Join moments in their order along the motions; of equal ones, those of earlier parts are first."""
    most = max(part.times_s.shape[1] for part in parts)
    times_s, worths = (
        np.concatenate([np.pad(values, ((0, 0), (0, most - values.shape[1])), constant_values=pad) for values in every])
        for every, pad in (([part.times_s for part in parts], np.nan), ([part.worths for part in parts], 0.0))
    )
    along_s = np.concatenate([part.along_s for part in parts])
    order = np.argsort(along_s, kind="stable")
    return _Items(along_s[order], times_s[order], worths[order])


def _met(items: _Items) -> list[tuple[float, float]]:
    """Choose a time for each moment, both ascending, with the greatest total value, by dynamic programming; returns
    pairs of time and moment.
    """
    count, most = items.times_s.shape
    if not items.times_s.size:
        return []
    possible = ~np.isnan(items.times_s)
    # Best total of the ways that end with each time of each moment; before the first moment there are none.
    best = np.zeros((LOOK_BACK + count, most))
    came = np.full((count, most), -1)
    rows = np.arange(most) * LOOK_BACK * most
    for at in range(count):
        if not at % _TOGETHER:
            costs, excluded = _pace_costs(items, np.arange(at, min(count, at + _TOGETHER)))
        value = best[at : at + LOOK_BACK].ravel() - costs[at % _TOGETHER]
        value[excluded[at % _TOGETHER]] = 0.0
        chosen = value.argmax(axis=1)
        reached = np.maximum(value.take(rows + chosen), 0.0)
        best[LOOK_BACK + at] = reached + items.worths[at]
        came[at] = np.where(reached > 0.0, (at - LOOK_BACK) * most + chosen, -1)
    ends = np.where(possible, best[LOOK_BACK:], -np.inf).ravel()
    # Of equal ends the last one.
    way = int(ends.size - 1 - ends[::-1].argmax())
    found: list[tuple[float, float]] = []
    while way >= 0:
        at, number = divmod(way, most)
        found.append((float(items.times_s[at, number]), float(items.along_s[at])))
        way = int(came[at, number])
    return found[::-1]


def _pace_costs(items: _Items, some: IntArray) -> tuple[FloatArray, BoolArray]:
    """Return the costs (S, K, `LOOK_BACK` * K) of going to each time of some moments, given as indices (S,), from each
    time of the moments before it, by the speed on the way, and which of these ways are excluded; the costs of these are
    0.
    """
    before = some[:, None] + np.arange(-LOOK_BACK, 0)
    first, before = before < 0, np.maximum(before, 0)
    way_s = np.where(first, 0.0, items.along_s[some, None] - items.along_s[before])
    gap_s = items.times_s[some, :, None] - items.times_s[before].reshape(len(some), 1, -1)
    far = np.repeat(way_s, items.times_s.shape[1], axis=1)[:, None]
    excluded = np.isnan(gap_s) | (far < 1e-3) | (gap_s < 1e-3)
    off = np.abs(np.log(np.where(excluded, 1.0, far) / np.where(excluded, 1.0, gap_s))) / float(np.log(SPEEDS[1]))
    excluded |= off > 1.0 + _TOLERANCE
    return np.where(excluded, 0.0, SPEED * off * off), excluded
