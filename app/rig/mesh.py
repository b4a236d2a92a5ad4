"""Meshes and morph targets as values, for characters, figures and instruments."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from threading import Lock
from typing import overload

import numpy as np
import numpy.typing as npt

from app.arrays import SingleArray
from app.formats.scene import Material
from app.formats.texture_colors import plain_material
from app.formats.textures import NO_TEXTURES
from app.identity_cache import IdentityCache


@dataclass(frozen=True, eq=False)
class Morph:
    """A morph target with entries only for the vertices it moves: displacement in the mesh's bind space, metres."""

    name: str
    vertices: npt.NDArray[np.int32]
    deltas_m: SingleArray
    normal_deltas: SingleArray | None


class MorphsOnDemand(Sequence[Morph]):
    """The morphs of a mesh, made when one of them is first read: a band is drawn from afar without any.

    Parameters
    ----------
    count : int
        Number of morphs.
    make : callable
        Makes all of them; called once, in any thread.
    """

    def __init__(self, count: int, make: Callable[[], tuple[Morph, ...]]) -> None:
        self._count = count
        self._make: Callable[[], tuple[Morph, ...]] | None = make
        self._made: tuple[Morph, ...] = ()
        self._lock = Lock()

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> Morph: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Morph, ...]: ...

    def __getitem__(self, index: int | slice) -> Morph | tuple[Morph, ...]:
        with self._lock:
            if self._make is not None:
                self._made, self._make = self._make(), None
        return self._made[index]


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
    morphs: Sequence[Morph] = ()

    @property
    def is_skinned(self) -> bool:
        """True for a mesh that bends, such as a character's. People made from one body share all of its arrays but
        vertices, normals and displacements of morphs.
        """
        return bool(self.joints.shape[1] > 1)


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
    if all(material.textures == NO_TEXTURES for material in mesh.materials):
        return mesh.materials
    arrays = mesh.uvs, mesh.triangles, mesh.triangle_materials
    seen = _SEEN.step(_seen, *arrays) if mesh.is_skinned else _seen(*arrays)
    return tuple(_plain(material, seen, number) for number, material in enumerate(mesh.materials))


def _plain(material: Material, seen: _Seen, number: int) -> Material:
    """Return a material with its textures replaced by their means."""
    if material.textures == NO_TEXTURES:
        return material
    white = replace(material, base_color=(1.0, 1.0, 1.0, material.base_color[3]), roughness=1.0, metallic=1.0)
    mean = _mean(white, seen, number)
    red, green, blue = (own * its for own, its in zip(material.base_color[:3], mean.base_color[:3], strict=True))
    return replace(
        mean,
        base_color=(red, green, blue, material.base_color[3]),
        roughness=material.roughness * mean.roughness,
        metallic=material.metallic * mean.metallic,
    )


@dataclass(frozen=True, eq=False)
class _Seen:
    """Texture coordinates (N, 2) of some places of each material of a mesh."""

    uvs: tuple[SingleArray, ...]


def _seen(uvs: SingleArray, triangles: npt.NDArray[np.int32], of_triangles: npt.NDArray[np.int32]) -> _Seen:
    found = []
    for number in range(int(of_triangles.max(initial=-1)) + 1):
        own = np.flatnonzero(of_triangles == number)
        corners = uvs[triangles[own[:: 1 + len(own) // _MOST_AVERAGED]]]
        # Only the corners of a hair card are cut out.
        found.append(np.concatenate([corners.reshape(-1, 2), corners.mean(axis=1)]))
    return _Seen(tuple(found))


# People made from one body share these arrays.
_SEEN: IdentityCache[_Seen] = IdentityCache(128)


@lru_cache(maxsize=128)
def _mean(white: Material, seen: _Seen, number: int) -> Material:
    """Return a white material with its textures replaced by their means, which are the same for people in all colours
    of skin, hair and clothes.
    """
    return plain_material(white, seen.uvs[number] if number < len(seen.uvs) else np.zeros((0, 2)))


def scaled_mesh(mesh: Mesh, size: float) -> Mesh:
    """Return a mesh scaled as a whole."""
    morphs = tuple(replace(morph, deltas_m=(size * morph.deltas_m).astype(np.float32)) for morph in mesh.morphs)
    return replace(mesh, positions_m=(size * mesh.positions_m).astype(np.float32), morphs=morphs)
