"""A character's motion as a BVH clip: the same joints from the hips on, in centimetres."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from app.export.character import CENTIMETRES, HIPS
from app.formats.bvh import BvhClip
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.model import Character

FloatArray = npt.NDArray[np.float64]

OWN_VERTEX = 0.5
"""A vertex belongs to the joint that holds more than this share of it."""


def character_bvh(character: Character, motion: Motion) -> BvhClip:
    """The skeleton below the root, whose (resting) transform goes into the hips.

    Parameters
    ----------
    character : Character
    motion : Motion
        Of this character's skeleton.
    """
    skeleton = character.skeleton
    hips = skeleton.index(HIPS)
    if hips != 1 or skeleton.parents.count(0) != 1:
        raise ValueError(f"{character.id}: {HIPS} must be the only child of the root")
    root_rotation = motion.rotations[:, 0].astype(np.float64)
    rotations = motion.rotations[:, 1:].copy()
    rotations[:, 0] = quaternion.multiply(root_rotation, rotations[:, 0])
    hips_m = quaternion.rotate(root_rotation, motion.hips_m) + skeleton.offsets_m[0]
    offsets_cm = skeleton.offsets_m[1:] * CENTIMETRES
    offsets_cm[0] = 0.0
    return BvhClip(
        names=skeleton.names[1:],
        parents=tuple(parent - 1 for parent in skeleton.parents[1:]),
        offsets_cm=offsets_cm,
        end_sites_cm={joint - 1: end * CENTIMETRES for joint, end in end_sites_m(character).items()},
        fps=motion.fps,
        root_translation_cm=hips_m * CENTIMETRES,
        rotations_xyzw=rotations,
    )


def end_sites_m(character: Character) -> dict[int, FloatArray]:
    """Where the bones of the joints without a child end, in the joint's frame: as far along the way to the joint as
    the surface it carries goes."""
    skeleton = character.skeleton
    leaves = set(range(len(skeleton.names))) - set(skeleton.parents)
    ends = {}
    for joint in sorted(leaves):
        offset = skeleton.offsets_m[joint]
        direction = offset / np.linalg.norm(offset)
        lengths = [float(np.max(points @ direction)) for points in _own_points_m(character, joint)]
        ends[joint] = direction * max([*lengths, 0.01])
    return ends


def _own_points_m(character: Character, joint: int) -> list[FloatArray]:
    """Vertices that a joint carries, in its frame, of every mesh that has some."""
    joint_from_mesh = character.joint_from_mesh[joint]
    found = []
    for mesh in character.meshes:
        own = np.where(mesh.joints == joint, mesh.weights, 0.0).sum(axis=1) > OWN_VERTEX
        if own.any():
            found.append(mesh.positions_m[own] @ joint_from_mesh[:3, :3].T + joint_from_mesh[:3, 3])
    return found
