"""Bundled characters in the form of other programs: bones with other axes and names, another rest pose, other units.
The files are written by this module or by the program's FBX writer; reading them must give the original character.

The files are written by hand or by our own FBX writer; what is read back must be the character they were made from.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from app.formats.fbx.write import write_scene
from app.formats.scene import Bone, Material, MorphTarget, Scene, SkinnedMesh
from app.rig import quaternion
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.skeleton import forward
from app.rig.skinning import patch
from tests.support.deformed import deform

VRM0_THUMBS = {"ThumbMetacarpal": "ThumbProximal", "ThumbProximal": "ThumbIntermediate"}


@dataclass(frozen=True, eq=False)
class Foreign:
    """A character as stored in a foreign file.

    Attributes
    ----------
    names : list of str
    parents : list of int
    world : (B, 4, 4)
        At rest, no scales.
    joints : dict of str to int
    meshes : list of Mesh
        In the world at rest; joints are bones.
    """

    names: list[str]
    parents: list[int]
    world: np.ndarray
    joints: dict[str, int]
    meshes: list[Mesh] = field(default_factory=list)


def still(character: Character) -> np.ndarray:
    """No rotation of any joint, (1, J, 4)."""
    return np.tile(quaternion.IDENTITY, (1, len(character.skeleton.names), 1))


def own_axes(character: Character, seed: int) -> np.ndarray:
    """Axes ``joint_from_bone`` (J, 4) of the bones: in fingers the Y axis points to the next bone, elsewhere the axes
    are random.
    """
    skeleton = character.skeleton
    turns = Rotation.random(len(skeleton.names), random_state=np.random.default_rng(seed)).as_quat()
    for joint, name in enumerate(skeleton.names):
        if name.endswith(("Proximal", "Intermediate", "Distal", "Metacarpal")):
            thumb = "Thumb" in name
            sign = 1.0 if name.startswith("left") else -1.0
            way = np.array([sign, 0.0, 1.0]) / np.sqrt(2.0) if thumb else np.array([sign, 0.0, 0.0])
            turns[joint] = quaternion.between(np.array([0.0, 1.0, 0.0]), way)
    return turns


def foreign(
    character: Character,
    pose: np.ndarray | None = None,
    seed: int = 1,
    rename: Callable[[str], str] = lambda name: f"Bip_{name}",
    extra: bool = True,
) -> Foreign:
    """Convert a character to the form of another program.

    Parameters
    ----------
    character : Character
    pose : (1, J, 4), optional
        Its rest pose, into which its skin is baked; the pose it was bound in where absent.
    seed : int
        Of the bones' own axes.
    rename : callable
    extra : bool
        With a twist bone in each upper arm, which takes a part of its skin, and bones of hair on the head.
    """
    skeleton = character.skeleton
    axes = own_axes(character, seed)
    if pose is None:
        world = np.linalg.inv(character.joint_from_mesh)
    else:
        transforms = forward(skeleton, pose)
        world = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
        world[:, :3] = transforms.matrices()[0]
    turn = np.tile(np.eye(4), (len(world), 1, 1))
    turn[:, :3, :3] = quaternion.to_matrix(axes)
    world = world @ turn
    names = [rename(name) for name in skeleton.names]
    parents = list(skeleton.parents)
    meshes = []
    for mesh in character.meshes:
        places = mesh.positions_m
        if pose is not None:
            places = deform(patch(character, mesh, np.arange(len(places))), forward(skeleton, pose))[0]
        meshes.append(_with(mesh, positions_m=places.astype(np.float32)))
    if extra:
        for above in ("leftUpperArm", "rightUpperArm", "head"):
            bone = skeleton.index(above)
            place = world[bone].copy()
            place[:3, :3] = Rotation.random(random_state=np.random.default_rng(seed + bone)).as_matrix()
            world = np.concatenate([world, place[None]])
            names.append("hair_01" if above == "head" else f"{rename(above)}_twist")
            parents.append(bone)
            meshes = [_shared(mesh, bone, len(names) - 1) for mesh in meshes]
    joints = {name: joint for joint, name in enumerate(skeleton.names) if name != "root"}
    return Foreign(names, parents, world, joints, meshes)


def _with(mesh: Mesh, **values: Any) -> Mesh:
    return Mesh(**{**{name: getattr(mesh, name) for name in Mesh.__dataclass_fields__}, **values})


def _shared(mesh: Mesh, bone: int, twin: int) -> Mesh:
    """Transfer a third of each vertex's weight for a bone to the bone's twin."""
    own = np.where(mesh.joints == bone, mesh.weights, 0.0)
    joints = np.concatenate([mesh.joints, np.full((len(mesh.joints), 1), twin, np.int32)], axis=1)
    weights = np.concatenate([mesh.weights - own / 3.0, own.sum(axis=1, keepdims=True) / 3.0], axis=1)
    return _with(mesh, joints=joints, weights=weights.astype(np.float32))


# --------------------------------------------------------------------------------------------------------------- glTF


def write_glb(
    path: Path,
    figure: Foreign,
    *,
    vrm: int | None = None,
    scale: float = 1.0,
    expressions: Mapping[str, Mapping[str, float]] | None = None,
    rigid: bool = False,
    image: bytes = b"",
    alpha: str = "OPAQUE",
) -> Path:
    """Write a figure as a glTF binary.

    Parameters
    ----------
    path : Path
    figure : Foreign
    vrm : int, optional
        With the extension of VRM 0.x or 1.0; a figure of 0.x faces -Z.
    scale : float
        Bones hang from a node "Armature" of this scale, and are the larger for it.
    expressions : mapping, optional
        By the names of their version; weights of morphs.
    rigid : bool
        Without a skin: each vertex in a mesh of the bone that holds most of it, which hangs from that bone.
    image : bytes
        The file of a texture for all surfaces.
    alpha : str
        Their alpha mode.
    """
    writer = _Glb()
    about = np.diag([-1.0, 1.0, -1.0, 1.0]) if vrm == 0 else np.eye(4)
    armature = about @ np.diag([scale, scale, scale, 1.0])
    grown = np.diag([1.0 / scale] * 3 + [1.0])
    nodes: list[dict[str, Any]] = [{"name": "Armature", "scale": [scale] * 3, "children": []}]
    if vrm == 0:
        nodes[0]["rotation"] = [0.0, 1.0, 0.0, 0.0]
    unscaled = np.linalg.inv(np.diag([scale] * 3 + [1.0])) @ figure.world @ np.linalg.inv(grown)
    for bone, name in enumerate(figure.names):
        parent = figure.parents[bone]
        local = np.linalg.inv(unscaled[parent]) @ unscaled[bone] if parent >= 0 else unscaled[bone]
        nodes[parent + 1].setdefault("children", []).append(len(nodes))
        nodes.append(
            {
                "name": name,
                "translation": local[:3, 3].tolist(),
                "rotation": quaternion.from_matrix(local[:3, :3]).tolist(),
            }
        )
    binds = np.linalg.inv(armature @ unscaled) @ about
    skin = {"joints": list(range(1, len(nodes))), "inverseBindMatrices": writer.floats(_columns(binds), "MAT4")}
    meshes, tops = [], [0]
    for bone, mesh in _pieces(figure) if rigid else ():
        meshes.append(_gltf_mesh(writer, _with(mesh, positions_m=_local(unscaled[bone], scale, mesh.positions_m))))
        nodes[bone + 1].setdefault("children", []).append(len(nodes))
        nodes.append({"name": mesh.name, "mesh": len(meshes) - 1})
    for mesh in () if rigid else figure.meshes:
        meshes.append(_gltf_mesh(writer, mesh))
        tops.append(len(nodes))
        nodes.append({"name": mesh.name, "mesh": len(meshes) - 1, "skin": 0})
    document: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": tops}],
        "nodes": nodes,
        "meshes": meshes,
        **({} if rigid else {"skins": [skin]}),
        "materials": [{"name": "plain", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.4, 0.3, 1.0]}}],
    }
    if image:
        document |= {"images": [{"bufferView": writer.blob(image), "mimeType": "image/png"}]}
        document |= {"textures": [{"source": 0}]}
        document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
        document["materials"][0]["alphaMode"] = alpha
    if vrm is not None:
        document |= _vrm(vrm, figure, expressions or {})
    writer.write(path, document)
    return path


def _pieces(figure: Foreign) -> list[tuple[int, Mesh]]:
    """Divide each mesh by the bone with the greatest weight; triangles follow their first corner."""
    found = []
    for mesh in figure.meshes:
        best = np.argmax(mesh.weights, axis=1)
        holders = np.take_along_axis(mesh.joints, best[:, None], axis=1)[:, 0]
        for bone in np.unique(holders):
            own = holders[mesh.triangles[:, 0]] == bone
            if own.any():
                kept = _with(
                    mesh,
                    name=f"{mesh.name}_{bone}",
                    triangles=mesh.triangles[own],
                    triangle_materials=mesh.triangle_materials[own],
                    joints=np.zeros((len(mesh.joints), 0), np.int32),
                    weights=np.zeros((len(mesh.joints), 0), np.float32),
                    morphs=(),
                )
                found.append((int(bone), kept))
    return found


def _local(bone: np.ndarray, scale: float, places_m: np.ndarray) -> np.ndarray:
    """Convert world positions to the space of a bone below an armature with a scale."""
    inverse = np.linalg.inv(bone)
    return (places_m / scale) @ inverse[:3, :3].T + inverse[:3, 3]


def _columns(matrices: np.ndarray) -> np.ndarray:
    return matrices.transpose(0, 2, 1).reshape(len(matrices), 16)


def _vrm(version: int, figure: Foreign, expressions: Mapping[str, Mapping[str, float]]) -> dict[str, Any]:
    if version == 1:
        bones = {name: {"node": bone + 1} for name, bone in figure.joints.items()}
        return {"extensionsUsed": ["VRMC_vrm"], "extensions": {"VRMC_vrm": {"humanoid": {"humanBones": bones}}}}
    listed = []
    for name, bone in figure.joints.items():
        side = next((side for side in ("left", "right") if name.startswith(side)), "")
        listed.append({"bone": side + VRM0_THUMBS.get(name[len(side) :], name[len(side) :]), "node": bone + 1})
    groups = []
    for name, weights in expressions.items():
        binds = [
            {"mesh": number, "index": [morph.name for morph in mesh.morphs].index(morph_name), "weight": 100.0 * weight}
            for number, mesh in enumerate(figure.meshes)
            for morph_name, weight in weights.items()
            if morph_name in [morph.name for morph in mesh.morphs]
        ]
        groups.append({"name": name.upper(), "presetName": name, "binds": binds})
    vrm = {"humanoid": {"humanBones": listed}, "blendShapeMaster": {"blendShapeGroups": groups}}
    return {"extensionsUsed": ["VRM"], "extensions": {"VRM": vrm}}


def _gltf_mesh(writer: _Glb, mesh: Mesh) -> dict[str, Any]:
    attributes = {
        "POSITION": writer.floats(mesh.positions_m, "VEC3"),
        "NORMAL": writer.floats(mesh.normals, "VEC3"),
        "TEXCOORD_0": writer.floats(mesh.uvs, "VEC2"),
    }
    sets = -(-mesh.joints.shape[1] // 4)
    joints = np.zeros((len(mesh.joints), 4 * sets), np.uint16)
    weights = np.zeros((len(mesh.joints), 4 * sets), np.float32)
    joints[:, : mesh.joints.shape[1]], weights[:, : mesh.joints.shape[1]] = mesh.joints, mesh.weights
    for number in range(sets):
        part = slice(4 * number, 4 * number + 4)
        attributes[f"JOINTS_{number}"] = writer.add(np.ascontiguousarray(joints[:, part]), 5123, "VEC4")
        attributes[f"WEIGHTS_{number}"] = writer.floats(np.ascontiguousarray(weights[:, part]), "VEC4")
    targets = []
    for morph in mesh.morphs:
        moved = np.zeros((len(mesh.positions_m), 3), np.float32)
        moved[morph.vertices] = morph.deltas_m
        targets.append({"POSITION": writer.floats(moved, "VEC3")})
    primitives = [
        {
            "attributes": attributes,
            "indices": writer.add(mesh.triangles[mesh.triangle_materials == surface].astype(np.uint32), 5125, "SCALAR"),
            "material": 0,
            **({"targets": targets} if targets else {}),
        }
        for surface in np.unique(mesh.triangle_materials)
    ]
    return {
        "name": mesh.name,
        "primitives": primitives,
        "extras": {"targetNames": [morph.name for morph in mesh.morphs]},
    }


class _Glb:
    """Buffers of a binary glTF file."""

    def __init__(self) -> None:
        self._blobs: list[bytes] = []
        self._accessors: list[dict[str, Any]] = []

    def floats(self, values: np.ndarray, kind: str) -> int:
        return self.add(np.ascontiguousarray(values, dtype=np.float32), 5126, kind)

    def add(self, values: np.ndarray, component: int, kind: str) -> int:
        count = values.size if kind == "SCALAR" else len(values)
        self._accessors.append(
            {"bufferView": len(self._blobs), "componentType": component, "count": count, "type": kind}
        )
        self.blob(values.tobytes())
        return len(self._accessors) - 1

    def blob(self, data: bytes) -> int:
        """Add a buffer view and return its index."""
        self._blobs.append(data + b"\0" * (-len(data) % 4))
        return len(self._blobs) - 1

    def write(self, path: Path, document: dict[str, Any]) -> None:
        starts = np.cumsum([0, *map(len, self._blobs)])
        document["buffers"] = [{"byteLength": int(starts[-1])}]
        document["bufferViews"] = [
            {"buffer": 0, "byteOffset": int(start), "byteLength": len(blob)}
            for start, blob in zip(starts[:-1], self._blobs, strict=True)
        ]
        document["accessors"] = self._accessors
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        binary = b"".join(self._blobs)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


# ---------------------------------------------------------------------------------------------------------------- FBX


def write_fbx(path: Path, figure: Foreign) -> Path:
    """Write a figure as a binary FBX file in centimetres."""
    world = figure.world.copy()
    world[:, :3, 3] *= 100.0
    bones = []
    for bone, name in enumerate(figure.names):
        parent = figure.parents[bone]
        local = np.linalg.inv(world[parent]) @ world[bone] if parent >= 0 else world[bone]
        bones.append(Bone(name, parent, local[:3, 3], quaternion.from_matrix(local[:3, :3])))
    meshes = [
        SkinnedMesh(
            name=f"{mesh.name}_mesh",
            vertices_cm=mesh.positions_m * 100.0,
            faces=mesh.triangles,
            normals=mesh.normals,
            uvs=None,
            materials=(Material("plain", (0.5, 0.4, 0.3, 1.0)),),
            face_materials=None,
            joint_indices=mesh.joints,
            weights=mesh.weights,
            world_from_bone_bind=world,
            morphs=tuple(MorphTarget(morph.name, morph.vertices, morph.deltas_m * 100.0) for morph in mesh.morphs),
        )
        for mesh in figure.meshes
    ]
    write_scene(path, Scene(tuple(bones), tuple(meshes)))
    return path
