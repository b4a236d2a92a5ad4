"""Meshes split by material, with normals smoothed across the resulting seams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import AnyIntArray, FloatArray, IntArray, SingleArray
from app.rig.mesh import Mesh


def row_keys(*columns: AnyIntArray, size: int | None = None) -> IntArray:
    """Return a number for each row of a table of integers: equal for equal rows, ascending in the order of rows.

    A table without columns has ``size`` equal rows.

    Sorting numbers takes a tenth of the time of sorting rows.
    """
    keys, count = np.zeros(len(columns[0]) if size is None else size, np.int64), 1
    for column in columns:
        low = int(column.min(initial=0))
        span = int(column.max(initial=0)) - low + 1
        if count * span >= 2**62:
            keys = np.unique(keys, return_inverse=True)[1].astype(np.int64).reshape(-1)
            count = int(keys.max(initial=0)) + 1
        keys, count = keys * span + (column.astype(np.int64) - low), count * span
    return keys


@dataclass(frozen=True, eq=False)
class SplitMesh:
    """A mesh whose vertices have a single material each; those at seams are duplicated."""

    mesh: Mesh
    vertices: IntArray
    """Original vertex of every vertex."""
    materials: IntArray
    triangles: IntArray


def split_mesh(mesh: Mesh) -> SplitMesh:
    count = len(mesh.materials)
    keys = mesh.triangles.astype(np.int64) * count + mesh.triangle_materials.astype(np.int64)[:, None]
    unique, triangles = np.unique(keys.ravel(), return_inverse=True)
    return SplitMesh(mesh, unique // count, unique % count, triangles.reshape(-1, 3))


class Weld:
    """Smooth normals of a mesh across its seams."""

    def __init__(self, split: SplitMesh) -> None:
        self._positions = split.mesh.positions_m[split.vertices].astype(np.float64)
        places = np.rint(self._positions * 1e6).astype(np.int64)
        whole = np.unique(row_keys(*places.T), return_inverse=True)[1].reshape(-1)
        self._whole = whole
        self._corners = whole[split.triangles]
        self._triangles = split.triangles
        self._rest = self._normals(self._positions)

    def _normals(self, positions: FloatArray) -> FloatArray:
        a, b, c = (positions[self._triangles[:, corner]] for corner in range(3))
        faces = np.cross(b - a, c - a)
        count = int(self._whole.max()) + 1
        total = np.zeros((count, 3))
        for axis in range(3):
            for corner in range(3):
                total[:, axis] += np.bincount(self._corners[:, corner], faces[:, axis], count)
        total /= np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-20)
        return total[self._whole]

    def turned(self, moves: SingleArray) -> SingleArray:
        """Return the change (V, 3) of the normals of V vertices under displacements (V, 3)."""
        return (self._normals(self._positions + moves) - self._rest).astype(np.float32)
