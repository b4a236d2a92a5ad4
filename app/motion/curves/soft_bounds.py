"""Smooth versions of minimum and maximum."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray


def softly_over(x: FloatArray, ease: FloatArray | float) -> FloatArray:
    """Return ``max(x, 0)`` with its corner rounded by a parabola between -ease and ease; exactly 0 below."""
    result: FloatArray = np.where(x >= ease, x, np.square(np.maximum(x + ease, 0.0)) / (4.0 * ease))
    return result


def softly_capped(x: FloatArray, most: FloatArray | float, ease: FloatArray | float) -> FloatArray:
    """Return ``min(x, most)`` with a corner that is rounded over a width of ``ease``."""
    return most - softly_over(most - x, ease)
