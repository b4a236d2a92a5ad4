"""Frame rates as fractions."""

from __future__ import annotations

from fractions import Fraction


def exact_rate(fps: float) -> Fraction:
    """The rate that a rounded number means: whole, a whole number / 1.001, or else the nearest simple fraction.

    Parameters
    ----------
    fps : float
        Frames per second, above zero.
    """
    for candidate in (Fraction(round(fps)), Fraction(round(fps * 1.001) * 1000, 1001)):
        if candidate and abs(float(candidate) - fps) < 1e-6 * fps:
            return candidate
    return Fraction(fps).limit_denominator(10000)
