"""Reading of binary FBX files written by `app.formats.fbx.write` back into scenes.

Supports only what that writer produces: bones in centimetres without scaling or pivots, directly under the scene or
under one Null per figure, and linear keys on frames, evaluated at every frame. Everything else raises an error, never a
silent misreading.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import FileError
from app.formats import euler
from app.formats.fbx.curves import EULER_ORDER, ORDERS
from app.formats.fbx.decode import read_elements
from app.formats.fbx.encode import Element
from app.formats.fbx.graph import FbxObject, ObjectGraph, numbers, properties_of
from app.formats.fbx.materials import read_material
from app.formats.fbx.take import MOST_VALUES, FbxCurve, FbxTake, read_take
from app.formats.files import read_file
from app.formats.joint_angles import AXES, channel_quaternions
from app.formats.scene import Bone, Clip, MorphTarget, NodePlace, Scene, SkinnedMesh, checked_scenes

MOST_BYTES = 2**30
_BLOCK = 16384
"""Number of values (frames times bones) processed at a time, so that they fit a processor core's cache."""

_NOT_SUPPORTED = (
    "PostRotation", "RotationOffset", "RotationPivot", "ScalingOffset", "ScalingPivot",
    "GeometricTranslation", "GeometricRotation",
)  # fmt: skip
_OF_BONES = ("PreRotation", "RotationOrder")


def read_scene(path: str | os.PathLike[str]) -> Scene:
    """Read a file written by `write_scene`.

    Normals and UVs are per corner; everything else is as written, in float64 (curves in float32 precision).

    Raises
    ------
    FileError
        The file was not written by `write_scene`, or is damaged.
    """
    return decode_scene(read_file(path, MOST_BYTES), os.fspath(path))


def read_scenes(path: str | os.PathLike[str]) -> tuple[Scene, ...]:
    """Read a file written by `write_scenes`; see `read_scene`."""
    return decode_scenes(read_file(path, MOST_BYTES), os.fspath(path))


def decode_scene(data: bytes, file: str) -> Scene:
    """Decode the bytes of a file with one scene, as `read_scene`."""
    scenes = decode_scenes(data, file)
    if len(scenes) != 1:
        raise FileError("fbx.unsupported", file=file, what=f"{len(scenes)} figures in one file")
    return scenes[0]


def decode_scenes(data: bytes, file: str) -> tuple[Scene, ...]:
    """Decode an FBX file with several scenes from its bytes; ``file`` names it in errors (see `read_scenes`)."""
    root = read_elements(data, file)
    graph = ObjectGraph(root, file)
    creator = root.child("Creator")
    made_by = graph.only(creator, str) if creator is not None else ""
    take = read_take(graph, root)
    nodes = graph.of_kind("Model", "Null")
    if any(parent for node in nodes for parent, _ in graph.parents.get(node.id, ())):
        raise FileError("fbx.unsupported", file=file, what="a figure within another")
    figures: list[FbxObject | None] = [*nodes] if nodes else [None]
    scenes = tuple(_figure(graph, node, take, made_by) for node in figures)
    found = sum(len(scene.bones) + len(scene.meshes) for scene in scenes)
    found += sum(len(mesh.levels) for scene in scenes for mesh in scene.meshes)
    if found != len(graph.of_kind("Model", "LimbNode")) + len(graph.of_kind("Model", "Mesh")):
        raise FileError("fbx.unsupported", file=file, what="a bone or mesh outside the figures")
    try:
        return tuple(checked_scenes(scenes))
    except ValueError as error:
        raise FileError("fbx.contradiction", file=file, detail=str(error)) from error


def _figure(graph: ObjectGraph, node: FbxObject | None, take: FbxTake | None, creator: str) -> Scene:
    """Return the scene of the figure below a node of the FBX file, or the whole file's scene if ``node`` is None."""
    bones, turns_from, bone_of_model = _bones(graph, node)
    place, node_from_world, models = None, np.eye(4, dtype=np.float64), graph.of_kind("Model", "Mesh")
    if node is not None:
        translation, rotation = _placement(graph, node, _OF_BONES)
        place = NodePlace(translation, euler.quaternions(rotation[::-1], EULER_ORDER))
        node_from_world[:] = np.linalg.inv(place.matrix)
        models = graph.below(node, "Model", "Mesh")
    levels = _levels(graph, node)
    below = {model.id for ones in levels.values() for model in ones}
    in_file = {model.id for model in models} | levels.keys() | below
    models = [model for model in graph.of_kind("Model", "Mesh") if model.id in in_file]

    def mesh(model: FbxObject) -> SkinnedMesh:
        return _mesh(graph, model, bone_of_model, node_from_world)

    meshes = tuple(
        replace(mesh(model), levels=tuple(map(mesh, levels.get(model.id, ()))))
        for model in models
        if model.id not in below
    )
    clip = None
    if take is not None:
        channels = {
            channel.id: channel.name
            for model in models
            for shape in graph.below(model, "Geometry")
            for channel in _channels(graph, shape)
        }
        clip = _clip(graph, take, bones, turns_from, bone_of_model, channels)
    return Scene(bones, meshes, clip, creator, "" if node is None else node.name, place)


# ------------------------------------------------------------------------------------------------------------ bones


def _bones(graph: ObjectGraph, node: FbxObject | None) -> tuple[tuple[Bone, ...], FloatArray, dict[int, int]]:
    """Return the bones below a node, parents first; the pre-rotations (B, 4) relative to which their angles are stored;
    and the bone index of each model.
    """
    top = 0 if node is None else node.id
    models = graph.of_kind("Model", "LimbNode")
    is_bone = {model.id for model in models}
    parent_of: dict[int, int] = {}
    for model in models:
        above = [parent for parent, to in graph.parents.get(model.id, ()) if not to]
        bone_above = [parent for parent in above if parent in is_bone]
        nodes = [graph.objects[parent] for parent in above if parent in graph.objects and parent not in is_bone]
        nodes = [one for one in nodes if one.kind == "Model"]
        if not bone_above and any(one.sub_class != "Null" for one in nodes):
            raise FileError("fbx.unsupported", file=graph.file, what=f"a node above the bone {model.name}")
        parent_of[model.id] = (*bone_above, *(one.id for one in nodes), 0)[0]
    index: dict[int, int] = {top: -1}
    found: list[tuple[FbxObject, int]] = []
    for model in models:
        chain = [model.id]
        while parent_of[chain[-1]] in is_bone and parent_of[chain[-1]] not in index:
            chain.append(parent_of[chain[-1]])
            if len(chain) > len(models):
                raise FileError("fbx.contradiction", file=graph.file, detail=f"{model.name} is its own ancestor")
        if parent_of[chain[-1]] not in index:
            continue  # belongs to another figure
        for key in reversed(chain):
            if key not in index:
                index[key] = len(found)
                found.append((graph.objects[key], index[parent_of[key]]))
    del index[top]
    places = [_placement(graph, model) for model, _ in found]
    turning = [_turning(graph, model) for model, _ in found]
    before = euler.quaternions(np.array([rotation[::-1] for _, rotation in turning]).reshape(-1, 3), EULER_ORDER)
    degrees = np.array([rotation for _, rotation in places]).reshape(-1, 1, 3)
    turns = channel_quaternions(degrees, [order for order, _ in turning], before)[:, 0]
    rows = zip(found, places, turns, turning, strict=True)
    bones = tuple(
        Bone(model.name, parent, place, turn, np.eye(3)[[AXES.index(axis) for axis in order]])
        for (model, parent), (place, _), turn, (order, _) in rows
    )
    return bones, before, index


def _turning(graph: ObjectGraph, model: FbxObject) -> tuple[str, FloatArray]:
    """Return the order of a bone's Euler angles, such as ``"xyz"``, and its pre-rotation (3,) in degrees."""
    properties = properties_of(model.element)
    values = {name: numbers(properties.get(name, ())) for name in ("RotationActive", *_OF_BONES)}
    if not any(values["RotationActive"]):
        if any(map(any, values.values())):
            raise FileError("fbx.unsupported", file=graph.file, what=f"inactive rotation of {model.name}")
        return EULER_ORDER, np.zeros(3)
    before, order = values["PreRotation"] or [0.0, 0.0, 0.0], int((*values["RotationOrder"], 0)[0])
    if len(before) != 3 or not np.isfinite(before).all() or not 0 <= order < len(ORDERS):
        raise FileError("fbx.unsupported", file=graph.file, what=f"rotation of {model.name}")
    return ORDERS[order], np.array(before)


def _placement(graph: ObjectGraph, model: FbxObject, without: Iterable[str] = ()) -> tuple[FloatArray, FloatArray]:
    """Return local translation (3,) in centimetres and Euler angles (3,) in degrees of an FBX model. Raises FileError
    if it has any other transform or one of the properties ``without``.
    """
    properties = properties_of(model.element)
    for name in (*_NOT_SUPPORTED, *without):
        if any(numbers(properties.get(name, ()))):
            raise FileError("fbx.unsupported", file=graph.file, what=f"{name} of {model.name}")
    if any(value != 1.0 for value in numbers(properties.get("Lcl Scaling", ()))):
        raise FileError("fbx.unsupported", file=graph.file, what=f"scaling of {model.name}")
    vectors = [numbers(properties.get(name, (0.0, 0.0, 0.0))) for name in ("Lcl Translation", "Lcl Rotation")]
    if any(len(vector) != 3 or not np.isfinite(vector).all() for vector in vectors):
        raise FileError("fbx.missing", file=graph.file, what=f"place of {model.name}")
    return np.array(vectors[0]), np.array(vectors[1])


# ----------------------------------------------------------------------------------------------------------- meshes


def _mesh(
    graph: ObjectGraph, model: FbxObject, bone_of_model: dict[int, int], node_from_world: FloatArray
) -> SkinnedMesh:
    if any(np.concatenate(_placement(graph, model, _OF_BONES))):
        raise FileError("fbx.unsupported", file=graph.file, what=f"place of the mesh {model.name}")
    shapes = graph.below(model, "Geometry", "Mesh")
    if len(shapes) != 1:
        raise FileError("fbx.missing", file=graph.file, what=f"geometry of {model.name}")
    element = shapes[0].element
    vertices = graph.floats(element, "Vertices", 3)
    faces = _faces(graph, element, model.name)
    normals = graph.floats(_layer(graph, element, "LayerElementNormal", "ByPolygonVertex"), "Normals", 3)
    joint_indices, weights, binds = _skin(graph, shapes[0], len(vertices), bone_of_model)
    return SkinnedMesh(
        name=model.name,
        vertices_cm=vertices,
        faces=faces,
        normals=normals,
        uvs=_uvs(graph, element),
        materials=tuple(read_material(material) for material in graph.below(model, "Material")),
        face_materials=_face_materials(graph, element, len(faces)),
        joint_indices=joint_indices,
        weights=weights,
        world_from_bone_bind=node_from_world @ binds,
        morphs=_morphs(graph, shapes[0]),
    )


def _levels(graph: ObjectGraph, node: FbxObject | None) -> dict[int, list[FbxObject]]:
    """Return the lower levels of detail of each mesh, by the mesh's id, in the figure below a node, or in the whole
    file if it is None.
    """
    groups = graph.of_kind("Model", "LodGroup") if node is None else graph.below(node, "Model", "LodGroup")
    found = [graph.below(group, "Model", "Mesh") for group in groups]
    return {models[0].id: models[1:] for models in found if models}


def _layer(graph: ObjectGraph, element: Element, name: str, mapping: str) -> Element:
    layer = graph.section(element, name)
    given = layer.child("MappingInformationType")
    if given is None or graph.only(given, str) != mapping:
        raise FileError("fbx.unsupported", file=graph.file, what=f"mapping of {name}")
    return layer


def _faces(graph: ObjectGraph, element: Element, name: str) -> IntArray:
    corners = graph.integers(element, "PolygonVertexIndex")
    ends = np.flatnonzero(corners < 0)
    width = int(ends[0]) + 1 if len(ends) else 0
    if not width or len(corners) % width or not np.array_equal(ends, np.arange(width - 1, len(corners), width)):
        raise FileError("fbx.unsupported", file=graph.file, what=f"polygons of different sizes in {name}")
    return np.where(corners < 0, -corners - 1, corners).reshape(-1, width)


def _uvs(graph: ObjectGraph, element: Element) -> FloatArray | None:
    if element.child("LayerElementUV") is None:
        return None
    layer = _layer(graph, element, "LayerElementUV", "ByPolygonVertex")
    uvs, indices = graph.floats(layer, "UV", 2), graph.integers(layer, "UVIndex")
    if indices.size and not 0 <= indices.min() <= indices.max() < len(uvs):
        raise FileError("fbx.contradiction", file=graph.file, detail="UVIndex beyond UV")
    return uvs.take(indices, axis=0)


def _face_materials(graph: ObjectGraph, element: Element, face_count: int) -> IntArray:
    layer = graph.section(element, "LayerElementMaterial")
    indices = graph.integers(layer, "Materials")
    return np.repeat(indices, face_count) if len(indices) == 1 else indices


def _skin(
    graph: ObjectGraph, shape: FbxObject, vertex_count: int, bone_of_model: dict[int, int]
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return bone indices (V, K) and weights (V, K) of V vertices, strongest first, and the bind pose of every bone."""
    binds = _bind_pose(graph, bone_of_model)
    shares: list[tuple[int, IntArray, FloatArray]] = []
    slots: list[IntArray] = []
    counts = np.zeros(vertex_count, dtype=np.int64)
    for skin in graph.below(shape, "Deformer", "Skin"):
        for cluster in graph.below(skin, "Deformer", "Cluster"):
            bones = [bone_of_model[child] for child, _ in graph.children.get(cluster.id, ()) if child in bone_of_model]
            if len(bones) != 1:
                raise FileError("fbx.missing", file=graph.file, what=f"bone of a cluster of {shape.name}")
            binds[bones[0]] = graph.matrix(cluster.element, "TransformLink")
            indices = graph.integers(cluster.element, "Indexes")
            values = graph.floats(cluster.element, "Weights", 1)[:, 0]
            if len(indices) != len(values) or (indices.size and not 0 <= indices.min() <= indices.max() < vertex_count):
                raise FileError("fbx.contradiction", file=graph.file, detail=f"weights of {shape.name}")
            shares.append((bones[0], indices, values))
            slots.append(counts[indices])
            counts[indices] += 1
    if counts.sum() != sum(map(len, slots)):
        raise FileError("fbx.unsupported", file=graph.file, what=f"a vertex twice in a cluster of {shape.name}")
    width = int(counts.max(initial=0))
    if width * vertex_count > MOST_VALUES:
        raise FileError("fbx.unsupported", file=graph.file, what=f"{width} influences on a vertex of {shape.name}")
    joint_indices = np.zeros((width, vertex_count), dtype=np.int64)
    weights = np.zeros((width, vertex_count))
    for slot, (bone, indices, values) in zip(slots, shares, strict=True):
        joint_indices[slot, indices], weights[slot, indices] = bone, values
    for end in range(width - 1, 0, -1):
        for place in range(end):
            both, weaker = np.s_[place : place + 2], np.flatnonzero(weights[place] < weights[place + 1])
            weights[both, weaker] = weights[both, weaker][::-1]
            joint_indices[both, weaker] = joint_indices[both, weaker][::-1]
    return np.ascontiguousarray(joint_indices.T), np.ascontiguousarray(weights.T), binds


def _bind_pose(graph: ObjectGraph, bone_of_model: dict[int, int]) -> FloatArray:
    binds = np.full((len(bone_of_model), 4, 4), np.nan)
    for pose in graph.of_kind("Pose", "BindPose"):
        for node in pose.element.children or ():
            if node.name == "PoseNode":
                model = int(graph.only(graph.section(node, "Node"), np.int64))
                if model in bone_of_model:
                    binds[bone_of_model[model]] = graph.matrix(node, "Matrix")
    return binds


def _channels(graph: ObjectGraph, shape: FbxObject) -> Iterator[FbxObject]:
    """Yield the morph channels of a mesh's shape."""
    for deformer in graph.below(shape, "Deformer", "BlendShape"):
        yield from graph.below(deformer, "Deformer", "BlendShapeChannel")


def _morphs(graph: ObjectGraph, shape: FbxObject) -> tuple[MorphTarget, ...]:
    morphs = []
    for channel in _channels(graph, shape):
        targets = graph.below(channel, "Geometry", "Shape")
        if len(targets) != 1:
            raise FileError("fbx.unsupported", file=graph.file, what=f"{len(targets)} shapes in {channel.name}")
        element = targets[0].element
        normals = graph.floats(element, "Normals", 3) if element.child("Normals") is not None else None
        indices = graph.integers(element, "Indexes")
        morphs.append(MorphTarget(channel.name, indices, graph.floats(element, "Vertices", 3), normals))
    return tuple(morphs)


# -------------------------------------------------------------------------------------------------------- animation


def _clip(
    graph: ObjectGraph,
    take: FbxTake,
    bones: tuple[Bone, ...],
    turns_from: FloatArray,
    bone_of_model: dict[int, int],
    name_of_channel: dict[int, str],
) -> Clip:
    """Read the clip of a take for the given bones and morphs."""
    frames = take.frames
    if frames * max(len(bones), len(name_of_channel)) > MOST_VALUES:
        raise FileError("fbx.unsupported", file=graph.file, what=f"{frames} frames of {len(bones)} bones")
    rotations = np.empty((4, len(bones), frames))
    rotations[:] = np.array([bone.rotation_xyzw for bone in bones]).T[..., None]
    turning: list[tuple[int, list[FbxCurve]]] = []
    translations: dict[int, FloatArray] = {}
    weights: dict[str, FloatArray] = {}
    for (target, to_property), channels in take.curves.items():
        if target in bone_of_model and to_property == "Lcl Rotation":
            turning.append((bone_of_model[target], channels))
        elif target in bone_of_model and to_property == "Lcl Translation":
            translations[bone_of_model[target]] = np.stack([curve.at(frames) for curve in channels], axis=1)
        elif target in bone_of_model:
            weights[to_property] = channels[0].at(frames)
        elif target in name_of_channel:
            name, weight = name_of_channel[target], channels[0].at(frames) / 100.0
            if name in weights and not np.array_equal(weights[name], weight):
                raise FileError("fbx.contradiction", file=graph.file, detail=f"two different curves of {name}")
            weights[name] = weight
    _turn(rotations, turning, [bone.order for bone in bones], turns_from)
    # Contiguous by component, as later computations read it.
    return Clip(take.name, take.fps, frames, rotations.transpose(2, 1, 0), translations, weights)


def _turn(
    rotations: FloatArray, turning: list[tuple[int, list[FbxCurve]]], orders: Sequence[str], turns_from: FloatArray
) -> None:
    """Set ``rotations`` (4, B, F), x y z w of B bones in F frames, from the curves of the bones' angles; ``orders`` are
    the orders of angles, ``turns_from`` the pre-rotations.
    """
    frames = rotations.shape[-1]
    resting = [row for row in turning if all(curve.rests for curve in row[1])]
    moving = [row for row in turning if not all(curve.rests for curve in row[1])]
    for rows, count in ((resting, 1), (moving, frames)):
        step = max(1, _BLOCK // count)
        for some in (rows[first : first + step] for first in range(0, len(rows), step)):
            angles = np.empty((3, len(some), count))
            for row, (_, curves) in enumerate(some):
                for axis, curve in enumerate(curves):
                    angles[axis, row] = curve.values[:1] if count == 1 else curve.at(frames)
            chosen = [bone for bone, _ in some]
            turns = channel_quaternions(
                np.moveaxis(angles, 0, -1), [orders[bone] for bone in chosen], turns_from[chosen]
            )
            rotations[:, chosen] = np.moveaxis(turns, -1, 0)
