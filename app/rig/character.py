"""Loading characters: our own glTF binaries as they are, everybody else's as figures (`app.rig.figure_character`).

In our own, rest rotations are removed: joint frames become parallel to the world, the bind pose stays what it was.

Messages
--------
model.invalid
    See `app.rig.source`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from app.rig.face_map import FaceMapping, map_morphs
from app.rig.figure import Figure
from app.rig.figure_character import figure_character
from app.rig.humanoid import JointMapping, map_joints
from app.rig.landmarks import found_landmarks
from app.rig.mesh import Mesh
from app.rig.model import Character, Landmark, Skeleton
from app.rig.read_figure import read_figure
from app.rig.source import Source, build_mesh, invalid, moved_mesh, read_source
from app.rig.t_pose import facing_ahead, upright
from metadata.model import REQUIRED_JOINTS

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Reading:
    """A figure and what of it is what.

    Attributes
    ----------
    figure : Figure
        Upright, facing +Z.
    joints : JointMapping
    face : FaceMapping
    """

    figure: Figure
    joints: JointMapping
    face: FaceMapping


def load_character(
    path: Path,
    id: str = "",
    joints: Mapping[str, str] | None = None,
    morphs: Mapping[str, Mapping[str, float]] | None = None,
) -> Character:
    """Load a character from a file: VRM, glTF or FBX.

    Parameters
    ----------
    path : Path
    id : str
        The character's; by the file's name where empty.
    joints : mapping of str to str
        By VRM 1.0 joint: the bone that is it, whatever its name suggests; empty: none is.
    morphs : mapping of str to mapping of str to float
        By ARKit name: weights of the file's own morphs that make it.

    Raises
    ------
    FileError
        The file cannot be read, or holds no humanoid that can play.
    """
    try:
        if path.suffix.lower() == ".glb":
            source = read_source(path)
            if _extras(source):
                return _build(source, id or path.stem)
        reading = read_character(path, joints, morphs)
        return figure_character(reading.figure, id or path.stem, reading.joints.bones, reading.face.morphs)
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise invalid(path, f"damaged: {error!r}") from error


def read_character(
    path: Path, joints: Mapping[str, str] | None = None, morphs: Mapping[str, Mapping[str, float]] | None = None
) -> Reading:
    """Read a figure and find out what of it is what. Raises FileError; a figure that lacks joints raises none.

    Parameters
    ----------
    path : Path
    joints, morphs : mapping
        A person's corrections, as in `load_character`.
    """
    figure = read_figure(path)
    found = map_joints(figure, joints)
    if set(REQUIRED_JOINTS) <= set(found.bones):
        facing = facing_ahead(upright(figure, found.bones), found.bones)
        if facing is not figure:
            # Which side is left depends on where ahead is.
            figure, found = facing, map_joints(facing, joints)
    return Reading(figure, found, map_morphs(figure, morphs))


def _build(source: Source, id: str) -> Character:
    skeleton, joint_of, world_from_node = _skeleton(source)
    missing = [name for name in REQUIRED_JOINTS if name not in skeleton.names]
    if missing:
        raise invalid(source.file, f"not a humanoid; missing: {', '.join(missing)}")
    count = len(skeleton.names)
    # joint_from_mesh of a joint no skin names: as if bound at rest.
    joint_from_mesh = np.tile(np.eye(4), (count, 1, 1))
    joint_from_mesh[:, :3, 3] = -np.array([_position(skeleton, joint) for joint in range(count)])
    bound = np.zeros(count, dtype=bool)
    meshes = []
    for node, entry in enumerate(source.gltf.nodes):
        if entry.mesh is None:
            continue
        name = source.gltf.meshes[entry.mesh].name or entry.name or f"mesh_{entry.mesh}"
        mesh, skinned = build_mesh(source, entry.mesh, name)
        if skinned and entry.skin is not None:
            meshes.append(_skinned(source, entry.skin, mesh, joint_of, world_from_node, joint_from_mesh, bound))
        else:
            meshes.append(_rigid(source, node, mesh, joint_of, joint_from_mesh, skeleton))
    extras = _extras(source)
    marks = {
        name: Landmark(place["mesh"], np.asarray(place["vertices"], dtype=np.int32))
        for name, place in extras.get("landmarks", {}).items()
    }
    if not marks:
        marks = found_landmarks(skeleton, joint_from_mesh, tuple(meshes))
    return Character(id, skeleton, joint_from_mesh, tuple(meshes), marks)


def _skeleton(source: Source) -> tuple[Skeleton, dict[int, int], dict[int, FloatArray]]:
    """Return the normalised skeleton, the joint of each node that is one, and the rest transforms of those nodes."""
    nodes = source.gltf.nodes
    bones = source.gltf.extensions.get("VRMC_vrm", {}).get("humanoid", {}).get("humanBones", {})
    names = {bone["node"]: name for name, bone in bones.items()}
    chosen = set(names)
    for skin in source.gltf.skins:
        chosen.update(skin.joints)
    for node, entry in enumerate(nodes):
        if not names and entry.name in REQUIRED_JOINTS:
            chosen.add(node)
    tops = [node for node in sorted(chosen) if _joint_above(source, node, chosen) < 0]
    titles = {node: names.get(node) or nodes[node].name or f"joint_{node}" for node in chosen}
    has_root = len(tops) == 1 and titles[tops[0]] == "root"
    # Children follow their parent closely (depth first), as a person would list them.
    children: dict[int, list[int]] = {}
    for node in sorted(chosen):
        children.setdefault(_joint_above(source, node, chosen), []).append(node)
    listed: list[int] = []
    pending = list(reversed(children.get(-1, [])))
    while pending:
        node = pending.pop()
        listed.append(node)
        pending.extend(reversed(children.get(node, [])))
    shift = 0 if has_root else 1
    joint_of = {node: index + shift for index, node in enumerate(listed)}
    rest = {node: source.world_from_node[node] for node in listed}
    all_names = [] if has_root else ["root"]
    parents = [] if has_root else [-1]
    offsets = [] if has_root else [np.zeros(3)]
    for node in listed:
        above = _joint_above(source, node, chosen)
        all_names.append(titles[node])
        parents.append(joint_of[above] if above >= 0 else (-1 if has_root else 0))
        offsets.append(rest[node][:3, 3] - (rest[above][:3, 3] if above >= 0 else 0.0))
    if len(set(all_names)) != len(all_names):
        raise invalid(source.file, "two joints share a name")
    return Skeleton(tuple(all_names), tuple(parents), np.array(offsets, dtype=np.float64)), joint_of, rest


def _joint_above(source: Source, node: int, chosen: set[int]) -> int:
    node = source.gltf.nodes[node].parent
    while node >= 0 and node not in chosen:
        node = source.gltf.nodes[node].parent
    return node


def _skinned(
    source: Source,
    skin: int,
    mesh: Mesh,
    joint_of: dict[int, int],
    world_from_node: dict[int, FloatArray],
    joint_from_mesh: FloatArray,
    bound: npt.NDArray[np.bool_],
) -> Mesh:
    """Take a skinned mesh into the character's joints; fills ``joint_from_mesh`` of joints that were not bound yet."""
    nodes = source.gltf.skins[skin].joints
    inverse = source.gltf.skins[skin].joint_from_mesh_bind
    table = np.array([joint_of[node] for node in nodes], dtype=np.int32)
    basis = np.array([world_from_node[node] for node in nodes])
    basis[:, :3, 3] = 0.0
    # The joint's new frame is parallel to the world, so what turned it at rest moves into the bind matrix.
    inverse = basis @ inverse
    weights = mesh.weights / np.maximum(mesh.weights.sum(axis=1, keepdims=True), 1e-9)
    joints = table[mesh.joints]
    change = np.eye(4)
    used = np.unique(mesh.joints[mesh.weights > 0.0])
    known = [place for place in used if bound[table[place]]]
    if known:
        # Another skin has bound this joint: the same pose up to the mesh's own space, or it cannot be one character.
        change = np.linalg.solve(joint_from_mesh[table[known[0]]], inverse[known[0]])
        for place in known:
            if np.abs(joint_from_mesh[table[place]] @ change - inverse[place]).max() > 1e-4:
                raise invalid(source.file, f"mesh '{mesh.name}' is bound in another pose than the others")
    back = np.linalg.inv(change)
    fresh = np.flatnonzero(~bound[table])
    joint_from_mesh[table[fresh]] = inverse[fresh] @ back
    bound[table[fresh]] = True
    return moved_mesh(mesh, change, joints, weights.astype(np.float32))


def _rigid(
    source: Source,
    node: int,
    mesh: Mesh,
    joint_of: dict[int, int],
    joint_from_mesh: FloatArray,
    skeleton: Skeleton,
) -> Mesh:
    """Bind a mesh that hangs from a node to the joint above it."""
    above = node if node in joint_of else _joint_above(source, node, set(joint_of))
    joint = joint_of.get(above, 0)
    world_from_joint = np.eye(4)
    world_from_joint[:3, 3] = _position(skeleton, joint)
    change = np.linalg.solve(world_from_joint @ joint_from_mesh[joint], source.world_from_node[node])
    joints = np.full((len(mesh.positions_m), 1), joint, dtype=np.int32)
    return moved_mesh(mesh, change, joints, np.ones((len(mesh.positions_m), 1), dtype=np.float32))


def _position(skeleton: Skeleton, joint: int) -> FloatArray:
    place = np.zeros(3)
    while joint >= 0:
        place = place + skeleton.offsets_m[joint]
        joint = skeleton.parents[joint]
    return place


def _extras(source: Source) -> dict[str, Any]:
    """Return what we wrote beside the scene, or on its first node; empty in a file of another program."""
    first = source.gltf.nodes[0].extras if source.gltf.nodes else {}
    for holder in (source.gltf.scene_extras, first):
        found = holder.get("suisou")
        if found is not None:
            content: dict[str, Any] = json.loads(found) if isinstance(found, str) else found
            return content
    return {}
