"""Binding of a body's meshes to the base mesh, so that they follow its displacements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray, IndexArray, SingleArray
from app.identity_cache import IdentityCache
from app.rig.mesh import Mesh
from app.rig.model import Character

if TYPE_CHECKING:
    from scipy.sparse import csr_array
    from scipy.spatial import cKDTree

NEIGHBOURS = 8
NEAR_M = 0.0003
"""Distance in metres up to which only the nearest vertex of the base mesh counts; at larger distances all neighbours
count equally.
"""
FAR_M = (0.010, 0.025)
"""Distances in metres from the skin up to which cloth around both legs is bound to the nearest skin alone, and from
which it is bound to both legs.
"""
EVERY, OF_A_LEG = 4, 16
"""Stride of the vertices of each leg's skin that count for such cloth, and number of the nearest of those."""
LEAST_SPAN = 0.05
"""Least share of both legs in a vertex far from the skin for which a mesh hangs around both legs."""
ANCHORS, REACH_M, BEYOND = 16, 0.025, 1e-3
"""Number of points whose displacement rotates and stretches the face's shapes, distance in metres within which they
count, and weight of no displacement.
"""


@dataclass(frozen=True, eq=False)
class Binding:
    """Binding of N vertices of a mesh to the base mesh: each moves as the weighted mean of K vertices ``corners`` (N,
    K), with the weights ``shares`` (N, K).
    """

    corners: IndexArray
    shares: SingleArray

    def carried(self, moved_m: FloatArray) -> FloatArray:
        """Return the displacements (N, 3) of the bound vertices for displacements (V, 3) of the base mesh."""
        steps_m = moved_m.astype(np.float32).take(self.corners, axis=0)
        carried: FloatArray = np.einsum("nk,nka->na", self.shares, steps_m)
        return carried.astype(np.float64)


class Attaching:
    """Binds meshes to the V base vertices (V, 3) of a body, whose ankles are at a height ``ankle_m`` in metres."""

    def __init__(self, base_m: FloatArray, ankle_m: float = -np.inf) -> None:
        from scipy.spatial import cKDTree  # slow to import; people are rarely made

        self._tree = cKDTree(base_m)
        self._sides: list[tuple[IndexArray, cKDTree]] = []
        for sign in (1.0, -1.0):
            own = np.flatnonzero((base_m[:, 0] * sign > 0.0) & (base_m[:, 1] > ankle_m))[::EVERY]
            self._sides.append((own, cKDTree(base_m[own])))

    def bound(self, mesh: Mesh, legs: FloatArray | None = None) -> Binding:
        """Bind each vertex of a mesh to the nearest of the base vertices, and cloth that hangs around both legs to both
        of them, so that it does not fold where the nearest leg changes.

        Parameters
        ----------
        legs : (N, 2), optional
            Share of the left and of the right leg in the weights of each vertex.
        """
        far, corners = _nearest(self._tree, mesh, NEIGHBOURS)
        shares = _near(far, NEAR_M)
        if legs is not None:
            hanging = _rising(far[:, 0], *FAR_M) * _rising(legs.sum(axis=1), 0.0, 0.5)
            if (hanging * legs.min(axis=1)).max() > LEAST_SPAN:
                of_legs = legs / np.maximum(legs.sum(axis=1, keepdims=True), 1e-9)
                shares *= 1.0 - hanging[:, None]
                for side, (own, tree) in enumerate(self._sides):
                    far, rows = _nearest(tree, mesh, OF_A_LEG)
                    corners = np.concatenate([corners, own[rows]], axis=1)
                    of_leg = (hanging * of_legs[:, side])[:, None] * _near(far, far.mean(axis=1, keepdims=True))
                    shares = np.concatenate([shares, of_leg], axis=1)
        return Binding(corners, shares.astype(np.float32))


def _nearest(tree: cKDTree, mesh: Mesh, count: int) -> tuple[FloatArray, IndexArray]:
    """Return distances and rows (N, ``count``) of the points of a tree that are nearest to a mesh's vertices."""
    far, rows = tree.query(mesh.positions_m, k=count)
    return np.asarray(far, dtype=np.float64), np.asarray(rows, dtype=np.intp)


def _near(far: FloatArray, scale_m: float | FloatArray) -> FloatArray:
    """Return the shares (N, K) of neighbours at distances (N, K), which decrease beyond ``scale_m``."""
    shares: FloatArray = 1.0 / (np.square(far) + np.square(scale_m))
    shares /= shares.sum(axis=1, keepdims=True)
    return shares


def _rising(values: FloatArray, low: float, high: float) -> FloatArray:
    """Return smooth steps (N,) from 0 at ``low`` to 1 at ``high``."""
    share: FloatArray = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def normals_of(positions_m: AnyFloatArray, mesh: Mesh, places: IndexArray) -> FloatArray:
    """Return the normals (V, 3) of a mesh with its vertices at ``positions_m``, as means of its faces weighted by area.

    Parameters
    ----------
    places : (V,) int
        Number of each vertex's position; vertices with equal numbers (either side of a seam) get equal normals.
    """
    corners = positions_m.take(mesh.triangles.T, axis=0)
    (ax, ay, az), (bx, by, bz) = (corners[1] - corners[0]).T, (corners[2] - corners[0]).T
    across = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1).astype(np.float64)
    found: FloatArray = _FACES.step(_faces_at, mesh.triangles, places) @ across
    found /= np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-12)
    return found.take(places, axis=0)


def _faces_at(triangles: AnyIntArray, places: IndexArray) -> csr_array:
    """Return a matrix (P, T) that sums over the corners of T triangles at each of P positions; the position of each
    vertex is ``places`` (V,)."""
    from scipy.sparse import csr_array  # slow to import, as above

    rows, columns = places[triangles].ravel(), np.repeat(np.arange(len(triangles)), 3)
    size = int(places.max(initial=-1)) + 1, len(triangles)
    return csr_array((np.ones(len(rows)), (rows, columns)), shape=size)


_FACES: IdentityCache[csr_array] = IdentityCache(256)


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
        near = _NEAR.step(_nearness, places_m, self.anchors)
        turns: FloatArray = (near @ (self.turns - np.eye(3)).reshape(-1, 9)).reshape(-1, 3, 3) + np.eye(3)
        return turns


def _nearness(places_m: AnyFloatArray, anchors: FloatArray) -> FloatArray:
    """Return the weights (N, A) of A anchors (A, 3) at N points (N, 3): greater near an anchor, together below 1."""
    squares = np.square(places_m[:, None] - anchors).sum(axis=2)
    near: FloatArray = np.exp(-squares / (2.0 * REACH_M**2))
    near /= near.sum(axis=1, keepdims=True) + BEYOND
    return near


_NEAR: IdentityCache[FloatArray] = IdentityCache(64)

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
    face = _face_before(before, mesh)
    if face is None:
        return NO_CHANGE
    after = face.ways.transpose(0, 2, 1) @ after_m[face.head]
    turns = np.linalg.solve(face.spreads, after + face.keep).transpose(0, 2, 1).astype(np.float64)
    return FaceChange(face.anchors, turns)


@dataclass(frozen=True, eq=False)
class _FaceBefore:
    """Parts of a least-squares fit of a face's change that are the same for all people made from one body.

    Attributes
    ----------
    head : (H,) int
        Vertices of the head.
    anchors : (A, 3)
        Points of the face at which changes are found.
    ways : (A, H, 3)
        Weighted offsets of the head's vertices from their weighted mean around each anchor.
    spreads, keep : (A, 3, 3)
        Matrices of the fit, and its regularisation, which is included in ``spreads``.
    """

    head: IndexArray
    anchors: FloatArray
    ways: FloatArray
    spreads: FloatArray
    keep: FloatArray


@lru_cache(maxsize=8)
def _face_before(before: Character, mesh: Mesh) -> _FaceBefore | None:
    """Prepare the fit for the skin of a body; None if it has no morphs of the face."""
    head = before.skeleton.index("head")
    own = np.flatnonzero((mesh.weights * (mesh.joints == head)).sum(axis=1) > 0.5)
    moving = np.zeros(len(mesh.positions_m))
    for morph in mesh.morphs:
        np.maximum.at(moving, morph.vertices, np.abs(morph.deltas_m).max(axis=1))
    lively = own[moving[own] > 0.002]
    if not len(lively):
        return None
    positions = mesh.positions_m.astype(np.float64)
    anchors = positions[_spread(positions, lively)]
    near = np.exp(-np.square(positions[own] - anchors[:, None]).sum(axis=2) / (2.0 * REACH_M**2))
    near /= near.sum(axis=1, keepdims=True)
    first = positions[own] - (near @ positions[own])[:, None]
    # Ways from a middle, weighted, sum to nothing: the middle of where vertices go need not be taken off.
    ways = first * near[..., None]
    spreads = np.einsum("awk,wl->akl", ways, positions[own])
    keep = 1e-3 * np.trace(spreads, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    return _FaceBefore(own, anchors, ways, spreads + keep, keep)


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
