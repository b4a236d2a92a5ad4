"""Conversion of a character and its motion to the scene of a file: centimetres, one root, the player at the origin
facing
+Z.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, SingleArray
from app.export.bind_pose import CENTIMETRES, bound_meshes, rest_transforms
from app.export.bone_axes import bone_axes
from app.export.eyes import eyes_of_file, looking_ahead, with_turned_balls
from app.export.face_curves import FACE_PARTS, FacePart, written_weights
from app.export.influences import with_few_influences
from app.export.morph_normals import with_morph_normals
from app.export.own_skeleton import own_weights
from app.export.target import BoneMotion, TargetSkeleton, Trajectory, bone_motion, matrices, normalised_target
from app.formats.joined_meshes import join_meshes
from app.formats.scene import Bone, Clip, MorphTarget, Scene, SkinnedMesh
from app.formats.unique_names import numbered
from app.identity_cache import IdentityCache
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.characters.bone_placements import local_placements, world_placements
from app.rig.figure import Figure
from app.rig.mesh import Mesh, materials_once
from app.rig.model import Character


def character_scene(
    character: Character,
    motion: Motion,
    name: str,
    creator: str,
    target: TargetSkeleton | None = None,
    held: Sequence[Trajectory] = (),
    *,
    face_parts: tuple[FacePart, ...] = FACE_PARTS,
    every_influence: bool = False,
) -> Scene:
    """Return the scene of a character with a motion.

    Parameters
    ----------
    character : Character
        The character.
    motion : Motion
        Motion of this character's skeleton.
    name : str
        Name of armature and animation, and prefix of mesh names.
    creator : str
        Program and version for the file.
    target : TargetSkeleton, optional
        Skeleton to write on; by default the normalised skeleton.
    held : sequence of Trajectory
        Trajectories of the musician's instruments, if the target has sockets for several; empty for the motion's only
        instrument.
    face_parts : tuple of FacePart
        Parts of the face with curves. Without the gaze, eyes do not turn in the head.
    every_influence : bool
        Keep all skin weights, as for measurements; files get few for each vertex.

    Returns
    -------
    Scene
        On the skeleton of the character's own file, it has that file's meshes and morphs. On any other skeleton it has
        one mesh, joined from all meshes with the vertices in order (so landmarks stay valid), and all morph targets.
        The clip animates the morphs that the motion uses.
    """
    target = normalised_target(character.skeleton) if target is None else target
    if "gaze" not in face_parts:
        motion = looking_ahead(character, motion)
    eyes = eyes_of_file(character, motion, target)
    motion = replace(eyes.motion, morphs=written_weights(eyes.motion.morphs, face_parts))
    if target.choice == "own" and character.own is not None:
        meshes, weights = _own_meshes(character.own.figure, target, name), own_weights(motion.morphs, character.own)
    else:
        if every_influence:
            # What is measured once is not kept.
            shaped = _shaped(character, target.eyes)
        else:
            shaped = _SHAPED.step(_shaped, character, sys.intern(target.eyes))
        meshes, weights = (_joined_mesh(shaped, target, name),), motion.morphs
    there = {morph.name for mesh in meshes for morph in mesh.morphs}
    clip = character_clip(
        character,
        motion,
        name,
        target,
        {morph: weight for morph, weight in weights.items() if morph in there},
        held,
    )
    scene = Scene(
        bones=_bones(target, character, meshes[0]),
        meshes=meshes,
        clip=replace(clip, whole_turns=eyes.whole(target, character, clip.rotations_xyzw)),
        creator=creator,
        name=name,
    )
    return scene if every_influence else with_few_influences(scene)


_SHAPED: Final[IdentityCache[Character]] = IdentityCache(16)
_LIT: Final[IdentityCache[Mesh]] = IdentityCache(128)
"""Shaded bodies, each of which takes half a second to compute; an ensemble has few different ones."""


def _shaped(character: Character, eyes: str) -> Character:
    """Return a character whose morphs include all effects that a file needs: changes of normals, and, if shapes rotate
    the eyes, the eyeballs.
    """
    if eyes == "shapes":
        character = with_turned_balls(character)
    return replace(character, meshes=tuple(map(with_morph_normals, character.meshes)))


def _bones(target: TargetSkeleton, character: Character, mesh: SkinnedMesh) -> tuple[Bone, ...]:
    """Return the bones of an exported character in the rest pose that the target skeleton requests, positions in
    centimetres relative to the parent."""
    offsets_cm, rotations = target.offsets_m * CENTIMETRES, target.rest
    if target.choice == "ue5" or target.rest_pose != "model":
        # The pose in which the mesh was bound: Unreal uses it as the rest pose, and three.js combines the two.
        binds = np.asarray(mesh.world_from_bone_bind, np.float64)
        turned = quaternion.from_matrix(binds[:, :3, :3])
        places_cm, rotations = local_placements(target.parents, binds[:, :3, 3], turned)
        placed = sorted(target.loose)
        offsets_cm[placed] = places_cm[placed]
    rows = zip(target.names, target.parents, offsets_cm, rotations, bone_axes(target, character.skeleton), strict=True)
    return tuple(Bone(*row) for row in rows)


def character_clip(
    character: Character,
    motion: Motion,
    name: str,
    target: TargetSkeleton,
    morph_weights: Mapping[str, SingleArray],
    held: Sequence[Trajectory] = (),
) -> Clip:
    """Return the animation clip of an exported character.

    ``morph_weights`` are the weights (F,) of the face's morphs by name; ``held`` as in `character_scene`.
    """
    if target.normalised:  # the rests are identity
        bones = BoneMotion(motion.rotations, {target.hips: motion.hips_m.astype(np.float64)})
    else:
        bones = bone_motion(target, character.skeleton, motion, held)
    return Clip(
        name=name,
        fps=motion.fps,
        frames=motion.frames,
        rotations_xyzw=bones.rotations,
        translations_cm={bone: places_m * CENTIMETRES for bone, places_m in bones.translations_m.items()},
        morph_weights=morph_weights,
    )


def _own_meshes(figure: Figure, target: TargetSkeleton, name: str) -> tuple[SkinnedMesh, ...]:
    """Return the meshes of the user's figure, bound to its bones in the rest pose of the target; ``name`` prefixes
    their names.
    """
    binds = matrices(*world_placements(target.parents, target.offsets_m * CENTIMETRES, target.rest))
    added = len(target.names) - len(target.added) - len(figure.bone_names)
    names = mesh_names([f"{name}_{mesh.name or 'mesh'}" for mesh in figure.meshes], target.names)
    meshes = [_LIT.step(with_morph_normals, mesh) for mesh in figure.meshes]
    return tuple(
        # A vertex without weight may refer to any bone.
        skinned_mesh(mesh, own_name, np.maximum(mesh.joints + np.int32(added), 0), mesh.weights, binds)
        for mesh, own_name in zip(meshes, names, strict=True)
    )


def _joined_mesh(character: Character, target: TargetSkeleton, name: str) -> SkinnedMesh:
    """Return all meshes of a character joined to one, bound to the bones of a target; a joint without a bone is merged
    with its parent.
    """
    binds = rest_transforms(character, target)
    meshes = [
        skinned_mesh(mesh, mesh.name, mesh.joints, mesh.weights, binds) for mesh in bound_meshes(character, target)
    ]
    return join_meshes(meshes, *mesh_names([f"{name}_mesh"], target.names))


def skinned_mesh(
    mesh: Mesh,
    name: str,
    joints: npt.NDArray[np.int32],
    weights: SingleArray,
    world_from_bone_bind: AnyFloatArray,
) -> SkinnedMesh:
    """Return a mesh bound to bones; UVs are converted from v down (glTF) to v up (FBX)."""
    uvs = mesh.uvs.astype(np.float64)
    uvs[:, 1] = 1.0 - uvs[:, 1]
    materials, face_materials = materials_once(mesh)
    return SkinnedMesh(
        name=name,
        vertices_cm=mesh.positions_m.astype(np.float64) * CENTIMETRES,
        faces=mesh.triangles,
        normals=mesh.normals,
        uvs=uvs,
        materials=materials,
        face_materials=face_materials,
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
    """Return mesh names that differ from each other and from bone names, since Unreal and Blender identify objects by
    name.
    """
    return numbered(names, bones)
