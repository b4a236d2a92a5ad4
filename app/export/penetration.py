"""How deep hands and fingers go into the closed bodies that stand for an instrument.

Every vertex against every body at every frame would be thousands of distances a frame. Vertices are grouped, and only
groups whose middle is near enough to a body are looked at vertex by vertex: nothing is left out, because a group's
vertices stay within its radius.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.export.playback import Playback, Surface
from app.export.proxy import bounding_ball, signed_distance
from app.formats.fbx.scene import FbxMesh
from instrument_maps.model import Proxy

FloatArray = npt.NDArray[np.float64]
AnyFloatArray = npt.NDArray[np.floating]
IntArray = npt.NDArray[np.integer]

GROUP = 16
"""Vertices per group, about."""
STRETCH = 1.3
"""How much further from its middle than in the bind pose a vertex of a group may come when the hand bends."""


@dataclass(frozen=True, eq=False)
class _Group:
    members: IntArray
    """Rows of the hand's vertices."""
    middle: int
    radius_m: float


class Hands:
    """The vertices of both hands and the bodies they must not enter.

    Parameters
    ----------
    playback : Playback
        Of the player.
    mesh : FbxMesh
    vertices : (V,) integer array
        Those of hands and fingers.
    proxy : sequence of Proxy
    """

    def __init__(self, playback: Playback, mesh: FbxMesh, vertices: IntArray, proxy: Sequence[Proxy]) -> None:
        self._surface = Surface(playback, mesh, vertices)
        self._by_node: dict[str, list[Proxy]] = {}
        for body in proxy:
            self._by_node.setdefault(body.node, []).append(body)
        self._balls_m = {
            node: np.array([(*centre, radius) for centre, radius in map(bounding_ball, bodies)])
            for node, bodies in self._by_node.items()
        }
        positions_m = np.asarray(mesh.vertices_cm, np.float64)[vertices] / 100.0
        strongest = np.asarray(mesh.joint_indices)[vertices, np.argmax(mesh.weights[vertices], axis=1)]
        self._groups = [
            _group(rows, positions_m)
            for bone in np.unique(strongest)
            for rows in _split(np.flatnonzero(strongest == bone), positions_m)
        ]
        middles = vertices[[group.middle for group in self._groups]]
        self._middles = Surface(playback, mesh, middles)
        self._members = [Surface(playback, mesh, vertices[group.members]) for group in self._groups]

    def depths_m(self, world: FloatArray, nodes: dict[str, FloatArray], first: int, last: int) -> FloatArray:
        """Greatest depth of any vertex in any body, at each frame.

        Parameters
        ----------
        world : (n, J, 4, 4) float64
            `Playback.world` of the player at these frames.
        nodes : dict of str to (n, 4, 4) float64
            World transforms of the instrument's nodes at these frames.

        Returns
        -------
        (n,) float64
            Metres, 0 where everything is outside.
        """
        deepest = np.zeros(last - first)
        middles = self._middles.positions_m(world, first, last)
        node_from_world = {name: np.linalg.inv(matrix) for name, matrix in nodes.items()}
        near: dict[int, list[tuple[Proxy, npt.NDArray[np.bool_]]]] = {}
        radii = np.array([group.radius_m for group in self._groups])
        for node, bodies in self._by_node.items():
            # Single precision is enough to choose by: the radii have room.
            local = _moved(node_from_world[node], middles).astype(np.float32)
            # A ball around each body first: most groups are nowhere near most bodies.
            balls = _ever_within(local, self._balls_m[node], radii)
            for body, close in zip(bodies, balls.T, strict=True):
                candidates = np.flatnonzero(close)
                if not len(candidates):
                    continue
                inside = signed_distance(body, local[:, candidates]) < radii[candidates]
                for column in np.flatnonzero(inside.any(axis=0)).tolist():
                    near.setdefault(int(candidates[column]), []).append((body, inside[:, column]))
        for index, touched in near.items():
            points = self._members[index].positions_m(world, first, last)
            for body, frames in touched:
                local = _moved(node_from_world[body.node][frames], points[frames])
                depth = -signed_distance(body, local).min(axis=1)
                deepest[frames] = np.maximum(deepest[frames], depth)
        return deepest


def _ever_within(points: AnyFloatArray, balls: FloatArray, radii: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether a ball of radius (G,) about a point (n, G, 3) may meet a ball (S, 4) in any frame, (G, S).

    Judged by a ball about all of a point's places: hands hardly move on what they hold.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    middle, wander = (low + high) / 2.0, np.linalg.norm(high - low, axis=-1) / 2.0
    apart = np.linalg.norm(middle[:, None] - balls[:, :3], axis=-1)
    near: npt.NDArray[np.bool_] = apart < (radii + wander)[:, None] + balls[:, 3]
    return near


def _moved(matrices: AnyFloatArray, points: AnyFloatArray) -> AnyFloatArray:
    """Points (n, V, 3) through transforms (n, 4, 4)."""
    return points @ matrices[:, :3, :3].swapaxes(1, 2) + matrices[:, None, :3, 3]


def _split(rows: IntArray, positions_m: FloatArray) -> list[IntArray]:
    """Halve along the longest side until the groups are small."""
    if len(rows) <= GROUP:
        return [rows]
    extent = np.ptp(positions_m[rows], axis=0)
    order = rows[np.argsort(positions_m[rows, int(np.argmax(extent))], kind="stable")]
    half = len(order) // 2
    return _split(order[:half], positions_m) + _split(order[half:], positions_m)


def _group(rows: IntArray, positions_m: FloatArray) -> _Group:
    points = positions_m[rows]
    middle = int(np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1)))
    radius_m = float(np.linalg.norm(points - points[middle], axis=1).max()) * STRETCH
    return _Group(rows, int(rows[middle]), radius_m)
