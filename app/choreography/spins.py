"""Limits the speed of spins in a dance, which increases when a motion is danced faster than captured.

The excess rotation is moved to slightly earlier and later frames. The body rotates about the vertical through its hips
and is otherwise unchanged, so that arrivals stay in time.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.body_speeds import turns_rad
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST_HIPS_RAD_S
from app.choreography.joint_changes import hips_within_changes
from app.rig import quaternion

AROUND_S: Final = 0.06
"""Standard deviation in seconds of the distribution of the excess."""
ROUNDS: Final = 60
TRIES: Final = 3
"""Greatest number of alternations between limits of the speed and of its changes."""
ROOM: Final = 0.97
"""Share of the limit that is used, since placing the feet moves the hips slightly again."""
_UP: Final = (0.0, 1.0, 0.0)


def without_haste(clip: MotionClip, fastest_rad_s: float = FASTEST_HIPS_RAD_S) -> MotionClip:
    """Limit the rotation speed of the hips; the same object is returned if it is within the limit."""
    fps = float(clip.fps)
    bound = ROOM * fastest_rad_s / fps
    if len(clip) < 2 or hips_rad(clip).max() <= bound:
        return clip
    turns = clip.rotations[:, 0]
    steps = turns_rad(turns)
    level, yaw = np.linalg.norm(steps[:, [0, 2]], axis=1), steps[:, 1].copy()
    free = np.sqrt(np.maximum(bound**2 - level**2, 0.0))
    for _ in range(ROUNDS):
        excess = yaw - np.clip(yaw, -free, free)
        yaw += gaussian_filter1d(excess, AROUND_S * fps, mode="nearest") - excess
    yaw = np.clip(yaw, -free, free)
    changed = np.concatenate([[0.0], np.cumsum(yaw - steps[:, 1])])
    rotations = clip.rotations.copy(order="K")
    rotations[:, 0] = quaternion.multiply(quaternion.from_axis_angle(_UP, changed), turns)
    return replace(clip, rotations=quaternion.continuous(rotations))


def hips_within(clip: MotionClip, fastest_rad_s: float, most_change_rad_s: float) -> MotionClip:
    """Return the motion with the rotation speed of the hips within a limit, and changing by at most
    ``most_change_rad_s`` from frame to frame, as far as the first limit allows; the same object if it does already.
    """
    for _ in range(TRIES):
        calm = hips_within_changes(without_haste(clip, fastest_rad_s), most_change_rad_s)
        if calm is clip:
            break
        clip = calm
    return without_haste(clip, fastest_rad_s)


def hips_rad(clip: MotionClip) -> FloatArray:
    """Return the rotation (F - 1,) of the hips in radians from frame to frame."""
    turns = clip.rotations[:, 0]
    steps = quaternion.multiply(quaternion.conjugate(turns[:-1]), turns[1:])
    return np.asarray(np.linalg.norm(quaternion.to_rotation_vector(steps), axis=-1))
