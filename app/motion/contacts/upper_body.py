"""Hips, trunk and instrument of some frames: what arms and legs are solved on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.carried_instrument import Carried
from app.motion.contacts.trunk_and_legs import Trunk


@dataclass(frozen=True)
class UpperBody:
    """Place (F, 3) and rotation (F, 4) of the hips, the trunk, and the instrument."""

    hips_m: FloatArray
    hips: FloatArray
    trunk: Trunk
    carried: Carried

    def __getitem__(self, frames: slice) -> UpperBody:
        trunk, carried = self.trunk, self.carried
        parts = (trunk.chest, trunk.chest_m, trunk.head, trunk.head_m)
        return UpperBody(
            self.hips_m[frames],
            self.hips[frames],
            Trunk({joint: turn[frames] for joint, turn in trunk.local.items()}, *(part[frames] for part in parts)),
            Carried(carried.position_m[frames], carried.rotation[frames]),
        )


def joined(parts: Sequence[UpperBody]) -> UpperBody:
    """Stretches of frames as one."""
    if len(parts) == 1:
        return parts[0]

    def whole(member: Callable[[UpperBody], FloatArray]) -> FloatArray:
        return np.concatenate([member(part) for part in parts])

    joints = parts[0].trunk.local
    return UpperBody(
        whole(lambda part: part.hips_m),
        whole(lambda part: part.hips),
        Trunk(
            {joint: np.concatenate([part.trunk.local[joint] for part in parts]) for joint in joints},
            whole(lambda part: part.trunk.chest),
            whole(lambda part: part.trunk.chest_m),
            whole(lambda part: part.trunk.head),
            whole(lambda part: part.trunk.head_m),
        ),
        Carried(whole(lambda part: part.carried.position_m), whole(lambda part: part.carried.rotation)),
    )
