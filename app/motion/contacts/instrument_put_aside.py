"""Puts an instrument aside while its player uses another: its resting place, and the motion to it.

The arm that holds it rotates as a whole about its shoulder, outwards and down from the lowered position, which stays
natural for any instrument. The other hand lets go and hangs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.carried_instrument import Y_AXIS, Z_AXIS, InstrumentTransform
from app.motion.contacts.help_for_far_hands import clavicle_of
from app.motion.contacts.trunk_and_legs import Side, Trunk
from app.rig import quaternion
from app.rig.grip.grip_pose import GripPose, hand_targets
from app.rig.ik import arm
from app.rig.model import Skeleton

SWING_RAD = float(np.deg2rad(52.0))
"""Angle in radians from the lowered position to that of the first instrument put aside."""
NEXT_RAD = float(np.deg2rad(44.0))
"""Additional angle in radians for each further instrument put aside."""
FARTHEST = 2
LEAST_M = 1e-6
DOWN_RAD = float(np.deg2rad(10.0))
"""Angle in radians by which the arm is lowered; with more, the bells of two instruments would collide below the
shoulder.
"""
OUT_M, LONGEST = 0.04, 0.93
"""Distance in metres by which the arm moves outwards, clear of the body, and greatest extension as a share of the arm's
length.
"""
HANGS_RAD = 1.25
"""Downward angle in radians from the T-pose of an arm that holds nothing."""
LOOKS_RAD = {"neck": 0.16, "head": 0.2}
LOOKS_DOWN_RAD = {"neck": 0.06, "head": 0.16}
TURNS = {"spine": 0.09, "chest": 0.16, "upperChest": 0.12}
"""Rotation of the trunk's joints towards the hand, as shares of the arm's swing; neck and head look there too."""


@dataclass(frozen=True)
class Aside:
    """Options for putting an instrument aside: the hand, and the instrument's index among the musician's."""

    side: Side
    number: int

    @property
    def sign(self) -> float:
        """1 if the instrument is put aside to the left, -1 to the right."""
        return 1.0 if self.side == "left" else -1.0

    @property
    def angle_rad(self) -> float:
        """Angle in radians by which the arm swings aside, left positive."""
        return self.sign * (SWING_RAD + NEXT_RAD * min(self.number, FARTHEST))


@dataclass(frozen=True)
class AsidePlace:
    """Resting place of an instrument put aside.

    Attributes
    ----------
    pivot_m : (3,) float64
        Centre of the swing: the shoulder of the still body.
    swing_rad : (3,) float64
        The whole swing as a rotation vector.
    rest : InstrumentTransform
        Placement at rest, one frame.
    """

    aside: Aside
    pivot_m: FloatArray
    swing_rad: FloatArray
    rest: InstrumentTransform

    @classmethod
    def of(cls, aside: Aside, skeleton: Skeleton, grip: GripPose, base: Trunk, low: InstrumentTransform) -> AsidePlace:
        """Compute the resting place for a still body that holds the instrument lowered."""
        joint, reaches_m = clavicle_of(skeleton, aside.side)
        begins_m = base.chest_m + quaternion.rotate(base.chest, skeleton.offsets_m[joint])
        pivot_m = (begins_m + quaternion.rotate(base.chest, reaches_m))[0]
        turn = quaternion.from_axis_angle(Y_AXIS, aside.angle_rad)
        hand = next((hand for hand in grip.hands if hand.side == aside.side), None)
        borne_m = low.position_m if hand is None else hand_targets(hand, low.position_m, low.rotation, {})[0]
        out_m = quaternion.rotate(turn, borne_m[0] - pivot_m) * np.array([1.0, 0.0, 1.0])
        axis = np.cross(Y_AXIS, out_m / max(float(np.linalg.norm(out_m)), LEAST_M))
        whole = quaternion.multiply(quaternion.from_axis_angle(axis, DOWN_RAD), turn)
        bare = cls(aside, pivot_m, quaternion.to_rotation_vector(whole), low)
        lies = bare._swung(low, np.ones(1))
        reach_m = LONGEST * arm(skeleton, aside.side).length_m
        # If the arm cannot reach that far, the instrument is put down nearer.
        towards = out_m / max(float(np.linalg.norm(out_m)), LEAST_M)
        wrist_m = quaternion.rotate(whole, borne_m[0] - pivot_m)
        along_m, away2 = float(wrist_m @ towards), float(wrist_m @ wrist_m)
        room_m = max(reach_m**2 - away2 + along_m**2, 0.0) ** 0.5 - along_m
        further_m = min(max(room_m, 0.0), OUT_M)
        return replace(bare, rest=InstrumentTransform(lies.position_m + further_m * towards, lies.rotation))

    def turned(self, stowed: FloatArray) -> FloatArray:
        """Rotation (F, 4) of the arm and the instrument about the pivot; ``stowed`` (F,) is 0 while carried, 1 when put
        aside.
        """
        return quaternion.from_rotation_vector(stowed[:, None] * self.swing_rad)

    def put(self, carried: InstrumentTransform, stowed: FloatArray) -> InstrumentTransform:
        """Placement of the instrument during the swing; ``stowed`` (F,) is 0 while carried, 1 when put aside."""
        swung, share = self._swung(carried, stowed), stowed[:, None]
        position_m = swung.position_m + (self.rest.position_m - swung.position_m) * share
        rotation = quaternion.slerp(swung.rotation, self.rest.rotation, stowed)
        lies, stays = share >= 1.0, share <= 0.0
        return InstrumentTransform(
            np.where(lies, self.rest.position_m, np.where(stays, carried.position_m, position_m)),
            np.where(lies, self.rest.rotation, np.where(stays, carried.rotation, rotation)),
        )

    def _swung(self, carried: InstrumentTransform, stowed: FloatArray) -> InstrumentTransform:
        turn = self.turned(stowed)
        return InstrumentTransform(
            self.pivot_m + quaternion.rotate(turn, carried.position_m - self.pivot_m),
            quaternion.multiply(turn, carried.rotation),
        )

    def let_go(
        self, skeleton: Skeleton, grip: GripPose, arms: dict[int, FloatArray], stowed: FloatArray
    ) -> dict[int, FloatArray]:
        """Rotations (F, 4), by joint index, of the arm that does not hold the put-aside instrument: it comes down to
        hang as ``stowed`` (F,) goes from 0 (playing) to 1 (put aside).
        """
        result: dict[int, FloatArray] = {}
        for hand in grip.hands:
            if hand.side == self.aside.side:
                continue
            limb, sign = arm(skeleton, hand.side), 1.0 if hand.side == "right" else -1.0
            hangs = quaternion.from_axis_angle(Z_AXIS, sign * HANGS_RAD)
            along = limb.lower_vector_m / np.linalg.norm(limb.lower_vector_m)
            joint, _ = clavicle_of(skeleton, hand.side)
            for bone in (joint, limb.upper, limb.lower, limb.end):
                there = hangs if bone == limb.upper else quaternion.IDENTITY
                # Bending and twisting of an elbow are interpolated separately; the shortest rotation would bend it
                # sideways.
                parts = quaternion.swing_twist(arms[bone], along) if bone == limb.lower else (arms[bone],)
                ways = [quaternion.slerp(part, np.broadcast_to(there, part.shape), stowed) for part in parts]
                freed = ways[0] if len(ways) == 1 else quaternion.multiply(*ways)
                result[bone] = np.where(stowed[:, None] > 0.0, freed, arms[bone])
        return result

    def watched(self, motion: BodyMotion, stowed: FloatArray) -> BodyMotion:
        """Turn the head in a body's motion towards the hand that puts the instrument aside."""
        turn, forward = dict(motion.turn_rad), dict(motion.forward_rad)
        for joint, angle_rad in LOOKS_RAD.items():
            turn[joint] = turn[joint] + self.aside.sign * angle_rad * stowed
        for joint, share in TURNS.items():
            turn[joint] = turn[joint] + self.aside.angle_rad * share * stowed
        for joint, angle_rad in LOOKS_DOWN_RAD.items():
            forward[joint] = forward[joint] + angle_rad * stowed
        return replace(motion, turn_rad=turn, forward_rad=forward)
