"""Combination of instruments with the sockets of their player: as one scene, or as a program shows two files
together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.export.equipped_skeleton import socket_names
from app.export.playback import METRES, ScenePlayback
from app.export.target import TargetSkeleton, Trajectory, instrument_path, placed_trajectory, trajectory_at_origin
from app.formats.scene import Clip, NodePlace, Scene, SkinnedMesh
from app.formats.unique_names import numbered
from app.motion.model import Motion
from app.rig import quaternion


def own_path(target: TargetSkeleton, motion: Motion) -> Trajectory:
    """Return the path of the root bone in an instrument's own file: its path in the world, or a fixed point if the
    instrument is attached to a socket.
    """
    return (
        trajectory_at_origin(motion.frames)
        if target.sockets
        else placed_trajectory(instrument_path(motion), target.place)
    )


def attached(character: Scene, instruments: Sequence[Scene], target: TargetSkeleton) -> Scene:
    """Merge a character and the instruments on its sockets into one scene with one skeleton.

    Parameters
    ----------
    character : Scene
        Scene of the character on ``target``.
    instruments : sequence of Scene
        Scenes of the musician's instruments as in their own files. The root bone of each is renamed to its scene's
        name.
    target : TargetSkeleton
        Skeleton of the character's scene.
    """
    for instrument, socket in zip(instruments, socket_names(target), strict=True):
        character = _with_instrument(character, instrument, socket)
    return character


def _with_instrument(character: Scene, instrument: Scene, socket: str) -> Scene:
    before = len(character.bones)
    hook = _bone(character, socket)
    taken = [bone.name for bone in character.bones] + [mesh.name for mesh in character.meshes + instrument.meshes]
    names = numbered([instrument.name, *(bone.name for bone in instrument.bones[1:])], taken)
    bones = tuple(
        replace(bone, name=name, parent=hook if bone.parent < 0 else bone.parent + before)
        for bone, name in zip(instrument.bones, names, strict=True)
    )
    world_from_socket = np.asarray(character.meshes[0].world_from_bone_bind[hook], np.float64)
    held = world_from_socket @ np.asarray(instrument.meshes[0].world_from_bone_bind, np.float64)
    binds = np.concatenate([character.meshes[0].world_from_bone_bind, held])
    meshes = [replace(mesh, world_from_bone_bind=binds) for mesh in character.meshes]
    meshes += [_moved(mesh, world_from_socket, before, binds) for mesh in instrument.meshes]
    return replace(
        character, bones=character.bones + bones, meshes=tuple(meshes), clip=_joined(character, instrument, before)
    )


def _moved(mesh: SkinnedMesh, world_from_socket: FloatArray, before: int, binds: FloatArray) -> SkinnedMesh:
    turn = world_from_socket[:3, :3]
    return replace(
        mesh,
        vertices_cm=mesh.vertices_cm @ turn.T + world_from_socket[:3, 3],
        normals=mesh.normals @ turn.T,
        joint_indices=mesh.joint_indices + before,
        world_from_bone_bind=binds,
    )


def _joined(character: Scene, instrument: Scene, before: int) -> Clip:
    clip, held = character.clip, instrument.clip
    assert clip is not None
    assert held is not None
    moved = {bone + before: values for bone, values in held.translations_cm.items()}
    keys = None if clip.keys is None or held.keys is None else clip.keys.beside(held.keys)
    return replace(
        clip,
        keys=keys,
        rotations_xyzw=np.concatenate([clip.rotations_xyzw, held.rotations_xyzw], axis=1, dtype=np.float32),
        translations_cm={**clip.translations_cm, **moved},
    )


# Reading back


def in_world(instrument: Scene, character: Scene, socket: str) -> Scene:
    """Return an instrument's scene moved from a character's socket to world space."""
    clip, held = character.clip, instrument.clip
    assert clip is not None
    assert held is not None
    world = ScenePlayback(character, clip).world(0, clip.frames)[:, _bone(character, socket)]
    return _carried(instrument, Trajectory(world[:, :3, 3], quaternion.from_matrix(world[:, :3, :3])))


def without_place(scene: Scene, place: NodePlace | None) -> Scene:
    """Return a scene on the stage with its motion moved back from the performer's place to the origin; unchanged
    without a place.
    """
    if place is None or scene.clip is None:
        return scene
    back = quaternion.conjugate(place.rotation_xyzw)
    there = NodePlace(-quaternion.rotate(back, place.translation_cm), back)
    return _carried(scene, placed_trajectory(trajectory_at_origin(scene.clip.frames), there))


def _carried(scene: Scene, path: Trajectory) -> Scene:
    """Return a scene, given relative to a moving object, with its root bone's motion in the space in which the object
    moves.

    ``path`` is the object's trajectory.
    """
    clip = scene.clip
    assert clip is not None
    own = np.asarray(clip.translations_cm.get(0, scene.bones[0].translation_cm), np.float64)
    place_cm = path.positions_m / METRES + quaternion.rotate(path.rotations, own)
    rotations = np.array(clip.rotations_xyzw)
    rotations[:, 0] = quaternion.multiply(path.rotations, rotations[:, 0])
    clip = replace(clip, rotations_xyzw=rotations, translations_cm={**clip.translations_cm, 0: place_cm})
    return replace(scene, clip=clip)


def _bone(scene: Scene, name: str) -> int:
    return [bone.name for bone in scene.bones].index(name)
