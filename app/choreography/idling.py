"""Detection of idle or small motion in a capture, which is avoided while music sounds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.ndimage import binary_opening, gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.model import MotionSegment

IDLE: Final = 10.0
"""Log odds per second against a segment in which the body idles."""
HELD_S: Final = 0.3
"""Longest time in seconds for which a slow body counts as holding a pose."""
IDLE_SHARE: Final = 0.4
"""Share of its clip's median speed below which a body idles."""
IDLE_S: Final = 0.25
"""Standard deviation in seconds of the Gaussian that averages this speed."""
THIN: Final = 8.0
"""Log odds per second against a segment without motion; proportionally less for small motion."""
THIN_SHARE: Final = 0.8
"""Share of the median speed of all clips below which motion is small."""


def idling_odds(segments: Sequence[MotionSegment], speeds: Sequence[FloatArray], rates: Sequence[float]) -> FloatArray:
    """Log odds (S,) against each of S segments in which the body idles or hardly moves.

    Parameters
    ----------
    speeds, rates : sequence
        Mean speed of the joints in each frame, and frames per second, by clip.
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
