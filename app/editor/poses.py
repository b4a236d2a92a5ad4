"""Interface through which the 3D view gets the poses of players."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from app.arrays import AnyFloatArray, SingleArray
from app.performance.chunks import Pose, between


def blended(one: Pose, other: Pose, share: float) -> Pose:
    """Return a pose interpolated between two poses: ``share`` 0 gives ``one``, 1 gives ``other``."""

    def mixed(before: Mapping[str, float], after: Mapping[str, float]) -> dict[str, float]:
        names = {**before, **after}
        return {name: (1.0 - share) * before.get(name, 0.0) + share * after.get(name, 0.0) for name in names}

    def moved(before: AnyFloatArray, after: AnyFloatArray) -> SingleArray:
        return np.asarray(before + share * (after - before), np.float32)

    def turned(before: AnyFloatArray, after: AnyFloatArray) -> SingleArray:
        return between(np.asarray(before, np.float32), np.asarray(after, np.float32), share)

    return Pose(
        rotations=turned(one.rotations, other.rotations),
        hips_m=moved(one.hips_m, other.hips_m),
        morphs=mixed(one.morphs, other.morphs),
        controls=mixed(one.controls, other.controls),
        instrument_position_m=moved(one.instrument_position_m, other.instrument_position_m),
        instrument_rotation=turned(one.instrument_rotation[None], other.instrument_rotation[None])[0],
    )


def same(one: Pose | None, other: Pose | None) -> bool:
    """Return whether two poses look the same, so that nothing need be drawn again."""
    if one is None or other is None or one is other:
        return one is other
    return (
        one.controls == other.controls
        and one.morphs == other.morphs
        and np.array_equal(one.instrument_position_m, other.instrument_position_m)
        and np.array_equal(one.instrument_rotation, other.instrument_rotation)
        and np.array_equal(one.hips_m, other.hips_m)
        and np.array_equal(one.rotations, other.rotations)
    )


class PoseSource(Protocol):
    """Source of poses by player and time."""

    def poses(self, player_ids: Sequence[str], time_s: float) -> Sequence[Pose | None]:
        """Return the poses of players at a time, in the order of the ids; None for a pose that is not computed yet.

        Returns immediately.
        """

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """Return the pose of a player, computing it immediately if it is missing, for pictures that must be
        complete.
        """
