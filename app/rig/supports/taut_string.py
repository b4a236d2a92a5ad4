"""Taut strings over a body: the section of the body in a plane, and the part of its convex hull that a string would
touch.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from app.arrays import FloatArray
from app.rig.model import Character
from app.rig.skinning import patch

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

_TRUNK = ("hips", "spine", "chest", "upperChest", "neck", "leftShoulder", "rightShoulder")
_LEAST_TRUNK = 0.5
"""Least share of a vertex's weight on joints of the trunk for a strap to lie on it."""
_HAIR, _CARDS = 0.7, 0.2
"""Shares of a mesh's weight on the head above which it is hair or part of the face, without and with transparent cards;
straps do not lie on it.
"""
_NEAR = 8
"""Number of vertices whose weights a point of a strap combines."""
_MIDLINE_M = 0.004
_BEFORE = 0.4
"""Share of the way from the back to the free end from which a string is in front of the body."""


@dataclass(frozen=True, eq=False)
class PosedTrunk:
    """Skin and clothes of a trunk in a pose, in the player's frame.

    Attributes
    ----------
    corners_m : (T, 3, 3) float64
        Corners of its T triangles.
    vertices_m : (V, 3) float64
        Its vertices.
    weights : (V, J) float64
        Weights of the vertices on all J joints.
    """

    corners_m: FloatArray
    vertices_m: FloatArray
    weights: FloatArray

    @cached_property
    def _tree(self) -> cKDTree:
        from scipy.spatial import cKDTree  # slow to import; few pieces have straps

        return cKDTree(self.vertices_m)

    def weights_at(self, points_m: FloatArray) -> FloatArray:
        """Return the joint weights (N, J) for points (N, 3) on the body: the mean of the nearest vertices."""
        _, near = self._tree.query(points_m, k=min(_NEAR, len(self.vertices_m)))
        found: FloatArray = self.weights[near.reshape(len(points_m), -1)].mean(axis=1)
        return found

    def above(self, height_m: float) -> PosedTrunk:
        """Return the same trunk without triangles that reach below a height."""
        return PosedTrunk(self.corners_m[self.corners_m[:, :, 1].min(axis=1) > height_m], self.vertices_m, self.weights)


def posed_trunk(character: Character, joints: FloatArray, morphs: dict[str, float]) -> PosedTrunk:
    """Pose the trunk of a character.

    Parameters
    ----------
    joints : (J, 3, 4) float64
        ``world_from_joint``.
    morphs : dict of str to float
        Weights of morphs, since straps are made for a chest full of air.
    """
    skeleton = character.skeleton
    trunk = np.isin(skeleton.names, _TRUNK)
    if not trunk.any():
        trunk[skeleton.index("hips")] = True
    world = np.zeros((1, len(skeleton.names), 4, 4))
    world[0, :, :3], world[0, :, 3, 3] = joints, 1.0
    curves = {name: np.array([weight]) for name, weight in morphs.items()}
    corners, vertices, weights = list[FloatArray](), list[FloatArray](), list[FloatArray]()
    for mesh in character.meshes:
        cards = all(material.alpha_mode != "opaque" for material in mesh.materials)
        on_head = mesh.weights[mesh.joints == skeleton.index("head")].sum() / len(mesh.weights)
        if on_head > (_CARDS if cards else _HAIR):
            continue
        own = np.einsum("nk,nk->n", mesh.weights, trunk[mesh.joints]) >= _LEAST_TRUNK
        one, two, three = mesh.triangles.T
        triangles = mesh.triangles[own[one] & own[two] & own[three]]
        if not len(triangles):
            continue
        used, numbered = np.unique(triangles, return_inverse=True)
        dense = np.zeros((len(used), len(skeleton.names)))
        np.add.at(dense, (np.arange(len(used))[:, None], mesh.joints[used]), mesh.weights[used])
        posed = patch(character, mesh, used).deformed(world, curves)[0]
        corners.append(posed[numbered.reshape(-1, 3)])
        vertices.append(posed)
        weights.append(dense)
    if not corners:
        empty = np.zeros((0, 3, 3))
        return PosedTrunk(empty, np.zeros((0, 3)), np.zeros((0, len(skeleton.names))))
    return PosedTrunk(np.concatenate(corners), np.concatenate(vertices), np.concatenate(weights))


@dataclass(frozen=True, eq=False)
class TautString:
    """A taut string over a body, then straight to its free end.

    Attributes
    ----------
    points_m : (N, 3) float64
        Points from its beginning on the body to its free end.
    leaves : int
        Index of the point at which it leaves the body.
    outwards : (N, 3) float64
        Unit vectors away from the body, at right angles to the string.
    """

    points_m: FloatArray
    leaves: int
    outwards: FloatArray


def taut_string(trunk: PosedTrunk, start_m: FloatArray, via_m: FloatArray, end_m: FloatArray) -> TautString | None:
    """Lay a string over the body from behind to a free end in front, in the plane of the three points.

    Parameters
    ----------
    start_m : (3,) float64
        Beginning; the nearest skin in the plane is used.
    via_m : (3,) float64
        Point on the side on which it passes: the left of the body if its x is positive.
    end_m : (3,) float64
        Free end.

    Returns
    -------
    TautString or None
        None if the plane does not cut the body.
    """
    along = (end_m - start_m) / np.linalg.norm(end_m - start_m)
    up = via_m - start_m
    up = up - along * (up @ along)
    up /= np.linalg.norm(up)
    cut = _cut(trunk.corners_m, start_m, np.cross(along, up))
    side = 1.0 if via_m[0] >= 0.0 else -1.0
    flat = np.stack([(cut - start_m) @ along, (cut - start_m) @ up], axis=1)
    # Behind the body the other shoulder belongs to the other string; in front both may run on one side.
    kept = (side * cut[:, 0] >= -_MIDLINE_M) | (flat[:, 0] > _BEFORE * ((end_m - start_m) @ along))
    flat = flat[kept]
    if len(flat) < 3:
        return None
    first = flat[np.argmin(np.linalg.norm(flat, axis=1))]
    last = np.array([(end_m - start_m) @ along, 0.0])
    path = _outer_path(np.concatenate([[first, last], flat]))
    if path is None:
        return None
    points = start_m + path[:, :1] * along + path[:, 1:] * up
    tangents = np.gradient(path, axis=0)
    tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-9)
    outwards = -tangents[:, 1:] * along + tangents[:, :1] * up
    return TautString(points, len(points) - 2, outwards)


def _cut(corners: FloatArray, origin: FloatArray, normal: FloatArray) -> FloatArray:
    """Return the points (N, 3) in which the edges of T triangles (T, 3, 3) cut the plane through ``origin``."""
    height = (corners - origin) @ normal
    found = list[FloatArray]()
    for one, other in ((0, 1), (1, 2), (2, 0)):
        a, b = height[:, one], height[:, other]
        crossed = np.flatnonzero((a < 0.0) != (b < 0.0))
        share = (a[crossed] / (a[crossed] - b[crossed]))[:, None]
        found.append(corners[crossed, one] + share * (corners[crossed, other] - corners[crossed, one]))
    return np.concatenate(found)


def _outer_path(points: FloatArray) -> FloatArray | None:
    """Return the boundary (N, 2) of the convex hull of points, from the first point over the top to the second; None if
    the second lies inside.
    """
    from scipy.spatial import ConvexHull, QhullError

    try:
        ring = np.asarray(ConvexHull(points).vertices, np.intp)
    except QhullError:
        return None
    end = np.flatnonzero(ring == 1)
    if not len(end):
        # The free end is inside the body: the string ends where it leaves the skin.
        return None
    ring = np.roll(ring, -int(end[0]))  # counter-clockwise from the end, over the top to the beginning
    outline = points[ring]
    begin = int(np.argmin(np.linalg.norm(outline - points[0], axis=1)))
    if begin < 1:
        return None
    return np.concatenate([[points[0]], outline[: begin + 1][::-1]])
