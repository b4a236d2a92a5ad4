"""Peaks of a curve with their prominences, without the modules of `scipy.signal`.

Loading these takes a second, which would delay the first dance of a session or of a process.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from app.arrays import FloatArray, IntArray


def prominent_peaks(values: FloatArray, least: float) -> tuple[IntArray, FloatArray]:
    """Return the indices (N,) of local maxima, ascending, with prominences (N,), equal to `scipy.signal.find_peaks`.

    A flat peak is at its middle. The prominence is the height above the higher of the lowest places on both sides, each
    up to where the curve exceeds the peak.

    Parameters
    ----------
    values : (F,) float64
        The curve.
    least : float
        Least prominence of a peak.
    """
    steps = np.flatnonzero(np.diff(values))
    if len(steps) < 2:
        return np.zeros(0, np.int64), np.zeros(0)
    levels = values[np.concatenate([steps, steps[-1:] + 1])]
    is_peak = (levels[1:-1] > levels[:-2]) & (levels[1:-1] > levels[2:])
    peaks = (((steps[:-1] + 1) + steps[1:]) // 2)[is_peak]
    if not len(peaks):
        return peaks, np.zeros(0)
    heights = values[peaks].tolist()
    # Lowest values before the first peak, between neighbouring peaks, and after the last one.
    valleys = np.minimum.reduceat(values, np.concatenate([[0], peaks])).tolist()
    before = _lowest_sides(heights, valleys[:-1])
    after = _lowest_sides(reversed(heights), reversed(valleys[1:]))[::-1]
    prominences = np.array(heights) - np.maximum(before, after)
    kept = prominences >= least
    return peaks[kept], prominences[kept]


def _lowest_sides(heights: Iterable[float], valleys: Iterable[float]) -> list[float]:
    """For each peak the lowest value between it and the last higher peak before it; ``valleys`` are the lowest values
    between consecutive peaks.
    """
    lowest: list[float] = []
    higher: list[tuple[float, float]] = []
    for height, valley in zip(heights, valleys, strict=True):
        while higher and higher[-1][0] <= height:
            valley = min(valley, higher.pop()[1])
        lowest.append(valley)
        higher.append((height, valley))
    return lowest
