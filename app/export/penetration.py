"""How deep hands and fingers go into the closed bodies that stand for an instrument.

Every vertex against every body at every frame would be thousands of distances a frame. Vertices are grouped, and only
groups whose middle is near enough to a body are looked at vertex by vertex: nothing is left out, because a group's
vertices stay within its radius.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.export.playback import Playback, Surface
from app.export.proxy import signed_distance
from app.formats.scene import SkinnedMesh
from instrument_maps.model import Proxy

FloatArray = npt.NDArray[np.float64]
AnyFloatArray = npt.NDArray[np.floating]
IntArray = npt.NDArray[np.integer]

GROUP = 8
"""Vertices per group, about."""
BLOCK = 32
"""Frames looked at together."""
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
    mesh : SkinnedMesh
    vertices : (V,) integer array
        Those of hands and fingers.
    proxy : sequence of Proxy
    """

    def __init__(self, playback: Playback, mesh: SkinnedMesh, vertices: IntArray, proxy: Sequence[Proxy]) -> None:
        self._surface = Surface(playback, mesh, vertices)
        self._by_node: dict[str, list[Proxy]] = {}
        for body in proxy:
            self._by_node.setdefault(body.node, []).append(body)
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
        radii = np.array([group.radius_m for group in self._groups])
        found = [
            (float(possible.max()), group, body, possible)
            for node, bodies in self._by_node.items()
            for blocks in [_Blocks(_moved(node_from_world[node], middles))]
            for body in bodies
            for group, possible in blocks.possible_depths(body, radii)
        ]
        points: dict[int, FloatArray] = {}
        # The likely deepest first: what cannot be deeper than what was found is not looked at.
        for _, group, body, possible in sorted(found, key=lambda item: -item[0]):
            frames = possible > deepest
            if not frames.any():
                continue
            if group not in points:
                points[group] = self._members[group].positions_m(world, first, last)
            local = _moved(node_from_world[body.node][frames], points[group][frames])
            deepest[frames] = np.maximum(deepest[frames], -signed_distance(body, local).min(axis=1))
        return deepest


class _Blocks:
    """Places of points (n, G, 3), some frames at a time: hands hardly move on what they hold, so one look at the
    middle of a point's places rules out a whole block."""

    def __init__(self, places: AnyFloatArray) -> None:
        self._frames = len(places)
        padding = -self._frames % BLOCK
        padded = np.concatenate([places, np.repeat(places[-1:], padding, axis=0)])
        self._places = padded.reshape(-1, BLOCK, *places.shape[1:])
        low, high = self._places.min(axis=1), self._places.max(axis=1)
        self._middle = (low + high) / 2.0
        self._wander = np.linalg.norm(high - low, axis=-1) / 2.0

    def possible_depths(self, body: Proxy, radii: FloatArray) -> Iterator[tuple[int, FloatArray]]:
        """How deep anything within a radius (G,) of a point may be in a body, (n,), of each point that is near."""
        # A distance changes by no more than the point moves, so nothing within reach is passed over.
        close = signed_distance(body, self._middle) < radii + self._wander
        block, point = np.nonzero(close)
        if not len(block):
            return
        depths = radii[point, None] - signed_distance(body, self._places[block, :, point])
        for index in np.unique(point).tolist():
            rows = point == index
            possible = np.zeros(close.shape[0] * BLOCK)
            possible.reshape(-1, BLOCK)[block[rows]] = depths[rows]
            if (possible[: self._frames] > 0.0).any():
                yield index, possible[: self._frames]


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
