"""Conversion between transforms of bones in the world and relative to their parents."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion


def world_placements(
    parents: Sequence[int], offsets_m: FloatArray, rotations: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return world positions (B, 3) and rotations (B, 4) of B bones from those relative to their parents."""
    positions, turned = np.array(offsets_m, np.float64), np.array(rotations, np.float64)
    for bone, parent in enumerate(parents):
        if parent >= 0:
            positions[bone] = positions[parent] + quaternion.rotate(turned[parent], positions[bone])
            turned[bone] = quaternion.multiply(turned[parent], turned[bone])
    return positions, turned


def local_placements(
    parents: Sequence[int], positions: FloatArray, turned: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return offsets (B, 3) and rotations (B, 4) of B bones relative to their parents from those in the world."""
    offsets, rotations = np.array(positions, np.float64), np.array(turned, np.float64)
    for bone, parent in enumerate(parents):
        if parent >= 0:
            back = quaternion.conjugate(turned[parent])
            offsets[bone] = quaternion.rotate(back, positions[bone] - positions[parent])
            rotations[bone] = quaternion.multiply(back, turned[bone])
    return offsets, rotations
