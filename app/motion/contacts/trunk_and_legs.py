"""Feet, hips, and the chain from hips to head, as base of the contact solvers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.motion.body_motion import BodyMotion
from app.rig import quaternion
from app.rig.grip.body_size import leg_size
from app.rig.ik import SOFT_SHARE, Limb, LimbPose, leg, solve_limb
from app.rig.model import Skeleton
from app.rig.skeleton import rest_positions
from metadata.model import JointLimits, Posture

Side = Literal["left", "right"]
SIDES: tuple[Side, Side] = ("left", "right")

LEGS_BLEND_M = 0.003
"""Difference in metres of the legs' reaches over which the limit changes smoothly from one leg to the other; the
shorter one limits the hips.
"""
STRAIGHTEST = 0.9995
"""Greatest extension of a leg or arm, as a share of its length."""
BALL = (-0.9, 1.5)
"""Position of the ball of the foot without a toes' joint: above and in front of the ankle, relative to the ankle's
height.
"""
HEEL = (-1.0, -0.45)
"""Position of the heel, likewise."""
SIT_BONES_M = 0.09
"""Distance in metres from the hips down to the axis about which a seated player leans the pelvis."""
ANKLE_SOFT_RAD = float(np.deg2rad(1.0))
"""Angle in radians over which a tap's toes approach the limit of the ankle."""
ANKLE_EASE_M = 0.007
"""Distance in metres over which dancing hips approach the height that the ankles allow."""
X_AXIS = np.array([1.0, 0.0, 0.0])
FOOT_PARTS = ("heel", "toes", "ahead", "up", "aside", "push")


@dataclass(frozen=True)
class Stance:
    """Standing or seated position of feet and hips, in the root's frame.

    Attributes
    ----------
    hips_m : (3,) float64
        Position of the hips before motion.
    knee_rad : float
        Bend of the knees before motion.
    ankles_m, feet : dict of side to (3,) and (4,) float64
        Position of ankles and rotation of feet, constant.
    seated : bool
        Whether the hips stay on the seat.
    balls_m, heels_m : dict of side to (3,) float64
        Toe joint and heel relative to the ankle in the foot's frame, about which a foot rolls.
    toes : dict of side to int
        Toe joints, if any.
    ankle : JointLimits
        Range of the ankles.
    """

    hips_m: FloatArray
    knee_rad: float
    ankles_m: dict[Side, FloatArray]
    feet: dict[Side, FloatArray]
    legs: dict[Side, Limb]
    seated: bool
    balls_m: dict[Side, FloatArray]
    heels_m: dict[Side, FloatArray]
    toes: dict[Side, int]
    ankle: JointLimits


def stance(skeleton: Skeleton, posture: Posture, ankle: JointLimits) -> Stance:
    """Place feet and hips for a posture: soles at rest height, hips over (or behind) the feet; ankles have the range
    ``ankle``.
    """
    legs = {side: leg(skeleton, side) for side in SIDES}
    rest = rest_positions(skeleton)
    thigh, shank = (float(np.linalg.norm(v)) for v in (legs["left"].upper_vector_m, legs["left"].lower_vector_m))
    hip_flexion, knee = np.deg2rad(posture.hip_flexion_deg), float(np.deg2rad(posture.knee_bend_deg))
    ahead_m = thigh * np.sin(hip_flexion) + shank * np.sin(hip_flexion - knee)
    above_m = thigh * np.cos(hip_flexion) + shank * np.cos(hip_flexion - knee)
    hips = skeleton.index("hips")
    ankles_m: dict[Side, FloatArray] = {}
    feet: dict[Side, FloatArray] = {}
    balls_m: dict[Side, FloatArray] = {}
    heels_m: dict[Side, FloatArray] = {}
    toes: dict[Side, int] = {}
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        hip_joint = rest[legs[side].upper]
        ankle_m = rest[legs[side].end].copy()
        ankle_m[0] = hip_joint[0] * posture.feet_apart_hip_widths
        ankle_m[2] = hip_joint[2] + ahead_m + sign * 0.5 * posture.foot_forward_m
        ankles_m[side] = ankle_m
        feet[side] = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), sign * np.deg2rad(posture.toes_out_deg))
        high_m = max(float(ankle_m[1]), 0.0)
        balls_m[side], heels_m[side] = (high_m * np.array([0.0, *part]) for part in (BALL, HEEL))
        if f"{side}Toes" in skeleton.names:
            toes[side] = skeleton.index(f"{side}Toes")
            balls_m[side] = skeleton.offsets_m[toes[side]]
    hips_m = rest[hips].copy()
    hips_m[1] = rest[legs["left"].end][1] + above_m - (rest[legs["left"].upper] - rest[hips])[1]
    seated = posture.seat_height_shank > 0.0
    return Stance(hips_m, knee, ankles_m, feet, legs, seated, balls_m, heels_m, toes, ankle)


@dataclass(frozen=True)
class Footing:
    """Pose of one foot over F frames: position of the ankle (F, 3) in metres, rotation of the foot (F, 4), and rotation
    of the toes (F, 4), None if they do not bend.
    """

    ankle_m: FloatArray
    foot: FloatArray
    toes: FloatArray | None


def footing(place: Stance, side: Side, moved: Mapping[str, FloatArray], frames: int) -> Footing:
    """Return ankle and rotation of a foot that stands, or moves as in ``moved`` (see
    `app.motion.gestures.feet.feet_moved`).

    A raised heel rotates about the toes, raised toes about the heel; a step moves the whole foot.
    """
    parts = _moved_parts(side, moved)
    ankle_m, foot = (quaternion.repeated(still, frames) for still in (place.ankles_m[side], place.feet[side]))
    toes = None
    if "heel" in parts and side in place.toes:
        toes = quaternion.repeated(quaternion.from_axis_angle(X_AXIS, -0.0), frames)
    here = _where_moved(parts)
    if len(here):
        parts = {name: values[here] for name, values in parts.items()}
        ankle_m[here], turned = _lifted(place, side, parts)
        if toes is not None:
            toes[here] = quaternion.from_axis_angle(X_AXIS, -parts["heel"])
        if "push" in parts:
            turned = quaternion.multiply(turned, quaternion.from_axis_angle(X_AXIS, parts["push"]))
        foot[here] = turned
    return Footing(ankle_m, foot, toes)


def _ankle_m(place: Stance, side: Side, moved: Mapping[str, FloatArray], frames: int) -> FloatArray:
    """Return the ankle position (F, 3) in metres of a standing foot, moved by those parts of ``moved`` (F,) that
    concern this side."""
    parts = _moved_parts(side, moved)
    ankle_m, here = quaternion.repeated(place.ankles_m[side], frames), _where_moved(parts)
    if len(here):
        ankle_m[here], _ = _lifted(place, side, {name: values[here] for name, values in parts.items()})
    return ankle_m


def _moved_parts(side: Side, moved: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    return {name: moved[f"{side}_{name}"] for name in FOOT_PARTS if f"{side}_{name}" in moved}


def _where_moved(parts: Mapping[str, FloatArray]) -> IndexArray:
    """Indices (K,) of the frames in which any of a foot's motions is not zero; in other frames the foot stands exactly
    still.
    """
    if not parts:
        return np.zeros(0, np.intp)
    return np.flatnonzero(np.logical_or.reduce([values != 0.0 for values in parts.values()]))


def _lifted(place: Stance, side: Side, parts: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return ankle position (F, 3) and foot rotation (F, 4) while a foot moves: roll over heel and ball, then the lift.
    ``parts`` are the values of `FOOT_PARTS` by name."""
    ankle_m, foot = place.ankles_m[side], place.feet[side]
    heel, toes, ahead_m, up_m, aside_m, _ = (parts.get(name) for name in FOOT_PARTS)
    for angle, pivot_m in ((heel, place.balls_m[side]), (None if toes is None else -toes, place.heels_m[side])):
        if angle is not None:
            turned = quaternion.multiply(foot, quaternion.from_axis_angle(X_AXIS, angle))
            # Only the difference is added, so that a standing foot keeps its exact position.
            ankle_m = ankle_m + (quaternion.rotate(foot, pivot_m) - quaternion.rotate(turned, pivot_m))
            foot = turned
    if ahead_m is not None:
        ahead = quaternion.rotate(place.feet[side], np.array([0.0, 0.0, 1.0]))
        ankle_m = ankle_m + np.multiply.outer(ahead, ahead_m).T
    if up_m is not None:
        ankle_m = ankle_m + np.multiply.outer(np.array([0.0, 1.0, 0.0]), up_m).T
    if aside_m is not None:
        ankle_m = ankle_m + np.multiply.outer(X_AXIS, aside_m).T
    return ankle_m, foot


def hips_path(place: Stance, skeleton: Skeleton, motion: BodyMotion) -> tuple[FloatArray, FloatArray]:
    """Position (F, 3) and rotation (F, 4) of the hips in the root's frame.

    Standing, the hips sink with bent knees and sideways weight, so that neither leg is too short. Seated, the pelvis
    leans on the seat.
    """
    if place.seated:
        turn = quaternion.columns(motion.hips_forward_rad, 0.0, -motion.hips_roll_rad)
        above_m = np.array([0.0, SIT_BONES_M * leg_size(skeleton), 0.0])
        rotation = quaternion.from_rotation_vector(turn)
        return place.hips_m + quaternion.rotate(rotation, above_m) - above_m, rotation
    danced, forward_rad, ease_m = motion.hips_danced, motion.hips_forward_rad, np.array(LEGS_BLEND_M)
    side_m, ahead_m = place.hips_m[0] + motion.hips_side_m, place.hips_m[2] + motion.hips_ahead_m
    if danced:
        forward_rad, ahead_m = forward_rad + danced["forward_rad"], ahead_m + danced["ahead_m"]
        ease_m = ease_m + danced["ease_m"]
    rotation = quaternion.from_rotation_vector(
        quaternion.columns(forward_rad, motion.hips_turn_rad, -motion.hips_roll_rad)
    )
    heights, bounds_m = [], []
    for side in SIDES:
        limb = place.legs[side]
        a, b = np.linalg.norm(limb.upper_vector_m), np.linalg.norm(limb.lower_vector_m)
        joint_m = quaternion.rotate(rotation, skeleton.offsets_m[limb.upper])
        ankle_m = _ankle_m(place, side, motion.feet, len(rotation))
        across_m, along_m = side_m + joint_m[:, 0] - ankle_m[:, 0], ahead_m + joint_m[:, 2] - ankle_m[:, 2]
        length2 = a * a + b * b + 2.0 * a * b * np.cos(place.knee_rad + motion.knee_rad)
        length2 = np.minimum(length2, np.square(STRAIGHTEST * (a + b)))
        rise_m = np.sqrt(np.maximum(length2 - (across_m * across_m + along_m * along_m), 0.01))
        heights.append(ankle_m[:, 1] + rise_m - joint_m[:, 1])
        if danced:
            off_m = np.stack([across_m, along_m], axis=1)
            bounds_m.append(ankle_m[:, 1] + _least_rise_m(place, side, off_m, motion.feet) - joint_m[:, 1])
    lower = np.minimum(heights[0], heights[1])
    apart = np.abs(heights[0] - heights[1])
    most_m = lower - ease_m * np.log1p(np.exp(-apart / ease_m))
    height_m = most_m - motion.hips_bob_m
    if bounds_m:
        for bound_m in bounds_m:
            height_m = height_m + ANKLE_EASE_M * np.logaddexp(0.0, (bound_m - height_m) / ANKLE_EASE_M)
        height_m = most_m - ANKLE_EASE_M * np.logaddexp(0.0, (most_m - height_m) / ANKLE_EASE_M)
    return quaternion.columns(side_m, height_m, ahead_m), rotation


def _least_rise_m(place: Stance, side: Side, off_m: FloatArray, moved: Mapping[str, FloatArray]) -> FloatArray:
    """Return the least height (F,) in metres of a hip joint above its ankle at which the ankle bends no farther than it
    can; ``off_m`` (F, 2) is the joint's distance to the left and ahead. A raised heel lets the shank lean farther
    forward, raised toes less far.
    """
    limb = place.legs[side]
    thigh_m, shank_m = (float(np.linalg.norm(one)) for one in (limb.upper_vector_m, limb.lower_vector_m))
    rest_rad = float(np.arctan2(-limb.lower_vector_m[2], -limb.lower_vector_m[1]))
    raised_rad = moved.get(f"{side}_heel", 0.0) - moved.get(f"{side}_toes", np.zeros(len(off_m)))
    lean_rad = np.deg2rad(place.ankle.flexion_deg[1]) - 2.0 * ANKLE_SOFT_RAD + rest_rad + raised_rad
    out, _, ahead = quaternion.rotate(place.feet[side], np.array([0.0, 0.0, 1.0]))
    along_m, across_m = off_m @ (out, ahead), off_m @ (ahead, -out)
    beyond_m = along_m - shank_m * np.sin(lean_rad)
    thigh_m2 = np.maximum(thigh_m * thigh_m - across_m * across_m - beyond_m * beyond_m, 0.0)
    return np.asarray(shank_m * np.cos(lean_rad) + np.sqrt(thigh_m2))


def exact_target(limb: Limb, root_m: FloatArray, target_m: FloatArray) -> FloatArray:
    """Shift a target (F, 3) so that `solve_limb`, which approaches full extension softly, makes the limb end exactly at
    ``target_m``.

    Exact up to `STRAIGHTEST` of the limb's length, approximate beyond.
    """
    line = target_m - root_m
    distance = np.sqrt(quaternion.dot(line, line))
    longest = limb.length_m
    band = SOFT_SHARE * longest
    left = np.maximum(longest - distance, (1.0 - STRAIGHTEST) * longest)
    asked = np.where(left < band, longest - band - band * np.log(np.minimum(left / band, 1.0)), distance)
    exact: FloatArray = root_m + line * (asked / distance)[:, None]
    return exact


def solve_legs(
    place: Stance,
    skeleton: Skeleton,
    hips_m: FloatArray,
    hips_rotation: FloatArray,
    feet: Mapping[str, FloatArray],
) -> dict[int, FloatArray]:
    """Solve both legs: rotations (F, 4) by joint index, for feet that stand or move as given in ``feet``; raised toes
    stay within the range of the ankle.
    """
    rotations: dict[int, FloatArray] = {}
    for side in SIDES:
        limb = place.legs[side]
        root_m = hips_m + quaternion.rotate(hips_rotation, skeleton.offsets_m[limb.upper])
        pose, there = _solve_leg(place, side, root_m, hips_rotation, feet)
        if np.any(feet.get(f"{side}_toes", 0.0)):
            lower = {**feet, f"{side}_toes": _within_ankle(place, pose, feet[f"{side}_toes"])}
            pose, there = _solve_leg(place, side, root_m, hips_rotation, lower)
        rotations |= {limb.upper: pose.upper, limb.lower: pose.lower, limb.end: pose.end}
        if there.toes is not None:
            rotations[place.toes[side]] = there.toes
    return rotations


def _solve_leg(
    place: Stance, side: Side, root_m: FloatArray, hips_rotation: FloatArray, feet: Mapping[str, FloatArray]
) -> tuple[LimbPose, Footing]:
    limb, there = place.legs[side], footing(place, side, feet, len(root_m))
    pole = quaternion.rotate(place.feet[side], np.array([0.0, 0.0, 1.0]))
    target_m = exact_target(limb, root_m, there.ankle_m)
    return solve_limb(limb, root_m, hips_rotation, target_m, there.foot, pole), there


def _within_ankle(place: Stance, pose: LimbPose, toes_rad: FloatArray) -> FloatArray:
    """Return the lift (F,) of toes in radians, lower where the ankle of ``pose`` is bent too far; its leg leans forward
    already under a bent knee.
    """
    bent_rad = -2.0 * np.arctan2(pose.end[:, 0], pose.end[:, 3])
    over = (bent_rad - np.deg2rad(place.ankle.flexion_deg[1])) / ANKLE_SOFT_RAD
    lower: FloatArray = np.maximum(toes_rad - ANKLE_SOFT_RAD * np.logaddexp(0.0, over), 0.0)
    return lower


@dataclass(frozen=True)
class Trunk:
    """Pose of the chain from hips to head.

    Attributes
    ----------
    local : dict of int to (F, 4)
        ``parent_from_joint`` of every joint in the chain except the hips.
    chest, chest_m, head, head_m : arrays
        World rotation (F, 4) and position (F, 3) of the joint that holds the shoulders, and of the head.
    """

    local: dict[int, FloatArray]
    chest: FloatArray
    chest_m: FloatArray
    head: FloatArray
    head_m: FloatArray


def trunk(skeleton: Skeleton, hips_m: FloatArray, hips_rotation: FloatArray, motion: BodyMotion) -> Trunk:
    """Compute the pose of the joints from hips to head, given the trunk's angles in ``motion``."""
    chest_joint = skeleton.parents[skeleton.index("leftShoulder")]
    hips, head = skeleton.index("hips"), skeleton.index("head")
    chain = [head]
    while skeleton.parents[chain[-1]] != hips:
        chain.append(skeleton.parents[chain[-1]])
    rotation, position = hips_rotation, hips_m
    chest, chest_m = rotation, position
    local: dict[int, FloatArray] = {}
    for joint in reversed(chain):
        name = skeleton.names[joint]
        position = position + quaternion.rotate(rotation, skeleton.offsets_m[joint])
        if name in motion.forward_rad:
            vector = quaternion.columns(motion.forward_rad[name], motion.turn_rad[name], -motion.left_rad[name])
            local[joint] = quaternion.from_rotation_vector(vector)
            rotation = quaternion.multiply(rotation, local[joint])
        if joint == chest_joint:
            chest, chest_m = rotation, position
    return Trunk(local, chest, chest_m, rotation, position)


def torso_forward(skeleton: Skeleton, hips_m: FloatArray, hips_rotation: FloatArray, motion: BodyMotion) -> FloatArray:
    """Forward lean (F,) in radians of the line from the hips to the top of the chest."""
    upright_m = neck_m(skeleton, trunk(skeleton, hips_m, hips_rotation, motion)) - hips_m
    forward_rad: FloatArray = np.arctan2(upright_m[:, 2], upright_m[:, 1])
    return forward_rad


def neck_m(skeleton: Skeleton, upper: Trunk) -> FloatArray:
    """Return the position (F, 3) of the base of the neck in metres; that of the head if the skeleton has no neck."""
    head = skeleton.index("head")
    neck = skeleton.parents[head]
    top = head if neck == skeleton.parents[skeleton.index("leftShoulder")] else neck
    found_m: FloatArray = upper.chest_m + quaternion.rotate(upper.chest, skeleton.offsets_m[top])
    return found_m
