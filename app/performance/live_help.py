"""Help of trunk and shoulders for far hands of a live player.

With known notes the body turns before a hand goes far (`app.motion.contacts.solve`). Live, it starts together with the
hand; a hand that a control moves along is slowed down until the body is there.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.help_for_far_hands import Help
from app.motion.curves.curve import minimum_jerk
from app.motion.curves.live_values import Reach

PEAK = 10.0 / math.sqrt(3.0)
"""Peak acceleration of a minimum-jerk move over 1 in 1 s."""
TURNS_RAD_S2, SHOULDER_RAD_S2, DRAWS_M_S2 = 180.0, 200.0, 12.0
"""Greatest accelerations of the trunk's rotation and of a shoulder in rad/s2, and of the drawing back of neck and head
in m/s2; the remainder for each joint is then within its range.
"""
STOPS = 4.0
"""Factor for the braking time (speed over acceleration) by which moving help is prolonged."""
LEAST_S = 0.08
"""Least duration in seconds of a change of help."""
STAYS_S = 0.30
"""Seconds in which help recedes after the hand has returned."""
CHANGES = 0.004
"""Change in radians or metres below which help counts as unchanged."""
OUT_S = 0.08
"""Seconds in which an elbow covers most of the rest of its way."""
_PHASES = np.linspace(0.0, 1.0, 65)
_SHARES = minimum_jerk(_PHASES)


class LiveHelp:
    """The help currently given to a player's hands.

    Attributes
    ----------
    carries_s : float
        Least seconds that a control with a hand must take from now on, so that the body arrives before its hand; 0: no
        limit.
    """

    def __init__(self) -> None:
        self._reaches: dict[str, Reach] = {}
        self._out_rad: dict[str, tuple[float, FloatArray]] = {}
        self.carries_s = 0.0

    def off_trunk(self, now_s: float, needed: BodyMotion) -> BodyMotion:
        """Return a body at a time, as one frame, with elbows that go out of the trunk's way, as ``needed`` has them at
        once, within about `OUT_S`."""
        given: dict[str, FloatArray] = {}
        for side, goal_rad in needed.elbow_out_rad.items():
            before_s, before_rad = self._out_rad.get(side, (-math.inf, goal_rad))
            left = math.exp(min(before_s - now_s, 0.0) / OUT_S)
            given[side] = goal_rad + left * (before_rad - goal_rad)
            self._out_rad[side] = now_s, given[side]
        return replace(needed, elbow_out_rad=given)

    def at(self, now_s: float, arrived_s: float, needed: Help) -> Help:
        """Return the help that trunk and shoulders give at a time, as one frame.

        Parameters
        ----------
        arrived_s : float
            Time at which the hands arrive.
        needed : Help
            Help needed on the way from the current place of the hands (first frame) to their goals (last frame).
        """
        self.carries_s = 0.0

        def given(name: str, values: FloatArray, most: float) -> FloatArray:
            return self._given(name, values, most, now_s, arrived_s)

        return Help(
            turn_rad=given("turn", needed.turn_rad, TURNS_RAD_S2),
            short_m=given("short", needed.short_m, DRAWS_M_S2),
            protraction_rad={
                side: given(side, values, SHOULDER_RAD_S2) for side, values in needed.protraction_rad.items()
            },
            most_turn_rad={side: values[:1] for side, values in needed.most_turn_rad.items()},
            most_protraction_rad={side: values[:1] for side, values in needed.most_protraction_rad.items()},
        )

    def _given(self, name: str, values: FloatArray, most: float, now_s: float, arrived_s: float) -> FloatArray:
        now, goal = float(values[0]), float(values[-1])
        reach = self._reaches.get(name)
        if reach is None:
            reach = self._reaches[name] = Reach.at_rest(now)
        if abs(goal - reach.target) > CHANGES or (goal == 0.0 and reach.target != 0.0):
            here = reach.at(now_s)
            length_s = max(
                math.sqrt(PEAK * abs(goal - here) / most) + STOPS * abs(reach.speed_at(now_s)) / most, LEAST_S
            )
            if abs(goal) > abs(reach.target):
                self.carries_s = max(self.carries_s, _waits_s(values, here, length_s))
            else:
                length_s = max(arrived_s - now_s, 0.0) + STAYS_S
            reach = self._reaches[name] = reach.toward(now_s, goal, length_s)
        ahead = reach.at(now_s)
        short = max(now - max(ahead, 0.0), 0.0) - max(min(ahead, 0.0) - now, 0.0)
        return np.array([ahead + short])


def _waits_s(values: FloatArray, here: float, length_s: float) -> float:
    """Least time in seconds that a hand's move must take so that the body's help keeps up with it. ``values`` are the
    help needed at equal steps of the move; the help can change from ``here`` to the last value within ``length_s``.
    """
    gone = np.linspace(0.0, 1.0, len(values))[1:]
    shares = np.clip((values[1:] - here) / (values[-1] - here), 0.0, 1.0)
    helped_s = length_s * np.interp(shares, _SHARES, _PHASES)
    return float(np.max(helped_s / np.interp(gone, _SHARES, _PHASES)))
