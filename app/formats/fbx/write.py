"""Scene -> binary FBX 7.4 file.

The layout is what the FBX SDK 2019.2, ufbx, Blender, assimp and three.js all read alike: no pivots, no scaling, bones
as LimbNodes under one root, Euler angles in the default order, a key on every frame.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from app.formats.atomic import atomic_write
from app.formats.euler import euler_degrees
from app.formats.fbx import encode, ticks
from app.formats.fbx.encode import Element, PackedArray, Property, encode_elements, pack_array, write_elements
from app.formats.fbx.geometry import geometry, morph_geometry, skin_clusters
from app.formats.fbx.materials import phong
from app.formats.fbx.sections import (
    definitions,
    documents,
    global_settings,
    header,
    integer,
    property_block,
    property_row,
    takes,
)
from app.formats.scene import Bone, Clip, FloatArray, Material, Scene, SkinnedMesh, check_scene

# FBX calls this order XYZ: x turns first, so the matrix is Rz Ry Rx.
EULER_ORDER = "ZYX"

_FIRST_ID = 1_000_000
_BESIDE_CM = 5e-4
# Linear keys. The bits beside "linear" (4) and the tangent data are those that every reader has met before.
_KEY_FLAGS = np.array([0x6104], dtype=np.int32)
_KEY_DATA = np.array([0.0, 0.0, 9.419963346924634e-30, 0.0], dtype=np.float32)


def write_scene(path: str | os.PathLike[str], scene: Scene) -> None:
    """Write a scene as a binary FBX file, whole or not at all.

    Parameters
    ----------
    path : str or path-like
    scene : Scene

    Raises
    ------
    FileError
        ``file.cannot_write``.
    ValueError
        If the scene contradicts itself.
    """
    elements = scene_elements(scene)
    with atomic_write(path) as stream:
        write_elements(stream, elements)


def encode_scene(scene: Scene) -> bytes:
    """Bytes that `write_scene` writes; the same scene always gives the same."""
    return encode_elements(scene_elements(scene))


def scene_elements(scene: Scene) -> tuple[Element, ...]:
    """Top level of the file, in the order that every reader expects."""
    check_scene(scene)
    graph = _Graph()
    _add_skeleton_and_meshes(graph, scene)
    last_tick = 0
    if scene.clip is not None:
        last_tick = _add_clip(graph, scene, scene.clip)
    take = scene.clip.name if scene.clip is not None else ""
    return (
        header(scene.creator),
        Element("FileId", (encode.FILE_ID,)),
        Element("CreationTime", (encode.CREATION_TIME,)),
        Element("Creator", (scene.creator,)),
        global_settings(scene.clip, last_tick),
        documents(graph.new_id(), take),
        Element("References", (), ()),
        definitions(graph.objects),
        Element("Objects", (), tuple(graph.objects)),
        Element("Connections", (), tuple(graph.connections)),
        takes(take, last_tick),
    )


# ---------------------------------------------------------------------------------------------------- object graph


@dataclass
class _Graph:
    """Objects and connections while the file is being put together."""

    objects: list[Element] = field(default_factory=list)
    connections: list[Element] = field(default_factory=list)
    bone_ids: list[int] = field(default_factory=list)
    channel_ids: dict[str, list[int]] = field(default_factory=dict)
    last_id: int = _FIRST_ID

    def new_id(self) -> int:
        self.last_id += 1
        return self.last_id

    def add(self, kind: str, name: str, class_name: str, sub_class: str, children: tuple[Element, ...]) -> int:
        new = self.new_id()
        self.objects.append(Element(kind, (np.int64(new), f"{name}\0\x01{class_name}", sub_class), children))
        return new

    def connect(self, child: int, parent: int, to_property: str | None = None) -> None:
        ends: tuple[Property, ...] = (np.int64(child), np.int64(parent))
        if to_property is None:
            self.connections.append(Element("C", ("OO", *ends)))
        else:
            self.connections.append(Element("C", ("OP", *ends, to_property)))


def _vector(name: str, values: FloatArray) -> Element:
    """A transform property that may be animated; its kind is called like the property."""
    return property_row(name, name, "", "A", *(float(value) for value in values))


# --------------------------------------------------------------------------------------------- skeleton and meshes


def _add_skeleton_and_meshes(graph: _Graph, scene: Scene) -> None:
    for bone in scene.bones:
        _add_bone(graph, bone)
    if scene.meshes:
        binds = _unconnected_binds(scene)
        materials: dict[Material, int] = {}
        mesh_ids = [_add_mesh(graph, mesh, binds, materials) for mesh in scene.meshes]
        nodes = [_pose_node(graph.bone_ids[index], bind) for index, bind in enumerate(binds)]
        nodes = [_pose_node(mesh_id, np.eye(4)) for mesh_id in mesh_ids] + nodes
        header = (Element("Type", ("BindPose",)), integer("Version", 100), integer("NbPoseNodes", len(nodes)))
        graph.add("Pose", "BindPose", "Pose", "BindPose", (*header, *nodes))


def _add_bone(graph: _Graph, bone: Bone) -> None:
    flags = (Element("TypeFlags", ("Skeleton",)),)
    attribute = graph.add("NodeAttribute", bone.name, "NodeAttribute", "LimbNode", flags)
    rotation = euler_degrees(np.asarray(bone.rotation_xyzw)[None, None], EULER_ORDER)[0, ::-1, 0]
    model = graph.add("Model", bone.name, "Model", "LimbNode", _model(bone.translation_cm, rotation))
    graph.bone_ids.append(model)
    graph.connect(model, 0 if bone.parent < 0 else graph.bone_ids[bone.parent])
    graph.connect(attribute, model)


def _model(translation_cm: FloatArray, rotation_degrees: FloatArray) -> tuple[Element, ...]:
    return (
        integer("Version", 232),
        property_block(
            property_row("InheritType", "enum", "", "", np.int32(1)),
            property_row("DefaultAttributeIndex", "int", "Integer", "", np.int32(0)),
            _vector("Lcl Translation", translation_cm),
            _vector("Lcl Rotation", rotation_degrees),
            _vector("Lcl Scaling", np.ones(3)),
        ),
        Element("Shading", (True,)),
        Element("Culling", ("CullingOff",)),
    )


def _unconnected_binds(scene: Scene) -> npt.NDArray[np.float64]:
    """Bind transforms (J, 4, 4) in which no bone that changes its place lies exactly on its parent's y axis.

    Blender takes the child at the end of that axis for connected and then drops its location keys, so such a bone is
    bound a hundredth of a millimetre beside it.
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


def _add_mesh(graph: _Graph, mesh: SkinnedMesh, binds: npt.NDArray[np.float64], materials: dict[Material, int]) -> int:
    model = graph.add("Model", mesh.name, "Model", "Mesh", _model(np.zeros(3), np.zeros(3)))
    graph.connect(model, 0)
    shape = graph.add("Geometry", mesh.name, "Geometry", "Mesh", geometry(mesh))
    graph.connect(shape, model)
    for material in mesh.materials:
        if material not in materials:
            materials[material] = graph.add("Material", material.name, "Material", "", _material(material))
        graph.connect(materials[material], model)
    _add_skin(graph, mesh, shape, binds)
    if mesh.morphs:
        _add_morphs(graph, mesh, shape)
    return model


def _material(surface: Material) -> tuple[Element, ...]:
    material = phong(surface)

    def color(name: str, rgb: tuple[float, float, float]) -> Element:
        return property_row(name, "Color", "", "A", *(float(value) for value in rgb))

    def number(name: str, value: float) -> Element:
        return property_row(name, "Number", "", "A", float(value))

    transparency = 1.0 - material.opacity
    return (
        integer("Version", 102),
        Element("ShadingModel", ("Phong",)),
        integer("MultiLayer", 0),
        property_block(
            color("DiffuseColor", material.diffuse_rgb),
            number("DiffuseFactor", 1.0),
            color("EmissiveColor", (0.0, 0.0, 0.0)),
            color("AmbientColor", (0.0, 0.0, 0.0)),
            color("SpecularColor", material.specular_rgb),
            number("SpecularFactor", 1.0),
            number("Shininess", material.shininess),
            number("ShininessExponent", material.shininess),
            color("TransparentColor", (transparency,) * 3),
            number("TransparencyFactor", transparency),
            number("Opacity", material.opacity),
        ),
    )


def _add_skin(graph: _Graph, mesh: SkinnedMesh, shape: int, binds: npt.NDArray[np.float64]) -> None:
    skin_children = (integer("Version", 101), Element("Link_DeformAcuracy", (50.0,)))
    skin = graph.add("Deformer", mesh.name, "Deformer", "Skin", skin_children)
    graph.connect(skin, shape)
    for bone, indices, weights in skin_clusters(mesh):
        bind = binds[bone]
        children = (
            integer("Version", 100),
            Element("UserData", ("", "")),
            Element("Indexes", (indices,)),
            Element("Weights", (weights,)),
            _matrix("Transform", np.linalg.inv(bind)),
            _matrix("TransformLink", bind),
        )
        cluster = graph.add("Deformer", mesh.name, "SubDeformer", "Cluster", children)
        graph.connect(cluster, skin)
        graph.connect(graph.bone_ids[bone], cluster)


def _matrix(name: str, matrix: FloatArray) -> Element:
    """Stored column by column: the translation is in entries 12 to 14."""
    return Element(name, (np.ascontiguousarray(matrix.T, dtype=np.float64).ravel(),))


def _pose_node(node: int, world_from_node: FloatArray) -> Element:
    return Element("PoseNode", (), (Element("Node", (np.int64(node),)), _matrix("Matrix", world_from_node)))


def _add_morphs(graph: _Graph, mesh: SkinnedMesh, shape: int) -> None:
    # Unreal cuts the deformer's name off the front of a channel's name, so it must not be one.
    deformer = graph.add("Deformer", f"{mesh.name}_morphs", "Deformer", "BlendShape", (integer("Version", 100),))
    graph.connect(deformer, shape)
    for morph in mesh.morphs:
        children = (
            integer("Version", 100),
            Element("DeformPercent", (0.0,)),
            Element("FullWeights", (np.array([100.0]),)),
        )
        channel = graph.add("Deformer", morph.name, "SubDeformer", "BlendShapeChannel", children)
        target = graph.add("Geometry", morph.name, "Geometry", "Shape", morph_geometry(morph))
        graph.connect(channel, deformer)
        graph.connect(target, channel)
        graph.channel_ids.setdefault(morph.name, []).append(channel)


# -------------------------------------------------------------------------------------------------------- animation


def _add_clip(graph: _Graph, scene: Scene, clip: Clip) -> int:
    """Stack, layer and all curves; returns the tick of the last key."""
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
    curves = _Curves(graph, layer, pack_array(key_ticks), clip.frames)

    rotations = euler_degrees(clip.rotations_xyzw, EULER_ORDER)
    for bone, model in enumerate(graph.bone_ids):
        if bone in clip.translations_cm:
            curves.add(model, "Lcl Translation", "T", "XYZ", np.asarray(clip.translations_cm[bone]).T)
        curves.add(model, "Lcl Rotation", "R", "XYZ", rotations[bone, ::-1])
    for name, weights in clip.morph_weights.items():
        percent = np.asarray(weights, dtype=np.float64)[None] * 100.0
        for channel in graph.channel_ids.get(name, ()):
            curves.add(channel, "DeformPercent", "DeformPercent", ("DeformPercent",), percent)
    return last_tick


class _Curves:
    """Adds the curves of one layer. What is the same in all of them is packed once."""

    def __init__(self, graph: _Graph, layer: int, times: PackedArray, frames: int) -> None:
        self._graph = graph
        self._layer = layer
        self._before = (integer("KeyVer", 4008), Element("KeyTime", (times,)))
        # All four are needed: without them the FBX SDK crashes.
        self._after = (
            Element("KeyAttrFlags", (pack_array(_KEY_FLAGS),)),
            Element("KeyAttrDataFloat", (pack_array(_KEY_DATA),)),
            Element("KeyAttrRefCount", (pack_array(np.array([frames], dtype=np.int32)),)),
        )

    def add(
        self, target: int, target_property: str, name: str, channels: str | tuple[str, ...], values: FloatArray
    ) -> None:
        """Animate one property; `values` has a row of frames per channel."""
        defaults = [
            property_row(f"d|{channel}", "Number", "", "A", float(row[0]))
            for channel, row in zip(channels, values, strict=True)
        ]
        node = self._graph.add("AnimationCurveNode", name, "AnimCurveNode", "", (property_block(*defaults),))
        self._graph.connect(node, self._layer)
        self._graph.connect(node, target, target_property)
        for channel, row in zip(channels, values.astype(np.float32), strict=True):
            keys = Element("KeyValueFloat", (_pack_keys(row),))
            children = (Element("Default", (float(row[0]),)), *self._before, keys, *self._after)
            curve = self._graph.add("AnimationCurve", "", "AnimCurve", "", children)
            self._graph.connect(curve, node, f"d|{channel}")


def _pack_keys(row: npt.NDArray[np.float32]) -> PackedArray:
    """Keys of one channel. One that rests is compressed to nothing; the noise of a moving one is not worth the time."""
    return pack_array(row, compress=bool((row == row[0]).all()))
