"""Limits of controls that carry a hand: they stop where the arm ends.

A hand never leaves what it carries: where trunk, shoulders and instrument have helped as far as they do and the place
is still too far, the control stays as far out as the hand comes. Frame by frame, from nothing but the frame itself: so
it does not matter which frames are made together, nor whether the notes are known beforehand.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.arms import shoulder
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.still_player import ContactCurves, StillPlayer
from app.motion.contacts.upper_body import UpperBody
from app.motion.curves.soft_bounds import softly_capped
from app.rig import quaternion
from app.rig.grip.grip_pose import HandHold, StationBlend, hand_targets
from app.rig.ik import arm

LONGEST = 0.997
"""Share of its length an arm is stretched at most for a hand that is carried: the elbow is 9 degrees from straight."""
EASE = 0.006
"""The arm comes to that softly, within this share of its length before it: up to there it goes as requested."""
HALVINGS = 24
"""Times the span is halved in which the place is sought: to a ten-millionth of the travel."""


@dataclass(frozen=True)
class _Seen:
    """One carried hand at the frames where its arm is nearly stretched or too short."""

    hand: HandHold
    shoulder_m: FloatArray
    carried: InstrumentTransform
    placed: Mapping[str, StationBlend]

    def distance_m(self, values: FloatArray) -> FloatArray:
        """Distance from the shoulder joint to the wrist with the control at these values."""
        assert self.hand.motion is not None
        controls = {self.hand.motion.control: values}
        wrist_m, _ = hand_targets(self.hand, self.carried.position_m, self.carried.rotation, controls, self.placed)
        away = wrist_m - self.shoulder_m
        distance_m: FloatArray = np.sqrt(quaternion.dot(away, away))
        return distance_m

    def value_at(self, distance_m: FloatArray, asked: FloatArray) -> FloatArray:
        """The value nearest below ``asked`` at which the wrist is so far away; 0 where it is nowhere so near."""
        low, high = np.zeros(len(asked)), asked.copy()
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            near = self.distance_m(middle) <= distance_m
            low, high = np.where(near, middle, low), np.where(near, high, middle)
        return low


def controls_within_reach(player: StillPlayer, curves: ContactCurves, upper: UpperBody) -> dict[str, FloatArray]:
    """The controls, those that carry a hand no farther out than it comes.

    Where a hand comes everywhere they are the very arrays given.
    """
    skeleton, carried, placed, result = player.skeleton, upper.carried, curves.placed, dict(curves.controls)
    for hand in player.grip.hands:
        if hand.motion is None or hand.motion.control not in result:
            continue
        asked = np.clip(np.asarray(result[hand.motion.control], dtype=np.float64), 0.0, 1.0)
        shoulder_m = shoulder(skeleton, hand.side, upper.trunk, curves.body).joint_m
        distance_m = _Seen(hand, shoulder_m, carried, placed).distance_m(asked)
        length_m = arm(skeleton, hand.side).length_m
        far = np.flatnonzero(distance_m > (LONGEST - EASE) * length_m)
        if not len(far):
            continue
        there = _Seen(
            hand,
            shoulder_m[far],
            InstrumentTransform(carried.position_m[far], carried.rotation[far]),
            {finger: StationBlend(*(values[far] for values in where)) for finger, where in placed.items()},
        )
        values = result[hand.motion.control].copy()
        values[far] = there.value_at(softly_capped(distance_m[far], LONGEST * length_m, EASE * length_m), asked[far])
        result[hand.motion.control] = values
    return result
