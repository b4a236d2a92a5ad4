"""Spins of a dance no faster than a body's: where a motion is danced faster than captured, its turns are too.

The excess is turned a little before and after instead. The body turns about the vertical through its hips and is
otherwise as it was, so that it arrives when it did.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST_HIPS_RAD_S
from app.rig import quaternion

AROUND_S: Final = 0.06
"""Standard deviation in time of where an excess goes."""
ROUNDS: Final = 60
ROOM: Final = 0.97
"""Feet that are put where they stood move the hips a little once more."""
_UP: Final = (0.0, 1.0, 0.0)


def without_haste(clip: MotionClip, fastest_rad_s: float = FASTEST_HIPS_RAD_S) -> MotionClip:
    """The motion with hips that turn no faster than this; the same value where they do not."""
    fps = float(clip.fps)
    bound = ROOM * fastest_rad_s / fps
    if len(clip) < 2 or hips_rad(clip).max() <= bound:
        return clip
    turns = clip.rotations[:, 0]
    steps = quaternion.to_rotation_vector(quaternion.multiply(turns[1:], quaternion.conjugate(turns[:-1])))
    level, yaw = np.linalg.norm(steps[:, [0, 2]], axis=1), steps[:, 1].copy()
    free = np.sqrt(np.maximum(bound**2 - level**2, 0.0))
    for _ in range(ROUNDS):
        excess = yaw - np.clip(yaw, -free, free)
        yaw += gaussian_filter1d(excess, AROUND_S * fps, mode="nearest") - excess
    yaw = np.clip(yaw, -free, free)
    changed = np.concatenate([[0.0], np.cumsum(yaw - steps[:, 1])])
    rotations = clip.rotations.copy()
    rotations[:, 0] = quaternion.multiply(quaternion.from_axis_angle(_UP, changed), turns)
    return replace(clip, rotations=quaternion.continuous(rotations))


def hips_rad(clip: MotionClip) -> FloatArray:
    """(F - 1,) how far the hips turn from frame to frame."""
    turns = clip.rotations[:, 0]
    steps = quaternion.multiply(quaternion.conjugate(turns[:-1]), turns[1:])
    return np.asarray(np.linalg.norm(quaternion.to_rotation_vector(steps), axis=-1))
