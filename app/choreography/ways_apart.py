"""Choice of one of several ways in which limbs are moved apart, with a size that is smooth over time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.body_speeds import runs

BRIDGED_S: Final = 0.1
"""Longest time in seconds between two overlaps that are mended as one."""
STRIDE_S: Final = (0.034, 0.1)
"""Times in seconds between the frames in which ways are compared, in a short span and in one of `LONG_S` or more."""
LONG_S: Final = 0.5
COARSE: Final = 3
"""Factor of the time between the frames in which all ways are compared first."""
MANY: Final = 30
"""Number of frames from which all ways are compared coarsely first."""
KEPT: Final = 4
"""Number of ways that are compared more closely."""
UNSOLVED: Final = 12.0
AROUND: Final = 1.5
"""Costs of a metre of depth that remains, and of one before or after, relative to a unit of size."""


class Span(NamedTuple):
    """Frames of a motion, ``start`` to before ``stop``, in which limbs enter each other; the motion's number of frames,
    and its frames per second."""

    start: int
    stop: int
    total: int
    fps: float


class Way(NamedTuple):
    """Index of a chosen way, and its size in some frames.

    Attributes
    ----------
    frames : (N,) int64
        Consecutive frames of the motion.
    sizes : (N,) float64
        Size in each of them, about 0 at both ends.
    """

    way: int
    frames: IntArray
    sizes: FloatArray


def overlaps(depths_m: FloatArray, fps: float, least_m: float) -> list[tuple[int, int]]:
    """Return the spans (start, stop) of frames in which limbs enter each other by more than ``least_m``, from the depth
    (F,) in each frame; spans with little between them are joined.
    """
    found: list[tuple[int, int]] = []
    for start, stop in runs(depths_m > 0.0):
        if depths_m[start:stop].max() < least_m:
            continue
        if found and start - found[-1][1] < BRIDGED_S * fps:
            found[-1] = found[-1][0], stop
        else:
            found.append((start, stop))
    return found


def least_way(
    depths: Callable[[IntArray, IntArray], FloatArray],
    count: int,
    span: Span,
    sizes: FloatArray,
    smooth_s: float,
    more: FloatArray | None = None,
) -> Way:
    """Choose the way that keeps limbs apart in a span of frames with the least size, smoothed over ``smooth_s`` seconds
    and nowhere less than needed.

    Parameters
    ----------
    depths : callable
        Depth (N, W, K) in metres in frames (N,) for ways with indices (W,) with each of K ascending ``sizes``; the
        first size is 0.
    count : int
        Number of ways.
    more : (count,) float64, optional
        Additional cost of each way.
    """
    tail = round(5.0 * smooth_s * span.fps)
    frames = np.arange(max(0, span.start - tail), min(span.total, span.stop + tail))
    stride = max(1, round(STRIDE_S[int(span.stop - span.start >= LONG_S * span.fps)] * span.fps))
    ways = np.arange(count)
    for apart in (COARSE * stride, stride) if len(frames) > MANY * stride else (stride,):
        some = np.arange(frames[0] + (span.start - frames[0]) % apart, frames[-1] + 1, apart)
        found = depths(some, ways)
        inside = (some > span.start - apart) & (some < span.stop - 1 + apart)
        needed = np.where(inside[:, None], _needed(found, sizes), 0.0)
        smooth = _smoothed(needed, smooth_s * span.fps / apart)
        left = np.maximum(_between(found, sizes, needed), 0.0)[inside].max(axis=0)
        around = np.maximum(_between(found, sizes, smooth), 0.0).max(axis=0)
        cost = needed.max(axis=0) + needed[inside].mean(axis=0) + UNSOLVED * left + AROUND * around
        order = np.argsort(cost if more is None else cost + more[ways], kind="stable")
        if apart == stride:
            break
        ways = np.sort(ways[order[:KEPT]])
    best = int(order[0])
    return Way(int(ways[best]), frames, _smoothed(np.interp(frames, some, needed[:, best]), smooth_s * span.fps))


def _smoothed(sizes: FloatArray, sigma: float) -> FloatArray:
    """Return sizes (N, ...) smoothed over frames, nowhere less than they were."""
    wide = 2 * round(2.0 * sigma) + 1
    early = maximum_filter1d(sizes, wide, axis=0, mode="nearest")
    return np.asarray(gaussian_filter1d(early, sigma, axis=0, mode="nearest"))


def _needed(depths: FloatArray, sizes: FloatArray) -> FloatArray:
    """Return the least size (N, W) of each of W ways after which limbs are apart in each of N frames, or least deep in
    each other, from the depths (N, W, K) with each of K ascending sizes.
    """
    apart = depths <= 0.0
    first = np.where(apart.any(axis=-1), apart.argmax(axis=-1), depths.argmin(axis=-1))
    before = np.maximum(first - 1, 0)
    deep, over = (np.take_along_axis(depths, at[..., None], axis=-1)[..., 0] for at in (before, first))
    # Between two sizes the depth is about linear.
    deep, over = np.maximum(deep, 0.0), np.maximum(-over, 0.0)
    return np.asarray(sizes[first] - (sizes[first] - sizes[before]) * over / np.maximum(deep + over, 1e-9))


def _between(depths: FloatArray, sizes: FloatArray, size: FloatArray) -> FloatArray:
    """Interpolate depths (N, W, K) with each of K ascending sizes at other sizes (N, W)."""
    after = np.clip(np.searchsorted(sizes, size), 1, len(sizes) - 1)
    share = (size - sizes[after - 1]) / (sizes[after] - sizes[after - 1])
    low, high = (np.take_along_axis(depths, at[..., None], axis=-1)[..., 0] for at in (after - 1, after))
    return np.asarray(low + share * (high - low))
