"""Frame rates as exact fractions, such as 30000/1001."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

LEAST_ACCURACY: Final = 2e-3
"""Relative difference above which two frame rates differ, even if a file states them with few digits."""


def exact_rate(fps: float, accuracy: float = 0.0) -> Fraction:
    """Return the exact frame rate for a rounded number: a whole number, a whole number / 1.001, or the nearest simple
    fraction.

    Parameters
    ----------
    fps : float
        Frames per second, above zero.
    accuracy : float
        Relative error due to rounding of the number; at least 1e-6.
    """
    accuracy = min(max(accuracy, 1e-6), LEAST_ACCURACY)
    for candidate in (Fraction(round(fps)), Fraction(round(fps * 1.001) * 1000, 1001)):
        if candidate and abs(float(candidate) - fps) < accuracy * fps:
            return candidate
    return Fraction(fps).limit_denominator(10000)
