"""Characters of files without textures: cut-out surfaces keep the faces that are seen, and few colours remain.

Cards of hair, brows and lashes are mostly transparent. Without the texture that cuts them out, they would be opaque
wedges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, BoolArray, FloatArray
from app.formats.scene import Material, Scene, SkinnedMesh
from app.formats.texture_colors import OPAQUE, encoded_color, sampled, without_textures

MOST_MATERIALS: Final = 6
_INSIDE: Final = np.array([[4, 4, 4], [8, 2, 2], [2, 8, 2], [2, 2, 8], [2, 5, 5], [5, 2, 5], [5, 5, 2]]) / 12.0
"""Barycentric coordinates (7, 3) of points spread over a triangle."""


def with_plain_surfaces(scene: Scene) -> Scene:
    """Return a scene without textures and with at most `MOST_MATERIALS` materials.

    Triangles of cut-out materials of which more than half is transparent are removed; vertices stay. While there are
    too many materials, the two of the most similar colours become one: that of more faces, as rough as the rougher.
    """
    meshes = tuple(without_textures(_without_transparent_faces(mesh)) for mesh in scene.meshes)
    faces: dict[Material, int] = {}
    for mesh in meshes:
        owners = np.zeros(len(mesh.faces), np.intp) if mesh.face_materials is None else mesh.face_materials
        for number, count in enumerate(np.bincount(owners, minlength=len(mesh.materials)).tolist()):
            faces[mesh.materials[number]] = faces.get(mesh.materials[number], 0) + count
    shared = _most_alike_joined(faces)
    return replace(
        scene, meshes=tuple(_with_materials(mesh, [shared[one] for one in mesh.materials]) for mesh in meshes)
    )


def _without_transparent_faces(mesh: SkinnedMesh) -> SkinnedMesh:
    """Return a mesh without the triangles of cut-out materials that are mostly transparent."""
    by_vertex = mesh.uvs is not None and len(mesh.uvs) == len(mesh.vertices_cm)
    if mesh.uvs is None or mesh.face_materials is None or not by_vertex or mesh.faces.shape[1] != len(_INSIDE[0]):
        return mesh
    places = mesh.uvs * (1.0, -1.0) + (0.0, 1.0)
    kept = np.ones(len(mesh.faces), np.bool_)
    for number, material in enumerate(mesh.materials):
        own = mesh.face_materials == number
        if material.alpha_mode == "mask":
            kept[own] = _mostly_opaque(material, places[mesh.faces[own]])
    return replace(mesh, faces=mesh.faces[kept], face_materials=mesh.face_materials[kept])


def _mostly_opaque(material: Material, corners: AnyFloatArray) -> BoolArray:
    """Return of triangles with corners at texture coordinates (T, 3, 2), v down, whether at least half of each is
    opaque.
    """
    color = material.textures.color
    found = None if color is None else sampled(color, (_INSIDE @ corners).reshape(-1, 2))
    if found is None:
        return np.ones(len(corners), np.bool_)
    opaque = found[:, 3].reshape(len(corners), len(_INSIDE)) > OPAQUE
    return np.asarray(opaque.mean(axis=1) >= OPAQUE)


def _most_alike_joined(faces: dict[Material, int]) -> dict[Material, Material]:
    """Return the material that replaces each one; ``faces`` has the number of faces of each."""
    shared = {material: material for material in faces}
    left = dict(faces)
    while len(left) > MOST_MATERIALS:
        kept = sorted(left, key=lambda material: -left[material])
        colors = np.array([encoded_color(material.base_color[:3]) for material in kept], np.float64)
        larger, smaller = _nearest_pair(colors)
        pair = (kept[larger], kept[smaller])
        joined = replace(pair[0], roughness=max(one.roughness for one in pair))
        left[joined] = sum(left.pop(one) for one in pair)
        shared = {old: joined if new in pair else new for old, new in shared.items()}
    return shared


def _nearest_pair(points: FloatArray) -> tuple[int, int]:
    """Return the indices, the lower one first, of the two nearest of points (N, 3)."""
    far = np.linalg.norm(points[:, None] - points, axis=2)
    far[np.tril_indices(len(points))] = np.inf
    first, second = np.unravel_index(np.argmin(far), far.shape)
    return int(first), int(second)


def _with_materials(mesh: SkinnedMesh, materials: Sequence[Material]) -> SkinnedMesh:
    """Return a mesh in which other materials, equal ones once, replace its own, in their order."""
    once = tuple(dict.fromkeys(materials))
    table = np.array([once.index(one) for one in materials])
    owners = np.zeros(len(mesh.faces), np.intp) if mesh.face_materials is None else mesh.face_materials
    return replace(mesh, materials=once, face_materials=table[owners])
