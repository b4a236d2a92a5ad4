"""Signed distance to the closed bodies of some nodes: roughly on a grid for each, exactly near them.

The grids' bricks are computed when something is first there: hands are near a small part of an instrument.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from threading import Lock

import numpy as np
import numpy.typing as npt

from app.rig.proxy import Bodies, bodies, distances
from instrument_maps.model import Proxy

SingleArray = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.intp]

CELL_M = 0.003
BRICK_CELLS = 4
"""Along each side of a brick."""
NEAR_M = 0.003
"""How far outside distances are exact."""
FAR_M = 0.04
"""More is not distinguished on the grid."""

_BRICK_M = BRICK_CELLS * CELL_M
_EDGE = 1e-3
"""Of a cell, at the end of a grid."""
_HALF_DIAGONAL = math.sqrt(3.0) / 2.0


class DistanceField:
    """Distances to the union of the bodies of each of some nodes, in its frame.

    Parameters
    ----------
    bodies_by_node : sequence of sequence of Proxy
        All of each node; nodes are numbered in this order.

    Attributes
    ----------
    reaches_m : (N,) float64
        How far from its origin each node has anything.
    """

    def __init__(self, bodies_by_node: Sequence[Sequence[Proxy]]) -> None:
        names = [some[0].node for some in bodies_by_node]
        self._bodies: Bodies = bodies([body for some in bodies_by_node for body in some], names)
        self._own = [np.flatnonzero(self._bodies.nodes == node) for node in range(len(names))]
        hulls = self._bodies.hulls
        low_m = np.minimum(hulls[:, :3], hulls[:, 3:6]) - hulls[:, 6:]
        high_m = np.maximum(hulls[:, :3], hulls[:, 3:6]) + hulls[:, 6:]
        self._low_m = np.array([low_m[own].min(axis=0) for own in self._own])
        self._high_m = np.array([high_m[own].max(axis=0) for own in self._own])
        ends_m = np.maximum(*(np.linalg.norm(hulls[:, at : at + 3], axis=1) for at in (0, 3))) + hulls[:, 6]
        self.reaches_m = np.array([ends_m[own].max() for own in self._own])
        self._corners_m = self._low_m - FAR_M
        self._shapes = np.ceil((self._high_m + FAR_M - self._corners_m) / _BRICK_M).astype(np.int32)
        ends = np.cumsum(self._shapes.prod(axis=1, dtype=np.int64)).astype(np.int32)
        self._starts = np.append(np.int32(0), ends[:-1])
        self._brick_at = np.full(ends[-1], -1, dtype=np.int32)
        """Number of the brick at each place of each node's grid; -1 where nothing has been computed."""
        self._about_m = np.zeros((0, BRICK_CELLS**3), dtype=np.float32)
        """By brick."""
        self._touching: list[IntArray] = []
        """By brick: the bodies that a point in it may be near."""
        self._lock = Lock()

    def about_m(self, points_m: SingleArray, nodes: IntArray) -> tuple[SingleArray, SingleArray]:
        """Distance (N,) of points (N, 3) in the frames of nodes (N,), at most `FAR_M`, and how much each may be off:
        a distance changes by no more than a point moves."""
        corners_m = self._corners_m.astype(np.float32).T.take(nodes, axis=1)
        inside = self._inside((points_m.T - corners_m) / np.float32(CELL_M), nodes, BRICK_CELLS)
        cells = inside.astype(np.int32)
        places = cells // BRICK_CELLS
        x, y, z = cells - places * BRICK_CELLS
        brick = self._bricks(places, nodes)
        cell = ((brick * BRICK_CELLS + x) * BRICK_CELLS + y) * BRICK_CELLS + z
        found: SingleArray = self._about_m.reshape(-1).take(cell)
        inside -= cells
        inside -= np.float32(0.5)
        return found, np.sqrt(np.einsum("in,in->n", inside, inside)) * np.float32(CELL_M)

    def beyond_m(self, points_m: SingleArray, nodes: IntArray) -> SingleArray:
        """How far points (N, 3) in the frames of nodes (N,) are outside the boxes around their bodies: (N,), the
        distance or less. Inside a box it is minus infinity."""
        low_m, high_m = self._low_m.astype(np.float32)[nodes], self._high_m.astype(np.float32)[nodes]
        outside_m = np.maximum(np.maximum(low_m - points_m, points_m - high_m), np.float32(0.0))
        found: SingleArray = np.sqrt(np.einsum("ni,ni->n", outside_m, outside_m))
        return np.where(found > 0.0, found, np.float32(-np.inf))

    def distances_m(self, points_m: npt.NDArray[np.floating], nodes: IntArray) -> npt.NDArray[np.floating]:
        """Distance (N,) of points (N, 3) in the frames of nodes (N,), at most `NEAR_M`."""
        result = np.full(len(points_m), NEAR_M, dtype=points_m.dtype)
        places = self._inside((points_m.T - self._corners_m.T.take(nodes, axis=1)) / _BRICK_M, nodes, 1).astype(
            np.int32
        )
        bodies_of = [self._touching[index] for index in self._bricks(places, nodes).tolist()]
        counts = np.fromiter(map(len, bodies_of), dtype=np.intp, count=len(bodies_of))
        if counts.any():
            point = np.repeat(np.arange(len(points_m)), counts)
            np.minimum.at(result, point, distances(self._bodies, points_m[point], np.concatenate(bodies_of)))
        return result

    def _inside(self, scaled: npt.NDArray[np.floating], nodes: IntArray, parts: int) -> npt.NDArray[np.floating]:
        """Numbers (3, N) within the nodes' grids, of so many parts of a brick. What is beyond a grid is taken for
        something at its edge: nothing is near that."""
        scaled = np.ascontiguousarray(np.maximum(scaled, 0.0))
        # Compared before they are whole numbers, which hold less.
        np.minimum(scaled, (self._shapes.T * parts - _EDGE).astype(scaled.dtype).take(nodes, axis=1), out=scaled)
        return scaled

    def _bricks(self, places: npt.NDArray[np.int32], nodes: IntArray) -> npt.NDArray[np.int32]:
        """Numbers (N,) of the bricks at places (3, N) of nodes (N,), computed where they have not been."""
        x, y, z = places
        flat = (x * self._shapes[:, 1].take(nodes) + y) * self._shapes[:, 2].take(nodes) + z
        flat += self._starts.take(nodes)
        bricks: npt.NDArray[np.int32] = self._brick_at.take(flat)
        missing = bricks < 0
        if missing.any():
            with self._lock:
                new = np.unique(flat[missing])
                new = new[self._brick_at[new] < 0]
                node = np.searchsorted(self._starts, new, side="right") - 1
                for one in np.unique(node).tolist():
                    self._compute(new[node == one], one)
            bricks[missing] = self._brick_at[flat[missing]]
        return bricks

    def _compute(self, flat: npt.NDArray[np.integer], node: int) -> None:
        own = self._own[node]
        steps = (np.arange(BRICK_CELLS) + 0.5) * CELL_M
        cells_m = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
        places = np.unravel_index(flat - self._starts[node], self._shapes[node].tolist())
        corners_m = np.stack(places, axis=-1) * _BRICK_M + self._corners_m[node]
        radius_m = _HALF_DIAGONAL * _BRICK_M
        brick, body = (index.ravel() for index in np.mgrid[: len(flat), : len(own)])
        middles_m = (corners_m + _BRICK_M / 2.0)[brick]
        middle_m = distances(self._bodies, middles_m, own[body]).reshape(len(flat), len(own))
        # What is nearest somewhere in a brick is no further from its middle than the nearest and the brick's diagonal.
        nearest = middle_m < np.minimum(middle_m.min(axis=1, keepdims=True) + 2.0 * radius_m, FAR_M + radius_m)
        brick, body = np.nonzero(nearest)
        points_m = corners_m[brick, None] + cells_m
        found = distances(self._bodies, points_m.reshape(-1, 3), np.repeat(own[body], len(cells_m)))
        about_m = np.full((len(flat), len(cells_m)), FAR_M)
        np.minimum.at(about_m, brick, found.reshape(-1, len(cells_m)))
        count = len(self._touching)
        self._about_m = np.concatenate([self._about_m, about_m.astype(np.float32)])
        self._touching += [own[row] for row in middle_m < NEAR_M + radius_m]
        # Last, since other threads look here without a lock.
        self._brick_at[flat] = count + np.arange(len(flat), dtype=np.int32)
