"""Distance of a motion from the cubic that joins two of its moments with their speeds."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.body_speeds import angle
from app.rig import quaternion

MOST_WINDOWS: Final = 8
MOST_INSIDE: Final = 8
"""Greatest number of window lengths, and of compared frames in each, at high frame rates."""
FAR_S: Final = 0.1
"""Time in seconds for which the bounds of distances are given; shorter windows have lower bounds."""
LEAST_PART: Final = 0.45
"""Least share of the bounds for short windows."""
GROWS: Final = 1.2
"""Exponent of the time in the growth of bounds."""


def between(
    before: FloatArray, after: FloatArray, slopes: tuple[FloatArray, FloatArray], share: float | FloatArray
) -> FloatArray:
    """Evaluate a cubic from ``before`` to ``after`` at a share 0..1 of the way; ``slopes`` are its derivatives by the
    share at both ends.
    """
    square, cube = share * share, share**3
    return np.asarray(
        (2.0 * cube - 3.0 * square + 1.0) * before
        + (cube - 2.0 * square + share) * slopes[0]
        + (3.0 * square - 2.0 * cube) * after
        + (cube - square) * slopes[1]
    )


def window_lengths(fps: float, most_s: float) -> list[int]:
    """Lengths of the windows to compare, in frame steps from two up to ``most_s`` seconds."""
    most = max(2, int(most_s * fps))
    return sorted({round(one) for one in np.geomspace(2, most, min(MOST_WINDOWS, most - 1))})


def part_of_bound(length_s: float) -> float:
    """Return the bound for windows of a length in seconds, relative to the bound for windows of `FAR_S`."""
    return float(max(LEAST_PART, (length_s / FAR_S) ** GROWS))


def turns_off(rotations: FloatArray, start: IntArray, part: IntArray, length: int) -> FloatArray:
    """Largest angle (N,) in radians between the rotations of a body part and a cubic through both ends of a window, for
    windows of ``length`` frames that begin at the frames ``start`` (N,).
    """
    ends = [rotations[start + step, part] for step in (-1, 0, length, length + 1)]
    slopes = length * (ends[1] - ends[0]), length * (ends[3] - ends[2])
    off = np.zeros(len(start))
    for step in _inside(length):
        expected = quaternion.normalize(between(ends[1], ends[2], slopes, step / length))
        off = np.maximum(off, angle(expected, rotations[start + step, part]))
    return off


def moves_off(places: FloatArray, start: IntArray, length: int) -> FloatArray:
    """Largest distance (N,) in metres between positions (F, 3) and a cubic through both ends of each window; the
    windows begin at the frames ``start`` (N,).
    """
    ends = [places[start + step] for step in (-1, 0, length, length + 1)]
    slopes = length * (ends[1] - ends[0]), length * (ends[3] - ends[2])
    off = np.zeros(len(start))
    for step in _inside(length):
        expected = between(ends[1], ends[2], slopes, step / length)
        off = np.maximum(off, np.linalg.norm(expected - places[start + step], axis=-1))
    return off


def _inside(length: int) -> list[int]:
    """Steps within a window of ``length`` at which positions are compared."""
    return sorted({round(one) for one in np.linspace(1, length - 1, min(MOST_INSIDE, length - 1))})
