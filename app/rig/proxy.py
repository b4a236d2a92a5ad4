"""Signed distance to an instrument's closed proxy: capsules, cylinders, cones, rings and boxes.

Distances are exact for each body (Quilez, "Distance functions", iquilezles.org) and the union's is their minimum:
exact outside, a lower bound of the depth inside.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from instrument_maps.model import Box, Capsule, Cone, Cylinder, Proxy, Ring

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]
_STEP_M = 1e-6


@dataclass(frozen=True, eq=False)
class Bodies:
    """Some proxies of one instrument as arrays; node index of each in ``nodes``.

    Attributes
    ----------
    tapers : (T, 8) float64
        a, b, radius at a and at b of cones and cylinders.
    capsules : (C, 7) float64
        a, b, radius.
    rings : (R, 8) float64
        Centre, axis, radius, tube radius.
    boxes : (B, 15) float64
        Centre, half sizes, x, y and z axes.
    nodes : (T + C + R + B,) int
        In that order.
    """

    tapers: FloatArray
    capsules: FloatArray
    rings: FloatArray
    boxes: FloatArray
    nodes: IntArray

    def __len__(self) -> int:
        return len(self.nodes)


def bodies(proxy: Sequence[Proxy], node_names: Sequence[str]) -> Bodies:
    """Turn a map's proxies into arrays."""
    groups: tuple[list[list[float]], ...] = ([], [], [], [])
    nodes: tuple[list[int], ...] = ([], [], [], [])
    for shape in proxy:
        match shape:
            case Cone():
                kind, row = 0, [*shape.a_m, *shape.b_m, shape.radius_a_m, shape.radius_b_m]
            case Cylinder():
                kind, row = 0, [*shape.a_m, *shape.b_m, shape.radius_m, shape.radius_m]
            case Capsule():
                kind, row = 1, [*shape.a_m, *shape.b_m, shape.radius_m]
            case Ring():
                kind, row = 2, [*shape.centre_m, *shape.axis, shape.radius_m, shape.tube_radius_m]
            case Box():
                across = np.cross(shape.x_axis, shape.y_axis)
                kind, row = 3, [*shape.centre_m, *shape.half_m, *shape.x_axis, *shape.y_axis, *across.tolist()]
        groups[kind].append(row)
        nodes[kind].append(node_names.index(shape.node))
    arrays = [
        np.array(group, dtype=np.float64).reshape(-1, width) for group, width in zip(groups, (8, 7, 8, 15), strict=True)
    ]
    tapers, capsules, rings, boxes = arrays
    return Bodies(tapers, capsules, rings, boxes, np.array([n for part in nodes for n in part], dtype=np.intp))


def near(all_bodies: Bodies, nodes_m: FloatArray, centre_m: FloatArray, radius_m: float) -> Bodies:
    """Return the bodies that come within a sphere of the instrument's frame; ``nodes_m`` (N, 3) places the nodes."""
    close = _distances(all_bodies, (centre_m - nodes_m[all_bodies.nodes])[None])[0] < radius_m
    edges = np.cumsum(
        [0, len(all_bodies.tapers), len(all_bodies.capsules), len(all_bodies.rings), len(all_bodies.boxes)]
    )
    keep = [close[a:b] for a, b in itertools.pairwise(edges)]
    return Bodies(
        all_bodies.tapers[keep[0]],
        all_bodies.capsules[keep[1]],
        all_bodies.rings[keep[2]],
        all_bodies.boxes[keep[3]],
        all_bodies.nodes[close],
    )


def distance(some: Bodies, points_m: FloatArray) -> tuple[FloatArray, IntArray]:
    """Signed distance to the union, negative inside.

    Parameters
    ----------
    some : Bodies
    points_m : (P, N, 3) float64
        Each point in the frames of all nodes.

    Returns
    -------
    distance_m : (P,) float64
    body : (P,) int
        The nearest body.
    """
    if not len(some):
        return np.full(len(points_m), np.inf), np.zeros(len(points_m), dtype=np.intp)
    local = points_m[:, some.nodes]
    found = _distances(some, local)
    body = np.argmin(found, axis=1)
    return found[np.arange(len(found)), body], body


def gradient(some: Bodies, points_m: FloatArray, body: IntArray) -> FloatArray:
    """Gradient (P, 3), in its node's frame, of the distance of each point to one body."""
    result = np.zeros((len(points_m), 3))
    local = points_m[np.arange(len(points_m)), some.nodes[body]]
    edges = np.cumsum([0, len(some.tapers), len(some.capsules), len(some.rings), len(some.boxes)])
    kinds: tuple[tuple[FloatArray, Callable[[FloatArray, FloatArray], FloatArray]], ...] = (
        (some.tapers, _taper), (some.capsules, _capsule), (some.rings, _ring), (some.boxes, _box),
    )  # fmt: skip
    for kind, (rows, measure) in enumerate(kinds):
        hit = np.flatnonzero((body >= edges[kind]) & (body < edges[kind + 1]))
        if len(hit):
            row, point = rows[body[hit] - edges[kind]], local[hit]
            for axis in range(3):
                step = np.zeros(3)
                step[axis] = _STEP_M
                result[hit, axis] = (measure(row, point + step) - measure(row, point - step)) / (2.0 * _STEP_M)
    return result


def _distances(some: Bodies, local: FloatArray) -> FloatArray:
    """Distances (P, bodies) of points (P, bodies, 3), each in the frame of that body's node."""
    result = np.empty(local.shape[:2])
    start = 0
    for rows, measure in (
        (some.tapers, _taper), (some.capsules, _capsule), (some.rings, _ring), (some.boxes, _box),
    ):  # fmt: skip
        stop = start + len(rows)
        if len(rows):
            result[:, start:stop] = measure(rows[None], local[:, start:stop])
        start = stop
    return result


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def _taper(row: FloatArray, point: FloatArray) -> FloatArray:
    """Distance to a flat-ended cone or cylinder."""
    a, span = row[..., :3], row[..., 3:6] - row[..., :3]
    wide, narrow = row[..., 6], row[..., 7]
    length2 = _dot(span, span)
    length = np.sqrt(length2)
    off = point - a
    along = _dot(off, span) / length
    across = np.sqrt(np.maximum(_dot(off, off) - along * along, 0.0))
    # In the plane of the axis: to the nearer end disc ...
    end_radius = np.where(along < 0.5 * length, wide, narrow)
    cap_x = np.maximum(across - end_radius, 0.0)
    cap_y = np.abs(along - 0.5 * length) - 0.5 * length
    # ... and to the slanted side.
    slope = narrow - wide
    share = np.clip(((across - wide) * slope + along * length) / (slope * slope + length2), 0.0, 1.0)
    side_x = across - wide - share * slope
    side_y = along - share * length
    inside = (side_x < 0.0) & (cap_y < 0.0)
    nearest = np.minimum(cap_x * cap_x + cap_y * cap_y, side_x * side_x + side_y * side_y)
    result: FloatArray = np.where(inside, -1.0, 1.0) * np.sqrt(nearest)
    return result


def _capsule(row: FloatArray, point: FloatArray) -> FloatArray:
    a, span = row[..., :3], row[..., 3:6] - row[..., :3]
    off = point - a
    share = np.clip(_dot(off, span) / np.maximum(_dot(span, span), 1e-12), 0.0, 1.0)
    off = off - span * share[..., None]
    result: FloatArray = np.sqrt(_dot(off, off)) - row[..., 6]
    return result


def _ring(row: FloatArray, point: FloatArray) -> FloatArray:
    off = point - row[..., :3]
    along = _dot(off, row[..., 3:6])
    across = np.sqrt(np.maximum(_dot(off, off) - along * along, 0.0)) - row[..., 6]
    result: FloatArray = np.sqrt(across * across + along * along) - row[..., 7]
    return result


def _box(row: FloatArray, point: FloatArray) -> FloatArray:
    off = point - row[..., :3]
    over = np.stack(
        [np.abs(_dot(off, row[..., 6 + 3 * axis : 9 + 3 * axis])) - row[..., 3 + axis] for axis in range(3)], axis=-1
    )
    out = np.maximum(over, 0.0)
    result: FloatArray = np.sqrt(_dot(out, out)) + np.minimum(over.max(axis=-1), 0.0)
    return result
