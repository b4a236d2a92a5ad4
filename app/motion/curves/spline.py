"""Several slow values on a common time grid, smooth between its points.

Uniform cubic B-splines: two continuous derivatives, and each sample depends on four points. The grid is in absolute
time, so distant values have no influence.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray
from app.motion.curves.curve import EVERYWHERE

REACH = 2
"""Number of points on either side that influence a sample."""


@dataclass(frozen=True, eq=False)
class Spline:
    """Values at equal steps; end values extend outwards.

    Attributes
    ----------
    first : int
        Point k is at ``(first + k) * step_s``.
    step_s : float
        Distance of the points in seconds.
    values : (C, K) float64, or whole numbers
        A row for each value, at least one point. Small integers save memory in long pieces.
    one : float
        Stored number that represents 1.
    """

    first: int
    step_s: float
    values: FloatArray | npt.NDArray[np.int16] | npt.NDArray[np.int32]
    one: float = 1.0

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the values (C, F) of the C channels of the spline at F times."""
        place = times_s / self.step_s
        before = np.floor(place)
        share = place - before
        left = 1.0 - share
        squared, cubed = share * share, share * share * share
        weights = (
            left * left * left / 6.0,
            (3.0 * cubed - 6.0 * squared + 4.0) / 6.0,
            (3.0 * (squared - cubed + share) + 1.0) / 6.0,
            cubed / 6.0,
        )
        if not len(times_s):
            return np.zeros((len(self.values), 0))
        row = before.astype(np.int64) - (self.first + 1)
        last = self.values.shape[1] - 1
        low, high = (int(np.clip(end, 0, last)) for end in (row.min(), row.max() + len(weights) - 1))
        values = self.values[:, low : high + 1] / self.one
        result = np.zeros((len(self.values), len(times_s)))
        for number, weight in enumerate(weights):
            part = values.take(np.clip(row + number, 0, last) - low, axis=1)
            part *= weight
            result += part
        return result

    def changed_s(self, other: Spline) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both splines have equal values."""
        if (other.step_s, other.one, len(other.values)) != (self.step_s, self.one, len(self.values)):
            return EVERYWHERE
        first = min(self.first, other.first)
        count = max(self.first + self.values.shape[1], other.first + other.values.shape[1]) - first
        place = first + np.arange(count)
        here, there = (one.values[:, np.clip(place - one.first, 0, one.values.shape[1] - 1)] for one in (self, other))
        differ = np.concatenate(([False], np.any(here != there, axis=0), [False]))
        edges = np.flatnonzero(np.diff(differ.astype(np.int8))).reshape(-1, 2)
        spans: FloatArray = (first + edges + np.array([-REACH, REACH - 1.0])) * self.step_s
        spans[edges[:, 0] == 0, 0] = -np.inf
        spans[edges[:, 1] == count, 1] = np.inf
        return spans
