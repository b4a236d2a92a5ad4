"""Arms: from the shoulders to hands that are where the hold puts them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.motion.body import BodyMotion
from app.motion.contact import Carried
from app.motion.curve import FloatArray
from app.motion.posture import Trunk
from app.motion.reach import clavicle_of, forwards_axis
from app.rig import quaternion
from app.rig.hold import HandHold, Hold, Placed, hand_targets
from app.rig.ik import arm, solve_limb
from app.rig.model import Skeleton

Z_AXIS = np.array([0.0, 0.0, 1.0])

ELBOW_OUT = 1.8
"""The elbow goes out by this multiple of the angle its shoulder comes forwards, so that the wrist stays straighter."""


def solve_arms(
    skeleton: Skeleton,
    hold: Hold,
    body: Trunk,
    base: Trunk,
    motion: BodyMotion,
    carried: Carried,
    controls: Mapping[str, FloatArray],
    placed: Mapping[str, Placed],
) -> dict[int, FloatArray]:
    """Rotations of clavicles, arms and hands, by joint."""
    rotations: dict[int, FloatArray] = {}
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(base.chest))
    for hand in hold.hands:
        targets = hand_targets(hand, carried.position_m, carried.rotation, controls, placed)
        rotations |= _solve_arm(skeleton, hand, body, with_chest, motion, *targets)
    return rotations


def _solve_arm(
    skeleton: Skeleton,
    hand: HandHold,
    body: Trunk,
    with_chest: FloatArray,
    motion: BodyMotion,
    target_m: FloatArray,
    target_rotation: FloatArray,
) -> dict[int, FloatArray]:
    side = hand.side
    limb = arm(skeleton, side)
    sign = 1.0 if side == "left" else -1.0
    shoulder, clavicle = clavicle_of(skeleton, side)
    moved = quaternion.multiply(
        quaternion.from_axis_angle(Z_AXIS, sign * motion.shoulders_rad),
        quaternion.from_axis_angle(forwards_axis(skeleton, side), motion.protraction_rad[side]),
    )
    clavicle_world = quaternion.multiply(body.chest, moved)
    joint_m = body.chest_m + quaternion.rotate(body.chest, skeleton.offsets_m[shoulder])
    root_m = joint_m + quaternion.rotate(clavicle_world, clavicle)
    out = np.tan(motion.elbows_rad + ELBOW_OUT * motion.protraction_rad[side])[:, None] * np.array([sign, 0.0, 0.0])
    pole = quaternion.rotate(with_chest, hand.elbow_direction + out)
    if side in motion.elbow_held_rad:
        line = target_m - root_m
        line /= np.sqrt(np.einsum("fi,fi->f", line, line))[:, None]
        pole = quaternion.rotate(quaternion.from_axis_angle(line, sign * motion.elbow_held_rad[side]), pole)
    pose = solve_limb(limb, root_m, clavicle_world, target_m, target_rotation, pole)
    return {
        shoulder: moved,
        limb.upper: pose.upper,
        limb.lower: pose.lower,
        limb.end: pose.end,
    }
