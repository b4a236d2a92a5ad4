"""Features for the similarity of motions: poses at minimum, maximum and minimum of acceleration, as in the paper.

A pose consists of the positions of its joints and ends relative to the floor below the hips, oriented by the body's
facing at the accent, and relative to the body's height. So it is independent of place, direction and size, distances
between poses are distances between points of the body, and no angle can wrap; a turn of the body during the motion is
preserved.
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
"""Number of compared poses of a motion: at its start, accent and end."""
LEAST_HEIGHT_M: Final = 0.1
SIDES: Final = ("left", "right")
ANKLE_PART: Final = 0.29
"""Height of an ankle above the sole relative to the distance from it to the tip of the toes."""
_UP = (0.0, 1.0, 0.0)
_HEAD = SEGMENTS.index("head")
_ALONG: Final = {
    ENDS.index("head"): (_HEAD, SEGMENTS.index("chest")),
    **{ENDS.index(f"{side}Hand"): tuple(map(SEGMENTS.index, (f"{side}Hand", f"{side}LowerArm"))) for side in SIDES},
}
"""Joint that each end is attached to, and the joint before it."""


def features(clip: MotionClip, cuts: Sequence[Cut]) -> FloatArray:
    """Compute for each motion of a clip, given as cuts, the features by which motions are compared.

    Returns
    -------
    (C, 3 * 21 * 3) float64
        For each cut the three poses, for each pose the `joint_points_m` of the body divided by its `size_m`.
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
    """Rotation (F, 4) about the vertical from +Z to the direction in which the hips face, without lean and roll."""
    _, twist = quaternion.swing_twist(clip.rotations[:, 0], _UP)
    return twist


def points_m(clip: MotionClip) -> FloatArray:
    """World positions (F, 21, 3) of the joints of `SEGMENTS`, followed by those of `ENDS`."""
    world = clip.world()
    last = [1 + SEGMENTS.index(name) for name in ENDS]
    ends = world.positions_m[:, last] + quaternion.rotate(world.rotations[:, last], clip.shape.ends_m)
    return np.concatenate([world.positions_m[:, 1:], ends], axis=1)


def joint_points_m(clip: MotionClip) -> FloatArray:
    """Positions (F, 21, 3) like `points_m`, but with hands along their forearms and the crown along the neck, so that
    decisions do not depend on head and hand rotations that a file without further bones leaves unknown.
    """
    points = points_m(clip)
    for end, (joint, before) in _ALONG.items():
        way = points[:, joint] - points[:, before]
        length = np.linalg.norm(way, axis=-1, keepdims=True)
        reach_m = float(np.linalg.norm(clip.shape.ends_m[end]))
        points[:, len(SEGMENTS) + end] = points[:, joint] + way * (reach_m / np.maximum(length, 1e-9))
    return points


def size_m(clip: MotionClip) -> float:
    """Size of a body in metres: total length of its bones from sole to crown, which is about its height in any pose."""
    offsets, ends = clip.shape.offsets_m, clip.shape.ends_m
    column = [np.linalg.norm(offsets[SEGMENTS.index(name)]) for name in ("spine", "chest", "head")]
    legs = [np.linalg.norm(offsets[SEGMENTS.index(side + name)]) for side in SIDES for name in ("LowerLeg", "Foot")]
    feet = [ANKLE_PART * np.linalg.norm(ends[ENDS.index(f"{side}Foot")]) for side in SIDES]
    total = sum(column) + (sum(legs) + sum(feet)) / len(SIDES) + np.linalg.norm(ends[ENDS.index("head")])
    return max(LEAST_HEIGHT_M, float(total))


def height_m(clip: MotionClip) -> float:
    """Return the height from the floor to the crown in the T-pose in metres; at least `LEAST_HEIGHT_M`, even if bones
    have no length.
    """
    crown_m = rest_positions(clip.shape.skeleton)[1 + _HEAD, 1] + clip.shape.ends_m[ENDS.index("head"), 1]
    return max(LEAST_HEIGHT_M, float(crown_m))
