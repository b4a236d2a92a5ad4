"""Joints side by side, with axes of their own, and a thumb over several keys, of bassoon and contrabassoon."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from resources.build.instrument_keys import Cup, Keywork, Touch, Wall, oval, slab
from resources.build.instrument_mesh import Array

LOW_KEYS = ("key_D", "key_C", "key_B", "key_B_flat_low")
"""From the first to the one that is reached last, over all others."""


@dataclass(frozen=True)
class Joints:
    """Axes of a body: ``up`` along it, ``front`` away from the player; distances ``along`` are counted down from
    ``socket``."""

    socket: Array
    up: Array
    front: Array

    @property
    def left(self) -> Array:
        """To the player's left."""
        return np.cross(self.up, self.front)

    def place(self, left: float, front: float, along: float) -> Array:
        """A point of the body's own axes."""
        return self.socket + left * self.left + front * self.front - along * self.up

    def wall(self, left: float, front: float, profile: list[tuple[float, float]]) -> Wall:
        """A round piece of body along the instrument: angle 0 is the front, 90 degrees the left."""
        return Wall(self.place(left, front, 0.0), -self.up, self.front, profile)

    def touch(self, left: float, front: float, along: float, normal: Array, length: float, width: float) -> Touch:
        """A spatula at a place of the body's own axes, its length along the body."""
        return slab(self.place(left, front, along), normal, -self.up, oval(length, width), foot=0.0)

    def thumb_key(
        self, work: Keywork, name: str, label: str, joint: Wall, cup: Cup, spatula: Touch, along: float,
        angle_deg: float, travel_m: float, attack_s: float | None = None,
    ) -> None:  # fmt: skip
        """A key of the left thumb, its rod along a joint from the spatula at ``along`` to the cup."""
        low, high = sorted((cup.along, along))
        rod = joint.rod(low - 0.006, high + 0.006, angle_deg, 0.0045)
        work.key(name, label, "left.thumb.pad", rod, spatula, [cup], travel_m=travel_m, attack_s=attack_s)

    def thumb_over_low_keys(self, work: Keywork, with_c_sharp: str) -> None:
        """The left thumb lies over two, three and all four of the low keys, and over C sharp and another key."""
        back = -self.front
        at = {str(row["control"]): np.asarray(row["point"]) for row in work.contacts}
        work.contacts[:] = [row for row in work.contacts if row["control"] not in LOW_KEYS[1:]]
        for count in (2, 3, 4):
            together: Sequence[str] = LOW_KEYS[:count]
            middle = 0.70 * at[together[-1]] + 0.30 * at[together[-2]]
            work.contact(
                "left.thumb.pad", middle, back, node=together[-1], control=together[-1], together=together[:-1]
            )
        point = 0.78 * at["key_C_sharp"] + 0.22 * at[with_c_sharp]
        work.also("left.thumb.pad", "key_C_sharp", (with_c_sharp,), point=point)
