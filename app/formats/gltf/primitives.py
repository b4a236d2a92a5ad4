"""Conversion of meshes of a scene to glTF primitives: triangles of one material with one normal per vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray
from app.formats.scene import SkinnedMesh


@dataclass(frozen=True, eq=False)
class Primitive:
    """The faces of a mesh that have one material, as glTF needs them.

    Attributes
    ----------
    material : int
        Index into the mesh's materials.
    vertices : ndarray of int, shape (V,)
        Index in the mesh of each vertex of the primitive, in the mesh's order; repeated if corners differ in normal or
        UV.
    normals : ndarray, shape (V, 3)
        Normals of unit length.
    uvs : ndarray, shape (V, 2), or None
        Texture coordinates; v points down.
    triangles : ndarray of int, shape (T, 3)
        Indices of the primitive's vertices.
    """

    material: int
    vertices: AnyIntArray
    normals: AnyFloatArray
    uvs: AnyFloatArray | None
    triangles: AnyIntArray


def primitives(mesh: SkinnedMesh) -> tuple[Primitive, ...]:
    """Split a mesh into glTF primitives: one for each material that has faces, with only the vertices used there."""
    faces, corners = len(mesh.faces), mesh.faces.shape[1]
    own = np.zeros(faces, dtype=np.int64) if mesh.face_materials is None else mesh.face_materials
    result = []
    for material in range(len(mesh.materials)):
        chosen = np.flatnonzero(own == material)
        if len(chosen):
            # Each polygon becomes a fan of triangles, given by indices into all corners of the mesh.
            first = chosen[:, None] * corners
            fan = [np.concatenate([first, first + k, first + k + 1], axis=1) for k in range(1, corners - 1)]
            result.append(_primitive(mesh, material, np.stack(fan, axis=1).reshape(-1, 3)))
    return tuple(result)


def _primitive(mesh: SkinnedMesh, material: int, triangles: AnyIntArray) -> Primitive:
    """Return the primitive of those triangles of the mesh that have a material; they are given by corner indices."""
    places = triangles.ravel()
    vertices = mesh.faces.ravel()[places]
    count = len(mesh.vertices_cm)
    by_corner = [
        np.asarray(values, dtype=np.float64)
        for values in (mesh.normals, mesh.uvs)
        if values is not None and len(values) != count
    ]
    if by_corner:
        rows = np.concatenate([vertices[:, None], *(values[places] for values in by_corner)], axis=1)
        _, kept, indices = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    else:
        # Same result as `np.unique`, without sorting.
        place_of_vertex = np.full(count, -1)
        place_of_vertex[vertices] = np.arange(len(vertices))
        kept = place_of_vertex[place_of_vertex >= 0]
        indices = (np.cumsum(place_of_vertex >= 0) - 1)[vertices]

    def own(values: AnyFloatArray) -> AnyFloatArray:
        return np.asarray(values[vertices[kept]] if len(values) == count else values[places[kept]], dtype=np.float64)

    normals = own(mesh.normals)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    uvs = None if mesh.uvs is None else own(mesh.uvs).copy()
    if uvs is not None:
        uvs[:, 1] = 1.0 - uvs[:, 1]
    return Primitive(
        material=material,
        vertices=vertices[kept],
        # A degenerate triangle may have no normal, but glTF requires one.
        normals=np.where(lengths > 0, normals / np.where(lengths > 0, lengths, 1.0), [0.0, 1.0, 0.0]),
        uvs=uvs,
        triangles=indices.reshape(-1, 3),
    )
