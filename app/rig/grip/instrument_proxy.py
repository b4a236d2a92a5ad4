"""Signed distance to an instrument's closed proxy of capsules, cylinders, cones, rings and boxes.

Distances are exact for each body (Quilez, "Distance functions", iquilezles.org), and the union's is their minimum:
exact outside, a lower bound of the depth inside.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, BoolArray, FloatArray, IndexArray
from instrument_maps.hold import Box, Capsule, Cone, Cylinder, Proxy, Ring

_STEP_M = 1e-6
_Measure = Callable[[npt.NDArray[Any], npt.NDArray[Any]], npt.NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Bodies:
    """Collision bodies of instruments or parts of them, as arrays.

    Attributes
    ----------
    tapers : (T, 8) float64
        Cones and cylinders: end points a and b, radius at a, radius at b.
    capsules : (C, 7) float64
        Capsules: end points a and b, radius.
    rings : (R, 8) float64
        Rings: centre, axis, radius, radius of the tube.
    boxes : (B, 15) float64
        Boxes: centre, half sizes, x, y and z axes.
    nodes : (T + C + R + B,) int
        Node of each body, in the order of the arrays above.
    hulls : (T + C + R + B, 7) float64
        A capsule that encloses each body: end points a and b, radius.
    """

    tapers: FloatArray
    capsules: FloatArray
    rings: FloatArray
    boxes: FloatArray
    nodes: IndexArray
    hulls: FloatArray

    def __len__(self) -> int:
        return len(self.nodes)

    def taken(self, chosen: BoolArray) -> Bodies:
        """Return only the bodies chosen by a mask."""
        edges = np.cumsum([0, len(self.tapers), len(self.capsules), len(self.rings), len(self.boxes)])
        keep = [chosen[a:b] for a, b in itertools.pairwise(edges)]
        return Bodies(
            self.tapers[keep[0]],
            self.capsules[keep[1]],
            self.rings[keep[2]],
            self.boxes[keep[3]],
            self.nodes[chosen],
            self.hulls[chosen],
        )


def bodies(proxy: Sequence[Proxy], node_names: Sequence[str]) -> Bodies:
    """Return the bodies of an instrument's proxy as arrays by kind."""
    groups: tuple[list[list[float]], ...] = ([], [], [], [])
    hulls: tuple[list[list[float]], ...] = ([], [], [], [])
    nodes: tuple[list[int], ...] = ([], [], [], [])
    for shape in proxy:
        match shape:
            case Cone():
                kind, row = 0, [*shape.a_m, *shape.b_m, shape.radius_a_m, shape.radius_b_m]
                hull = [*shape.a_m, *shape.b_m, max(shape.radius_a_m, shape.radius_b_m)]
            case Cylinder():
                kind, row = 0, [*shape.a_m, *shape.b_m, shape.radius_m, shape.radius_m]
                hull = [*shape.a_m, *shape.b_m, shape.radius_m]
            case Capsule():
                kind, row = 1, [*shape.a_m, *shape.b_m, shape.radius_m]
                hull = row
            case Ring():
                kind, row = 2, [*shape.centre_m, *shape.axis, shape.radius_m, shape.tube_radius_m]
                hull = [*shape.centre_m, *shape.centre_m, shape.radius_m + shape.tube_radius_m]
            case Box():
                across = np.cross(shape.x_axis, shape.y_axis)
                kind, row = 3, [*shape.centre_m, *shape.half_m, *shape.x_axis, *shape.y_axis, *across.tolist()]
                hull = [*shape.centre_m, *shape.centre_m, float(np.linalg.norm(shape.half_m))]
        groups[kind].append(row)
        hulls[kind].append(hull)
        nodes[kind].append(node_names.index(shape.node))
    tapers, capsules, rings, boxes = (
        np.array(group, dtype=np.float64).reshape(-1, width) for group, width in zip(groups, (8, 7, 8, 15), strict=True)
    )
    return Bodies(
        tapers,
        capsules,
        rings,
        boxes,
        np.array([n for part in nodes for n in part], dtype=np.intp),
        np.array([hull for part in hulls for hull in part], dtype=np.float64).reshape(-1, 7),
    )


def near(all_bodies: Bodies, nodes_m: FloatArray, centre_m: FloatArray, radius_m: float) -> Bodies:
    """Return the bodies near a sphere in the instrument's frame; ``nodes_m`` (N, 3) are the positions of the nodes."""
    return all_bodies.taken(_capsule(all_bodies.hulls, centre_m - nodes_m[all_bodies.nodes]) < radius_m)


class InstrumentNodes(NamedTuple):
    """Nodes of an instrument in its frame: places (N, 3) and bases (N, 3, 3)."""

    place_m: FloatArray
    basis: FloatArray


def inside(
    some: Bodies, nodes: InstrumentNodes, points_m: FloatArray, radius_m: FloatArray
) -> tuple[FloatArray, IndexArray]:
    """Return the depth of balls inside the union.

    Parameters
    ----------
    points_m : (P, 3) float64
        The centre of each ball in the instrument's frame.
    radius_m : (P,) float64
        0 for a point of the skin.

    Returns
    -------
    depth_m : (P,) float64
        0 outside.
    body : (P,) int
        Body with the greatest depth; -1 outside.
    """
    depth, owner = np.zeros(len(points_m)), np.full(len(points_m), -1, dtype=np.intp)
    if not len(some) or not len(points_m):
        return depth, owner
    point, body = _candidates(some, nodes, points_m, radius_m)
    found = radius_m[point] - distances(some, _local(some, nodes, points_m[point], body), body)
    np.maximum.at(depth, point, found)
    deepest = (found > 0.0) & (found == depth[point])
    owner[point[deepest]] = body[deepest]
    return depth, owner


def distance(some: Bodies, nodes: InstrumentNodes, points_m: FloatArray) -> FloatArray:
    """Return the signed distance (P,) of P points (P, 3) in the instrument's frame to the union of the bodies, negative
    inside."""
    count = len(points_m)
    point, body = (index.ravel() for index in np.mgrid[:count, : len(some)])
    found = distances(some, _local(some, nodes, points_m[point], body), body).reshape(count, len(some))
    nearest: FloatArray = found.min(axis=1, initial=np.inf)
    return nearest


def gradient(some: Bodies, nodes: InstrumentNodes, points_m: FloatArray, body: IndexArray) -> FloatArray:
    """Return the gradient (P, 3) of the distance of P points (P, 3), each to the body with the index in ``body`` (P,),
    in the instrument's frame.
    """
    local = _local(some, nodes, points_m, body)
    steps = _STEP_M * np.concatenate([np.eye(3), -np.eye(3)])
    found = distances(some, (local + steps[:, None]).reshape(-1, 3), np.tile(body, 6)).reshape(6, -1)
    slope: FloatArray = (found[:3] - found[3:]).T / (2.0 * _STEP_M)
    turned: FloatArray = (nodes.basis[some.nodes[body]] @ slope[:, :, None])[:, :, 0]
    return turned


def signed_distance(shape: Proxy, points_m: AnyFloatArray) -> AnyFloatArray:
    """Return the signed distance (...) of points (..., 3) to a body in the frame of its node, in the points'
    precision.
    """
    row, measure = _alone(shape)
    return measure(row.astype(points_m.dtype), points_m)


@lru_cache(maxsize=1024)
def _alone(shape: Proxy) -> tuple[FloatArray, _Measure]:
    """Return the array row of a single body, and the function that measures distances to such rows."""
    return next((rows[0], measure) for rows, measure in _kinds(bodies((shape,), (shape.node,))) if len(rows))


def _local(some: Bodies, nodes: InstrumentNodes, points_m: FloatArray, body: IndexArray) -> FloatArray:
    """Return K points (K, 3) in the frames of the nodes of the bodies with the indices ``body`` (K,)."""
    node = some.nodes[body]
    off = points_m - nodes.place_m[node]
    local: FloatArray = (off[:, None, :] @ nodes.basis[node])[:, 0]
    return local


def _candidates(
    some: Bodies, nodes: InstrumentNodes, points_m: FloatArray, radius_m: FloatArray
) -> tuple[IndexArray, IndexArray]:
    """Return the indices of ball (K,) and body (K,) for each pair that may overlap by the bodies' hulls.

    Bodies far from all balls are excluded first. A ball is a point with a radius.
    """
    basis, place_m = nodes.basis[some.nodes], nodes.place_m[some.nodes]
    a = (basis @ some.hulls[:, :3, None])[:, :, 0] + place_m
    span = (basis @ (some.hulls[:, 3:6] - some.hulls[:, :3])[:, :, None])[:, :, 0]
    length2 = _dot(span, span)
    middle = (points_m.min(axis=0) + points_m.max(axis=0)) / 2.0
    off = points_m - middle
    reach_m = float(np.sqrt(_dot(off, off).max())) + float(radius_m.max())
    from_a = middle - a
    share = np.clip(_dot(from_a, span) / np.maximum(length2, 1e-12), 0.0, 1.0)
    from_a = from_a - span * share[:, None]
    members = np.flatnonzero(_dot(from_a, from_a) < np.square(some.hulls[:, 6] + reach_m))
    a, span, hull_m = a[members] - middle, span[members], some.hulls[members, 6]
    length = np.sqrt(length2[members])
    unit = span / np.maximum(length, 1e-12)[:, None]
    # In single precision with a margin: superfluous pairs are rejected in `inside`. One product of ball and body gives
    # both the position along the hull's axis and the squared distance to its start minus that of contact.
    ball2, start2 = _dot(off, off), _dot(a, a)
    spare = np.float32(4e-6 * (ball2.max(initial=0.0) + start2.max(initial=0.0) + np.square(length.max(initial=0.0))))
    balls = np.column_stack([off, np.ones(len(off)), ball2 - np.square(radius_m), radius_m]).astype(np.float32)
    axes = np.column_stack([unit, -_dot(a, unit)]).astype(np.float32)
    starts = np.column_stack([-2.0 * a, start2 - np.square(hull_m), np.ones(len(a)), -2.0 * hull_m]).astype(np.float32)
    along, apart = balls[:, :4] @ axes.T, balls @ starts.T
    foot = np.minimum(np.maximum(along, np.float32(0.0)), length.astype(np.float32))
    along *= np.float32(2.0)
    along -= foot
    along *= foot
    along += spare
    point, body = np.nonzero(apart < along)
    return point, members[body]


def distances(some: Bodies, local_m: npt.NDArray[Any], body: IndexArray) -> npt.NDArray[Any]:
    """Return the signed distance (K,) of K points (K, 3), each to the body with the index in ``body`` (K,), in the
    frame of its node, in the points' precision.
    """
    result = np.empty(len(body), dtype=local_m.dtype)
    start = 0
    for rows, measure in _kinds(some):
        hit = np.flatnonzero((body >= start) & (body < start + len(rows)))
        if len(hit):
            # One component at a time: arithmetic on whole columns is faster if they are contiguous.
            row = rows.T.astype(local_m.dtype).take(body.take(hit) - start, axis=1)
            result[hit] = measure(row.T, local_m.T.take(hit, axis=1).T)
        start += len(rows)
    return result


def _kinds(some: Bodies) -> tuple[tuple[FloatArray, _Measure], ...]:
    """Return for every kind of body (tapers, capsules, rings, boxes) its rows and the function that measures distances
    to them."""
    return (some.tapers, _taper), (some.capsules, _capsule), (some.rings, _ring), (some.boxes, _box)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def _taper(row: FloatArray, point: FloatArray) -> FloatArray:
    """Return the distance from points to a flat-ended cone or cylinder; a row has both end points and both radii."""
    a, span = row[..., :3], row[..., 3:6] - row[..., :3]
    wide, narrow = row[..., 6], row[..., 7]
    length2 = _dot(span, span)
    length = np.sqrt(length2)
    off = point - a
    along = _dot(off, span) / length
    across = np.sqrt(np.maximum(_dot(off, off) - along * along, 0.0))
    # In the plane of the axis: distance to the nearer end disc ...
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
    far: FloatArray = np.sqrt(nearest)
    return np.where(inside, -far, far)


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
