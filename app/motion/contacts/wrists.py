"""Keeps wrists within their range by moving the elbow where the hand would bend sideways too far.

The hand's place is given by the instrument, so the elbow rotates about the line from shoulder to wrist, as when a
player raises the bell. Each frame is computed independently.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.motion.contacts.trunk_and_legs import SIDES, Side
from app.motion.curves.soft_bounds import softly_capped, softly_over
from app.rig import quaternion
from metadata.model import Body
from metadata.skeleton_profile import SkeletonProfile

EASE_RAD = float(np.deg2rad(3.0))
"""Angle in radians before the end of a wrist's range at which the elbow begins to rotate."""
MOST_RAD = float(np.deg2rad(25.0))
"""Greatest rotation of an elbow in radians."""
LOST_RAD = float(np.deg2rad(18.0))
"""Angle in radians beyond a wrist's range from which the elbow's help decreases; at twice this angle it is zero."""
PROBE_RAD = 0.02
"""Rotation of the elbow in radians by which its effect on the wrist is measured."""
STIFF = 0.18
"""Effect on the wrist (rad per rad) below which the elbow is rotated less."""
VAIN = 0.1
"""Effect on the wrist (rad per rad) below which the elbow is hardly rotated, since near zero it would alternate between
both sides.
"""
ROUNDS = 2
LEAST_SINE = 1e-9


@dataclass(frozen=True, eq=False)
class Wrist:
    """Range of motion of one wrist.

    Attributes
    ----------
    axes : (2, 3) float64
        Axes of flexion and of sideways bending.
    twist : (3,) float64
        Axis of forearm rotation.
    low_rad, high_rad : (2,) float64
        Lowest and highest angle of flexion and of sideways bending.
    """

    axes: FloatArray
    twist: FloatArray
    low_rad: FloatArray
    high_rad: FloatArray

    def aside_rad(self, hand: FloatArray) -> FloatArray:
        """Sideways angle (F,) in radians of the hand, given its rotation (F, 4) relative to the forearm."""
        aside: FloatArray = np.ascontiguousarray(self._swing(hand)) @ self.axes[1]
        return aside

    def outside_rad(self, hand: FloatArray, *, within: bool = False) -> FloatArray:
        """Largest angle (F,) in radians by which the hand's rotation relative to the forearm (F, 4) exceeds the wrist's
        ranges; 0 within them, or, with ``within``, minus the angle that is left to the nearest limit.
        """
        bent = np.ascontiguousarray(self._swing(hand)) @ self.axes.T
        outside: FloatArray = np.maximum(bent - self.high_rad, self.low_rad - bent).max(axis=1)
        return outside if within else np.maximum(0.0, outside)

    def _swing(self, hand: FloatArray) -> FloatArray:
        """Bend of the hand without its twist, as rotation vectors (F, 3), given its rotation (F, 4) relative to the
        forearm.
        """
        taken = quaternion.rotate(hand, self.twist)
        across = quaternion.cross(self.twist, taken)
        sine = np.sqrt(quaternion.dot(across, across))
        angle = np.arctan2(sine, np.ascontiguousarray(taken) @ self.twist)
        swing: FloatArray = across * (angle / np.maximum(sine, LEAST_SINE))[:, None]
        return swing

    def beyond_rad(self, aside_rad: FloatArray) -> FloatArray:
        """Angle (F,) in radians by which the sideways bend of the wrist should be reduced; 0 well within its range, and
        where turning the elbow cannot help.
        """
        over = softly_over(aside_rad - self.high_rad[1], EASE_RAD)
        beyond = over - softly_over(self.low_rad[1] - aside_rad, EASE_RAD)
        lost = np.clip(np.abs(beyond) / LOST_RAD - 1.0, 0.0, 1.0)
        helped: FloatArray = beyond * (1.0 - lost * lost * (3.0 - 2.0 * lost))
        return helped

    def relief_rad(
        self, aside_rad: FloatArray, beyond_rad: FloatArray, at: Callable[[FloatArray], FloatArray]
    ) -> FloatArray:
        """Angle (F,) in radians by which the elbow turns about the line from shoulder to wrist to bring the sideways
        angle back into range.

        Parameters
        ----------
        aside_rad, beyond_rad : (F,) float64
            Sideways angle with the elbow in its usual place, and its excess.
        at : callable
            Function that returns the sideways angle of the wrist for each rotation of the elbow.
        """
        slope = (at(np.full(len(aside_rad), PROBE_RAD)) - aside_rad) / PROBE_RAD
        gain = slope**3 / ((slope * slope + STIFF * STIFF) * (slope * slope + VAIN * VAIN))
        turn, now = np.zeros(len(aside_rad)), aside_rad
        for number in range(ROUNDS):
            if number:
                now = at(turn)
            turn = _capped(turn + gain * (aside_rad - beyond_rad - now))
        return turn


def _capped(turn_rad: FloatArray) -> FloatArray:
    capped: FloatArray = np.sign(turn_rad) * softly_capped(np.abs(turn_rad), MOST_RAD, 0.25 * MOST_RAD)
    return capped


def wrists_of(body: Body, profile: SkeletonProfile) -> dict[Side, Wrist]:
    """Return axes and limits of the left and the right wrist of a body, limits in radians."""
    found: dict[Side, Wrist] = {}
    for side in SIDES:
        axes, joint = profile.joint_axes(f"{side}Hand"), profile.joint(f"{side}Hand")
        limits = body.limits[joint.kind]
        low_rad, high_rad = np.deg2rad([limits.flexion_deg, limits.sideways_deg]).T
        found[side] = Wrist(np.array([axes.flexion, axes.sideways]), np.array(axes.twist), low_rad, high_rad)
    return found


@dataclass(frozen=True)
class BellRoom:
    """Range of tilt of an instrument relative to the chest within which both wrists stay in range; down positive."""

    low_rad: float = -np.inf
    high_rad: float = np.inf

    @classmethod
    def within(cls, down_rad: FloatArray, fits: BoolArray) -> BellRoom:
        """Find the range of tilt around the playing position, which is the middle of T ascending angles (T,); ``fits``
        (T,) marks the angles that both wrists can follow.
        """
        usual, misses = len(down_rad) // 2, np.flatnonzero(~fits)
        low, high = misses[misses < usual], misses[misses > usual]
        return cls(
            low_rad=float(down_rad[low[-1] + 1]) if len(low) else -np.inf,
            high_rad=float(down_rad[high[0] - 1]) if len(high) else np.inf,
        )

    def back_rad(self, down_rad: FloatArray) -> FloatArray:
        """Correction (F,) in radians that brings tilt angles (F,) into the range; 0 well within it."""
        back: FloatArray = softly_over(self.low_rad - down_rad, ROOM_EASE_RAD)
        return back - softly_over(down_rad - self.high_rad, ROOM_EASE_RAD)


ROOM_EASE_RAD = float(np.deg2rad(2.0))
"""Angle in radians over which the limits of the elbow's room are approached smoothly."""

ANYWHERE = BellRoom()
