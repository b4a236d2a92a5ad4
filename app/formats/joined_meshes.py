"""Joining of several meshes into one.

If several meshes of a file share morph names, there are several curves of one name: Unreal drives them all, but
programs that identify weights by name see duplicates, and three.js copies every bone for each mesh. One mesh with
several materials avoids this.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, AnyIntArray
from app.formats.scene import Material, MorphTarget, SkinnedMesh

Number = TypeVar("Number", bound=np.generic)


def join_meshes(meshes: Sequence[SkinnedMesh], name: str) -> SkinnedMesh:
    """Return one mesh with the vertices of all meshes in the given order.

    Parameters
    ----------
    meshes : sequence of SkinnedMesh
        At least one mesh; all with equal polygon sizes and the same bind pose.

    Returns
    -------
    SkinnedMesh
        Vertex v of a mesh becomes v plus the vertex counts of the meshes before it. Equal materials, and morphs of one
        name, are merged. Normals are per vertex if all were. If only some meshes have UVs, the others get zeros.
    """
    counts = [len(mesh.vertices_cm) for mesh in meshes]
    starts = (np.cumsum(counts) - counts).tolist()
    materials: dict[Material, int] = {}
    for mesh in meshes:
        for material in mesh.materials:
            materials.setdefault(material, len(materials))
    width = max(mesh.joint_indices.shape[1] for mesh in meshes)
    by_corner = any(len(mesh.normals) != len(mesh.vertices_cm) for mesh in meshes)
    uvs_by_corner = any(mesh.uvs is not None and len(mesh.uvs) != len(mesh.vertices_cm) for mesh in meshes)
    return SkinnedMesh(
        name=name,
        vertices_cm=np.concatenate([mesh.vertices_cm for mesh in meshes]),
        faces=np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]),
        normals=np.concatenate([_spread(mesh, mesh.normals, by_corner) for mesh in meshes]),
        uvs=None
        if all(mesh.uvs is None for mesh in meshes)
        else np.concatenate([_uvs(mesh, uvs_by_corner) for mesh in meshes]),
        materials=tuple(materials),
        face_materials=np.concatenate([_face_materials(mesh, materials) for mesh in meshes]),
        joint_indices=np.concatenate([_widened(mesh.joint_indices, width) for mesh in meshes]),
        weights=np.concatenate([_widened(mesh.weights, width) for mesh in meshes]),
        world_from_bone_bind=meshes[0].world_from_bone_bind,
        morphs=_morphs(meshes, starts),
    )


def _spread(mesh: SkinnedMesh, values: AnyFloatArray, by_corner: bool) -> AnyFloatArray:
    return values[mesh.faces.ravel()] if by_corner and len(values) == len(mesh.vertices_cm) else values


def _uvs(mesh: SkinnedMesh, by_corner: bool) -> AnyFloatArray:
    return _spread(mesh, np.zeros((len(mesh.vertices_cm), 2)) if mesh.uvs is None else mesh.uvs, by_corner)


def _face_materials(mesh: SkinnedMesh, materials: dict[Material, int]) -> AnyIntArray:
    own = np.zeros(len(mesh.faces), dtype=np.int64) if mesh.face_materials is None else mesh.face_materials
    return np.array([materials[material] for material in mesh.materials])[own]


def _widened(values: npt.NDArray[Number], width: int) -> npt.NDArray[Number]:
    return np.pad(values, ((0, 0), (0, width - values.shape[1])))


def _morphs(meshes: Sequence[SkinnedMesh], starts: Sequence[int]) -> tuple[MorphTarget, ...]:
    parts: dict[str, list[tuple[MorphTarget, int]]] = {}
    for mesh, start in zip(meshes, starts, strict=True):
        for morph in mesh.morphs:
            parts.setdefault(morph.name, []).append((morph, start))
    return tuple(_joined_morph(name, morphs) for name, morphs in parts.items())


def _joined_morph(name: str, parts: Sequence[tuple[MorphTarget, int]]) -> MorphTarget:
    normals = [
        np.zeros_like(morph.position_deltas_cm) if morph.normal_deltas is None else morph.normal_deltas
        for morph, _ in parts
    ]
    return MorphTarget(
        name,
        np.concatenate([morph.vertex_indices + start for morph, start in parts]),
        np.concatenate([morph.position_deltas_cm for morph, _ in parts]),
        np.concatenate(normals) if any(morph.normal_deltas is not None for morph, _ in parts) else None,
    )
