"""Binding of a body's meshes to the base mesh, so that they follow its displacements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray, IndexArray, SingleArray
from app.rig.mesh import Mesh
from app.rig.model import Character

NEIGHBOURS = 8
NEAR_M = 0.0003
"""Skin lies on its own vertex of the base mesh, which counts alone; far from there all neighbours count alike."""
ANCHORS, REACH_M, BEYOND = 16, 0.025, 1e-3
"""Places of the face whose own change turns and stretches its shapes, how far one counts, how much no change does."""


@dataclass(frozen=True, eq=False)
class Binding:
    """Binding of N vertices of a mesh to the base mesh: each moves as the weighted mean of K vertices ``corners`` (N,
    K), with the weights ``shares`` (N, K).
    """

    corners: IndexArray
    shares: SingleArray

    def carried(self, moved_m: FloatArray) -> FloatArray:
        """Return the displacements (N, 3) of the bound vertices for displacements (V, 3) of the base mesh."""
        carried: FloatArray = np.einsum("nk,nka->na", self.shares, moved_m[self.corners].astype(np.float32))
        return carried.astype(np.float64)


def bound(mesh: Mesh, base_m: FloatArray) -> Binding:
    """Bind each vertex of a mesh to the nearest of the V base vertices (V, 3)."""
    from scipy.spatial import cKDTree  # heavy; people are made seldom

    far, corners = cKDTree(base_m).query(mesh.positions_m, k=NEIGHBOURS)
    shares = 1.0 / (np.square(far) + NEAR_M**2)
    return Binding(np.asarray(corners, dtype=np.intp), (shares / shares.sum(axis=1, keepdims=True)).astype(np.float32))


def normals_of(positions_m: AnyFloatArray, mesh: Mesh, places: IndexArray) -> FloatArray:
    """Return the normals (V, 3) of a mesh with its vertices at ``positions_m``, as means of its faces weighted by area.

    Parameters
    ----------
    places : (V,) int
        Number of each vertex's position; vertices with equal numbers (either side of a seam) get equal normals.
    """
    corners = positions_m[mesh.triangles]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across: AnyFloatArray = np.asarray(np.cross(first, second), dtype=np.float64)
    rows, count = places[mesh.triangles].ravel(), len(positions_m)
    summed = [np.bincount(rows, np.repeat(across[:, axis], 3), count) for axis in range(3)]
    found = np.stack(summed, axis=1).astype(np.float64)[places]
    found /= np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-12)
    return found


def places_of(mesh: Mesh) -> IndexArray:
    """Return a number for each vertex (V,) that is equal for vertices at the same position."""
    keys = np.round(mesh.positions_m / 1e-6).astype(np.int64)
    places: IndexArray = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    return places


@dataclass(frozen=True, eq=False)
class FaceChange:
    """Deformation of a face from one body to another: linear maps ``turns`` (A, 3, 3) at A points ``anchors`` (A, 3) of
    the first body.
    """

    anchors: FloatArray
    turns: FloatArray

    def at(self, places_m: AnyFloatArray) -> FloatArray:
        """Return the linear maps (N, 3, 3) by which displacements of morphs change at points (N, 3)."""
        squares = np.square(places_m[:, None] - self.anchors).sum(axis=2)
        near = np.exp(-squares / (2.0 * REACH_M**2))
        near /= near.sum(axis=1, keepdims=True) + BEYOND
        turns: FloatArray = (near @ (self.turns - np.eye(3)).reshape(-1, 9)).reshape(-1, 3, 3) + np.eye(3)
        return turns


NO_CHANGE: Final = FaceChange(np.zeros((1, 3)), np.eye(3)[None])
"""Change of a face that stays as it is."""


def face_change(before: Character, mesh: Mesh, after_m: FloatArray) -> FaceChange:
    """Return the deformation of the face between two bodies, from their skin.

    Parameters
    ----------
    before : Character
        The body before.
    mesh : Mesh
        Its skin, with the morphs of the face.
    after_m : (V, 3)
        Positions of the skin's vertices on the other body.
    """
    head = before.skeleton.index("head")
    own = np.flatnonzero((mesh.weights * (mesh.joints == head)).sum(axis=1) > 0.5)
    moving = np.zeros(len(mesh.positions_m))
    for morph in mesh.morphs:
        np.maximum.at(moving, morph.vertices, np.abs(morph.deltas_m).max(axis=1))
    lively = own[moving[own] > 0.002]
    if not len(lively):
        return NO_CHANGE
    positions = mesh.positions_m.astype(np.float64)
    anchors = positions[_spread(positions, lively)]
    turns = [_turn(positions[own], after_m[own], anchor) for anchor in anchors]
    return FaceChange(anchors, np.array(turns))


def _spread(positions: FloatArray, rows: IndexArray) -> IndexArray:
    """Return at most `ANCHORS` of the vertices ``rows``, spread out: each is as far as possible from those chosen
    before.
    """
    chosen = [int(rows[np.argmax(positions[rows, 2])])]
    far = np.full(len(rows), np.inf)
    for _ in range(min(ANCHORS, len(rows)) - 1):
        far = np.minimum(far, np.linalg.norm(positions[rows] - positions[chosen[-1]], axis=1))
        chosen.append(int(rows[np.argmax(far)]))
    return np.array(chosen, dtype=np.intp)


def _turn(before: FloatArray, after: FloatArray, anchor: FloatArray) -> FloatArray:
    """Return the linear map (3, 3) that approximates, by least squares, how points near ``anchor`` move from ``before``
    to ``after``.
    """
    near = np.exp(-np.square(before - anchor).sum(axis=1) / (2.0 * REACH_M**2))
    near /= near.sum()
    first, second = before - near @ before, after - near @ after
    spread = (first * near[:, None]).T @ first
    keep = 1e-3 * float(np.trace(spread)) * np.eye(3)
    turn: FloatArray = np.linalg.solve(spread + keep, (first * near[:, None]).T @ second + keep).T
    return turn
