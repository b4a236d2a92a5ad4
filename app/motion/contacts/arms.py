"""Arms, solved from the shoulders to the hands' places on the instrument."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.hands_away import Away
from app.motion.contacts.help_for_far_hands import clavicle_of, forwards_axis
from app.motion.contacts.instrument_put_aside import HANGS_RAD
from app.motion.contacts.still_player import ContactCurves, StillPlayer
from app.motion.contacts.trunk_and_legs import Side, Trunk, exact_target
from app.motion.contacts.upper_body import UpperBody
from app.motion.contacts.wrists import Wrist
from app.rig import quaternion
from app.rig.grip.grip_pose import HandHold, hand_targets
from app.rig.ik import Limb, LimbPose, arm, end_of, solve_limb, swivelled
from app.rig.model import Skeleton

Z_AXIS = np.array([0.0, 0.0, 1.0])

ELBOW_OUT = 1.8
"""Angle by which the elbow moves outwards, as a multiple of the angle by which the shoulder moves forward, which keeps
the wrist straighter. It moves earlier and more slowly than the shoulder.
"""


@dataclass(frozen=True)
class Shoulder:
    """Pose of a shoulder.

    Attributes
    ----------
    moved : (F, 4) float64
        Rotation of the clavicle in the chest's frame.
    clavicle : (F, 4) float64
        Rotation of the clavicle in world space.
    joint_m : (F, 3) float64
        World position of the shoulder joint.
    """

    moved: FloatArray
    clavicle: FloatArray
    joint_m: FloatArray


def shoulder(skeleton: Skeleton, side: Side, body: Trunk, motion: BodyMotion) -> Shoulder:
    """Return position and rotation of a shoulder joint as the trunk moves and the clavicle is lifted or brought
    forward."""
    sign = 1.0 if side == "left" else -1.0
    joint, reaches_m = clavicle_of(skeleton, side)
    moved = quaternion.multiply(
        quaternion.from_axis_angle(Z_AXIS, sign * motion.shoulders_rad),
        quaternion.from_axis_angle(forwards_axis(skeleton, side), motion.protraction_rad[side]),
    )
    clavicle = quaternion.multiply(body.chest, moved)
    begins_m = body.chest_m + quaternion.rotate(body.chest, skeleton.offsets_m[joint])
    return Shoulder(moved, clavicle, begins_m + quaternion.rotate(clavicle, reaches_m))


@dataclass(frozen=True)
class SolvedArm:
    """An arm whose hand is where the instrument has it.

    Attributes
    ----------
    shoulder : Shoulder
    limb : Limb
    pose : LimbPose
    line : (F, 3) float64
        Unit direction from shoulder to hand.
    hand : (F, 4) float64
        World rotation of the hand.
    """

    shoulder: Shoulder
    limb: Limb
    pose: LimbPose
    line: FloatArray
    hand: FloatArray


def solve_arms(
    player: StillPlayer,
    curves: ContactCurves,
    upper: UpperBody,
    swung: FloatArray | None = None,
    away: Away | None = None,
) -> dict[int, FloatArray]:
    """Rotations (F, 4) of clavicles, arms and hands by joint index, with each hand on its grip of the instrument;
    parameters as in `solved_arms`."""
    rotations: dict[int, FloatArray] = {}
    for side, solved in solved_arms(player, curves, upper, swung, away).items():
        joint, _ = clavicle_of(player.skeleton, side)
        limb, pose = solved.limb, solved.pose
        rotations |= {joint: solved.shoulder.moved, limb.upper: pose.upper, limb.lower: pose.lower, limb.end: pose.end}
    for side, sign in (("left", -1.0), ("right", 1.0)):
        if all(hand.side != side for hand in player.grip.hands):
            hangs = quaternion.from_axis_angle(np.array([0.0, 0.0, 1.0]), sign * HANGS_RAD)
            rotations[player.skeleton.index(f"{side}UpperArm")] = np.tile(hangs, (len(upper.hips_m), 1))
    return rotations


def solved_arms(
    player: StillPlayer,
    curves: ContactCurves,
    upper: UpperBody,
    swung: FloatArray | None = None,
    away: Away | None = None,
) -> dict[Side, SolvedArm]:
    """Solve the arms of the hands that hold the instrument, by side.

    Parameters
    ----------
    swung : (F, 4) float64, optional
        Rotation of the elbows with swinging arms.
    away : Away, optional
        Hands that have left the instrument.
    """
    found: dict[Side, SolvedArm] = {}
    body, carried = upper.trunk, upper.carried
    with_chest = quaternion.multiply(body.chest, quaternion.conjugate(player.base.chest))
    for hand in player.grip.hands:
        target = hand_targets(hand, carried.position_m, carried.rotation, curves.controls, curves.placed)
        turned = with_chest if swung is None else quaternion.multiply(swung, with_chest)
        freely = None
        if away is not None:
            target, freely = away.targets(hand.side, *target), away.elbows.get(hand.side)
        found[hand.side] = _solve_arm(player, hand, body, turned, curves.body, target, freely)
    return found


def _solve_arm(
    player: StillPlayer,
    hand: HandHold,
    body: Trunk,
    with_chest: FloatArray,
    motion: BodyMotion,
    target: tuple[FloatArray, FloatArray],
    freely: tuple[FloatArray, FloatArray] | None = None,
) -> SolvedArm:
    side, skeleton = hand.side, player.skeleton
    limb, (target_m, target_rotation) = arm(skeleton, side), target
    sign = 1.0 if side == "left" else -1.0
    held = shoulder(skeleton, side, body, motion)
    root_m = held.joint_m
    along_rad = motion.elbow_along_rad.get(side, motion.protraction_rad[side])
    out = sign * np.tan(motion.elbows_rad + ELBOW_OUT * along_rad)
    aside, up, ahead = hand.elbow_direction
    pole = quaternion.rotate(with_chest, quaternion.columns(aside + out, up, ahead))
    line = target_m - root_m
    line /= np.sqrt(quaternion.dot(line, line))[:, None]
    if side in motion.elbow_held_rad:
        pole = quaternion.rotate(quaternion.from_axis_angle(line, sign * motion.elbow_held_rad[side]), pole)
    if freely is not None:
        share, elbow = freely
        pole = pole + share[:, None] * (quaternion.rotate(body.chest, elbow) - pole)
    if hand.motion is not None:
        target_m = exact_target(limb, root_m, target_m)
    pose = solve_limb(limb, root_m, held.clavicle, target_m, target_rotation, pole)
    _relieve(player.wrists[side], limb, pose, line, held.clavicle, target_rotation)
    if side in motion.elbow_out_rad:
        _swivel(limb, pose, line, sign * motion.elbow_out_rad[side], held.clavicle, target_rotation)
    return SolvedArm(held, limb, pose, line, target_rotation)


def _relieve(
    wrist: Wrist, limb: Limb, pose: LimbPose, line: FloatArray, clavicle: FloatArray, target_rotation: FloatArray
) -> None:
    """Turn the arm about the line from shoulder to hand, in place in ``pose``, in the frames in which the wrist is bent
    sideways too far.
    """
    aside_rad = wrist.aside_rad(pose.end)
    beyond_rad = wrist.beyond_rad(aside_rad)
    bent = np.flatnonzero(beyond_rad)
    if not len(bent):
        return
    lower, axis, target = pose.bones[1][bent], line[bent], target_rotation[bent]

    def aside_at(turn_rad: FloatArray) -> FloatArray:
        turned = quaternion.multiply(quaternion.from_axis_angle(axis, turn_rad), lower)
        return wrist.aside_rad(end_of(limb, turned, target))

    turn_rad = np.zeros(len(line))
    turn_rad[bent] = wrist.relief_rad(aside_rad[bent], beyond_rad[bent], aside_at)
    _swivel(limb, pose, line, turn_rad, clavicle, target_rotation)


def _swivel(
    limb: Limb,
    pose: LimbPose,
    line: FloatArray,
    turn_rad: FloatArray,
    clavicle: FloatArray,
    target_rotation: FloatArray,
) -> None:
    """Rotate the arms (in place) about the line from shoulder to hand by angles (F,)."""
    turning = np.flatnonzero(turn_rad)
    if not len(turning):
        return
    # All are turned where most are: selecting them would take as long.
    here = turning if 2 * len(turning) < len(turn_rad) else slice(None)
    bones = pose.bones[0][here], pose.bones[1][here]
    there = LimbPose(pose.upper[here], pose.lower[here], pose.end[here], pose.miss_m[here], bones)
    turn = quaternion.from_axis_angle(line[here], turn_rad[here])
    turned = swivelled(limb, there, turn, clavicle[here], target_rotation[here])
    rotations = (pose.upper, pose.lower, pose.end, *pose.bones)
    for own, new in zip(rotations, (turned.upper, turned.lower, turned.end, *turned.bones), strict=True):
        # Of the two quaternions of each rotation the one closer to the former value is used, so that none changes sign.
        own[here] = np.where(quaternion.dot(own[here], new)[:, None] < 0.0, -new, new)
