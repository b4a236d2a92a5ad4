"""Brings the feet of a body that hovers down: one of them is at the floor unless the body is in free fall."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.body_speeds import runs
from app.choreography.clip import MotionClip
from app.choreography.feet_on_floor import rest_tip_m
from app.choreography.free_fall import falls_m_s2, supported
from app.rig import quaternion
from app.rig.skeleton import JointTransforms

NEAR_M: Final = 0.0
"""Height in metres of the lower sole up to which a body does not hover."""
EASES_M: Final = 0.003
"""Height in metres within which feet begin to be brought down."""
BOTH_M: Final = 0.004
"""Difference in the heights of both soles, in metres, within which neither is clearly the lower one."""
_UP: Final = np.array([0.0, 1.0, 0.0])


def hover_m(clip: MotionClip, world: JointTransforms, legs: JointTransforms, tips: FloatArray) -> FloatArray:
    """Return the distance (F,) in metres by which both feet must be lowered so that one is near the floor; 0 while
    either is there and in free fall.

    Parameters
    ----------
    world : JointTransforms
        World transforms of the clip.
    legs : JointTransforms
        Those of the legs, with the desired rotations of the feet.
    tips : (F, 2, 3) float64
        Desired positions in metres of the left and the right tip.
    """
    soles = []
    for foot, name in enumerate(FEET):
        end = clip.shape.ends_m[ENDS.index(name)]
        heel = quaternion.rotate(legs.of(1 + SEGMENTS.index(name))[1], end * (_UP - 1.0))[:, 1]
        soles.append(tips[:, foot, 1] + np.minimum(heel, 0.0) - rest_tip_m(clip, foot))
    lower_m = -BOTH_M * np.logaddexp(*(-np.array(soles) / BOTH_M))
    over_m: FloatArray = np.maximum(lower_m - NEAR_M, 0.0)
    if not over_m.any():
        return over_m
    fps = float(clip.fps)
    hover = over_m**2 / (over_m + EASES_M)
    return np.asarray(hover * supported(over_m, falls_m_s2(world, fps), fps))


def supporting(hover: FloatArray, tips: FloatArray) -> list[tuple[int, int, int]]:
    """Return the spans in which a foot of a body that hovers by ``hover`` (F,) carries it: the foot with the lower one
    of the ``tips`` (F, 2, 3), first frame, and the frame after the last one."""
    found = []
    for foot in range(2):
        own = (hover > 0.0) & (tips[:, foot, 1] <= tips[:, 1 - foot, 1])
        found += [(foot, start, stop) for start, stop in runs(own)]
    return found
