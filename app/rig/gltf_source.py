"""Reading of nodes at rest and meshes (joined by material) from a glTF file, for characters and instruments."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, SingleArray
from app.errors import FileError
from app.formats.gltf.model import GltfModel, GltfNode, GltfPrimitive
from app.formats.gltf.read import read_glb
from app.formats.gltf.read_materials import scene_materials
from app.formats.scene import Material
from app.rig import quaternion
from app.rig.mesh import Mesh, Morph

OURS: Final = "Suisou build_characters"
"""Generator name in bundled characters. A modified file contains another name and other vertices."""
PLAIN: Final = Material("default", (1.0, 1.0, 1.0, 1.0), 0.0, 1.0)
"""Material of surfaces without a material."""


@dataclass(frozen=True, eq=False)
class GltfSource:
    """A glTF file and each node's rest transform.

    Attributes
    ----------
    world_from_node : (N, 4, 4) float64
        World transforms of the N nodes at rest.
    """

    file: str
    gltf: GltfModel
    world_from_node: FloatArray

    @cached_property
    def materials(self) -> tuple[Material, ...]:
        """Materials of the glTF file, with those textures that could be read."""
        return scene_materials(self.gltf, own=self.gltf.generator == OURS)


def read_source(path: Path, *, animated: bool = False) -> GltfSource:
    """Read a glTF binary, with its animations if requested. Raises FileError."""
    gltf = read_glb(path, animated=animated)
    return GltfSource(str(path), gltf, _world(gltf.nodes))


def invalid(path: Path | str, detail: str) -> FileError:
    """Return the error for a file whose content cannot be used; ``detail`` describes the fault."""
    return FileError("model.invalid", file=str(path), detail=detail)


def build_mesh(source: GltfSource, index: int, name: str) -> tuple[Mesh, bool]:
    """Return a mesh of a glTF file, joined from its primitives, and whether it is skinned.

    Shared vertices of primitives stay shared, so that vertex indices of the file remain valid.
    """
    primitives = source.gltf.meshes[index].primitives
    blocks: list[tuple[int, GltfPrimitive]] = []
    starts: list[int] = []
    # Primitives with the same positions share their joints.
    alone = len({id(primitive.positions) for primitive in primitives}) == 1
    known: dict[bytes, int] = {}
    digests: dict[int, bytes] = {}
    count = 0
    for primitive in primitives:
        own = id(primitive.positions)
        if own not in digests:
            digests[own] = b"" if alone else _digest(primitive)
        digest = digests[own]
        if digest not in known:
            blocks.append((count, primitive))
            known[digest], count = count, count + len(primitive.positions)
        starts.append(known[digest])
    width = max((part.joint_indices.shape[1] for _, part in blocks), default=0)
    positions, normals = np.zeros((count, 3), np.float32), np.zeros((count, 3), np.float32)
    uvs = np.zeros((count, 2), np.float32)
    joints, weights = np.zeros((count, max(width, 1)), np.int32), np.zeros((count, max(width, 1)), np.float32)
    morphs: dict[str, list[tuple[int, GltfPrimitive, int]]] = {}
    for start, part in blocks:
        span = slice(start, start + len(part.positions))
        positions[span] = part.positions
        if part.normals is not None:
            normals[span] = part.normals
        if part.uvs is not None:
            uvs[span] = part.uvs
        joints[span, : part.joint_indices.shape[1]] = part.joint_indices
        weights[span, : part.weights.shape[1]] = part.weights
        for order, morph in enumerate(part.morphs):
            morphs.setdefault(morph.name, []).append((start, part, order))
    owners = np.repeat(np.arange(len(primitives)), [len(part.triangles) for part in primitives])
    triangles = [part.triangles + start for part, start in zip(primitives, starts, strict=True)]
    mesh = Mesh(
        name=name,
        positions_m=positions,
        normals=normals,
        uvs=uvs,
        triangles=np.concatenate([np.zeros((0, 3), np.int64), *triangles]).astype(np.int32),
        triangle_materials=owners.astype(np.int32),
        materials=tuple(PLAIN if part.material is None else source.materials[part.material] for part in primitives),
        joints=joints,
        weights=weights,
        morphs=tuple(_morph(title, parts) for title, parts in morphs.items()),
    )
    return mesh, width > 0


def moved_mesh(mesh: Mesh, change: FloatArray, joints: npt.NDArray[np.int32], weights: SingleArray) -> Mesh:
    """Return a mesh with its vertices transformed by the matrix ``change`` (4, 4), and with other skinning."""
    values = {field: getattr(mesh, field) for field in Mesh.__dataclass_fields__}
    values.update(joints=joints, weights=weights)
    if np.abs(change - np.eye(4)).max() > 1e-9:
        turn = change[:3, :3]
        across = np.linalg.inv(turn).T
        values["positions_m"] = (mesh.positions_m @ turn.T + change[:3, 3]).astype(np.float32)
        normals = mesh.normals @ across.T
        values["normals"] = (normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)).astype(
            np.float32
        )
        values["morphs"] = tuple(
            type(morph)(morph.name, morph.vertices, (morph.deltas_m @ turn.T).astype(np.float32), morph.normal_deltas)
            for morph in mesh.morphs
        )
    return Mesh(**values)


def _digest(primitive: GltfPrimitive) -> bytes:
    """Return a digest that is equal for primitives with the same vertices."""
    digest = hashlib.blake2b(str(primitive.joint_indices.shape).encode(), digest_size=16)
    digest.update(primitive.positions.tobytes())
    digest.update(primitive.joint_indices.tobytes())
    return digest.digest()


def _morph(name: str, parts: list[tuple[int, GltfPrimitive, int]]) -> Morph:
    targets = [(start, part.morphs[order]) for start, part, order in parts]
    turned = [target.normal_deltas for _, target in targets if target.normal_deltas is not None]
    return Morph(
        name=name,
        vertices=np.concatenate([target.vertex_indices + start for start, target in targets]).astype(np.int32),
        deltas_m=np.concatenate([target.position_deltas for _, target in targets]).astype(np.float32),
        normal_deltas=np.concatenate(turned).astype(np.float32) if len(turned) == len(targets) else None,
    )


def _world(nodes: tuple[GltfNode, ...]) -> FloatArray:
    """Return the transforms (N, 4, 4) of all glTF nodes in the world at rest."""
    world = np.tile(np.eye(4), (len(nodes), 1, 1))
    done = [False] * len(nodes)
    for index in range(len(nodes)):
        chain = []
        node = index
        while node >= 0 and not done[node]:
            chain.append(node)
            node = nodes[node].parent
        for node in reversed(chain):
            entry = nodes[node]
            local = np.eye(4)
            local[:3, :3] = quaternion.to_matrix(quaternion.normalize(entry.rotation_xyzw)) * entry.scale
            local[:3, 3] = entry.translation
            world[node] = world[entry.parent] @ local if entry.parent >= 0 else local
            done[node] = True
    return world
