"""Changes of normals by morph targets, computed for files that lack them.

Compares triangle normals before and after, weighted by corner angles (Thürmer and Wüthrich, 1998). Vertices with equal
position and normal belong to one smooth surface; others at the position are separated by a hard edge and treated
separately.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.rig.mesh import Mesh, Morph

_PLACE_M: Final = 1e-6
_ALIKE: Final = 1e-3
"""Difference of positions and normals up to which vertices are equal."""
_LEAST: Final = 1e-3
"""Rotation in radians below which a normal is left unchanged."""


def with_morph_normals(mesh: Mesh) -> Mesh:
    """Return a mesh whose morphs all have changes of normals; missing ones are computed."""
    if all(morph.normal_deltas is not None for morph in mesh.morphs):
        return mesh
    surface = _Surface(mesh)
    return replace(
        mesh,
        morphs=tuple(surface.with_normals(m) if m.normal_deltas is None else m for m in mesh.morphs),
    )


class _Surface:
    """Triangles of a mesh, grouped at corners: vertices of equal position and normal are one corner of a smooth
    surface.
    """

    def __init__(self, mesh: Mesh) -> None:
        self._places_m = mesh.positions_m.astype(np.float64)
        self._normals = mesh.normals.astype(np.float64)
        keys = np.concatenate([np.rint(self._places_m / _PLACE_M), np.rint(self._normals / _ALIKE)], axis=1)
        _, self._corner = np.unique(keys.astype(np.int64), axis=0, return_inverse=True)
        self._corner = self._corner.reshape(-1)
        self._triangles = mesh.triangles.astype(np.intp)
        self._count = int(self._corner.max(initial=-1)) + 1
        self._of_triangles = self._corner[self._triangles]

    def with_normals(self, morph: Morph) -> Morph:
        """Add normal changes to a morph, including vertices next to the moved ones."""
        moved_m = np.zeros_like(self._places_m)
        moved_m[morph.vertices] = morph.deltas_m
        moving = np.zeros(len(moved_m), bool)
        moving[morph.vertices] = np.any(morph.deltas_m != 0.0, axis=1)
        touched = np.zeros(self._count, bool)
        touched[self._of_triangles[moving[self._triangles].any(axis=1)]] = True
        around = self._triangles[touched[self._of_triangles].any(axis=1)]
        before, after = (self._sums(around, places) for places in (self._places_m, self._places_m + moved_m))
        vertices = np.flatnonzero(touched[self._corner])
        own = self._normals[vertices]
        change = after[self._corner[vertices]] - before[self._corner[vertices]]
        turned = own + change
        turned /= np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-12)
        deltas = turned - own
        deltas[np.linalg.norm(deltas, axis=1) < _LEAST] = 0.0
        return _with(morph, vertices[deltas.any(axis=1)], deltas[deltas.any(axis=1)])

    def _sums(self, triangles: IntArray, places_m: FloatArray) -> FloatArray:
        """Return the unit normals (C, 3) of C corners, from given triangles around them with vertices at ``places_m``;
        zeros at other corners.
        """
        at = places_m[triangles]
        face = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
        face /= np.maximum(np.linalg.norm(face, axis=1, keepdims=True), 1e-20)
        sums = np.zeros((self._count, 3))
        for corner in range(3):
            one, other = at[:, (corner + 1) % 3] - at[:, corner], at[:, (corner + 2) % 3] - at[:, corner]
            lengths = np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
            angle = np.arccos(np.clip(np.sum(one * other, axis=1) / np.maximum(lengths, 1e-20), -1.0, 1.0))
            numbers = self._corner[triangles[:, corner]]
            for axis in range(3):
                sums[:, axis] += np.bincount(numbers, angle * face[:, axis], self._count)
        unit: FloatArray = sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-20)
        return unit


def _with(morph: Morph, vertices: IntArray, normals: FloatArray) -> Morph:
    """Return a morph that also changes the normals (K, 3) of K vertices."""
    every = np.union1d(morph.vertices, vertices).astype(np.int32)
    deltas_m, normal_deltas = np.zeros((len(every), 3), np.float32), np.zeros((len(every), 3), np.float32)
    deltas_m[np.searchsorted(every, morph.vertices)] = morph.deltas_m
    normal_deltas[np.searchsorted(every, vertices)] = normals
    return Morph(morph.name, every, deltas_m, normal_deltas)
