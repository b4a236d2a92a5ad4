"""Toes of a character that stay flat on the floor while the foot rolls over its ball."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.limbs import smooth_share
from app.rig import quaternion

MOST_RAD: Final = 1.05
"""Greatest bend of the toes in radians, approached softly: about 60 degrees (people reach 60 to 70 in push-off and on
tiptoe)."""
SOFT_RAD: Final = 0.02
"""Angle in radians within which the bend begins, and five times that within which it ends at `MOST_RAD`."""
SOLE_DOWN: Final = 0.35
"""Cosine of the angle between sole and floor from which toes bend fully; those of a foot with its sole upright are
straight."""
SWINGS_RAD_S2: Final = 32.0
"""Angular acceleration in rad/s^2 with which toes bend before, and straighten after, the greatest bend that the floor
needs; they begin earlier, or end later, where it needs more."""
SMOOTH_S: Final = 0.015
"""Standard deviation in seconds over which the bend begins and ends."""


def toe_bend_rad(
    foot: FloatArray, ahead: FloatArray, height_m: FloatArray, rest_m: float, reach_m: float, fps: float
) -> FloatArray:
    """Return the upward bend (F,) in radians of the toes with which their tip is on or above the floor.

    Parameters
    ----------
    foot : (F, 4) float64
        World rotation of the foot.
    ahead : (3,) float64
        Horizontal direction of the toes at rest, a unit vector.
    height_m : (F,) float64
        Height of the toes' joint in metres.
    rest_m, reach_m : float
        Height of that joint at rest, and the distance ahead from it to the tip, in metres.
    """
    forward = quaternion.rotate(foot, ahead)[:, 1]
    upward = quaternion.rotate(foot, np.array([0.0, 1.0, 0.0]))[:, 1]
    # Height of the tip under the joint: straight * cos(bend) + bent * sin(bend).
    straight, bent = reach_m * forward - rest_m * upward, reach_m * upward + rest_m * forward
    whole = np.maximum(np.hypot(straight, bent), 1e-9)
    needed = np.arctan2(bent, straight) - np.arccos(np.clip(-height_m / whole, -1.0, 1.0))
    bend = smooth_share(upward, (0.0, SOLE_DOWN)) * SOFT_RAD * np.logaddexp(0.0, needed / SOFT_RAD)
    end = 5.0 * SOFT_RAD
    bend = bend - end * (np.logaddexp(0.0, (bend - MOST_RAD) / end) - np.logaddexp(0.0, -MOST_RAD / end))
    beside = np.arange(-(reach := math.ceil(math.sqrt(2.0 * MOST_RAD / SWINGS_RAD_S2) * fps)), reach + 1) / fps
    around = np.lib.stride_tricks.sliding_window_view(np.pad(bend, reach, mode="edge"), len(beside))
    bend = (around - 0.5 * SWINGS_RAD_S2 * beside**2).max(axis=1)
    return np.asarray(gaussian_filter1d(bend, SMOOTH_S * fps, mode="nearest"))
