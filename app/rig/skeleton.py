"""Forward kinematics of normalised skeletons for requested joints, vectorised over frames."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import AnyFloatArray, FloatArray, IntArray
from app.rig import quaternion
from app.rig.model import Skeleton


@dataclass(frozen=True)
class JointTransforms:
    """World transforms of some joints.

    Attributes
    ----------
    joints : tuple of int
        Indices of the joints, ascending, so that parents come first.
    positions_m : (F, len(joints), 3) float64
        World positions.
    rotations : (F, len(joints), 4) float64
        ``world_from_joint``.
    """

    joints: tuple[int, ...]
    positions_m: FloatArray
    rotations: FloatArray

    def place(self, joint: int) -> int:
        """Return the index of a joint in the arrays; ValueError if it was not computed."""
        return self.joints.index(joint)

    def of(self, joint: int) -> tuple[FloatArray, FloatArray]:
        """Return positions (F, 3) and rotations (F, 4) of one joint."""
        place = self.place(joint)
        return self.positions_m[:, place], self.rotations[:, place]

    def at(self, frames: IntArray) -> JointTransforms:
        """Return the transforms in some frames (N,)."""
        return JointTransforms(self.joints, self.positions_m[frames], self.rotations[frames])

    def only(self, joints: Sequence[int]) -> JointTransforms:
        """Return a copy of the transforms of some joints, given in ascending order."""
        frames = len(self.positions_m)
        result = JointTransforms(
            tuple(joints),
            quaternion.planes(frames, len(joints), 3),
            quaternion.planes(frames, len(joints), 4),
        )
        for index, joint in enumerate(joints):
            result.positions_m[:, index], result.rotations[:, index] = self.of(joint)
        return result

    def matrices(self) -> FloatArray:
        """Return ``world_from_joint`` as (F, len(joints), 3, 4) matrices."""
        return np.concatenate([quaternion.to_matrix(self.rotations), self.positions_m[..., None]], axis=-1)


def ancestors(skeleton: Skeleton, joint: int) -> tuple[int, ...]:
    """Return the indices of the joints from the root to a joint, both included."""
    chain = []
    while joint >= 0:
        chain.append(joint)
        joint = skeleton.parents[joint]
    return tuple(reversed(chain))


def closure(skeleton: Skeleton, joints: Iterable[int]) -> tuple[int, ...]:
    """Return the given joints and all their ancestors as ascending indices, so that a pose of them can be computed."""
    return tuple(sorted({above for joint in joints for above in ancestors(skeleton, joint)}))


def rest_positions(skeleton: Skeleton) -> FloatArray:
    """Return the world positions (J, 3) of the skeleton's J joints in the rest pose, metres."""
    positions = np.array(skeleton.offsets_m, dtype=np.float64)
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            positions[joint] += positions[parent]
    return positions


def forward(
    skeleton: Skeleton,
    rotations: AnyFloatArray,
    hips_m: AnyFloatArray | None = None,
    joints: Iterable[int] | None = None,
) -> JointTransforms:
    """Compute world transforms of joints and their ancestors.

    Parameters
    ----------
    rotations : (F, J, 4)
        ``parent_from_joint`` of every joint.
    hips_m : (F, 3), optional
        Translation of the hips in the root's frame; the rest offset if absent.
    joints : iterable of int, optional
        Requested joints; all if absent.
    """
    return forward_by_joint(skeleton, [rotations[:, joint] for joint in range(rotations.shape[1])], hips_m, joints)


def forward_by_joint(
    skeleton: Skeleton,
    rotations: Sequence[AnyFloatArray],
    hips_m: AnyFloatArray | None = None,
    joints: Iterable[int] | None = None,
) -> JointTransforms:
    """Compute world transforms as `forward` does, from the rotations (F, 4) of each joint in a sequence."""
    requested = closure(skeleton, range(len(skeleton.names)) if joints is None else joints)
    place = {joint: index for index, joint in enumerate(requested)}
    frames = len(rotations[0])
    hips = _hips(skeleton) if hips_m is not None else -1
    # Each component of each joint is contiguous in memory; only the result has frames first.
    turned = np.empty((len(requested), 4, frames)).transpose(0, 2, 1)
    placed = np.empty((len(requested), 3, frames)).transpose(0, 2, 1)
    for index, joint in enumerate(requested):
        local = rotations[joint]
        offset = hips_m if joint == hips and hips_m is not None else skeleton.offsets_m[joint]
        parent = skeleton.parents[joint]
        if parent < 0:
            turned[index] = local
            placed[index] = offset
        else:
            above = place[parent]
            turned[index] = quaternion.multiply(turned[above], local)
            np.add(placed[above], quaternion.rotate(turned[above], offset), out=placed[index])
    return JointTransforms(requested, placed.transpose(1, 0, 2), turned.transpose(1, 0, 2))


@lru_cache(maxsize=64)
def _hips_index(names: tuple[str, ...]) -> int:
    return names.index("hips")


def _hips(skeleton: Skeleton) -> int:
    return _hips_index(skeleton.names)
