"""Contacts of the feet of a motion with the floor."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, label

from app.arrays import BoolArray, FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion
from app.rig.skeleton import JointTransforms

STANDS_M_S: Final = 0.20
"""A foot whose tip is slower than this stands ..."""
LEAVES_M_S: Final = 0.29
"""... until it is faster than this."""
NEAR_M: Final = 0.03
"""And is no higher than this over where it is lowest within `AROUND_S`."""
AROUND_S: Final = 2.0
LEAST_S: Final = 0.07
"""A foot that stands stands this long."""
SMOOTH_S: Final = 0.025
"""Standard deviation of the Gaussian over the speed: one frame of noise is no step."""


def tips_m(clip: MotionClip, world: JointTransforms | None = None) -> FloatArray:
    """(F, 2, 3) places of the tips of the left and the right foot, in the world (that of the clip, where given)."""
    world = clip.world() if world is None else world
    joints = [1 + SEGMENTS.index(foot) for foot in FEET]
    ends = clip.shape.ends_m[[ENDS.index(foot) for foot in FEET]]
    return world.positions_m[:, joints] + quaternion.rotate(world.rotations[:, joints], ends)


def foot_contacts(clip: MotionClip) -> BoolArray:
    """(F, 2) whether the left and the right foot stand, by speed and height of their tips, with hysteresis."""
    fps, tips = float(clip.fps), tips_m(clip)
    if len(clip) < 2:
        return np.ones((len(clip), 2), bool)
    speed = np.linalg.norm(np.gradient(tips, axis=0), axis=-1) * fps
    speed = gaussian_filter1d(speed, SMOOTH_S * fps, axis=0, mode="nearest")
    result = np.zeros(speed.shape, bool)
    around = max(1, round(AROUND_S * fps))
    for foot in range(2):
        height = tips[:, foot, 1]
        padded = np.pad(height, around, mode="edge")
        lowest = np.lib.stride_tricks.sliding_window_view(padded, 2 * around + 1).min(axis=-1)
        low = height < lowest + NEAR_M
        result[:, foot] = _hysteresis(low & (speed[:, foot] < STANDS_M_S), low & (speed[:, foot] < LEAVES_M_S))
        spans, count = label(result[:, foot])
        for number in range(1, count + 1):
            here = spans == number
            if here.sum() < LEAST_S * fps:
                result[here, foot] = False
    return result


def _hysteresis(begins: BoolArray, goes_on: BoolArray) -> BoolArray:
    """Stretches of ``goes_on`` that hold a frame of ``begins``."""
    spans, _ = label(goes_on)
    held = np.unique(spans[begins & goes_on])
    return np.asarray(np.isin(spans, held[held > 0]))
