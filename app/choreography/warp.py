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
from typing import Final

import numpy as np
from scipy.interpolate import PchipInterpolator

from app.arrays import BoolArray, FloatArray
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
FALLS: Final = 0.2
"""Value of a footfall on a beat without an arrival."""
SPEED: Final = 0.2
"""Cost of a speed at a limit of `SPEEDS`; quadratic between."""
MOVED: Final = 0.2
"""Cost of an arrival shifted by `MOST_S`; quadratic for less, so that motions stay near their sounds."""
_TOLERANCE: Final = 0.06
"""Relative tolerance of the limits of speed, which allows choices based on rounded times."""
_STEP_S: Final = 0.002


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
    *,
    with_falls: bool = False,
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
    with_falls : bool
        Put footfalls on beats too where no body arrives.
    """
    held = np.zeros(len(plain.times_s), bool) if plain.held is None else plain.held
    knots = zip(plain.times_s.tolist(), plain.along_s.tolist(), np.where(held, HELD, ANCHOR).tolist(), strict=True)
    items = [_Item(along, ((time, worth),)) for time, along, worth in list(knots)[1:-1]]
    falls = np.zeros(0) if footfalls is None else footfalls
    stepped = np.abs(arrivals[:, None] - falls).min(axis=1, initial=np.inf) <= STEPPED_S
    items += _to_meet(plain, arrivals[stepped], grid, ARRIVES + STEPPED)
    items += _to_meet(plain, arrivals[~stepped], grid, ARRIVES)
    if with_falls:
        alone = np.abs(falls[:, None] - arrivals).min(axis=1, initial=np.inf) > STEPPED_S
        items += _to_meet(plain, falls[alone], grid, FALLS)
    met = _met(sorted(items, key=lambda item: item.along_s))
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


@dataclass(frozen=True)
class _Item:
    """A moment along the motions, with the times in the piece at which it may be shown, and the value of each."""

    along_s: float
    options: tuple[tuple[float, float], ...]


def _to_meet(plain: TimeMap, moments: FloatArray, grid: AccentGrid, on_beat: float) -> list[_Item]:
    """Collect the moments along the motions that may be put on accents of the grid, with the possible times and values
    of each.
    """
    items = []
    for along, time in zip(moments.tolist(), plain.when(moments).tolist(), strict=True):
        near = range(*np.searchsorted(grid.times_s, time + np.array([-MOST_S, MOST_S])).tolist())
        options = []
        for at in near:
            place_s = float(grid.times_s[at])
            moved = MOVED * ((place_s - time) / MOST_S) ** 2
            strength = float(grid.strengths[at])
            options.append((place_s, strength * on_beat + (1.0 - strength) * ARRIVES_BETWEEN - moved))
        items.append(_Item(along, tuple(options)))
    return items


def _met(items: Sequence[_Item]) -> list[tuple[float, float]]:
    """Choose a time for each moment, both ascending, with the greatest total value, by dynamic programming; returns
    pairs of time and moment.
    """
    limit = float(np.log(SPEEDS[1]))
    times = [np.array([time_s for time_s, _ in item.options]) for item in items]
    best: list[FloatArray] = []
    came: list[list[tuple[int, int] | None]] = []
    for at, item in enumerate(items):
        worth = np.array([worth for _, worth in item.options])
        seen = [
            earlier for earlier in range(max(0, at - LOOK_BACK), at) if item.along_s - items[earlier].along_s >= 1e-3
        ]
        numbers = [(earlier, number) for earlier in seen for number in range(len(times[earlier]))]
        if not numbers or not len(worth):
            best.append(worth)
            came.append([None] * len(worth))
            continue
        before_s = np.concatenate([times[earlier] for earlier in seen])
        way_s = np.concatenate(
            [np.full(len(times[earlier]), item.along_s - items[earlier].along_s) for earlier in seen]
        )
        gap_s = times[at][:, None] - before_s
        off = np.abs(np.log(way_s / np.maximum(gap_s, 1e-3))) / limit
        value = np.concatenate([best[earlier] for earlier in seen]) - SPEED * off * off
        value[(off > 1.0 + _TOLERANCE) | (gap_s < 1e-3)] = 0.0
        chosen = value.argmax(axis=1)
        reached = np.maximum(value[np.arange(len(worth)), chosen], 0.0)
        best.append(reached + worth)
        came.append([numbers[number] if top > 0.0 else None for number, top in zip(chosen, reached, strict=True)])
    ends = [(value, at, number) for at, here in enumerate(best) for number, value in enumerate(here.tolist())]
    way: tuple[int, int] | None = max(ends)[1:] if ends else None
    found: list[tuple[float, float]] = []
    while way is not None:
        item, number = items[way[0]], way[1]
        found.append((item.options[number][0], item.along_s))
        way = came[way[0]][number]
    return found[::-1]
