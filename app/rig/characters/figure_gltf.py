"""Reading of figures from glTF 2.0 and VRM 0.x and 1.0 files.

Sources: VRM consortium, "VRMC_vrm-1.0" (humanoid.md, expressions.md) and "VRM 0.0" (the JSON schema). A VRM 0.x figure
faces -Z and is rotated here.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.characters.figure_build import (
    SINGULAR,
    FigurePart,
    NodeHierarchy,
    build_figure,
    nearest_rotations,
    rest_pose,
    transforms_differ,
    turned,
)
from app.rig.figure import Figure, Origin
from app.rig.gltf_source import GltfSource, build_mesh, read_source

THUMBS_OF_VRM0: Final = {"ThumbProximal": "ThumbMetacarpal", "ThumbIntermediate": "ThumbProximal"}
PRESETS_OF_VRM0: Final = {
    "a": "aa",
    "i": "ih",
    "u": "ou",
    "e": "ee",
    "o": "oh",
    "blink": "blink",
    "blink_l": "blinkLeft",
    "blink_r": "blinkRight",
    "joy": "happy",
    "angry": "angry",
    "sorrow": "sad",
    "fun": "relaxed",
    "lookup": "lookUp",
    "lookdown": "lookDown",
    "lookleft": "lookLeft",
    "lookright": "lookRight",
    "neutral": "neutral",
}
"""VRM 1.0 names of VRM 0.x presets; groups without a preset keep their own names."""
ABOUT_FACE: Final = np.diag([-1.0, 1.0, -1.0, 1.0])


def gltf_figure(path: Path) -> Figure:
    """Read a figure from a glTF 2.0 or VRM file. Raises FileError."""
    source = read_source(path)
    posed = source.world_from_node
    bound = bind_pose(source, squared=True)
    source = replace(source, world_from_node=rest_pose([node.parent for node in source.gltf.nodes], posed, bound))
    nodes, parts = _nodes(source), tuple(_parts(source))
    extensions = source.gltf.extensions
    origin: Origin = "gltf"
    humanoid: Mapping[str, int] = {}
    expressions: Mapping[str, Mapping[str, float]] = {}
    if isinstance(extensions.get("VRMC_vrm"), dict) or isinstance(extensions.get("VRM"), dict):
        nodes = replace(nodes, posed=posed)
    if isinstance(extensions.get("VRMC_vrm"), dict):
        origin, humanoid, expressions = "vrm1", *_vrm1(extensions["VRMC_vrm"], source)
    elif isinstance(extensions.get("VRM"), dict):
        origin, humanoid, expressions = "vrm0", *_vrm0(extensions["VRM"], source)
        nodes, parts = turned(nodes, parts, ABOUT_FACE)
    nodes = replace(nodes, joints={*nodes.joints, *humanoid.values()})
    return build_figure(source.file, origin, nodes, parts, humanoid, expressions)


def bind_pose(source: GltfSource, *, squared: bool = False) -> Mapping[int, FloatArray]:
    """Return the world transform (4, 4) of each joint in the pose in which its skin was bound, by node; empty if skins
    contradict each other.

    A skin is bound in a space of its own, whose place in the world follows from the root joint of the skin, or from a
    joint that another skin has bound too.

    Parameters
    ----------
    squared : bool
        Whether to place that space at right angles to the world if the nodes are posed: a root joint that leans in a
        jump leans for the nodes alone.
    """
    bound: dict[int, FloatArray] = {}
    depths = _depths(source)
    for skin in sorted(source.gltf.skins, key=lambda skin: -len(skin.joints)):
        if not len(skin.joints) or (np.abs(np.linalg.det(skin.joint_from_mesh_bind)) < SINGULAR).any():
            return {}
        mesh_from_joint = np.linalg.inv(skin.joint_from_mesh_bind)
        known = [place for place, joint in enumerate(skin.joints) if joint in bound]
        if known:
            world_from_mesh = bound[skin.joints[known[0]]] @ skin.joint_from_mesh_bind[known[0]]
        else:
            top = min(range(len(skin.joints)), key=lambda place: depths[skin.joints[place]])
            world_from_mesh = source.world_from_node[skin.joints[top]] @ skin.joint_from_mesh_bind[top]
            posed = source.world_from_node[list(skin.joints)]
            if squared and any(map(transforms_differ, world_from_mesh @ mesh_from_joint, posed)):
                world_from_mesh = _at_right_angles(world_from_mesh, posed[top, :3, 3])
        for joint, placed in zip(skin.joints, world_from_mesh @ mesh_from_joint, strict=True):
            if transforms_differ(bound.setdefault(joint, placed), placed):
                return {}
    return bound


def _at_right_angles(world_from_mesh: FloatArray, pivot_m: FloatArray) -> FloatArray:
    """Return a transform (4, 4) turned about a point (3,) of the world to the nearest right angles."""
    from scipy.spatial.transform import Rotation  # slow to import; figures are rarely read

    turn = quaternion.to_matrix(nearest_rotations(world_from_mesh[None]))[0]
    group = Rotation.create_group("O").as_matrix()
    back = np.eye(4)
    back[:3, :3] = group[int(np.argmax(np.einsum("gij,ij->g", group, turn)))] @ turn.T
    back[:3, 3] = pivot_m - back[:3, :3] @ pivot_m
    result: FloatArray = back @ world_from_mesh
    return result


def _depths(source: GltfSource) -> list[int]:
    """Return the number of ancestors of each node of a glTF file."""
    depths = []
    for node in source.gltf.nodes:
        depth, above = 0, node.parent
        while above >= 0:
            depth, above = depth + 1, source.gltf.nodes[above].parent
        depths.append(depth)
    return depths


def _nodes(source: GltfSource) -> NodeHierarchy:
    entries = source.gltf.nodes
    return NodeHierarchy(
        names=[entry.name for entry in entries],
        parents=[entry.parent for entry in entries],
        world_from_node=source.world_from_node,
        joints={joint for skin in source.gltf.skins for joint in skin.joints},
        other={
            index
            for index, entry in enumerate(entries)
            if entry.mesh is not None or "KHR_lights_punctual" in entry.extensions
        },
    )


def _parts(source: GltfSource) -> list[FigurePart]:
    parts = []
    lower = _lower_levels(source)
    for node, entry in enumerate(source.gltf.nodes):
        if entry.mesh is None or node in lower:
            continue
        name = source.gltf.meshes[entry.mesh].name or entry.name
        mesh, skinned = build_mesh(source, entry.mesh, name)
        mesh = replace(mesh, morphs=tuple(replace(m, name=morph_name(source, entry.mesh, m.name)) for m in mesh.morphs))
        skin = source.gltf.skins[entry.skin] if entry.skin is not None else None
        if skinned and skin is not None and len(skin.joints):
            if len(mesh.joints) and mesh.joints.max() >= len(skin.joints):
                mesh = replace(mesh, joints=np.where(mesh.joints < len(skin.joints), mesh.joints, 0))
            matrices = source.world_from_node[list(skin.joints)] @ skin.joint_from_mesh_bind
            parts.append(FigurePart(mesh, skin.joints, matrices))
        else:
            count = len(mesh.positions_m)
            rigid = replace(mesh, joints=np.zeros((count, 1), np.int32), weights=np.ones((count, 1), np.float32))
            parts.append(FigurePart(rigid, (node,), source.world_from_node[node][None]))
    return parts


def _lower_levels(source: GltfSource) -> frozenset[int]:
    """Return the nodes that are simplified versions of other nodes, for greater distances (extension MSFT_lod)."""
    levels = (entry.extensions.get("MSFT_lod") for entry in source.gltf.nodes)
    ids = (one.get("ids") for one in levels if isinstance(one, dict))
    return frozenset(id for some in ids if isinstance(some, list) for id in some if isinstance(id, int))


def morph_name(source: GltfSource, mesh: int, name: str) -> str:
    """Return a morph's name; an unnamed morph gets the name of its mesh as a prefix."""
    if re.fullmatch(r"morph_\d+", name) and len(source.gltf.meshes) > 1:
        return f"{source.gltf.meshes[mesh].name}.{name}"
    return name


def _members(owner: object, name: str) -> list[dict[str, Any]]:
    """Return the list ``name`` of a JSON object, without entries that are no objects; empty if there is no
    such list.
    """
    values = owner.get(name) if isinstance(owner, dict) else None
    return [value for value in values if isinstance(value, dict)] if isinstance(values, list) else []


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e6 else None


def _bone(value: object, source: GltfSource) -> int | None:
    whole = isinstance(value, int) and not isinstance(value, bool)
    return value if whole and 0 <= value < len(source.gltf.nodes) else None  # type: ignore[operator, return-value]


def _vrm1(vrm: dict[str, Any], source: GltfSource) -> tuple[dict[str, int], dict[str, dict[str, float]]]:
    humanoid = vrm.get("humanoid")
    bones = humanoid.get("humanBones") if isinstance(humanoid, dict) else None
    found = {
        name: node
        for name, bone in (bones.items() if isinstance(bones, dict) else ())
        if isinstance(bone, dict) and (node := _bone(bone.get("node"), source)) is not None
    }
    tables = vrm.get("expressions")
    faces: dict[str, dict[str, float]] = {}
    for kind in ("custom", "preset"):
        table = tables.get(kind) if isinstance(tables, dict) else None
        for name, expression in table.items() if isinstance(table, dict) else ():
            weights: dict[str, float] = {}
            for bind in _members(expression, "morphTargetBinds"):
                node = _bone(bind.get("node"), source)
                mesh = source.gltf.nodes[node].mesh if node is not None else None
                _add(weights, source, mesh, bind.get("index"), bind.get("weight", 1.0), 1.0)
            faces[name] = weights
    return found, {name: weights for name, weights in faces.items() if weights}


def _vrm0(vrm: dict[str, Any], source: GltfSource) -> tuple[dict[str, int], dict[str, dict[str, float]]]:
    found: dict[str, int] = {}
    for bone in _members(vrm.get("humanoid"), "humanBones"):
        name, node = bone.get("bone"), _bone(bone.get("node"), source)
        if not isinstance(name, str) or node is None:
            continue
        part = name
        for side in ("left", "right"):
            if name.startswith(side):
                part = side + THUMBS_OF_VRM0.get(name[len(side) :], name[len(side) :])
        found[part] = node
    faces: dict[str, dict[str, float]] = {}
    for group in _members(vrm.get("blendShapeMaster"), "blendShapeGroups"):
        preset, own = group.get("presetName"), group.get("name")
        name = PRESETS_OF_VRM0.get(str(preset).lower()) or PRESETS_OF_VRM0.get(str(own).lower()) or str(own or preset)
        weights: dict[str, float] = {}
        for bind in _members(group, "binds"):
            mesh = bind.get("mesh")
            inside = isinstance(mesh, int) and 0 <= mesh < len(source.gltf.meshes)
            _add(weights, source, mesh if inside else None, bind.get("index"), bind.get("weight", 100.0), 0.01)
        if weights:
            faces[name] = weights
    return found, faces


def _add(
    weights: dict[str, float], source: GltfSource, mesh: int | None, index: object, weight: object, unit: float
) -> None:
    """Add a bind of a VRM expression (morph ``index`` of a mesh, with a weight) to ``weights`` by morph name.

    Invalid binds are ignored, as viewers do. ``unit`` converts the weight to 0..1.
    """
    share = _number(weight)
    if mesh is None or share is None or not source.gltf.meshes[mesh].primitives:
        return
    morphs = source.gltf.meshes[mesh].primitives[0].morphs
    if isinstance(index, int) and not isinstance(index, bool) and 0 <= index < len(morphs):
        name = morph_name(source, mesh, morphs[index].name)
        weights[name] = min(max(share * unit, weights.get(name, 0.0), 0.0), 1.0)
