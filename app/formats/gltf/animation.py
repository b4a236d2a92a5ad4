"""Sampling of an animation's channels at given times.

Source: Khronos, "glTF 2.0 Specification", section 3.11 and appendix C (interpolation).
"""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray, IntArray
from app.formats.gltf.model import GltfChannel
from app.formats.keys import slerp

_KEY_TOLERANCE = 1e-5
"""Tolerance of key times in seconds and relative to the time: far below a frame, above the rounding of sums
in float32.
"""


def sampled(channel: GltfChannel, times_s: FloatArray) -> FloatArray:
    """Return values (T, W) of an animation channel of width W at T times; constant before its first and after its last
    key. Rotations are normalised."""
    known = channel.times_s
    if channel.interpolation == "STEP":
        # Times of keys are float32, which may be rounded up beyond their frame.
        reached = np.searchsorted(known, times_s + _KEY_TOLERANCE * np.maximum(1.0, np.abs(times_s)), side="right") - 1
        return _unit(channel, channel.values[np.maximum(reached, 0)])
    after = np.clip(np.searchsorted(known, times_s, side="right"), 1, max(1, len(known) - 1))
    before = after - 1
    after = np.minimum(after, len(known) - 1)
    length_s = known[after] - known[before]
    share = np.clip((times_s - known[before]) / np.where(length_s > 0.0, length_s, 1.0), 0.0, 1.0)[:, None]
    if channel.interpolation == "CUBICSPLINE":
        found = _spline(channel.values.reshape(len(known), 3, -1), before, after, share, length_s[:, None])
    elif channel.path == "rotation":
        found = slerp(channel.values[before], channel.values[after], share)
    else:
        found = channel.values[before] * (1.0 - share) + channel.values[after] * share
    return _unit(channel, found)


def _unit(channel: GltfChannel, found: FloatArray) -> FloatArray:
    """Return the values (N, W) of an animation channel with rotations normalised to unit quaternions; other channels
    are unchanged.
    """
    if channel.path != "rotation":
        return found
    size = np.linalg.norm(found, axis=1, keepdims=True)
    return np.where(size > 1e-9, found / np.maximum(size, 1e-9), (0.0, 0.0, 0.0, 1.0))


def _spline(keys: FloatArray, before: IntArray, after: IntArray, share: FloatArray, length_s: FloatArray) -> FloatArray:
    """Return values (N, W) of a cubic Hermite spline: ``keys`` (K, 3, W) are in-tangent, value and out-tangent of K
    keys, ``before`` and ``after`` (N,) the keys around each of N times, ``share`` 0..1 the position between them, and
    ``length_s`` their distance.
    """
    t, t2, t3 = share, share**2, share**3
    return np.asarray(
        (2.0 * t3 - 3.0 * t2 + 1.0) * keys[before, 1]
        + length_s * (t3 - 2.0 * t2 + t) * keys[before, 2]
        + (3.0 * t2 - 2.0 * t3) * keys[after, 1]
        + length_s * (t3 - t2) * keys[after, 0]
    )
