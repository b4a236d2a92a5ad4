"""A character and its motion as the scene of a file: centimetres, one root at the origin, the player facing +Z."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from app.formats.join import join_meshes
from app.formats.scene import Bone, Clip, MorphTarget, Scene, SkinnedMesh
from app.motion.model import Motion
from app.rig.model import Character, Mesh, Skeleton

CENTIMETRES = 100.0
HIPS = "hips"
"""The joint whose translation a motion gives."""


def character_scene(character: Character, motion: Motion, clip: str, creator: str) -> Scene:
    """The scene of one player.

    Parameters
    ----------
    character : Character
    motion : Motion
        Of this character's skeleton.
    clip : str
        Name of the animation.
    creator : str
        Program and version.

    Returns
    -------
    Scene
        One mesh of all the character's meshes, vertices in their order (so that landmarks hold in the file); it has
        every morph target of the character, and the clip weighs those that the motion moves.
    """
    skeleton = character.skeleton
    world_from_bone = np.linalg.inv(character.joint_from_mesh)
    world_from_bone[:, :3, 3] *= CENTIMETRES
    meshes = [skinned_mesh(mesh, mesh.name, mesh.joints, mesh.weights, world_from_bone) for mesh in character.meshes]
    (name,) = mesh_names([character.id], skeleton.names)
    return Scene(
        bones=skeleton_bones(skeleton),
        meshes=(join_meshes(meshes, name),),
        clip=character_clip(character, motion, clip),
        creator=creator,
    )


def skeleton_bones(skeleton: Skeleton) -> tuple[Bone, ...]:
    """The joints at rest: unturned, because the skeleton is normalised."""
    unturned = np.array([0.0, 0.0, 0.0, 1.0])
    return tuple(
        Bone(name, parent, offset * CENTIMETRES, unturned)
        for name, parent, offset in zip(skeleton.names, skeleton.parents, skeleton.offsets_m, strict=True)
    )


def character_clip(character: Character, motion: Motion, name: str) -> Clip:
    """What the joints and the face do. The root stays at the origin; only the hips are moved."""
    targets = {morph.name for mesh in character.meshes for morph in mesh.morphs}
    return Clip(
        name=name,
        fps=motion.fps,
        frames=motion.frames,
        rotations_xyzw=motion.rotations,
        translations_cm={character.skeleton.index(HIPS): motion.hips_m.astype(np.float64) * CENTIMETRES},
        morph_weights={target: weights for target, weights in motion.morphs.items() if target in targets},
    )


def skinned_mesh(
    mesh: Mesh,
    name: str,
    joints: npt.NDArray[np.int32],
    weights: npt.NDArray[np.float32],
    world_from_bone_bind: npt.NDArray[np.floating],
) -> SkinnedMesh:
    """A mesh bound to bones. Texture coordinates turn from glTF's (v down) to FBX's (v up)."""
    uvs = mesh.uvs.astype(np.float64)
    uvs[:, 1] = 1.0 - uvs[:, 1]
    return SkinnedMesh(
        name=name,
        vertices_cm=mesh.positions_m.astype(np.float64) * CENTIMETRES,
        faces=mesh.triangles,
        normals=mesh.normals,
        uvs=uvs,
        materials=mesh.materials,
        face_materials=mesh.triangle_materials,
        joint_indices=joints,
        weights=weights,
        world_from_bone_bind=world_from_bone_bind,
        morphs=tuple(
            MorphTarget(
                morph.name, morph.vertices, morph.deltas_m.astype(np.float64) * CENTIMETRES, morph.normal_deltas
            )
            for morph in mesh.morphs
        ),
    )


def mesh_names(names: Iterable[str], bones: Iterable[str]) -> tuple[str, ...]:
    """Names no other mesh and no bone has: Unreal and Blender tell objects apart by name alone."""
    taken = {bone.casefold() for bone in bones}
    result = []
    for name in names:
        unique, number = name or "mesh", 1
        while unique.casefold() in taken:
            number += 1
            unique = f"{name or 'mesh'}_{number}"
        taken.add(unique.casefold())
        result.append(unique)
    return tuple(result)
