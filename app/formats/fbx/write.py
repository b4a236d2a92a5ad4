"""Writing of scenes as binary FBX 7.4 files.

The FBX SDK 2019.2, ufbx, Blender, assimp and three.js read the chosen layout alike: no pivots, no scaling, bones as
LimbNodes under one root, linear keys. A bone's rest is its pre-rotation, so that its curves are 0 there, and each bone
has its own rotation order. Several scenes share one take; the bones and meshes of each are below a Null with its name
and place, which becomes the armature in Blender. Textures are separate files (`app.formats.texture_files`).
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.formats.atomic import atomic_write
from app.formats.euler import euler_degrees
from app.formats.fbx import encode, ticks
from app.formats.fbx.assembly import Assembly
from app.formats.fbx.curves import EULER_ORDER, ORDERS, FbxLayerCurves
from app.formats.fbx.encode import Element, element_pieces
from app.formats.fbx.packed_meshes import PackedMesh, packed_mesh
from app.formats.fbx.sections import (
    definitions,
    documents,
    global_settings,
    header,
    integer,
    lod_group,
    property_block,
    property_row,
    takes,
)
from app.formats.fbx.write_materials import material_object
from app.formats.scene import Bone, Clip, NodePlace, Scene, SkinnedMesh, checked_scenes
from app.formats.texture_files import TextureFiles

_BESIDE_CM = 5e-4


def write_scene(path: str | os.PathLike[str], scene: Scene) -> None:
    """Write a scene as a binary FBX file, atomically and deterministically.

    Raises
    ------
    FileError
        The file cannot be written.
    ValueError
        The scene is inconsistent.
    """
    write_scenes(path, (scene,))


def write_scenes(path: str | os.PathLike[str], scenes: Iterable[Scene]) -> None:
    """Write several scenes into one file, like `write_scene`; each scene is released when the next is requested."""
    textures = TextureFiles()
    pieces = element_pieces(scene_elements(scenes, textures))
    textures.write(Path(path).parent)
    with atomic_write(path) as stream:
        stream.writelines(pieces)


def scene_elements(scenes: Iterable[Scene], textures: TextureFiles | None = None) -> tuple[Element, ...]:
    """Return the top-level records of the file in the order that all programs expect; the image files of used textures
    are added to ``textures``.
    """
    graph = Assembly(TextureFiles() if textures is None else textures)
    curves: FbxLayerCurves | None = None
    creator, take, rate, last_tick = "", "", None, 0
    for scene in checked_scenes(scenes):
        creator = scene.creator
        figure = _add_figure(graph, scene)
        if scene.clip is not None:
            if curves is None:
                take, rate = scene.clip.name, scene.clip.fps
                last_tick, curves = _add_take(graph, scene.clip)
            curves.add_clip(scene.bones, scene.clip, figure.bone_ids, figure.channel_ids, alone=not scene.meshes)
    return (
        header(creator),
        Element("FileId", (encode.FILE_ID,)),
        Element("CreationTime", (encode.CREATION_TIME,)),
        Element("Creator", (creator,)),
        global_settings(rate, last_tick),
        documents(graph.new_id(), take),
        Element("References", (), ()),
        definitions(graph.objects),
        Element("Objects", (), tuple(graph.objects)),
        Element("Connections", (), tuple(graph.connections)),
        takes(take, last_tick),
    )


def _vector(name: str, values: AnyFloatArray) -> Element:
    """Return a record of a transform property that may be animated; its type is named like the property."""
    return property_row(name, name, "", "A", *(float(value) for value in values))


# --------------------------------------------------------------------------------------------- skeleton and meshes


@dataclass
class _Figure:
    """Object ids of one scene in the file.

    Attributes
    ----------
    node : int
        Parent of its root bone and meshes: its own node, or the file's root.
    channel_ids : dict of str to list of int
        Ids of the channels for each morph name.
    """

    node: int = 0
    bone_ids: list[int] = field(default_factory=list)
    channel_ids: dict[str, list[int]] = field(default_factory=dict)


def _add_figure(graph: Assembly, scene: Scene) -> _Figure:
    figure = _Figure()
    world_from_node = np.eye(4)
    if scene.place is not None:
        figure.node = graph.add("Model", scene.name, "Model", "Null", _placed(scene.place))
        graph.connect(figure.node, 0)
        world_from_node = scene.place.matrix
    rests = euler_degrees(np.stack([bone.rotation_xyzw for bone in scene.bones])[None], EULER_ORDER)[:, ::-1, 0]
    weights = scene.clip.morph_weights if scene.clip is not None and not scene.meshes else ()
    for bone, rest_degrees in zip(scene.bones, rests, strict=True):
        _add_bone(graph, figure, bone, rest_degrees, () if figure.bone_ids else weights)
    if scene.meshes:
        binds = world_from_node @ _unconnected_binds(scene)
        mesh_ids = [id for mesh in scene.meshes for id in _add_levels(graph, figure, mesh, binds, world_from_node)]
        nodes = [_pose_node(mesh_id, world_from_node) for mesh_id in mesh_ids]
        nodes += [_pose_node(bone_id, bind) for bone_id, bind in zip(figure.bone_ids, binds, strict=True)]
        if figure.node:
            nodes.insert(0, _pose_node(figure.node, world_from_node))
        header = (Element("Type", ("BindPose",)), integer("Version", 100), integer("NbPoseNodes", len(nodes)))
        graph.add("Pose", scene.name if figure.node else "BindPose", "Pose", "BindPose", (*header, *nodes))
    return figure


def _add_bone(
    graph: Assembly, figure: _Figure, bone: Bone, rest_degrees: AnyFloatArray, weights: Iterable[str]
) -> None:
    flags = (Element("TypeFlags", ("Skeleton",)),)
    attribute = graph.add("NodeAttribute", bone.name, "NodeAttribute", "LimbNode", flags)
    turning = (
        # Otherwise the FBX SDK ignores the other two.
        property_row("RotationActive", "bool", "", "", np.int32(1)),
        property_row("RotationOrder", "enum", "", "", np.int32(ORDERS.index(bone.order))),
        property_row("PreRotation", "Vector3D", "Vector", "", *map(float, rest_degrees)),
        # Weights of morphs of another mesh are animated user properties, which Unreal imports as curves.
        *(property_row(name, "Number", "", "A+U", 0.0) for name in weights),
    )
    model = graph.add("Model", bone.name, "Model", "LimbNode", _model(bone.translation_cm, np.zeros(3), turning))
    graph.connect(model, figure.node if bone.parent < 0 else figure.bone_ids[bone.parent])
    figure.bone_ids.append(model)
    graph.connect(attribute, model)


def _placed(place: NodePlace) -> tuple[Element, ...]:
    rotation = euler_degrees(np.asarray(place.rotation_xyzw)[None, None], EULER_ORDER)[0, ::-1, 0]
    return _model(place.translation_cm, rotation)


def _model(
    translation_cm: AnyFloatArray, rotation_degrees: AnyFloatArray, turning: tuple[Element, ...] = ()
) -> tuple[Element, ...]:
    return (
        integer("Version", 232),
        property_block(
            *turning,
            property_row("InheritType", "enum", "", "", np.int32(1)),
            property_row("DefaultAttributeIndex", "int", "Integer", "", np.int32(0)),
            _vector("Lcl Translation", translation_cm),
            _vector("Lcl Rotation", rotation_degrees),
            _vector("Lcl Scaling", np.ones(3)),
        ),
        Element("Shading", (True,)),
        Element("Culling", ("CullingOff",)),
    )


def _unconnected_binds(scene: Scene) -> FloatArray:
    """Return the bind transforms (J, 4, 4) of J bones, adjusted so that no translated bone lies exactly on its parent's
    y axis.

    Blender treats a child at the end of that axis as connected and drops its location keys, so such a bone is moved by
    a hundredth of a millimetre.
    """
    binds = np.array(scene.meshes[0].world_from_bone_bind, dtype=np.float64)
    moving = scene.clip.translations_cm if scene.clip is not None else ()
    for index, bone in enumerate(scene.bones):
        if index in moving and bone.parent >= 0:
            parent_axes = binds[bone.parent, :3, :3]
            beside = parent_axes.T @ (binds[index, :3, 3] - binds[bone.parent, :3, 3])
            if np.hypot(beside[0], beside[2]) < _BESIDE_CM:
                binds[index, :3, 3] += parent_axes[:, 0] * _BESIDE_CM * (2 if beside[0] >= 0 else -2)
    return binds


def _add_levels(
    graph: Assembly, figure: _Figure, mesh: SkinnedMesh, binds: FloatArray, world_from_node: FloatArray
) -> tuple[int, ...]:
    """Add a mesh, and its levels of detail below a node that shows one level at a time; return the ids of all
    meshes.
    """
    if not mesh.levels:
        return (_add_mesh(graph, figure, mesh, figure.node, binds, world_from_node),)
    name = f"{mesh.name}_LODs"
    group = graph.add("Model", name, "Model", "LodGroup", _model(np.zeros(3), np.zeros(3)))
    graph.connect(group, figure.node)
    graph.connect(graph.add("NodeAttribute", name, "NodeAttribute", "LodGroup", lod_group(len(mesh.levels))), group)
    levels = (_add_mesh(graph, figure, one, group, binds, world_from_node) for one in (mesh, *mesh.levels))
    return (group, *levels)


def _add_mesh(
    graph: Assembly,
    figure: _Figure,
    mesh: SkinnedMesh,
    parent: int,
    binds: FloatArray,
    world_from_node: FloatArray,
) -> int:
    packed = packed_mesh(mesh)
    model = graph.add("Model", mesh.name, "Model", "Mesh", _model(np.zeros(3), np.zeros(3)))
    graph.connect(model, parent)
    shape = graph.add("Geometry", mesh.name, "Geometry", "Mesh", packed.geometry)
    graph.connect(shape, model)
    for material in mesh.materials:
        graph.connect(material_object(graph, material), model)
    _add_skin(graph, figure, mesh.name, packed, shape, binds, world_from_node)
    if mesh.morphs:
        _add_morphs(graph, figure, mesh, packed, shape)
    return model


def _add_skin(
    graph: Assembly,
    figure: _Figure,
    name: str,
    packed: PackedMesh,
    shape: int,
    binds: FloatArray,
    world_from_node: FloatArray,
) -> None:
    skin_children = (integer("Version", 101), Element("Link_DeformAcuracy", (50.0,)))
    skin = graph.add("Deformer", name, "Deformer", "Skin", skin_children)
    graph.connect(skin, shape)
    for bone, indices, weights in packed.clusters:
        bind = binds[bone]
        children = (
            integer("Version", 100),
            Element("UserData", ("", "")),
            indices,
            weights,
            _matrix("Transform", np.linalg.inv(bind) @ world_from_node),
            _matrix("TransformLink", bind),
        )
        cluster = graph.add("Deformer", name, "SubDeformer", "Cluster", children)
        graph.connect(cluster, skin)
        graph.connect(figure.bone_ids[bone], cluster)


def _matrix(name: str, matrix: AnyFloatArray) -> Element:
    """Return a record of a matrix, stored column by column: entries 12 to 14 are the translation."""
    return Element(name, (np.ascontiguousarray(matrix.T, dtype=np.float64).ravel(),))


def _pose_node(node: int, world_from_node: AnyFloatArray) -> Element:
    return Element("PoseNode", (), (Element("Node", (np.int64(node),)), _matrix("Matrix", world_from_node)))


def _add_morphs(graph: Assembly, figure: _Figure, mesh: SkinnedMesh, packed: PackedMesh, shape: int) -> None:
    # Unreal removes the deformer's name from the front of channel names, so it must not be a prefix of one.
    deformer = graph.add("Deformer", f"{mesh.name}_morphs", "Deformer", "BlendShape", (integer("Version", 100),))
    graph.connect(deformer, shape)
    for morph, geometry in zip(mesh.morphs, packed.morphs, strict=True):
        children = (
            integer("Version", 100),
            Element("DeformPercent", (0.0,)),
            Element("FullWeights", (np.array([100.0]),)),
        )
        channel = graph.add("Deformer", morph.name, "SubDeformer", "BlendShapeChannel", children)
        target = graph.add("Geometry", morph.name, "Geometry", "Shape", geometry)
        graph.connect(channel, deformer)
        graph.connect(target, channel)
        figure.channel_ids.setdefault(morph.name, []).append(channel)


# -------------------------------------------------------------------------------------------------------- animation


def _add_take(graph: Assembly, clip: Clip) -> tuple[int, FbxLayerCurves]:
    """Add animation stack and layer; return the tick of the last key, and the writer of the layer's curves."""
    key_ticks = ticks.frame_ticks(clip.fps, clip.frames)
    last_tick = int(key_ticks[-1])
    spans = [
        property_row(name, "KTime", "Time", "", np.int64(tick))
        for name, tick in zip(
            ("LocalStart", "LocalStop", "ReferenceStart", "ReferenceStop"), (0, last_tick, 0, last_tick), strict=True
        )
    ]
    stack = graph.add("AnimationStack", clip.name, "AnimStack", "", (property_block(*spans),))
    layer = graph.add("AnimationLayer", "BaseLayer", "AnimLayer", "", ())
    graph.connect(layer, stack)
    return last_tick, FbxLayerCurves(graph, layer, key_ticks)
