"""The greatest and the least of the values around each: as `scipy.ndimage` finds them, without loading it."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray


def greatest_within(values: FloatArray, half: int) -> FloatArray:
    """The greatest value (F,) within ``half`` of each; beyond the ends the values go back."""
    found, window, width = _symmetric(values, half), 2 * half + 1, 1
    while width < window:
        # Of twice as many each time, the last time of as many as are left.
        step = min(width, window - width)
        found = np.maximum(found[:-step], found[step:])
        width += step
    return found


def _symmetric(values: FloatArray, half: int) -> FloatArray:
    """The values, and ``half`` more at each end, which go back as in a mirror."""
    if half > len(values):
        return np.pad(values, half, mode="symmetric")
    return np.concatenate((values[:half][::-1], values, values[len(values) - half :][::-1]))


def least_within(values: FloatArray, half: int) -> FloatArray:
    """The least value (F,) within ``half`` of each, in the same way."""
    return -greatest_within(-values, half)
