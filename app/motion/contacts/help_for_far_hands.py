"""Help of the body for far hands: shoulders move forward, the trunk turns, and finally head and instrument give way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.hands_away import Away
from app.motion.contacts.trunk_and_legs import Side, Trunk
from app.motion.curves.soft_bounds import softly_capped, softly_over
from app.rig import quaternion
from app.rig.grip.grip_pose import GripPose, StationBlend, hand_targets
from app.rig.ik import arm
from app.rig.model import Skeleton

Z_AXIS = np.array([0.0, 0.0, 1.0])

AT_EASE = 0.985
"""Share of an arm's length up to which it reaches without help from the shoulder."""
STRETCHED = 0.985
"""Length of a stretched arm, as for the farthest places, as a share of the whole arm."""
NEAREST = 0.33
"""Least distance of a hand from its shoulder, as a share of the arm's length (an elbow bent by 141 degrees)."""
EASE_M = 0.008
LEAST_M = 1e-6
"""Distance in metres over which the shoulder's help sets in."""
CLAVICLE_RAD = float(np.deg2rad(28.0))
"""Greatest rotation in radians of the shoulder towards a far hand."""
TURN_RAD = float(np.deg2rad(50.0))
"""Greatest rotation in radians of hips and trunk towards a far hand."""
FOLLOWS_RAD, TURNS_ALONG_RAD = float(np.deg2rad(4.5)), float(np.deg2rad(2.5))
"""Rotations in radians of clavicle and trunk that follow a hand moving with its control, before its arm is
stretched.
"""


@dataclass(frozen=True)
class Help:
    """Contribution of trunk and shoulders needed so that both hands reach.

    Attributes
    ----------
    turn_rad : (F,) float64
        Turn of the trunk, left positive.
    short_m : (F,) float64
        Distance still missing for the hand after that.
    protraction_rad : dict of side to (F,) float64
        Forward rotation of each clavicle.
    most_turn_rad, most_protraction_rad : dict of side to (F,) float64
        Limits that keep each hand at least `NEAREST` of its arm's length away, so that smoothed help does not push a
        shoulder into a near hand.
    """

    turn_rad: FloatArray
    short_m: FloatArray
    protraction_rad: dict[str, FloatArray]
    most_turn_rad: dict[str, FloatArray]
    most_protraction_rad: dict[str, FloatArray]

    @property
    def moves_trunk(self) -> bool:
        """True if help by the shoulders is not enough, so that the trunk turns too."""
        return bool(np.any(self.turn_rad) or np.any(self.short_m))


def needed_help(
    skeleton: Skeleton,
    grip: GripPose,
    body: Trunk,
    carried: InstrumentTransform,
    controls: Mapping[str, FloatArray],
    placed: Mapping[str, StationBlend],
    away: Away | None = None,
) -> Help:
    """Help of shoulders and trunk that the hands need to reach their grips; ``body`` is the trunk without help. Exactly
    0 where the arms alone reach and the hands stay.

    First the shoulders help, then the trunk turns; the remaining distance is returned. Both follow slightly when a hand
    moves out and back.
    """
    turn, short_m = np.zeros(len(body.chest_m)), np.zeros(len(body.chest_m))
    protraction: dict[str, FloatArray] = {}
    most_turn: dict[str, FloatArray] = {}
    most_protraction: dict[str, FloatArray] = {}
    for hand in grip.hands:
        target_m, rotation = hand_targets(hand, carried.position_m, carried.rotation, controls, placed)
        if away is not None:
            target_m, _ = away.targets(hand.side, target_m, rotation)
        girdle = _girdle(skeleton, hand.side, body, target_m)
        arm_m = arm(skeleton, hand.side).length_m
        distance_m = girdle.distance_m(0.0)
        asked = girdle.turn_for(distance_m - softly_over(distance_m - AT_EASE * arm_m, EASE_M))
        out = np.zeros(len(turn))
        if hand.motion is not None and hand.motion.control in controls:
            out = np.asarray(controls[hand.motion.control], dtype=np.float64)
        asked = asked + FOLLOWS_RAD * out
        protraction[hand.side] = softly_capped(asked, CLAVICLE_RAD, 0.15 * CLAVICLE_RAD)
        most_protraction[hand.side] = girdle.turn_for(np.full(len(turn), NEAREST * arm_m))
        waist = _waist(skeleton, hand.side, body, target_m)
        most_turn[hand.side] = waist.turn_for(np.full(len(turn), NEAREST * arm_m))
        distance_m = waist.distance_m(np.zeros(len(turn)))
        asked = waist.turn_for(distance_m - softly_over(distance_m - AT_EASE * arm_m, EASE_M))
        asked = asked + TURNS_ALONG_RAD * out
        given = softly_capped(asked, TURN_RAD, 0.1 * TURN_RAD)
        turn += given if hand.side == "right" else -given
        short_m = np.maximum(short_m, softly_over(waist.distance_m(given) - STRETCHED * arm_m, EASE_M))
    return Help(turn, short_m, protraction, most_turn, most_protraction)


def shoulder_distance_m(skeleton: Skeleton, side: Side, body: Trunk, target_m: FloatArray) -> float:
    """Distance in metres, in the first frame, from a shoulder that is moved forward as far as possible to the target of
    its hand.
    """
    return float(_girdle(skeleton, side, body, target_m).distance_m(CLAVICLE_RAD)[0])


@dataclass(frozen=True)
class _Swing:
    """A shoulder joint that rotates about a fixed axis, and the target of its hand.

    The squared distance from the shoulder joint to the target is ``square_m2 - 2 reach_m2 cos(phase_rad - turn)``.
    """

    square_m2: FloatArray
    reach_m2: FloatArray
    phase_rad: FloatArray

    def distance_m(self, turned_rad: FloatArray | float) -> FloatArray:
        """Return the distance (F,) in metres from the shoulder to the target after a rotation in radians."""
        cosine = np.cos(np.maximum(self.phase_rad - turned_rad, 0.0))
        distance: FloatArray = np.sqrt(np.maximum(self.square_m2 - 2.0 * self.reach_m2 * cosine, 1e-9))
        return distance

    def turn_for(self, distance_m: FloatArray) -> FloatArray:
        """Return the angle (F,) in radians that brings the shoulder to a distance (metres) from the target, or as near
        to it as possible."""
        cosine = np.clip(
            (self.square_m2 - distance_m * distance_m) / np.maximum(2.0 * self.reach_m2, LEAST_M**2), -1.0, 1.0
        )
        return np.maximum(self.phase_rad - np.arccos(cosine), 0.0)


def _girdle(skeleton: Skeleton, side: Side, body: Trunk, target_m: FloatArray) -> _Swing:
    """Describe how turning the clavicle forward changes the distance from the shoulder to the target of its hand, as a
    rotation about an axis in the chest's frame.
    """
    shoulder, clavicle = clavicle_of(skeleton, side)
    joint_m = body.chest_m + quaternion.rotate(body.chest, skeleton.offsets_m[shoulder])
    there = np.ascontiguousarray(quaternion.rotate(quaternion.conjugate(body.chest), target_m - joint_m))
    ahead = quaternion.cross(forwards_axis(skeleton, side), clavicle)
    phase = np.arctan2(there @ ahead, there @ clavicle)
    square_m2 = quaternion.dot(there, there) + clavicle @ clavicle
    return _Swing(square_m2, np.hypot(there @ ahead, there @ clavicle), phase)


def _waist(skeleton: Skeleton, side: Side, body: Trunk, target_m: FloatArray) -> _Swing:
    """Effect of a rotation of the chest about the vertical axis on the distance from a shoulder, brought fully forward,
    to the target of its hand.
    """
    shoulder, clavicle = clavicle_of(skeleton, side)
    forwards = quaternion.from_axis_angle(forwards_axis(skeleton, side), CLAVICLE_RAD)
    root_m = skeleton.offsets_m[shoulder] + quaternion.rotate(forwards, clavicle)
    root = quaternion.rotate(body.chest, root_m)
    there = target_m - body.chest_m
    # Turning to the left moves the right shoulder forward; for a left hand the sign is reversed.
    sign = 1.0 if side == "right" else -1.0
    across = sign * (root[:, 2] * there[:, 0] - root[:, 0] * there[:, 2])
    along = root[:, 0] * there[:, 0] + root[:, 2] * there[:, 2]
    rise_m = there[:, 1] - root[:, 1]
    flat = root[:, 0] ** 2 + root[:, 2] ** 2 + there[:, 0] ** 2 + there[:, 2] ** 2
    return _Swing(flat + rise_m * rise_m, np.hypot(along, across), np.arctan2(across, along))


@lru_cache(maxsize=64)
def clavicle_of(skeleton: Skeleton, side: Side) -> tuple[int, FloatArray]:
    """Return the joint index of a clavicle, and the position (3,) of the shoulder joint in its frame, in metres."""
    return skeleton.index(f"{side}Shoulder"), skeleton.offsets_m[skeleton.index(f"{side}UpperArm")]


@lru_cache(maxsize=64)
def forwards_axis(skeleton: Skeleton, side: Side) -> FloatArray:
    """Return the unit axis (3,), in the chest's frame, about which a positive turn brings the shoulder forward."""
    _, clavicle = clavicle_of(skeleton, side)
    axis = np.cross(clavicle, Z_AXIS)
    length = float(np.linalg.norm(axis))
    if length < LEAST_M:
        # A clavicle of zero length rotates like others and does not move the shoulder.
        return np.array([0.0, -1.0 if side == "left" else 1.0, 0.0])
    unit: FloatArray = axis / length
    return unit
