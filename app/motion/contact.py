"""Contacts, solved last: the rim on the lips, the hands on the instrument, the fingers on their controls.

The head carries the instrument while it is played and the chest while it is lowered; hands follow the instrument, arms
follow the hands. Body motion moves all of it together, so it never breaks a contact.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.motion.body import BodyMotion
from app.motion.curve import FloatArray
from app.motion.posture import STRAIGHTEST, Side, Trunk, exact_target
from app.rig import quaternion
from app.rig.hold import HandHold, Hold, hand_targets
from app.rig.ik import arm, solve_limb
from app.rig.model import Skeleton
from instrument_maps.model import Carriage, Lowered

X_AXIS, Y_AXIS, Z_AXIS = np.eye(3)

CLEAR_M = 0.05
"""On its way down and up the instrument swings ahead by this much, clear of the chin."""
AT_EASE = 0.965
"""Share of its length an arm reaches without help from the shoulder."""
EASE_M = 0.010
"""The shoulder's help sets in over about this distance."""
CLAVICLE_RAD = float(np.deg2rad(24.0))
"""Most the shoulder comes towards a far hand."""
TURN_RAD = float(np.deg2rad(24.0))
"""Most the trunk turns for a far hand."""


@dataclass(frozen=True)
class Carried:
    """World transform of the instrument: (F, 3) and (F, 4) float64."""

    position_m: FloatArray
    rotation: FloatArray


def attitude(pitch_down_rad: FloatArray, yaw_left_rad: float, roll_left_rad: float) -> FloatArray:
    """Rotation (F, 4) of an instrument from its angles, in the order yaw, pitch, roll."""
    yaw = quaternion.from_axis_angle(Y_AXIS, yaw_left_rad)
    roll = quaternion.from_axis_angle(Z_AXIS, -roll_left_rad)
    return quaternion.multiply(quaternion.multiply(yaw, quaternion.from_axis_angle(X_AXIS, pitch_down_rad)), roll)


def bell_pitch(carriage: Carriage, bell_rad: FloatArray) -> FloatArray:
    """Pitch of the bell (down positive) within the carriage's range; its ends are approached softly."""
    low, usual, high = np.deg2rad(carriage.pitch_down_deg)
    down = -bell_rad
    room = np.where(down >= 0.0, max(high - usual, 1e-3), max(usual - low, 1e-3))
    pitch: FloatArray = usual + room * np.tanh(down / room)
    return pitch


def carry(
    hold: Hold,
    carriage: Carriage,
    lowered: Lowered,
    body: Trunk,
    base: Trunk,
    motion: BodyMotion,
    morphs: Mapping[str, FloatArray],
    mouth_open: FloatArray,
    lowering: FloatArray,
) -> Carried:
    """Place the instrument: its rim on the lips, or lowered before the body.

    Parameters
    ----------
    hold, carriage, lowered
    body, base : Trunk
        The trunk as it moves, (F,), and in the posture before any motion, (1,).
    motion : BodyMotion
    morphs : mapping of str to (F,)
    mouth_open : (F,) float64
        How far the mouth is open for a breath, 0..1: then the upper lip alone carries the rim.
    lowering : (F,) float64
        0 at the lips, 1 lowered.
    """
    frames = len(lowering)
    contact_m, upper_m = hold.lips.contact_m(morphs, frames), hold.lips.upper_m(morphs, frames)
    lips_m = contact_m + (upper_m - contact_m) * mouth_open[:, None]
    yaw, roll = np.deg2rad(carriage.yaw_left_deg[1]), np.deg2rad(carriage.roll_left_deg[1])
    with_head = quaternion.multiply(body.head, quaternion.conjugate(base.head))
    rotation = quaternion.multiply(with_head, attitude(bell_pitch(carriage, motion.bell_rad), float(yaw), float(roll)))
    position_m = body.head_m + quaternion.rotate(body.head, lips_m)
    if not np.any(lowering):
        return Carried(position_m, rotation)
    base_lips_m = base.head_m + quaternion.rotate(base.head, hold.lips.contact_rest_m)
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(base.chest))
    low_m = body.chest_m + quaternion.rotate(with_chest, base_lips_m + np.array(lowered.offset_m) - base.chest_m)
    low = quaternion.multiply(
        with_chest,
        attitude(
            np.array([np.deg2rad(lowered.pitch_down_deg)]),
            float(np.deg2rad(lowered.yaw_left_deg)),
            float(np.deg2rad(lowered.roll_left_deg)),
        ),
    )
    share = lowering[:, None]
    swing = 4.0 * share * (1.0 - share) * CLEAR_M * Z_AXIS
    return Carried(position_m + (low_m - position_m) * share + swing, quaternion.slerp(rotation, low, lowering))


def reach_turn(hold: Hold, skeleton: Skeleton, controls: Mapping[str, FloatArray], frames: int) -> FloatArray:
    """How far the trunk turns (left positive) so that a far hand is reached, (F,) float64.

    What the shoulder alone can give is left to it.
    """
    total = np.zeros(frames)
    for reach in hold.reach:
        if reach.control is None or reach.control not in controls:
            continue
        clavicle_m, across_m = _shoulder_levers(skeleton, reach.side)
        need_m = reach.shortfall_m + (1.0 - AT_EASE) * reach.arm_m
        rest_m = need_m - 0.75 * clavicle_m * np.sin(CLAVICLE_RAD)
        if np.all(rest_m <= -EASE_M):
            continue
        values = np.linspace(0.0, 1.0, 101)
        soft_m = _softly_positive(np.interp(values, reach.values, rest_m))
        lever_m = across_m * max(float(reach.direction[2]), 0.3)
        turn = TURN_RAD * np.tanh(soft_m / (lever_m * TURN_RAD))
        sign = 1.0 if reach.side == "right" else -1.0
        total += sign * np.interp(controls[reach.control], values, turn)
    return total


def _softly_positive(x: FloatArray) -> FloatArray:
    result: FloatArray = 0.5 * (x + np.sqrt(x * x + EASE_M * EASE_M))
    return result


def _shoulder_levers(skeleton: Skeleton, side: Side) -> tuple[float, float]:
    """Length of the clavicle, and how far the shoulder joint lies from the spine."""
    upper, shoulder = skeleton.index(f"{side}UpperArm"), skeleton.index(f"{side}Shoulder")
    offset = skeleton.offsets_m[upper]
    return float(np.linalg.norm(offset)), abs(float(offset[0] + skeleton.offsets_m[shoulder][0]))


def solve_arms(
    skeleton: Skeleton,
    hold: Hold,
    body: Trunk,
    base: Trunk,
    motion: BodyMotion,
    carried: Carried,
    controls: Mapping[str, FloatArray],
) -> tuple[dict[int, FloatArray], dict[Side, FloatArray]]:
    """Rotations of clavicles, arms and hands by joint, and how far each hand stays from its place (F,), metres."""
    rotations: dict[int, FloatArray] = {}
    misses: dict[Side, FloatArray] = {}
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(base.chest))
    for hand in hold.hands:
        targets = hand_targets(hand, carried.position_m, carried.rotation, controls)
        solved, misses[hand.side] = _solve_arm(skeleton, hand, body, with_chest, motion, *targets)
        rotations |= solved
    return rotations, misses


def _solve_arm(
    skeleton: Skeleton,
    hand: HandHold,
    body: Trunk,
    with_chest: FloatArray,
    motion: BodyMotion,
    target_m: FloatArray,
    target_rotation: FloatArray,
) -> tuple[dict[int, FloatArray], FloatArray]:
    side: Side = hand.side
    limb = arm(skeleton, side)
    sign = 1.0 if side == "left" else -1.0
    shoulder = skeleton.index(f"{side}Shoulder")
    clavicle = skeleton.offsets_m[limb.upper]
    joint_m = body.chest_m + quaternion.rotate(body.chest, skeleton.offsets_m[shoulder])
    lift = quaternion.from_axis_angle(Z_AXIS, sign * motion.shoulders_rad)
    clavicle_world = quaternion.multiply(body.chest, lift)
    root_m = joint_m + quaternion.rotate(clavicle_world, clavicle)
    # The shoulder comes towards a hand that is far away.
    line = target_m - root_m
    distance = np.sqrt(np.einsum("fi,fi->f", line, line))
    axis = np.cross(root_m - joint_m, line / distance[:, None])
    lever_m = np.sqrt(np.einsum("fi,fi->f", axis, axis))
    axis /= np.maximum(lever_m, 1e-9)[:, None]
    need_m = _softly_positive(distance - AT_EASE * limb.length_m)
    angle = CLAVICLE_RAD * np.tanh(need_m / np.maximum(lever_m * CLAVICLE_RAD, 1e-6))
    clavicle_world = quaternion.multiply(quaternion.from_axis_angle(axis, angle), clavicle_world)
    root_m = joint_m + quaternion.rotate(clavicle_world, clavicle)
    out = np.tan(motion.elbows_rad)[:, None] * np.array([sign, 0.0, 0.0])
    pole = quaternion.rotate(with_chest, hand.elbow_direction + out)
    pose = solve_limb(limb, root_m, clavicle_world, exact_target(limb, root_m, target_m), target_rotation, pole)
    line = target_m - root_m
    distance = np.sqrt(np.einsum("fi,fi->f", line, line))
    miss_m = np.maximum(distance - STRAIGHTEST * limb.length_m, 0.0)
    return {
        shoulder: quaternion.multiply(quaternion.conjugate(body.chest), clavicle_world),
        limb.upper: pose.upper,
        limb.lower: pose.lower,
        limb.end: pose.end,
    }, miss_m
