"""Meshes and morph targets as values, for characters, figures and instruments."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.arrays import SingleArray
from app.formats.scene import Material
from app.formats.texture_colors import plain_material
from app.formats.textures import NO_TEXTURES


@dataclass(frozen=True, eq=False)
class Morph:
    """A morph target with entries only for the vertices it moves: displacement in the mesh's bind space, metres."""

    name: str
    vertices: npt.NDArray[np.int32]
    deltas_m: SingleArray
    normal_deltas: SingleArray | None


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh, of one or several materials.

    Attributes
    ----------
    positions_m, normals : (V, 3) float32
        In the mesh's bind space.
    uvs : (V, 2) float32
        Texture coordinates.
    triangles : (T, 3) int32
        Vertex indices.
    triangle_materials : (T,) int32
        Index into ``materials``.
    joints, weights : (V, K) int32 and float32
        Skinning of a character's mesh; weights of a vertex sum to 1. An instrument's mesh is rigid: K = 1 and the index
        is a node of the `InstrumentModel`.
    """

    name: str
    positions_m: SingleArray
    normals: SingleArray
    uvs: SingleArray
    triangles: npt.NDArray[np.int32]
    triangle_materials: npt.NDArray[np.int32]
    materials: tuple[Material, ...]
    joints: npt.NDArray[np.int32]
    weights: SingleArray
    morphs: tuple[Morph, ...] = ()


def materials_once(mesh: Mesh) -> tuple[tuple[Material, ...], npt.NDArray[np.int32]]:
    """Return a mesh's materials with equal ones only once, and the index (T,) into them of each triangle.

    A file may give several parts of a mesh materials that are the same in everything.
    """
    kept = tuple(dict.fromkeys(mesh.materials))
    if len(kept) == len(mesh.materials):
        return mesh.materials, mesh.triangle_materials
    table = np.array([kept.index(material) for material in mesh.materials], np.int32)
    return kept, table[mesh.triangle_materials]


_MOST_AVERAGED = 2000
"""Number of triangles of a material at most over which the colours of its texture are averaged."""


def plain_materials(mesh: Mesh) -> tuple[Material, ...]:
    """Return a mesh's materials with each texture replaced by its mean colour."""
    made = []
    for number, material in enumerate(mesh.materials):
        if material.textures == NO_TEXTURES:
            made.append(material)
            continue
        own = np.flatnonzero(mesh.triangle_materials == number)
        corners = mesh.uvs[mesh.triangles[own[:: 1 + len(own) // _MOST_AVERAGED]]]
        # Only the corners of a hair card are cut out.
        made.append(plain_material(material, np.concatenate([corners.reshape(-1, 2), corners.mean(axis=1)])))
    return tuple(made)


def scaled_mesh(mesh: Mesh, size: float) -> Mesh:
    """Return a mesh scaled as a whole."""
    morphs = tuple(replace(morph, deltas_m=(size * morph.deltas_m).astype(np.float32)) for morph in mesh.morphs)
    return replace(mesh, positions_m=(size * mesh.positions_m).astype(np.float32), morphs=morphs)
