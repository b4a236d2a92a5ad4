"""Signed distance to the closed bodies of a node: roughly on a grid, exactly near them.

The grid's bricks are computed when something is first there: hands are near a small part of an instrument.
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
_HALF_DIAGONAL = math.sqrt(3.0) / 2.0


class DistanceField:
    """Distance to the union of the bodies of one node, in its frame.

    Parameters
    ----------
    node_bodies : sequence of Proxy
        All of one node.

    Attributes
    ----------
    error_m : float
        How much `about_m` may be off: a distance changes by no more than a point moves.
    """

    error_m = _HALF_DIAGONAL * CELL_M

    def __init__(self, node_bodies: Sequence[Proxy]) -> None:
        self._bodies: Bodies = bodies(node_bodies, [node_bodies[0].node])
        hulls = self._bodies.hulls
        low_m = np.minimum(hulls[:, :3], hulls[:, 3:6]) - hulls[:, 6:]
        high_m = np.maximum(hulls[:, :3], hulls[:, 3:6]) + hulls[:, 6:]
        self._low_m, self._high_m = low_m.min(axis=0), high_m.max(axis=0)
        self._corner_m = self._low_m - FAR_M
        self._shape = tuple(np.ceil((self._high_m + FAR_M - self._corner_m) / _BRICK_M).astype(int).tolist())
        self._brick_at = np.full(self._shape, -1, dtype=np.int32)
        """Number of the brick at each place; -1 where nothing has been computed."""
        self._about_m = np.full((1, BRICK_CELLS**3), FAR_M, dtype=np.float32)
        """By brick; brick 0 is whatever is beyond the grid."""
        self._lock = Lock()
        self._touching: list[IntArray] = [np.zeros(0, dtype=np.intp)]
        """By brick: the bodies that a point in it may be near."""

    def about_m(self, points_m: SingleArray) -> SingleArray:
        """Distance (N,) of points (N, 3), at most `FAR_M`, give or take `error_m`."""
        cell = np.floor((points_m - self._corner_m.astype(np.float32)) * np.float32(1.0 / CELL_M)).astype(np.int32)
        brick = self._bricks(cell // BRICK_CELLS)
        inside = cell % BRICK_CELLS
        flat = (inside[:, 0] * BRICK_CELLS + inside[:, 1]) * BRICK_CELLS + inside[:, 2]
        found: SingleArray = self._about_m.reshape(-1)[brick * BRICK_CELLS**3 + flat]
        return found

    def beyond_m(self, points_m: SingleArray) -> SingleArray:
        """How far points (N, 3) are outside the box around the bodies: (N,), the distance or less.

        Inside the box it is minus infinity.
        """
        low_m, high_m = self._low_m.astype(np.float32), self._high_m.astype(np.float32)
        outside_m = np.maximum(np.maximum(low_m - points_m, points_m - high_m), np.float32(0.0))
        found: SingleArray = np.sqrt(np.einsum("ni,ni->n", outside_m, outside_m))
        return np.where(found > 0.0, found, np.float32(-np.inf))

    def distances_m(self, points_m: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
        """Distance (N,) of points (N, 3), at most `NEAR_M`."""
        result = np.full(len(points_m), NEAR_M, dtype=points_m.dtype)
        brick = self._bricks(np.floor((points_m - self._corner_m) / _BRICK_M).astype(np.int32))
        bodies_of = [self._touching[index] for index in brick.tolist()]
        counts = np.fromiter(map(len, bodies_of), dtype=np.intp, count=len(bodies_of))
        if counts.any():
            point = np.repeat(np.arange(len(points_m)), counts)
            np.minimum.at(result, point, distances(self._bodies, points_m[point], np.concatenate(bodies_of)))
        return result

    def _bricks(self, places: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
        """Numbers (N,) of the bricks at places (N, 3), computed where they have not been."""
        beyond = ((places < 0) | (places >= self._shape)).any(axis=1)
        flat = (places[:, 0] * self._shape[1] + places[:, 1]) * self._shape[2] + places[:, 2]
        flat[beyond] = 0
        bricks: npt.NDArray[np.int32] = self._brick_at.reshape(-1)[flat]
        bricks[beyond] = 0
        missing = bricks < 0
        if missing.any():
            with self._lock:
                places = np.unique(flat[missing])
                self._compute(places[self._brick_at.reshape(-1)[places] < 0])
            bricks[missing] = self._brick_at.reshape(-1)[flat[missing]]
        return bricks

    def _compute(self, flat: npt.NDArray[np.integer]) -> None:
        steps = (np.arange(BRICK_CELLS) + 0.5) * CELL_M
        cells_m = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
        corners_m = np.stack(np.unravel_index(flat, self._shape), axis=-1) * _BRICK_M + self._corner_m
        radius_m = _HALF_DIAGONAL * _BRICK_M
        brick, body = (index.ravel() for index in np.mgrid[: len(flat), : len(self._bodies)])
        middle_m = distances(self._bodies, (corners_m + _BRICK_M / 2.0)[brick], body).reshape(
            len(flat), len(self._bodies)
        )
        # What is nearest somewhere in a brick is no further from its middle than the nearest and the brick's diagonal.
        nearest = middle_m < np.minimum(middle_m.min(axis=1, keepdims=True) + 2.0 * radius_m, FAR_M + radius_m)
        brick, body = np.nonzero(nearest)
        points_m = corners_m[brick, None] + cells_m
        found = distances(self._bodies, points_m.reshape(-1, 3), np.repeat(body, len(cells_m)))
        about_m = np.full((len(flat), len(cells_m)), FAR_M)
        np.minimum.at(about_m, brick, found.reshape(-1, len(cells_m)))
        count = len(self._touching)
        self._about_m = np.concatenate([self._about_m, about_m.astype(np.float32)])
        self._touching += [np.flatnonzero(row) for row in middle_m < NEAR_M + radius_m]
        # Last, since other threads look here without a lock.
        self._brick_at.reshape(-1)[flat] = count + np.arange(len(flat))
