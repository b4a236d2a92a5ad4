"""Height of the floor under a captured body."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.cleaning import CleanedClip
from app.choreography.clip import MotionClip
from app.rig import quaternion

PERCENTILE: Final = 2.0
"""Percentile of the lowest point's height that defines the floor, so that a few damaged frames do not."""
RESTING: Final = ("leftLowerLeg", "rightLowerLeg", "leftHand", "rightHand")
"""Segments whose joints (knees and wrists) also rest on the floor."""
RESTS_M_S: Final = 0.2
"""Speed in metres per second below which such a joint rests."""
SAME_M: Final = 0.015
"""Difference in metres below which two floors are the same one: about the thickness of a sole."""


def floor_of_all(positions_m: FloatArray, rotations: FloatArray, ends_m: FloatArray) -> float:
    """Return the height of the floor in metres: that of the lowest point of the lower foot in the lowest of all frames.

    Parameters
    ----------
    positions_m : ndarray, shape (F, 16, 3)
        World positions of the segments' joints.
    rotations : ndarray, shape (F, 16, 4)
        World rotations of the segments.
    ends_m : ndarray, shape (5, 3)
        See `app.choreography.clip.BodyShape`.
    """
    return float(np.percentile(_lowest_of_feet(positions_m, rotations, ends_m), PERCENTILE))


def floor_of_danced(done: CleanedClip) -> float:
    """Return the height of the floor in metres in the frames of a clip that are danced: that of the lowest of feet,
    resting knees and resting wrists in the lowest frames. It is 0 if it is the clip's own floor or nothing is danced.
    """
    clip = done.clip
    danced = np.ones(len(clip), bool)
    for start, stop in done.unfit:
        danced[start:stop] = False
    if not danced.any():
        return 0.0
    world = clip.world()
    feet = _lowest_of_feet(world.positions_m[:, 1:], world.rotations[:, 1:], clip.shape.ends_m)
    lowest = np.minimum(feet, _lowest_at_rest(clip, world.positions_m[:, 1:]))
    height_m = float(np.percentile(lowest[danced], PERCENTILE))
    return height_m if abs(height_m) > SAME_M else 0.0


def _lowest_of_feet(positions_m: FloatArray, rotations: FloatArray, ends_m: FloatArray) -> FloatArray:
    """Height (F,) of the lowest of the toes and of the soles below the ankles."""
    heights = []
    for name in FEET:
        at, end_m = SEGMENTS.index(name), ends_m[ENDS.index(name)]
        toe = positions_m[:, at] + quaternion.rotate(rotations[:, at], end_m)
        sole = positions_m[:, at] + quaternion.rotate(rotations[:, at], end_m * (0.0, 1.0, 0.0))
        heights += [toe[:, 1], sole[:, 1]]
    return np.asarray(np.min(heights, axis=0))


def _lowest_at_rest(clip: MotionClip, positions_m: FloatArray) -> FloatArray:
    """Height (F,) of the lowest of the joints of `RESTING` that rest; infinite where none does."""
    joints = positions_m[:, [SEGMENTS.index(name) for name in RESTING]]
    if len(clip) < 2:
        return np.full(len(clip), np.inf)
    speeds = np.linalg.norm(np.gradient(joints, axis=0), axis=-1) * float(clip.fps)
    return np.asarray(np.where(speeds < RESTS_M_S, joints[..., 1], np.inf).min(axis=1))
