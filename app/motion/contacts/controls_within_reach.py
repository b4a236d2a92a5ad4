"""Limits controls that a hand moves along (such as a slide) to the reach of the arm.

The hand stays on the control: if trunk, shoulders and instrument have helped as much as possible and the position is
still too far, the control stops where the hand can reach. Each frame is computed independently of others, so results do
not depend on the span or on knowledge of later notes.
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
"""Greatest extension of an arm for a carried hand, as a share of the arm's length: the elbow is 9 degrees from
straight.
"""
EASE = 0.006
"""Range of extension below `LONGEST`, as a share of the arm's length, in which the limit is approached smoothly."""
HALVINGS = 24
"""Number of bisections that find the place of a hand, exact to a ten-millionth of the travel."""


@dataclass(frozen=True)
class _Seen:
    """A hand on a control that moves with it (such as a slide), in the frames in which its arm is almost stretched or
    too short."""

    hand: HandHold
    shoulder_m: FloatArray
    carried: InstrumentTransform
    placed: Mapping[str, StationBlend]

    def distance_m(self, values: FloatArray) -> FloatArray:
        """Distance (metres) from the shoulder joint to the wrist with the control at these values."""
        assert self.hand.motion is not None
        controls = {self.hand.motion.control: values}
        wrist_m, _ = hand_targets(self.hand, self.carried.position_m, self.carried.rotation, controls, self.placed)
        away = wrist_m - self.shoulder_m
        distance_m: FloatArray = np.sqrt(quaternion.dot(away, away))
        return distance_m

    def value_at(self, distance_m: FloatArray, asked: FloatArray) -> FloatArray:
        """Return the largest value (F,) of the control, at most ``asked``, at which the wrist is no farther than
        ``distance_m``; 0 if it is always farther."""
        low, high = np.zeros(len(asked)), asked.copy()
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            near = self.distance_m(middle) <= distance_m
            low, high = np.where(near, middle, low), np.where(near, high, middle)
        return low


def controls_within_reach(player: StillPlayer, curves: ContactCurves, upper: UpperBody) -> dict[str, FloatArray]:
    """Return the control values (F,) by name, limited to the reach of the hands that move along with them, such as on a
    slide.

    Arrays are returned unchanged if the hands reach everywhere.
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
