"""Straps and chair of a musician as the scene of a file: a skeleton of their own, in the same space as their player.

Bones that follow a joint have its name; those of a strap are named after its kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.export.bind_pose import CENTIMETRES
from app.export.character import mesh_names, skinned_mesh
from app.formats.scene import Bone, Clip, NodePlace, Scene
from app.rig import quaternion
from app.rig.supports.follow import support_matrices
from app.rig.supports.model import Supports

_ROOT: Final = "root"


def support_bones(supports: Supports) -> tuple[str, ...]:
    """Return the names of the bones in the file of a musician's straps and chair, the root first."""
    return (_ROOT, *(bone.name for bone in supports.bones))


def supports_scene(
    supports: Supports,
    joints: FloatArray,
    instruments: Sequence[FloatArray],
    fps: Fraction,
    name: str,
    creator: str,
    place: NodePlace | None = None,
) -> Scene:
    """Return the scene of a musician's straps and chair with their motion.

    Parameters
    ----------
    joints : (F, J, 3, 4) float64
        ``world_from_joint`` of the character, in the player's frame.
    instruments : sequence of (F, 3, 4) float64
        ``world_from_instrument`` of the musician's instruments.
    fps : Fraction
        Frames per second.
    name, creator : str
        Name of armature and animation, and prefix of the meshes' names; program and version.
    place : NodePlace, optional
        Transform of the root bone on the stage; by default the origin.
    """
    moved = support_matrices(supports, joints, instruments)
    frames, count = moved.shape[:2]
    rest_m = np.array([bone.place_m for bone in supports.bones])
    places_m = (moved[..., :3] @ rest_m[:, :, None])[..., 0] + moved[..., 3]
    rotations = np.tile(quaternion.IDENTITY, (frames, count + 1, 1))
    rotations[:, 1:] = quaternion.continuous(quaternion.from_matrix(moved[..., :3]))
    translations_cm = {
        number + 1: places_m[:, number] * CENTIMETRES
        for number, bone in enumerate(supports.bones)
        if bone.role != "still"
    }
    root_cm, root = np.zeros(3), quaternion.IDENTITY
    if place is not None:
        root_cm, root = np.asarray(place.translation_cm, np.float64), np.asarray(place.rotation_xyzw, np.float64)
        rotations[:, 0] = root
    bones = [Bone(_ROOT, -1, root_cm, root)]
    bones += [Bone(bone.name, 0, bone.place_m * CENTIMETRES, quaternion.IDENTITY) for bone in supports.bones]
    binds = np.tile(np.eye(4), (count + 1, 1, 1))
    binds[1:, :3, 3] = rest_m * CENTIMETRES
    names = mesh_names([f"{name}_{mesh.name}" for mesh in supports.meshes], (bone.name for bone in bones))
    return Scene(
        bones=tuple(bones),
        meshes=tuple(
            skinned_mesh(mesh, own_name, mesh.joints + np.int32(1), mesh.weights, binds)
            for mesh, own_name in zip(supports.meshes, names, strict=True)
        ),
        clip=Clip(name, fps, frames, rotations, translations_cm),
        creator=creator,
        name=name,
    )
