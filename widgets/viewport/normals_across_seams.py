"""Meshes split by material, with normals smoothed across the resulting seams."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.arrays import AnyIntArray, FloatArray, IntArray, SingleArray
from app.identity_cache import IdentityCache
from app.rig.mesh import Mesh


def row_keys(*columns: AnyIntArray, size: int | None = None) -> IntArray:
    """Return a number for each row of a table of integers, given by columns: equal for equal rows, and in the same
    order as the rows.

    A table without columns has ``size`` equal rows.

    Sorting numbers takes a tenth of the time of sorting rows.
    """
    keys, count = np.zeros(len(columns[0]) if size is None else size, np.int64), 1
    for column in columns:
        low = int(column.min(initial=0))
        span = int(column.max(initial=0)) - low + 1
        if count * span >= 2**62:
            keys = numbered(keys)[1].astype(np.int64)
            count = int(keys.max(initial=0)) + 1
        keys, count = keys * span + (column.astype(np.int64) - low), count * span
    return keys


def numbered(keys: IntArray) -> tuple[IntArray, IntArray]:
    """Return the first row of each distinct one of K keys, in ascending order of the keys, and the number (K,) of each
    row's key; as `numpy.unique`, which takes several times as long to sort.
    """
    order = np.argsort(keys)
    ordered = keys.take(order)
    begins = np.ones(len(keys), np.bool_)
    np.not_equal(ordered[1:], ordered[:-1], out=begins[1:])
    number = np.empty(len(keys), np.intp)
    number[order] = np.cumsum(begins) - 1
    starts = np.flatnonzero(begins)
    return (np.minimum.reduceat(order, starts) if len(starts) else starts), number


@dataclass(frozen=True, eq=False)
class SplitMesh:
    """A mesh whose vertices have a single material each; those at seams are duplicated."""

    mesh: Mesh
    vertices: IntArray
    """Index of the original vertex of each vertex."""
    materials: IntArray
    triangles: IntArray


def split_mesh(mesh: Mesh) -> SplitMesh:
    if not mesh.is_skinned:
        return SplitMesh(mesh, *_split(mesh.triangles, mesh.triangle_materials))
    return SplitMesh(mesh, *_SPLITS.step(_split, mesh.triangles, mesh.triangle_materials))


def _split(corners: AnyIntArray, of_triangles: AnyIntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Return vertices, materials and triangles as in `SplitMesh`."""
    count = int(of_triangles.max(initial=0)) + 1
    keys = corners.astype(np.int64) * count + of_triangles.astype(np.int64)[:, None]
    unique, triangles = np.unique(keys.ravel(), return_inverse=True)
    return unique // count, unique % count, triangles.reshape(-1, 3)


# People made from one body share their triangles.
_SPLITS: IdentityCache[tuple[IntArray, IntArray, IntArray]] = IdentityCache(128)


@dataclass(frozen=True, eq=False)
class TurnedMorph:
    """A morph over the vertices of a split mesh.

    Attributes
    ----------
    vertices : (K,) int
    moves_m, turns : (K, 3) float32
        Displacements, and changes of the normals.
    """

    vertices: IntArray
    moves_m: SingleArray
    turns: SingleArray


def turned_morphs(split: SplitMesh) -> list[TurnedMorph]:
    """Return all morphs of a mesh, with normals smoothed across its seams."""
    morphs = split.mesh.morphs
    positions = split.mesh.positions_m[split.vertices].astype(np.float64)
    places = np.rint(positions * 1e6).astype(np.int64)
    # Numbered by their first vertex, positions are the same for all people made from one body.
    first, place = numbered(row_keys(*places.T))
    whole = _shared(first[place].astype(np.int64).tobytes())
    parts = _PARTS.step(_turning, whole, split.vertices, split.triangles, *(morph.vertices for morph in morphs))
    rest = _summed(
        [positions.take(corner, axis=0) for corner in split.triangles.T], whole[split.triangles.T], len(whole)
    )
    moves = np.concatenate([*(morph.deltas_m for morph in morphs), np.zeros((1, 3), np.float32)])
    corners = zip(parts.corners, parts.corner_rows, strict=True)
    sums = _summed(
        [positions.take(own, axis=0) + moves.take(rows, axis=0) for own, rows in corners], parts.places, parts.count + 1
    )
    turns = _unit(sums[parts.place_of]) - _unit(rest)[whole[parts.own]]
    moved = moves[parts.rows]
    x, y, z = np.abs(moved).T > 1e-6
    kept = np.flatnonzero(x | y | z)
    found = parts.own[kept], moved[kept], turns[kept].astype(np.float32)
    ends = np.searchsorted(kept, parts.ends)
    return [TurnedMorph(*of_one) for of_one in zip(*(np.split(whole, ends) for whole in found), strict=True)]


@lru_cache(maxsize=48)
def _shared(content: bytes) -> IntArray:
    """Convert bytes to an array of integers; equal bytes give the same object."""
    return np.frombuffer(content, np.int64)


@dataclass(frozen=True, eq=False)
class _Turning:
    """Vertices that the morphs of a split mesh move and the faces around them, concatenated over the morphs.

    Attributes
    ----------
    own, rows, place_of : (K,) int
        Moved vertices, their rows among the displacements of all morphs, and numbers of their positions.
    ends : (M - 1,) int
        First index into these of each of M morphs but the first.
    corners, corner_rows, places : (3, F) int
        Corners of the faces: vertices, rows of displacements, and numbers of positions. A corner that does not move has
        the row after the last one, and ``count`` as its position.
    count : int
        Number of positions.
    """

    own: IntArray
    rows: IntArray
    place_of: IntArray
    ends: IntArray
    corners: IntArray
    corner_rows: IntArray
    places: IntArray
    count: int


def _turning(whole: IntArray, vertices: IntArray, triangles: IntArray, *moved: npt.NDArray[np.int32]) -> _Turning:
    """Find the vertices and faces whose normals the morphs of a mesh change.

    Parameters
    ----------
    whole : (V,) int
        Number of each vertex's position, the same on both sides of a seam.
    vertices, triangles
        As in `SplitMesh`.
    moved : (N,) int
        Vertices of the original mesh that each morph moves.
    """
    total = sum(len(one) for one in moved)
    parts, start, count = list[_Part](), 0, 0
    for one in moved:
        row_of = np.full(max(int(vertices.max(initial=0)), int(one.max(initial=0))) + 1, total)
        row_of[one] = start + np.arange(len(one))
        parts.append(_part(row_of[vertices], total, whole, triangles, count))
        start, count = start + len(one), int(parts[-1].place_of.max(initial=count - 1)) + 1
    places = np.concatenate([part.places for part in parts], axis=1)
    return _Turning(
        own=np.concatenate([part.own for part in parts]),
        rows=np.concatenate([part.rows for part in parts]),
        place_of=np.concatenate([part.place_of for part in parts]),
        ends=np.cumsum([len(part.own) for part in parts])[:-1],
        corners=np.concatenate([part.corners for part in parts], axis=1),
        corner_rows=np.concatenate([part.corner_rows for part in parts], axis=1),
        places=np.where(places < 0, count, places),
        count=count,
    )


class _Part(NamedTuple):
    """Arrays of `_Turning` for one morph; the position of a corner that does not move is -1."""

    own: IntArray
    rows: IntArray
    place_of: IntArray
    corners: IntArray
    corner_rows: IntArray
    places: IntArray


def _part(row: IntArray, none: int, whole: IntArray, triangles: IntArray, first: int) -> _Part:
    """Find the vertices and faces whose normals one morph changes.

    Parameters
    ----------
    row : (V,) int
        Row of each vertex among the displacements; ``none`` if the morph does not move it.
    whole : (V,) int
        Number of each vertex's position, the same on both sides of a seam.
    first : int
        Number to be given to the first position that moves.
    """
    own = np.flatnonzero(row < none)
    number = np.full(len(whole), -1)
    asked = np.unique(whole[own])
    number[asked] = first + np.arange(len(asked))
    near = number[whole[triangles]]
    around = np.flatnonzero((near >= 0).any(axis=1))
    corners: IntArray = triangles[around].T
    return _Part(own, row[own], number[whole[own]], corners, row[corners], near[around].T)


_PARTS: IdentityCache[_Turning] = IdentityCache(24)


def _summed(corners_m: Sequence[FloatArray], places: IntArray, count: int) -> FloatArray:
    """Sum the normals of F faces, weighted by area, at each of ``count`` positions (3, F) of their corners (F, 3)."""
    first, second = corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]
    (ax, ay, az), (bx, by, bz) = first.T, second.T
    total = np.zeros((count, 3))
    for axis, across in enumerate((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)):
        for corner in places:
            total[:, axis] += np.bincount(corner, across, count)
    return total


def _unit(ways: FloatArray) -> FloatArray:
    found: FloatArray = ways / np.maximum(np.linalg.norm(ways, axis=1, keepdims=True), 1e-20)
    return found
