"""Shapes of an empty hand: open, pinching, pointing.

Angles are flexions in degrees in order from the palm to the tip, chosen by eye. At rest fingers are straight and the
palm faces down.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.grip_pose import Side
from app.rig.model import Skeleton
from metadata.gestures import HandShape

FINGERS: Final = ("Thumb", "Index", "Middle", "Ring", "Little")
SHAPES_DEG: Final[Mapping[HandShape, tuple[tuple[float, float, float], ...]]] = {
    "open": ((4.0, 8.0, 10.0), (12.0, 16.0, 8.0), (15.0, 20.0, 10.0), (19.0, 24.0, 12.0), (22.0, 26.0, 12.0)),
    "pinch": ((24.0, 14.0, 12.0), (46.0, 34.0, 16.0), (44.0, 44.0, 22.0), (42.0, 46.0, 24.0), (40.0, 44.0, 22.0)),
    "point": ((16.0, 22.0, 22.0), (10.0, 16.0, 8.0), (54.0, 70.0, 36.0), (60.0, 76.0, 40.0), (60.0, 74.0, 38.0)),
}
TIP_SHARE: Final = 0.75
"""Length of a finger's last bone relative to the preceding one."""
PAD_M: Final = 0.006
"""Depth of a fingertip's bone below its skin."""
OPPOSED: Final = (0.55, 0.85)
"""Shares by which the thumb bends along the fingers and towards the palm."""
PALMAR = np.array([0.0, -1.0, 0.0])


def finger_joints(skeleton: Skeleton, side: Side, finger: str) -> tuple[int, ...]:
    """Return the joints of a finger from the palm outwards, as far as the skeleton has them."""
    bones = ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
    names = [f"{side}{finger}{bone}" for bone in bones]
    return tuple(skeleton.index(name) for name in names if name in skeleton.names)


@lru_cache(maxsize=64)
def shaped(skeleton: Skeleton, side: Side, shape: HandShape) -> dict[int, FloatArray]:
    """Return the rotation (4,) of every finger joint, by joint index, in a shape of the empty hand."""
    along = np.array([1.0 if side == "left" else -1.0, 0.0, 0.0])
    rotations: dict[int, FloatArray] = {}
    for finger, angles_deg in zip(FINGERS, SHAPES_DEG[shape], strict=True):
        joints = finger_joints(skeleton, side, finger)
        towards = OPPOSED[0] * along + OPPOSED[1] * PALMAR if finger == "Thumb" else PALMAR
        for joint, following, angle_deg in zip(joints, [*joints[1:], None], angles_deg, strict=False):
            bone = skeleton.offsets_m[joint if following is None else following]
            axis = np.cross(bone, towards)
            length = float(np.linalg.norm(axis))
            if length > 0.0:
                rotations[joint] = quaternion.from_axis_angle(axis / length, float(np.deg2rad(angle_deg)))
    return rotations


@lru_cache(maxsize=64)
def tip_m(skeleton: Skeleton, side: Side, shape: HandShape) -> FloatArray:
    """Return the point (3,) of a shaped hand, in the wrist's frame, that touches things: the index finger's pad, or for
    a pinch the middle between it and the thumb's pad.
    """
    pads = [
        _pad_m(skeleton, side, finger, shape) for finger in (("Index", "Thumb") if shape == "pinch" else ("Index",))
    ]
    middle: FloatArray = np.mean(pads, axis=0)
    return middle


def _pad_m(skeleton: Skeleton, side: Side, finger: str, shape: HandShape) -> FloatArray:
    joints, rotations = finger_joints(skeleton, side, finger), shaped(skeleton, side, shape)
    place_m, turn = np.zeros(3), quaternion.IDENTITY
    for joint in joints:
        place_m = place_m + quaternion.rotate(turn, skeleton.offsets_m[joint])
        turn = quaternion.multiply(turn, rotations.get(joint, quaternion.IDENTITY))
    last_m = TIP_SHARE * skeleton.offsets_m[joints[-1]] if joints else np.zeros(3)
    pad_m: FloatArray = place_m + quaternion.rotate(turn, last_m + PAD_M * PALMAR)
    return pad_m
