"""Time in FBX files: integer ticks, 46,186,158,000 per second, and the codes of frame rates.

Source: FBX SDK reference, ``FbxTime`` (``FBXSDK_TC_SECOND`` and ``FbxTime::EMode``).
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from app.arrays import FloatArray, IntArray
from app.formats.rates import exact_rate

TICKS_PER_SECOND = 46_186_158_000

CUSTOM_TIME_MODE = 14

_TIME_MODES = {
    Fraction(120): 1,
    Fraction(100): 2,
    Fraction(60): 3,
    Fraction(50): 4,
    Fraction(48): 5,
    Fraction(30): 6,
    Fraction(30000, 1001): 9,
    Fraction(25): 10,
    Fraction(24): 11,
    Fraction(1000): 12,
    Fraction(24000, 1001): 13,
    Fraction(96): 15,
    Fraction(72): 16,
    Fraction(60000, 1001): 17,
    Fraction(120000, 1001): 18,
}
_RATES = {mode: fps for fps, mode in _TIME_MODES.items()} | {7: Fraction(30), 8: Fraction(30000, 1001)}


def frame_ticks(fps: Fraction, frames: int) -> IntArray:
    """Return the tick of each frame (frames,), rounded separately so that errors do not add up."""
    numerator, denominator = TICKS_PER_SECOND * fps.denominator, fps.numerator
    if numerator % denominator == 0:
        return np.arange(frames, dtype=np.int64) * (numerator // denominator)
    # In Python integers, since products would overflow 64 bits after about an hour.
    return np.array([(2 * n * numerator + denominator) // (2 * denominator) for n in range(frames)], dtype=np.int64)


def nearest_frames(at_ticks: FloatArray, fps: Fraction) -> IntArray:
    """Return the frame numbers (N,) nearest to FBX times (N,) in ticks."""
    return np.rint(at_ticks * (float(fps) / TICKS_PER_SECOND)).astype(np.int64)


def time_mode(fps: Fraction) -> int:
    """Return the ``TimeMode`` code of a frame rate; `CUSTOM_TIME_MODE` requires ``CustomFrameRate``."""
    return _TIME_MODES.get(fps, CUSTOM_TIME_MODE)


def rate(mode: int, custom: float) -> Fraction | None:
    """Return the frame rate of a ``TimeMode`` code; None if the code stands for none."""
    if mode != CUSTOM_TIME_MODE:
        return _RATES.get(mode)
    if not 0 < custom < 1e6:
        return None
    return exact_rate(custom)
