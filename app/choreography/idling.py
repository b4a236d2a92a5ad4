"""Motion of a capture in which its body idles or moves little, and how far it is avoided while music sounds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.ndimage import binary_opening, gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.model import MotionSegment

IDLE: Final = 10.0
"""Log odds a second against a segment in which the body idles."""
HELD_S: Final = 0.3
"""A body that is slow for less holds a pose within its motion."""
IDLE_SHARE: Final = 0.4
"""A body idles that is slower than this share of the median speed of its clip ..."""
IDLE_S: Final = 0.25
"""... averaged by a Gaussian of this standard deviation."""
THIN: Final = 8.0
"""Log odds a second against a segment in which the body hardly moves; of one that moves little, by how little."""
THIN_SHARE: Final = 0.8
"""A body moves little that is slower than this share of the median speed of all clips."""


def idling_odds(segments: Sequence[MotionSegment], speeds: Sequence[FloatArray], rates: Sequence[float]) -> FloatArray:
    """(S,) log odds against each segment.

    Parameters
    ----------
    speeds, rates : sequence
        By clip: mean speed of the joints in each frame, and frames per second.
    """
    means = [gaussian_filter1d(speed, IDLE_S * fps, mode="nearest") for speed, fps in zip(speeds, rates, strict=True)]
    of_all = float(np.median(np.concatenate(means)))
    slow = []
    for mean, fps in zip(means, rates, strict=True):
        held = np.ones(max(1, round(HELD_S * fps)), bool)
        idle = binary_opening(mean < IDLE_SHARE * np.median(mean), held)
        little = np.maximum(0.0, 1.0 - mean / max(THIN_SHARE * of_all, 1e-9))
        slow.append((IDLE * idle + THIN * little) / fps)
    return np.array([slow[one.clip][one.start : one.end].sum() for one in segments])
