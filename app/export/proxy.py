"""Signed distances to the closed bodies that stand for an instrument when a hand is checked against it.

Negative inside. Formulas: Inigo Quilez, "distance functions" (capsule, box, torus, rounded forms), written here for
arrays of points; a cone is the region under a line in the plane of its axis and its radius.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from instrument_maps.model import Box, Capsule, Cone, Cylinder, Proxy, Ring

FloatArray = npt.NDArray[np.floating]


def signed_distance(shape: Proxy, points_m: FloatArray) -> FloatArray:
    """Signed distance of points to a body, both in the frame of the body's node.

    Parameters
    ----------
    shape : Proxy
    points_m : (..., 3) float array

    Returns
    -------
    (...) float array
        Metres, negative inside.
    """
    match shape:
        case Capsule():
            return _capsule(points_m, shape.a_m, shape.b_m, shape.radius_m)
        case Cylinder():
            return _cone(points_m, shape.a_m, shape.b_m, shape.radius_m, shape.radius_m)
        case Cone():
            return _cone(points_m, shape.a_m, shape.b_m, shape.radius_a_m, shape.radius_b_m)
        case Ring():
            return _ring(points_m, shape)
        case Box():
            return _box(points_m, shape)


def _capsule(
    points: FloatArray, a: tuple[float, float, float], b: tuple[float, float, float], radius: float
) -> FloatArray:
    start = np.asarray(a, points.dtype)
    axis = np.asarray(b, points.dtype) - start
    relative = points - start
    along = np.clip(relative @ axis / (axis @ axis), 0.0, 1.0)
    distance: FloatArray = np.linalg.norm(relative - along[..., None] * axis, axis=-1) - radius
    return distance


def _cone(
    points: FloatArray,
    a: tuple[float, float, float],
    b: tuple[float, float, float],
    radius_a: float,
    radius_b: float,
) -> FloatArray:
    """Flat-ended cone: distance to the polygon (0, ra) (h, rb) with the axis, in the plane of axis and radius."""
    start = np.asarray(a, points.dtype)
    axis = np.asarray(b, points.dtype) - start
    height = float(np.linalg.norm(axis))
    axis /= height
    relative = points - start
    x = relative @ axis
    r = np.linalg.norm(relative - x[..., None] * axis, axis=-1)
    # Nearest points of the three edges: the side and the two flat ends.
    slope = radius_b - radius_a
    t = np.clip((x * height + (r - radius_a) * slope) / (height * height + slope * slope), 0.0, 1.0)
    side = np.hypot(x - t * height, r - (radius_a + t * slope))
    end_a = np.hypot(x, np.maximum(r - radius_a, 0.0))
    end_b = np.hypot(x - height, np.maximum(r - radius_b, 0.0))
    inside = (x > 0.0) & (x < height) & (r < radius_a + x / height * slope)
    distance: FloatArray = np.minimum(side, np.minimum(end_a, end_b)) * np.where(inside, -1.0, 1.0)
    return distance.astype(points.dtype, copy=False)


def _ring(points: FloatArray, shape: Ring) -> FloatArray:
    axis = np.asarray(shape.axis, points.dtype)
    relative = points - np.asarray(shape.centre_m, points.dtype)
    x = relative @ axis
    r = np.linalg.norm(relative - x[..., None] * axis, axis=-1)
    distance: FloatArray = np.hypot(x, r - shape.radius_m) - shape.tube_radius_m
    return distance


def _box(points: FloatArray, shape: Box) -> FloatArray:
    x_axis = np.asarray(shape.x_axis)
    y_axis = np.asarray(shape.y_axis)
    axes = np.stack([x_axis, y_axis, np.cross(x_axis, y_axis)]).astype(points.dtype)
    relative = (points - np.asarray(shape.centre_m, points.dtype)) @ axes.T
    beyond = np.abs(relative) - np.asarray(shape.half_m, points.dtype)
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=-1)
    distance: FloatArray = outside + np.minimum(beyond.max(axis=-1), 0.0)
    return distance
