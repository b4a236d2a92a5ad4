"""Curves as values: built once from events, sampled at any times.

A sample depends on its own time only, never on its neighbours, so a span of a performance sampled alone equals the
same span of the whole. Moves are minimum-jerk (Flash & Hogan 1985): the profile of an unhurried reach, with no
velocity and no acceleration at both ends. Its peak speed is 15/8 of the mean, its peak acceleration 10/sqrt(3) d/T².
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]

ROUNDING_S = 1e-9
"""Moves whose times touch may overlap by this much."""


def frame_times(first_frame_s: float, fps: Fraction, first_frame: int, frames: int) -> FloatArray:
    """Times of ``frames`` frames from frame ``first_frame`` on, seconds; exact to one rounding each."""
    index = np.arange(first_frame, first_frame + frames, dtype=np.float64)
    return first_frame_s + index * float(fps.denominator) / float(fps.numerator)


def minimum_jerk(phase: FloatArray) -> FloatArray:
    """Progress 0..1 of a minimum-jerk move at ``phase`` 0..1 of its time (10u³ - 15u⁴ + 6u⁵)."""
    return phase * phase * phase * (10.0 + phase * (6.0 * phase - 15.0))


@dataclass(frozen=True)
class Curve:
    """A value that rests and moves: minimum-jerk segments, held between them.

    Attributes
    ----------
    start_s, end_s : (S,) float64
        Segments in order, not overlapping.
    before, after : (S,) float64
        Value at a segment's start and end. ``after`` of one is ``before`` of the next.
    initial : float
        Value before the first segment.
    """

    start_s: FloatArray
    end_s: FloatArray
    before: FloatArray
    after: FloatArray
    initial: float = 0.0

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Values at ascending times, (F,) float64."""
        if len(self.start_s) == 0:
            return np.full(len(times_s), self.initial)
        first = np.searchsorted(times_s, self.start_s, side="left")
        counts = np.diff(np.concatenate(([0], first, [len(times_s)])))
        segment = np.repeat(np.arange(-1, len(self.start_s)), counts)
        np.maximum(segment, 0, out=segment)  # before the first segment the phase is clipped to 0
        duration_s = self.end_s - self.start_s
        phase = np.clip((times_s - self.start_s[segment]) / duration_s[segment], 0.0, 1.0)
        return self.before[segment] + (self.after - self.before)[segment] * minimum_jerk(phase)

    @property
    def still(self) -> bool:
        """Whether the value never changes."""
        return len(self.start_s) == 0


def moves(segments: Sequence[tuple[float, float, float]], initial: float = 0.0) -> Curve:
    """A curve from ``(start_s, end_s, value)``: each move starts where the last one ended.

    Moves that change nothing are left out. Raises ValueError where they overlap or take no time.
    """
    rows: list[tuple[float, float, float, float]] = []
    value, time_s = initial, -np.inf
    for start_s, end_s, target in segments:
        if target == value:
            continue
        if time_s - ROUNDING_S < start_s < time_s:
            start_s = time_s
        if start_s < time_s or end_s <= start_s:
            raise ValueError(f"move [{start_s}, {end_s}) to {target} overlaps the one before, which ends at {time_s}")
        rows.append((start_s, end_s, value, target))
        value, time_s = target, end_s
    table = np.array(rows, dtype=np.float64).reshape(-1, 4)
    return Curve(table[:, 0], table[:, 1], table[:, 2], table[:, 3], initial)


def through(times_s: FloatArray, values: FloatArray) -> Curve:
    """A curve that passes ``values`` at ascending ``times_s`` and moves all the time between them."""
    if len(times_s) == 0:
        return moves(())
    return Curve(times_s[:-1], times_s[1:], values[:-1], values[1:], float(values[0]))


@dataclass(frozen=True)
class Envelopes:
    """Raised spans that may overlap: up from ``start_s`` to ``full_s``, level, down from ``fall_s`` to ``end_s``.

    All arrays are (N,) float64; ``height`` is the level in between.
    """

    start_s: FloatArray
    full_s: FloatArray
    fall_s: FloatArray
    end_s: FloatArray
    height: FloatArray

    @classmethod
    def of(cls, rows: Sequence[tuple[float, float, float, float, float]]) -> Envelopes:
        """From rows of (start_s, full_s, fall_s, end_s, height); times that run backwards are put in order."""
        table = np.array(rows, dtype=np.float64).reshape(-1, 5)
        table[:, :4] = np.maximum.accumulate(table[:, :4], axis=1)
        return cls(table[:, 0], table[:, 1], table[:, 2], table[:, 3], table[:, 4])

    def sample(self, times_s: FloatArray) -> FloatArray:
        """The highest of the raised spans at each of the ascending times, (F,) float64; 0 outside them."""
        result = np.zeros(len(times_s))
        first = np.searchsorted(times_s, self.start_s, side="left")
        last = np.searchsorted(times_s, self.end_s, side="right")
        for index in np.flatnonzero(last > first):
            here = slice(first[index], last[index])
            t = times_s[here]
            rise_s = max(self.full_s[index] - self.start_s[index], 1e-9)
            fall_s = max(self.end_s[index] - self.fall_s[index], 1e-9)
            up = minimum_jerk(np.clip((t - self.start_s[index]) / rise_s, 0.0, 1.0))
            down = minimum_jerk(np.clip((self.end_s[index] - t) / fall_s, 0.0, 1.0))
            np.maximum(result[here], self.height[index] * np.minimum(up, down), out=result[here])
        return result


def bump(times_s: FloatArray, centre_s: float, half_width_s: float) -> FloatArray:
    """A smooth bump of height 1 whose greatest acceleration, 8 / half_width², lies at its centre; 0 outside.

    ``(1 - u²)⁴``; the side lobes of its second derivative stay below 0.65 of the centre's.
    """
    u = np.clip((times_s - centre_s) / half_width_s, -1.0, 1.0)
    inside = 1.0 - u * u
    return np.square(np.square(inside))


@dataclass(frozen=True)
class Noise:
    """Smooth band-limited noise: a sum of sinusoids with an RMS of 1.

    Attributes
    ----------
    frequency_hz, phase_rad, weight : (K,) float64
    """

    frequency_hz: FloatArray
    phase_rad: FloatArray
    weight: FloatArray

    @classmethod
    def of(cls, random: np.random.Generator, low_hz: float, high_hz: float, terms: int = 4) -> Noise:
        """Draw noise with frequencies spread log-evenly over ``low_hz`` .. ``high_hz``, weaker towards the top."""
        edges = np.geomspace(low_hz, high_hz, terms + 1)
        frequency_hz = random.uniform(edges[:-1], edges[1:])
        weight = 1.0 / np.sqrt(frequency_hz)
        weight *= np.sqrt(2.0 / np.sum(np.square(weight)))
        return cls(frequency_hz, random.uniform(0.0, 2.0 * np.pi, terms), weight)

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Values at any times, (F,) float64."""
        result = np.zeros(len(times_s))
        for frequency_hz, phase_rad, weight in zip(self.frequency_hz, self.phase_rad, self.weight, strict=True):
            result += weight * np.sin(2.0 * np.pi * frequency_hz * times_s + phase_rad)
        return result
