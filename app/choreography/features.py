"""Features for the likeness of motions: the poses at their minimum, maximum and minimum, as in the paper.

A pose is where its joints and ends are, over the floor below the hips, seen from where the body faces at the accent,
and in parts of the body's height. So it depends neither on where the body dances nor where it looks nor how tall it is,
distances between poses are distances between points of the body, and no angle can wrap; a turn of the body during the
motion stays in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.cuts import Cut
from app.rig import quaternion
from app.rig.skeleton import rest_positions

POSES: Final = 3
"""Number of poses of a motion that are compared: at its start, its accent and its end."""
LEAST_HEIGHT_M: Final = 0.1
SIDES: Final = ("left", "right")
ANKLE_PART: Final = 0.29
"""Height of an ankle over the sole, as a part of the way from it to the tip of the toes."""
_UP = (0.0, 1.0, 0.0)
_HEAD = SEGMENTS.index("head")
_ALONG: Final = {
    ENDS.index("head"): (_HEAD, SEGMENTS.index("chest")),
    **{ENDS.index(f"{side}Hand"): tuple(map(SEGMENTS.index, (f"{side}Hand", f"{side}LowerArm"))) for side in SIDES},
}
"""By end: the joint that it hangs from and the one before it."""


def features(clip: MotionClip, cuts: Sequence[Cut]) -> FloatArray:
    """Features of motions of a clip.

    Returns
    -------
    (C, 3 * 21 * 3) float64
        Of each cut the three poses, of each pose the `joint_points_m` of the body over its `size_m`.
    """
    if not cuts:
        return np.zeros((0, POSES * (len(SEGMENTS) + len(ENDS)) * 3))
    accents = [cut.accent for cut in cuts]
    frames = np.array([[cut.start, cut.accent, min(cut.end, len(clip) - 1)] for cut in cuts])
    below_hips = clip.hips_m * (1.0, 0.0, 1.0)
    points = joint_points_m(clip) - below_hips[:, None]
    back = quaternion.conjugate(facing(clip)[accents])
    seen = quaternion.rotate(back[:, None, None], points[frames])
    return np.asarray(seen / size_m(clip)).reshape(len(cuts), -1)


def facing(clip: MotionClip) -> FloatArray:
    """(F, 4) turn about +Y from +Z to where the hips face; their lean and roll are left out."""
    _, twist = quaternion.swing_twist(clip.rotations[:, 0], _UP)
    return twist


def points_m(clip: MotionClip) -> FloatArray:
    """(F, 21, 3) places of the joints of `SEGMENTS`, then of `ENDS`, in the world."""
    world = clip.world()
    last = [1 + SEGMENTS.index(name) for name in ENDS]
    ends = world.positions_m[:, last] + quaternion.rotate(world.rotations[:, last], clip.shape.ends_m)
    return np.concatenate([world.positions_m[:, 1:], ends], axis=1)


def joint_points_m(clip: MotionClip) -> FloatArray:
    """(F, 21, 3) the places that `points_m` has, as joints alone show them: a hand along its forearm, a crown along its
    neck. So what is decided by them does not depend on how a head or a hand without further bones was read."""
    points = points_m(clip)
    for end, (joint, before) in _ALONG.items():
        way = points[:, joint] - points[:, before]
        length = np.linalg.norm(way, axis=-1, keepdims=True)
        reach_m = float(np.linalg.norm(clip.shape.ends_m[end]))
        points[:, len(SEGMENTS) + end] = points[:, joint] + way * (reach_m / np.maximum(length, 1e-9))
    return points


def size_m(clip: MotionClip) -> float:
    """Length of the bones from sole to crown, about the height of the body; it depends on no pose."""
    offsets, ends = clip.shape.offsets_m, clip.shape.ends_m
    column = [np.linalg.norm(offsets[SEGMENTS.index(name)]) for name in ("spine", "chest", "head")]
    legs = [np.linalg.norm(offsets[SEGMENTS.index(side + name)]) for side in SIDES for name in ("LowerLeg", "Foot")]
    feet = [ANKLE_PART * np.linalg.norm(ends[ENDS.index(f"{side}Foot")]) for side in SIDES]
    total = sum(column) + (sum(legs) + sum(feet)) / len(SIDES) + np.linalg.norm(ends[ENDS.index("head")])
    return max(LEAST_HEIGHT_M, float(total))


def height_m(clip: MotionClip) -> float:
    """Height from the floor to the crown in the T-pose; at least `LEAST_HEIGHT_M`, also where bones have no length."""
    crown_m = rest_positions(clip.shape.skeleton)[1 + _HEAD, 1] + clip.shape.ends_m[ENDS.index("head"), 1]
    return max(LEAST_HEIGHT_M, float(crown_m))
