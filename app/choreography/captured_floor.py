"""Height of the floor under a captured body."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d, minimum_filter1d

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
FLIGHT_S: Final = 1.0
"""Time in seconds for which no body is off the floor: a jump of 1.2 m, by free fall."""
DRIFT_M: Final = 0.06
"""Height in metres up to which a body may be off the floor for longer, since soles are captured imprecisely: up to
5 cm in captures whose floor stays in place."""
JUMP_S: Final = 0.6
"""Time in seconds for which a dancer is off the floor at most: a jump of 44 cm."""
TOUCHES_M: Final = 0.005
"""Height in metres over a moving floor up to which the body touches it."""
DRIFTS_S: Final = 0.1
"""Standard deviation in seconds over which a moving floor changes its height."""
THICK_M: Final = {
    "hips": 0.15, "spine": 0.15, "chest": 0.15, "head": 0.1, "UpperArm": 0.1, "LowerArm": 0.1, "Hand": 0.1,
    "UpperLeg": 0.15, "LowerLeg": 0.1, "Foot": 0.05,
}  # fmt: skip
"""Most height in metres over the floor of a joint on which the body rests, by end of the segment's name."""


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


def floors_m(done: CleanedClip) -> FloatArray:
    """Return the height (F,) of the floor in metres in each frame of a clip: everywhere that of what is danced, or, if
    the body is higher over that for longer than it can fall, a height that follows the body slowly, however it rests.
    """
    clip, own_m = done.clip, floor_of_danced(done)
    floor = np.full(len(clip), own_m)
    sound = np.ones(len(clip), bool)
    for one in done.left_out:
        sound[one.start : one.stop] = False
    if not sound.any():
        return floor
    frames, fps = np.arange(len(clip)), float(clip.fps)
    lowest = np.interp(frames, frames[sound], _lowest_of_body(clip, own_m)[sound])
    if _lasting(lowest, FLIGHT_S * fps).max() - own_m <= DRIFT_M:
        return floor
    touches = np.flatnonzero(lowest <= _lasting(lowest, JUMP_S * fps) + TOUCHES_M)
    return np.asarray(gaussian_filter1d(np.interp(frames, touches, lowest[touches]), DRIFTS_S * fps, mode="nearest"))


def _lasting(heights_m: FloatArray, frames: float) -> FloatArray:
    """Remove what rises over both neighbours for fewer than some frames from heights (F,)."""
    wide = 2 * round(0.5 * frames) + 1
    return np.asarray(maximum_filter1d(minimum_filter1d(heights_m, wide, mode="nearest"), wide, mode="nearest"))


def _lowest_of_body(clip: MotionClip, floor_m: float) -> FloatArray:
    """Height (F,) of the lowest of feet and of the surface under all joints, as far as that is over the floor."""
    world = clip.world()
    positions_m, rotations = world.positions_m[:, 1:], world.rotations[:, 1:]
    thick_m = [next(thick for end, thick in THICK_M.items() if name.endswith(end)) for name in SEGMENTS]
    surface_m = np.maximum((positions_m[..., 1] - thick_m).min(axis=1), floor_m)
    return np.asarray(np.minimum(surface_m, _lowest_of_feet(positions_m, rotations, clip.shape.ends_m)))


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
