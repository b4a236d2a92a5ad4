"""Signed distances to the closed bodies of some nodes: approximate on grids, exact nearby.

Bricks of the grids are computed on first use, since hands are near a small part of an instrument. For most points the
distance of a brick's centre suffices; its cells are computed on first use by nearby points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from threading import Lock

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray, IndexArray, SingleArray
from app.rig.grip.instrument_proxy import Bodies, bodies, distances
from instrument_maps.hold import Proxy

CELL_M = 0.003
BRICK_CELLS = 4
"""Number of cells along each side of a brick."""
NEAR_M = 0.003
"""Distance in metres outside the surface up to which distances are exact."""
FAR_M = 0.04
"""Greatest distance in metres that the grid stores; farther points have this value."""

_BRICK_M = BRICK_CELLS * CELL_M
_EDGE = 1e-3
"""Margin at the end of a grid, in cells."""
_HALF_DIAGONAL = math.sqrt(3.0) / 2.0
_CELL_MIDDLES_M = (
    np.stack(np.unravel_index(np.arange(BRICK_CELLS**3), (BRICK_CELLS,) * 3), axis=-1) + np.float64(0.5)
) * CELL_M
"""Centres of the cells (n, 3) in metres from the lowest corner of a brick."""


class DistanceField:
    """Signed distances to the bodies of each node, in the node's frame; the bodies of one node count as their union.

    Parameters
    ----------
    bodies_by_node : sequence of sequence of Proxy
        Bodies of each node, in the order of node numbers.

    Attributes
    ----------
    reaches_m : (N,) float64
        Distance of the farthest point from each node's origin.
    """

    def __init__(self, bodies_by_node: Sequence[Sequence[Proxy]]) -> None:
        names = [some[0].node for some in bodies_by_node]
        self._bodies: Bodies = bodies([body for some in bodies_by_node for body in some], names)
        own = [np.flatnonzero(self._bodies.nodes == node) for node in range(len(names))]
        self._own, self._owned = np.concatenate(own), np.array([len(some) for some in own])
        self._first_own = np.cumsum(self._owned) - self._owned
        hulls = self._bodies.hulls
        low_m = np.minimum(hulls[:, :3], hulls[:, 3:6]) - hulls[:, 6:]
        high_m = np.maximum(hulls[:, :3], hulls[:, 3:6]) + hulls[:, 6:]
        self._low_m = np.array([low_m[some].min(axis=0) for some in own])
        self._high_m = np.array([high_m[some].max(axis=0) for some in own])
        ends_m = np.maximum(*(np.linalg.norm(hulls[:, at : at + 3], axis=1) for at in (0, 3))) + hulls[:, 6]
        self.reaches_m = np.array([ends_m[some].max() for some in own])
        self._corners_m = self._low_m - FAR_M
        self._shapes = np.ceil((self._high_m + FAR_M - self._corners_m) / _BRICK_M).astype(np.int32)
        ends = np.cumsum(self._shapes.prod(axis=1, dtype=np.int64)).astype(np.int32)
        self._starts = np.append(np.int32(0), ends[:-1])
        self._brick_at = np.full(ends[-1], -1, dtype=np.int32)
        """Number of the brick at each place of each node's grid; -1 where nothing has been computed."""
        self._middle_m = np.full(ends[-1], np.nan, dtype=np.float32)
        """Distance of the middle of each brick; NaN where it has not been computed."""
        self._place_of = np.zeros(0, dtype=np.int32)
        """By brick: its place."""
        self._about_m = np.zeros((0, BRICK_CELLS**3), dtype=np.float32)
        """By brick, of its cells; NaN where nothing has been computed."""
        self._nearest: list[IndexArray] = []
        """By brick: the bodies that may be the nearest to something in it."""
        self._touching: list[IndexArray] = []
        """By brick: the bodies that a point in it may be near."""
        self._lock = Lock()

    def about_m(
        self,
        points_m: SingleArray,
        nodes: IndexArray,
        clear_m: SingleArray | None = None,
        depth_m: SingleArray | None = None,
    ) -> tuple[SingleArray, SingleArray]:
        """Approximate distance of points from the bodies of nodes.

        Parameters
        ----------
        points_m : (N, 3) float32
            Points in the frames of ``nodes``.
        nodes : (N,) int
            Number of the node for each point.
        clear_m, depth_m : (N,) float32, optional
            Limits that reduce the work: points farther outside than ``clear_m``, and points less deep than ``depth_m``,
            need no better value.

        Returns
        -------
        about_m : (N,) float32
            Approximate distance.
        error_m : (N,) float32
            Largest possible error. Distances above `FAR_M` minus this are not distinguished.
        """
        corners_m = self._corners_m.astype(np.float32).T.take(nodes, axis=1)
        inside = self._inside((points_m.T - corners_m) / np.float32(CELL_M), nodes, BRICK_CELLS)
        if clear_m is None or depth_m is None:
            return self._by_cells(inside, nodes)
        places = (inside * np.float32(1.0 / BRICK_CELLS)).astype(np.int32)
        flat = self._flat(places, nodes)
        about_m = self._middles(flat)
        error_m = _off_middle(inside, places, BRICK_CELLS)
        least_m, most_m = about_m - error_m, about_m + error_m
        rows = np.flatnonzero((least_m < clear_m) & ((most_m >= clear_m) | (least_m < -depth_m)))
        if len(rows):
            about_m[rows], error_m[rows] = self._by_cells(inside.take(rows, axis=1), nodes.take(rows))
        return about_m, error_m

    def beyond_m(self, points_m: SingleArray, nodes: IndexArray) -> SingleArray:
        """Distance (N,), or a lower bound of it, of points (N, 3) in the frames of ``nodes`` (N,) from the nodes'
        bounding boxes; minus infinity inside a box.
        """
        low_m, high_m = self._low_m.astype(np.float32)[nodes], self._high_m.astype(np.float32)[nodes]
        outside_m = np.maximum(np.maximum(low_m - points_m, points_m - high_m), np.float32(0.0))
        found: SingleArray = np.sqrt(np.einsum("ni,ni->n", outside_m, outside_m))
        return np.where(found > 0.0, found, np.float32(-np.inf))

    def distances_m(self, points_m: AnyFloatArray, nodes: IndexArray) -> AnyFloatArray:
        """Distance (N,) of points (N, 3) in the frames of nodes (N,), at most `NEAR_M`."""
        result = np.full(len(points_m), NEAR_M, dtype=points_m.dtype)
        places = self._inside((points_m.T - self._corners_m.T.take(nodes, axis=1)) / _BRICK_M, nodes, 1).astype(
            np.int32
        )
        bodies_of = [self._touching[index] for index in self._bricks(self._flat(places, nodes)).tolist()]
        counts = np.fromiter(map(len, bodies_of), dtype=np.intp, count=len(bodies_of))
        if counts.any():
            point = np.repeat(np.arange(len(points_m)), counts)
            np.minimum.at(result, point, distances(self._bodies, points_m[point], np.concatenate(bodies_of)))
        return result

    def _inside(self, scaled: AnyFloatArray, nodes: IndexArray, parts: int) -> AnyFloatArray:
        """Convert points to fractional grid indices (3, N), counted in ``parts`` per brick; positions outside a grid
        are clipped to its edge, where no body is near.
        """
        scaled = np.ascontiguousarray(np.maximum(scaled, 0.0))
        # Clamped before conversion to integers, which have a smaller range.
        np.minimum(scaled, (self._shapes.T * parts - _EDGE).astype(scaled.dtype).take(nodes, axis=1), out=scaled)
        return scaled

    def _by_cells(self, inside: SingleArray, nodes: IndexArray) -> tuple[SingleArray, SingleArray]:
        """Approximate distances, and their largest errors, for positions (3, N) in cell units, from the distances of
        cell centres; see `about_m`.
        """
        cells = inside.astype(np.int32)
        places = cells // BRICK_CELLS
        x, y, z = cells - places * BRICK_CELLS
        brick = self._bricks(self._flat(places, nodes))
        cell = ((brick * BRICK_CELLS + x) * BRICK_CELLS + y) * BRICK_CELLS + z
        found: SingleArray = self._about_m.reshape(-1).take(cell)
        missing = np.isnan(found)
        if missing.any():
            with self._lock:
                self._compute_cells(np.unique(cell[missing]))
                found[missing] = self._about_m.reshape(-1)[cell[missing]]
        return found, _off_middle(inside, cells, 1)

    def _flat(self, places: npt.NDArray[np.int32], nodes: IndexArray) -> npt.NDArray[np.int32]:
        """Convert grid positions (3, N) in the grids of ``nodes`` (N,) to flat indices (N,) of bricks."""
        x, y, z = places
        flat: npt.NDArray[np.int32] = (x * self._shapes[:, 1].take(nodes) + y) * self._shapes[:, 2].take(nodes) + z
        flat += self._starts.take(nodes)
        return flat

    def _middles(self, flat: npt.NDArray[np.int32]) -> SingleArray:
        """Distances (N,) of the centres of bricks, computed on first use."""
        found: SingleArray = self._middle_m.take(flat)
        missing = np.isnan(found)
        if missing.any():
            # Threads that miss the same bricks compute identical values.
            new = np.unique(flat[missing])
            distances_m, _, firsts = self._from_middles_m(self._corners_of(new), self._nodes_of(new))
            self._middle_m[new] = np.minimum.reduceat(distances_m, firsts)
            found[missing] = self._middle_m[flat[missing]]
        return found

    def _bricks(self, flat: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
        """Indices (N,) of bricks with cells, computed on first use."""
        bricks: npt.NDArray[np.int32] = self._brick_at.take(flat)
        missing = bricks < 0
        if missing.any():
            with self._lock:
                new = np.unique(flat[missing])
                self._compute(new[self._brick_at[new] < 0])
            bricks[missing] = self._brick_at[flat[missing]]
        return bricks

    def _nodes_of(self, flat: AnyIntArray) -> IndexArray:
        """Return the index (N,) of the node to which each flat brick index belongs."""
        return np.searchsorted(self._starts, flat, side="right") - 1

    def _corners_of(self, flat: AnyIntArray) -> FloatArray:
        """Lowest corner (N, 3) of each brick in metres."""
        nodes = self._nodes_of(flat)
        _, y, z = self._shapes.T.take(nodes, axis=1)
        place, at_z = np.divmod(flat - self._starts[nodes], z)
        corners_m: FloatArray = np.stack([*np.divmod(place, y), at_z], axis=-1) * _BRICK_M + self._corners_m[nodes]
        return corners_m

    def _from_middles_m(self, corners_m: FloatArray, nodes: IndexArray) -> tuple[FloatArray, IndexArray, IndexArray]:
        """Distances of the centres of bricks, given by their lowest corners (N, 3), from the bodies of their nodes
        (N,): the distances, the index of each body, and the index (N,) of each brick's first entry in both.
        """
        counts = self._owned[nodes]
        brick, firsts = np.repeat(np.arange(len(nodes)), counts), np.cumsum(counts) - counts
        body = self._own[np.arange(len(brick)) + (self._first_own[nodes] - firsts)[brick]]
        return distances(self._bodies, (corners_m + _BRICK_M / 2.0)[brick], body), body, firsts

    def _compute(self, flat: AnyIntArray) -> None:
        if not len(flat):
            return
        nodes, corners_m = self._nodes_of(flat), self._corners_of(flat)
        radius_m = _HALF_DIAGONAL * _BRICK_M
        middle_m, body, firsts = self._from_middles_m(corners_m, nodes)
        brick = np.repeat(np.arange(len(flat)), self._owned[nodes])
        # The surface nearest to a point in a brick is no farther from the centre than the nearest distance plus the
        # diagonal.
        nearest_m = np.minimum(np.minimum.reduceat(middle_m, firsts) + 2.0 * radius_m, FAR_M + radius_m)
        count = len(self._touching)
        for lists, near in (
            (self._nearest, middle_m < nearest_m[brick]),
            (self._touching, middle_m < NEAR_M + radius_m),
        ):
            lists += np.split(body[near], np.cumsum(np.add.reduceat(near, firsts, dtype=np.intp))[:-1])
        self._place_of = np.concatenate([self._place_of, flat.astype(np.int32)])
        cells_m = np.full((len(flat), BRICK_CELLS**3), np.nan, dtype=np.float32)
        self._about_m = np.concatenate([self._about_m, cells_m])
        # Written last, because other threads read it without a lock.
        self._brick_at[flat] = count + np.arange(len(flat), dtype=np.int32)

    def _compute_cells(self, cells: AnyIntArray) -> None:
        """Compute the distances of cells (N,), numbered brick by brick."""
        bricks, within = np.divmod(cells, BRICK_CELLS**3)
        bodies_of = [self._nearest[brick] for brick in bricks.tolist()]
        cell = np.repeat(np.arange(len(cells)), [len(some) for some in bodies_of])
        middles_m = self._corners_of(self._place_of[bricks]) + _CELL_MIDDLES_M[within]
        about_m = np.full(len(cells), FAR_M)
        np.minimum.at(about_m, cell, distances(self._bodies, middles_m[cell], np.concatenate(bodies_of)))
        self._about_m.reshape(-1)[cells] = about_m


def _off_middle(inside: SingleArray, numbers: npt.NDArray[np.int32], cells: int) -> SingleArray:
    """Distance (N,) in metres between positions (3, N), in cell units, and the centres of the cubes of ``cells`` cells
    that contain them.
    """
    x, y, z = inside - numbers * np.float32(cells) - np.float32(0.5 * cells)
    off_m: SingleArray = np.sqrt(x * x + y * y + z * z) * np.float32(CELL_M)
    return off_m
