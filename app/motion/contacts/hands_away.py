"""Placement of hands that have left the instrument (`app.motion.contacts.hand_destinations`), as input for arm
solvers.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.grip_pose import Side


class Shift(NamedTuple):
    """Displacement of a wrist from its grip: a world rotation (F, 4) about a point (3,) in the hand's frame."""

    turned: FloatArray
    about_m: FloatArray

    def target(self, position_m: FloatArray, rotation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Position and rotation of the displaced wrist, from ``position_m`` (F, 3) and ``rotation`` (F, 4) on its
        grip.
        """
        about_m = quaternion.rotate(rotation, self.about_m)
        there_m = position_m + about_m - quaternion.rotate(self.turned, about_m)
        return there_m, quaternion.multiply(self.turned, rotation)


@dataclass(frozen=True)
class Away:
    """Hands away from the instrument at some frames.

    Attributes
    ----------
    places : dict of side to list of (share (F,), position (F, 3), rotation (F, 4))
        Weight, position and rotation of wrists in world space.
    offsets_m : dict of side to (F, 3)
        Offset added to the position of wrists, in metres.
    elbows : dict of side to (share (F,), direction (3,))
        Direction of elbows in the chest's frame, with its weight.
    shifts : dict of side to Shift
        Displacements of hands that close a bell.
    """

    places: dict[Side, list[tuple[FloatArray, FloatArray, FloatArray]]]
    offsets_m: dict[Side, FloatArray]
    elbows: dict[Side, tuple[FloatArray, FloatArray]]
    shifts: dict[Side, Shift] = field(default_factory=dict)

    def targets(self, side: Side, position_m: FloatArray, rotation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return position and rotation of a wrist whose grip would be at ``position_m`` (F, 3) and ``rotation`` (F, 4);
        unchanged arrays if it has not left the grip.
        """
        if side in self.shifts:
            position_m, rotation = self.shifts[side].target(position_m, rotation)
        if side not in self.offsets_m:
            return position_m, rotation
        moved_m, turned = position_m, rotation
        for share, there_m, there in self.places[side]:
            moved_m = moved_m + share[:, None] * (there_m - position_m)
            turned = quaternion.slerp(turned, there, share)
        left = np.zeros(len(position_m), dtype=bool)
        for share, _, _ in self.places[side]:
            left |= share > 0.0
        moved_m = moved_m + self.offsets_m[side]
        left |= np.any(self.offsets_m[side] != 0.0, axis=1)
        return np.where(left[:, None], moved_m, position_m), np.where(left[:, None], turned, rotation)
