"""A smooth curve through values without stopping at each, for swinging body motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import ROUNDING_S, rows_changed_s


@dataclass(frozen=True, eq=False)
class Path:
    """A smooth curve through knots: at rest where it reverses or stays, otherwise moving, without jerk.

    Between two knots it is the quintic with these values and slopes and no acceleration at the ends; from rest to rest
    this is the minimum-jerk move. Outside the knots it is constant.

    Attributes
    ----------
    times_s, values, slopes : (K,) float64
        Times of the knots in order, with value and slope at each.
    """

    times_s: FloatArray
    values: FloatArray
    slopes: FloatArray

    @classmethod
    def through(cls, segments: Sequence[tuple[float, float, float]] | FloatArray) -> Path:
        """Create a path from rows ``(start_s, end_s, value)``: it starts at 0 and moves to each value over the row's
        span.

        Raises ValueError if spans overlap or take no time.
        """
        table = np.array(segments, dtype=np.float64).reshape(-1, 3)
        start_s, end_s, values = table.T
        free_s = np.concatenate(([-np.inf], end_s[:-1]))[: len(end_s)]
        start_s = np.where((free_s - ROUNDING_S < start_s) & (start_s < free_s), free_s, start_s)
        wrong = np.flatnonzero((start_s < free_s) | (end_s <= start_s))
        if len(wrong):
            row = int(wrong[0])
            raise ValueError(f"a way from {start_s[row]} to {end_s[row]} begins before {free_s[row]}")
        before = np.concatenate(([0.0], values[:-1]))[: len(values)]
        at_s = np.stack((start_s, end_s), axis=1).ravel()
        knots = np.stack((before, values), axis=1).ravel()
        kept = np.concatenate(([True], np.diff(at_s) > 0.0))[: len(at_s)]
        return cls.of(at_s[kept], knots[kept])

    @classmethod
    def of(cls, times_s: FloatArray, values: FloatArray) -> Path:
        """Create a path through values at ascending times, without overshoot between neighbours."""
        slopes = np.zeros(len(times_s))
        if len(times_s) > 2:
            steep = np.diff(values) / np.diff(times_s)
            before, after = steep[:-1], steep[1:]
            onwards = before * after > 0.0
            both = np.where(onwards, before + after, 1.0)
            slopes[1:-1] = np.where(onwards, 2.0 * before * after / both, 0.0)
        return cls(times_s, values, slopes)

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the values (F,) of the path at any times (F,)."""
        if len(self.times_s) < 2:
            return np.full(len(times_s), self.values[0] if len(self.values) else 0.0)
        here = np.clip(np.searchsorted(self.times_s, times_s, side="right") - 1, 0, len(self.times_s) - 2)
        lasts_s = np.diff(self.times_s)
        way = np.diff(self.values)
        out, into = self.slopes[:-1] * lasts_s, self.slopes[1:] * lasts_s
        third, fourth = 10.0 * way - 6.0 * out - 4.0 * into, -15.0 * way + 8.0 * out + 7.0 * into
        fifth = 6.0 * way - 3.0 * out - 3.0 * into
        powers = np.stack((self.times_s[:-1], lasts_s, self.values[:-1], out, third, fourth, fifth))
        begins_s, length_s, value, slope, third, fourth, fifth = powers.take(here, axis=1)
        u = np.clip((times_s - begins_s) / length_s, 0.0, 1.0)
        moved: FloatArray = value + u * (slope + u * u * (third + u * (fourth + u * fifth)))
        return moved

    def changed_s(self, other: Path) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both paths have equal values."""
        spans = rows_changed_s(self._rows, other._rows, self._rows[:, :2], other._rows[:, :2])
        ends = [
            span
            for mine, others, span in (
                (self._end(0), other._end(0), (-np.inf, max(self._edge(0), other._edge(0)))),
                (self._end(-1), other._end(-1), (min(self._edge(-1), other._edge(-1)), np.inf)),
            )
            if mine != others
        ]
        return np.concatenate((spans, np.array(ends, np.float64).reshape(-1, 2)))

    @property
    def _rows(self) -> FloatArray:
        knots = (self.times_s, self.values, self.slopes)
        return np.stack([column for knot in knots for column in (knot[:-1], knot[1:])], axis=1)

    def _end(self, place: int) -> float:
        return float(self.values[place]) if len(self.values) else 0.0

    def _edge(self, place: int) -> float:
        return float(self.times_s[place]) if len(self.times_s) else (np.inf if place else -np.inf)
