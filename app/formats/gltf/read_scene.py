"""Reading of GLB files written by `app.formats.gltf.write` back into scenes.

Supports only what that writer produces: bones below one root without scaling, meshes on one skin, one animation with
rate and length in its extras. Everything else raises an error, never a silent misreading. glTF splits vertices where
corners differ and orders them by material; the scene gets the vertices of the written meshes.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from app.arrays import AnyIntArray, FloatArray
from app.errors import FileError
from app.formats.gltf.animation import sampled
from app.formats.gltf.model import GltfAnimation, GltfChannel, GltfMesh, GltfModel, GltfSkin
from app.formats.gltf.primitives import primitives
from app.formats.gltf.read import read_glb
from app.formats.gltf.read_materials import scene_materials
from app.formats.gltf.samplers import METRES
from app.formats.scene import Bone, Clip, MorphTarget, NodePlace, Scene, SkinnedMesh, check_scene


def read_scene(path: str | os.PathLike[str], written: Sequence[SkinnedMesh]) -> Scene:
    """Read a file with one scene written by `write_glb`.

    Normals and UVs are per corner. A vertex without a face is missing in the file and put at the origin. Lower levels
    of detail are not read.

    Parameters
    ----------
    written : sequence of SkinnedMesh
        The written meshes, for their vertex order.

    Raises
    ------
    FileError
        The file was not written by `write_glb`, or is damaged.
    """
    file, model = os.fspath(path), read_glb(path, animated=True, morphing=True)
    if len(model.skins) != 1 or len(model.animations) > 1 or len(model.meshes) < len(written):
        raise FileError("gltf.damaged", file=file, what="skin, animation or meshes")
    (skin,) = model.skins
    row_of = {node: row for row, node in enumerate(skin.joints)}
    above = model.nodes[skin.joints[0]].parent
    bones = tuple(
        Bone(node.name, row_of.get(node.parent, -1), node.translation / METRES, node.rotation_xyzw)
        for node in (model.nodes[joint] for joint in skin.joints)
    )
    try:
        scene = Scene(
            bones,
            tuple(_mesh(model, mesh, skin, known) for mesh, known in zip(model.meshes, written, strict=False)),
            _clip(model, model.animations[0], row_of, bones) if model.animations else None,
            model.generator,
            "" if above < 0 else model.nodes[above].name,
            None if above < 0 else NodePlace(model.nodes[above].translation / METRES, model.nodes[above].rotation_xyzw),
        )
        check_scene(scene)
    except (ValueError, LookupError) as error:
        raise FileError("gltf.damaged", file=file, what=str(error)) from error
    return scene


def _mesh(model: GltfModel, mesh: GltfMesh, skin: GltfSkin, written: SkinnedMesh) -> SkinnedMesh:
    """Return a mesh of the file with the vertex order of the ``written`` mesh; ValueError if the file's vertices do not
    match.
    """
    numbers = [primitive.vertices for primitive in primitives(written)]
    if [len(one) for one in numbers] != [len(primitive.positions) for primitive in mesh.primitives]:
        raise ValueError(f"mesh {mesh.name!r}")
    count, width = len(written.vertices_cm), max(one.joint_indices.shape[1] for one in mesh.primitives)
    vertices_cm, joints, weights = np.zeros((count, 3)), np.zeros((count, width), np.int64), np.zeros((count, width))
    for own, primitive in zip(numbers, mesh.primitives, strict=True):
        columns = primitive.joint_indices.shape[1]
        vertices_cm[own] = primitive.positions / METRES
        joints[own, :columns], weights[own, :columns] = primitive.joint_indices, primitive.weights
    binds = np.linalg.inv(skin.joint_from_mesh_bind)
    binds[:, :3, 3] /= METRES
    parts = [*zip(numbers, mesh.primitives, strict=True)]
    corners = [primitive.triangles.ravel() for primitive in mesh.primitives]
    surfaces = scene_materials(model, own=True)
    return SkinnedMesh(
        name=mesh.name,
        vertices_cm=vertices_cm,
        faces=np.concatenate([own[one.triangles] for own, one in parts]),
        normals=np.concatenate([np.zeros((0, 3)), *_by_corner(corners, [one.normals for one in mesh.primitives])]),
        uvs=None if any(one.uvs is None for one in mesh.primitives) else _uvs(corners, mesh),
        materials=tuple(surfaces[one.material or 0] for one in mesh.primitives),
        face_materials=np.repeat(np.arange(len(parts)), [len(one.triangles) for one in mesh.primitives]),
        joint_indices=joints,
        weights=weights,
        world_from_bone_bind=binds,
        morphs=tuple(_morph(mesh, number, numbers) for number in range(len(mesh.morph_names))),
    )


def _by_corner(corners: Sequence[AnyIntArray], values: Sequence[FloatArray | None]) -> list[FloatArray]:
    return [own[rows] for rows, own in zip(corners, values, strict=True) if own is not None]


def _uvs(corners: Sequence[AnyIntArray], mesh: GltfMesh) -> FloatArray:
    uvs = np.concatenate(_by_corner(corners, [one.uvs for one in mesh.primitives]))
    return np.stack([uvs[:, 0], 1.0 - uvs[:, 1]], axis=1)


def _morph(mesh: GltfMesh, number: int, numbers: Sequence[AnyIntArray]) -> MorphTarget:
    """Return the morph with the index ``number``, with vertices merged that are split in the file; ``numbers`` has the
    written mesh's vertex for each vertex of each primitive.
    """
    found = [primitive.morphs[number] for primitive in mesh.primitives]
    rows = np.concatenate([own[morph.vertex_indices] for own, morph in zip(numbers, found, strict=True)])
    vertices, first = np.unique(rows, return_index=True)
    deltas = np.concatenate([morph.position_deltas for morph in found])[first] / METRES
    normals = [morph.normal_deltas for morph in found if morph.normal_deltas is not None]
    turned = np.concatenate(normals)[first] if len(normals) == len(found) else None
    return MorphTarget(mesh.morph_names[number], vertices, deltas, turned)


def _clip(model: GltfModel, animation: GltfAnimation, row_of: Mapping[int, int], bones: tuple[Bone, ...]) -> Clip:
    """Return an animation as a clip for the bones (``row_of`` has a bone's index by node); LookupError or ValueError if
    rate or length is missing.
    """
    fps, times_s = clip_frames(animation)
    frames = len(times_s)
    rotations = np.tile(np.stack([np.asarray(bone.rotation_xyzw, np.float64) for bone in bones]), (frames, 1, 1))
    translations: dict[int, FloatArray] = {}
    for channel in animation.channels:
        if channel.path == "rotation":
            rotations[:, row_of[channel.node]] = channel_values(channel, times_s)
        elif channel.path == "translation":
            translations[row_of[channel.node]] = channel_values(channel, times_s) / METRES
        else:
            raise ValueError(channel.path)
    weights: dict[str, FloatArray] = {}
    for channel in animation.weights:
        mesh = model.nodes[channel.node].mesh
        assert mesh is not None, "the reader knows how many morphs it has"
        weights |= zip(model.meshes[mesh].morph_names, channel_values(channel, times_s).T, strict=True)
    return Clip(animation.name, fps, frames, rotations, translations, weights)


def clip_frames(animation: GltfAnimation) -> tuple[Fraction, FloatArray]:
    """Return the frame rate of an animation written by this program, and the times (F,) of its frames; LookupError or
    ValueError if they are missing.
    """
    fps, frames = Fraction(str(animation.extras["framesPerSecond"])), int(animation.extras["frames"])
    last_s = max((channel.times_s[-1] for channel in (*animation.channels, *animation.weights)), default=0.0)
    if fps <= 0 or not 1 <= frames <= last_s * float(fps) + 1.5:
        raise ValueError(f"{frames} frames")
    return fps, np.arange(frames) / float(fps)


def channel_values(channel: GltfChannel, times_s: FloatArray) -> FloatArray:
    """Return the values (F, W) of an animation channel at F times."""
    on_every_frame = len(channel.times_s) == len(times_s) and channel.interpolation == "LINEAR"
    return channel.values if on_every_frame else sampled(channel, times_s)
