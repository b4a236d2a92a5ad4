"""Finds the point of a triangle mesh nearest to a given point."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray


def nearest_point(triangles: FloatArray, point: FloatArray) -> tuple[float, FloatArray]:
    """Return the distance of a point from a mesh, and the surface normal at the nearest point of the mesh.

    Parameters
    ----------
    triangles : (T, 3, 3) float64
        Corners, counter-clockwise seen from outside.
    point : (3,) float64
        The given point, in metres.

    Returns
    -------
    distance_m : float
        Distance of the point from the mesh.
    normal : (3,) float64
        Unit normal of the nearest triangle.

    Notes
    -----
    The nearest point of a triangle is on its face if the point's projection is inside, else on one of its edges
    (Ericson, Real-Time Collision Detection, 5.1.5).
    """
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    normals = normals / np.maximum(areas, 1e-30)[:, None]
    height = np.einsum("ti,ti->t", point - a, normals)
    foot = point - height[:, None] * normals
    inside = areas > 1e-14
    edge_m = np.full(len(triangles), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        along = end - start
        inside &= np.einsum("ti,ti->t", np.cross(along, foot - start), normals) >= 0.0
        share = np.einsum("ti,ti->t", point - start, along) / np.maximum(np.einsum("ti,ti->t", along, along), 1e-30)
        on_edge = start + np.clip(share, 0.0, 1.0)[:, None] * along
        edge_m = np.minimum(edge_m, np.linalg.norm(point - on_edge, axis=1))
    distance = np.where(inside, np.abs(height), edge_m)
    nearest = int(np.argmin(distance))
    return float(distance[nearest]), normals[nearest]
