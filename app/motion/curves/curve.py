"""Curves of time: built once from events, sampled at any times.

Samples are independent of each other, so any part of a performance can be sampled alone with equal results. Moves are
minimum-jerk (Flash & Hogan 1985), the profile of an unhurried reach: velocity and acceleration are zero at both ends,
the peak speed is 15/8 of the mean, the peak acceleration 10/sqrt(3) d/T².
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from app.arrays import FloatArray

ROUNDING_S = 1e-9
"""Overlap in seconds of adjacent moves that is attributed to rounding."""


def frame_times(first_frame_s: float, fps: Fraction, first_frame: int, frames: int) -> FloatArray:
    """Return the times (frames,) in seconds of ``frames`` frames from ``first_frame`` on, each rounded once."""
    index = np.arange(first_frame, first_frame + frames, dtype=np.float64)
    return first_frame_s + index * float(fps.denominator) / float(fps.numerator)


def minimum_jerk(phase: FloatArray) -> FloatArray:
    """Progress 0..1 of a minimum-jerk move at ``phase`` 0..1 of its time (10u³ - 15u⁴ + 6u⁵)."""
    way = 6.0 * phase
    way -= 15.0
    way *= phase
    way += 10.0
    way *= phase * phase * phase
    return way


NOWHERE: FloatArray = np.zeros((0, 2))
EVERYWHERE: FloatArray = np.array([[-np.inf, np.inf]])


def rows_changed_s(mine: FloatArray, others: FloatArray, mine_s: FloatArray, others_s: FloatArray) -> FloatArray:
    """Return the K spans (K, 2) of rows found in only one of two tables (N, C) with C columns; ``mine_s`` and
    ``others_s`` (N, 2) are the spans of the rows."""
    shorter = min(len(mine), len(others))
    same = np.all(mine[:shorter] == others[:shorter], axis=1)
    head = shorter if same.all() else int(np.argmin(same))
    back = np.all(mine[len(mine) - shorter :] == others[len(others) - shorter :], axis=1)[::-1][: shorter - head]
    tail = len(back) if back.all() else int(np.argmin(back))
    here, there = slice(head, len(mine) - tail), slice(head, len(others) - tail)
    own, foreign = list(map(tuple, mine[here].tolist())), list(map(tuple, others[there].tolist()))
    known, asked = set(own), set(foreign)
    alone = [row not in asked for row in own]
    missing = [row not in known for row in foreign]
    return np.concatenate((mine_s[here][alone], others_s[there][missing]))


@dataclass(frozen=True, eq=False)
class Curve:
    """A value that rests and moves: minimum-jerk segments with constant values in between.

    Attributes
    ----------
    start_s, end_s : (S,) float64
        Segments in order without overlap.
    before, after : (S,) float64
        Values at a segment's start and end. ``after`` of one equals ``before`` of the next.
    initial : float
        Value before the first segment.
    """

    start_s: FloatArray
    end_s: FloatArray
    before: FloatArray
    after: FloatArray
    initial: float = 0.0

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the values (F,) of the curve at ascending times (F,)."""
        if len(self.start_s) == 0:
            return np.full(len(times_s), self.initial)
        if len(times_s) < len(self.start_s):  # a short span of a long curve: only its own segments are examined
            here = np.maximum(np.searchsorted(self.start_s, times_s, side="right") - 1, 0)
            start_s, before = self.start_s[here], self.before[here]
            phase = np.clip((times_s - start_s) / (self.end_s[here] - start_s), 0.0, 1.0)
            return before + (self.after[here] - before) * minimum_jerk(phase)
        first, stops = np.searchsorted(times_s, self.start_s), np.searchsorted(times_s, self.end_s)
        edges, way = np.concatenate(([0], first, [len(times_s)])), self.after - self.before
        levels = np.concatenate((self.before[:1], self.before + way))
        result = np.repeat(levels, np.diff(edges))
        # Frames at which the value changes, one segment after another.
        counts = np.maximum(np.minimum(stops, edges[2:]) - first, 0)
        segment = np.repeat(np.arange(len(first)), counts)
        moving = np.arange(len(segment)) + np.repeat(first - (np.cumsum(counts) - counts), counts)
        phase = (times_s[moving] - self.start_s[segment]) / (self.end_s - self.start_s)[segment]
        result[moving] = self.before[segment] + way[segment] * minimum_jerk(np.clip(phase, 0.0, 1.0))
        return result

    def between(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """For a curve whose values are numbers of places: return, each (F,), the place left last, the place reached
        next and the share of the way between them at each time.
        """
        rows = self._described(times_s)
        resting = rows[:, 1] == rows[:, 0]
        duration_s = np.where(resting, 1.0, rows[:, 1] - rows[:, 0])
        share = np.where(resting, 1.0, minimum_jerk(np.clip((times_s - rows[:, 0]) / duration_s, 0.0, 1.0)))
        return np.where(resting, rows[:, 3], rows[:, 2]), rows[:, 3], share

    @property
    def still(self) -> bool:
        """True if the value is the same at all times."""
        return len(self.start_s) == 0

    def changed_s(self, other: Curve | Trace) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both curves have equal values."""
        if isinstance(other, Trace):
            return EVERYWHERE
        mine = (self.start_s, self.end_s, self.before, self.after)
        others = (other.start_s, other.end_s, other.before, other.after)
        if self.initial == other.initial and all(map(np.array_equal, mine, others)):
            return NOWHERE
        edges = np.unique(np.concatenate((self.start_s, self.end_s, other.start_s, other.end_s)))
        if len(edges) == 0:
            return EVERYWHERE
        # Between two edges each curve either rests or is within one of its moves.
        inner = np.concatenate(([edges[0] - 1.0], 0.5 * (edges[:-1] + edges[1:]), [edges[-1] + 1.0]))
        differ = np.any(self._described(inner) != other._described(inner), axis=1)
        bounds = np.concatenate(([-np.inf], edges, [np.inf]))
        return np.stack((bounds[:-1][differ], bounds[1:][differ]), axis=1)

    def _described(self, times_s: FloatArray) -> FloatArray:
        """Data (F, 4) that determine the value at each time (start and end of the segment, values), for comparing
        curves.
        """
        if len(self.start_s) == 0:
            return np.tile([0.0, 0.0, 0.0, self.initial], (len(times_s), 1))
        segment = np.searchsorted(self.start_s, times_s, side="right") - 1
        here = np.maximum(segment, 0)
        rows = np.stack((self.start_s, self.end_s, self.before, self.after), axis=1)[here]
        resting = (segment < 0) | (times_s >= rows[:, 1])
        value = np.where(segment < 0, rows[:, 2], rows[:, 2] + (rows[:, 3] - rows[:, 2]))
        rows[resting] = 0.0
        rows[resting, 3] = value[resting]
        return rows


@dataclass(frozen=True, eq=False)
class Trace:
    """A recorded value: samples at equal steps with linear interpolation; end values extend outwards.

    Attributes
    ----------
    start_s, step_s : float
        Sample k is at ``start_s + k * step_s``; ``start_s`` is a multiple of the step.
    values : (K,) float64
        At least two samples.
    """

    start_s: float
    step_s: float
    values: FloatArray

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the values (F,) of the sampled curve at any times (F,)."""
        last = len(self.values) - 1
        place = np.clip((times_s - self.start_s) / self.step_s, 0.0, float(last))
        before = np.minimum(place.astype(np.int64), last - 1)
        low = self.values[before]
        result: FloatArray = low + (self.values[before + 1] - low) * (place - before)
        return result

    def changed_s(self, other: Curve | Trace) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both curves have equal values."""
        if isinstance(other, Curve) or other.step_s != self.step_s:
            return EVERYWHERE
        mine, others = (round(trace.start_s / self.step_s) for trace in (self, other))
        first = min(mine, others)
        count = max(mine + len(self.values), others + len(other.values)) - first
        place = first + np.arange(count)
        here = self.values[np.clip(place - mine, 0, len(self.values) - 1)]
        there = other.values[np.clip(place - others, 0, len(other.values) - 1)]
        differ = np.concatenate(([False], here != there, [False]))
        edges = np.flatnonzero(np.diff(differ.astype(np.int8))).reshape(-1, 2)
        # From the sample before the first difference to the one after the last; a different end value differs to
        # infinity.
        spans: FloatArray = (first + edges + np.array([-1.0, 0.0])) * self.step_s
        spans[edges[:, 0] == 0, 0] = -np.inf
        spans[edges[:, 1] == count, 1] = np.inf
        return spans


def moves(segments: Sequence[tuple[float, float, float]], initial: float = 0.0) -> Curve:
    """Create a curve from moves ``(start_s, end_s, value)``, each beginning at the value of the previous one.

    Moves without change are dropped. Raises ValueError if moves overlap or take no time.
    """
    table = np.array(segments, dtype=np.float64).reshape(-1, 3)
    return moves_to(table[:, 0], table[:, 1], table[:, 2], initial)


def moves_to(start_s: FloatArray, end_s: FloatArray, values: FloatArray, initial: float = 0.0) -> Curve:
    """Create a curve that moves to each value (S,) from ``start_s`` to ``end_s`` and holds it until the next move;
    before the first move it is ``initial``. Moves to the value already held are dropped.

    Raises ValueError if moves overlap.
    """
    before = np.concatenate(([initial], values[:-1]))[: len(values)]
    kept = values != before
    start_s, end_s, before, after = start_s[kept], end_s[kept], before[kept], values[kept]
    free_s = np.concatenate(([-np.inf], end_s[:-1]))[: len(end_s)]
    start_s = np.where((free_s - ROUNDING_S < start_s) & (start_s < free_s), free_s, start_s)
    wrong = np.flatnonzero((start_s < free_s) | (end_s <= start_s))
    if len(wrong):
        row = int(wrong[0])
        raise ValueError(
            f"move [{start_s[row]}, {end_s[row]}) to {after[row]} overlaps the one before, which ends at {free_s[row]}"
        )
    return Curve(start_s, end_s, before, after, initial)


def through(times_s: FloatArray, values: FloatArray) -> Curve:
    """Create a curve that passes through ``values`` at ascending ``times_s`` and stops at each."""
    if len(times_s) == 0:
        return moves(())
    return Curve(times_s[:-1], times_s[1:], values[:-1], values[1:], float(values[0]))


@dataclass(frozen=True, eq=False)
class Envelopes:
    """Raised spans that may overlap: rising from ``start_s`` to ``full_s``, level, falling from ``fall_s`` to
    ``end_s``.

    All arrays are (N,) float64; ``height`` is the level.
    """

    start_s: FloatArray
    full_s: FloatArray
    fall_s: FloatArray
    end_s: FloatArray
    height: FloatArray

    def changed_s(self, other: Envelopes) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both envelopes have equal values."""
        mine, others = self._rows, other._rows
        return rows_changed_s(mine, others, mine[:, [0, 3]], others[:, [0, 3]])

    @property
    def spans_s(self) -> FloatArray:
        """Start and end (N, 2) in seconds of each raised span, including its rise and fall."""
        return np.stack((self.start_s, self.end_s), axis=1)

    @property
    def _rows(self) -> FloatArray:
        return np.stack((self.start_s, self.full_s, self.fall_s, self.end_s, self.height), axis=1)

    @classmethod
    def of(cls, rows: Sequence[tuple[float, float, float, float, float]] | FloatArray) -> Envelopes:
        """Create the envelopes from rows (start_s, full_s, fall_s, end_s, height); times of a row in wrong order are
        sorted.
        """
        table = np.array(rows, dtype=np.float64).reshape(-1, 5)
        table[:, :4] = np.maximum.accumulate(table[:, :4], axis=1)
        return cls(table[:, 0], table[:, 1], table[:, 2], table[:, 3], table[:, 4])

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Values (F,) at ascending times: the largest of all raised spans at each, 0 outside them."""
        result = np.zeros(len(times_s))
        first = np.searchsorted(times_s, self.start_s, side="left")
        last = np.searchsorted(times_s, self.end_s, side="right")
        shown = np.flatnonzero(last > first)
        if not len(shown):
            return result
        counts = (last - first)[shown]
        # Frame numbers of each span that is shown, one span after another.
        span = np.repeat(shown, counts)
        here = np.arange(len(span)) + np.repeat(first[shown] - (np.cumsum(counts) - counts), counts)
        rise_s, fall_s = np.maximum(self.full_s - self.start_s, 1e-9), np.maximum(self.end_s - self.fall_s, 1e-9)
        times_s = times_s[here]
        up = minimum_jerk(np.clip((times_s - self.start_s[span]) / rise_s[span], 0.0, 1.0))
        down = minimum_jerk(np.clip((self.end_s[span] - times_s) / fall_s[span], 0.0, 1.0))
        np.maximum.at(result, here, self.height[span] * np.minimum(up, down))
        return result


def bump(times_s: FloatArray, centre_s: float, half_width_s: float) -> FloatArray:
    """A smooth bump of height 1 with its largest acceleration, 8 / half_width², at the centre; 0 outside.

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
        Frequency, phase and amplitude of each sinusoid.
    """

    frequency_hz: FloatArray
    phase_rad: FloatArray
    weight: FloatArray

    @classmethod
    def of(cls, random: np.random.Generator, low_hz: float, high_hz: float, terms: int = 4) -> Noise:
        """Create noise with frequencies spread logarithmically between ``low_hz`` and ``high_hz``, weaker at the
        top.
        """
        edges = np.geomspace(low_hz, high_hz, terms + 1)
        frequency_hz = random.uniform(edges[:-1], edges[1:])
        weight = 1.0 / np.sqrt(frequency_hz)
        weight *= np.sqrt(2.0 / np.sum(np.square(weight)))
        return cls(frequency_hz, random.uniform(0.0, 2.0 * np.pi, terms), weight)

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the values (F,) of the noise at any times (F,)."""
        result = np.zeros(len(times_s))
        for frequency_hz, phase_rad, weight in zip(self.frequency_hz, self.phase_rad, self.weight, strict=True):
            result += weight * np.sin(2.0 * np.pi * frequency_hz * times_s + phase_rad)
        return result
