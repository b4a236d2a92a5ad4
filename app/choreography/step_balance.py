"""Balance of the steps of a dance: segments rich in steps are favoured while the dance has fewer than the captures.

Motions fit beats and each other best where feet stand, so that a sequence chosen by these alone has fewer steps than
the captured dancers took in the same time. To music with faster beats than theirs, dancers step faster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.model import MotionSegment

AHEAD: Final = 2.0
"""Number of steps that the dance should be ahead of the captures, since a phrase can only make up for those before it.
"""
MOST: Final = 4.0
"""Number of steps missing to that number from which steps are favoured most."""


@dataclass(frozen=True, eq=False)
class StepBalance:
    """Steps in the segments of a model.

    Attributes
    ----------
    steps : (S,) float64
        Number of times at which a foot lands in each of S segments.
    lasts_s : (S,) float64
        Length of each as captured, in seconds.
    pace : float
        Pace of the dance relative to the captures.
    """

    steps: FloatArray
    lasts_s: FloatArray
    pace: float = 1.0

    @property
    def per_s(self) -> float:
        """Steps in a second of the captures."""
        return float(self.steps.sum() / max(float(self.lasts_s.sum()), 1e-9))

    def favoured(self, grid: AccentGrid, chosen: Sequence[tuple[int, int]], first: int) -> FloatArray:
        """Number (S,) of steps that each segment has beyond the usual number for its length, or lacks (negative), by
        a share of 0 to 1 for how many the dance is behind.

        Parameters
        ----------
        chosen : sequence of (place, segment)
            Accents of the dance so far with their segments.
        first : int
            Accent up to which the dance is counted.
        """
        if not chosen:
            return np.zeros(len(self.steps))
        danced_s = float(grid.times_s[first] - grid.times_s[chosen[0][0]])
        missing = self.pace * self.per_s * danced_s - float(self.steps[[segment for _, segment in chosen]].sum())
        return float(np.clip((missing + AHEAD) / MOST, 0.0, 1.0)) * (self.steps - self.per_s * self.lasts_s)


def step_balance(
    segments: Sequence[MotionSegment], fps: Sequence[float], lands_s: Sequence[FloatArray], pace: float = 1.0
) -> StepBalance:
    """Count the steps in segments.

    Parameters
    ----------
    fps : sequence of float
        Frames per second, by clip.
    lands_s : sequence of (N,) float64
        Times in seconds, by clip, at which the left or the right foot lands, ascending.
    """
    edges_s = [(one.start / fps[one.clip], one.end / fps[one.clip]) for one in segments]
    steps = [
        float(np.subtract(*np.searchsorted(lands_s[one.clip], edges[::-1])))
        for one, edges in zip(segments, edges_s, strict=True)
    ]
    return StepBalance(np.array(steps), np.array([stop_s - start_s for start_s, stop_s in edges_s]), pace)
