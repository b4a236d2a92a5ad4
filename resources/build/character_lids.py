"""Measurement of the opening of a body's lids, for building bodies and for testing files against `anatomy.toml`."""

from __future__ import annotations

import numpy as np


def lid_edges_m(
    points: np.ndarray, triangles: np.ndarray, centre: np.ndarray, radius: float, aside_m: float = 0.0
) -> tuple[float, float]:
    """Heights of the lower and the upper lid's edge over the middle of an eye, seen from the front.

    Parameters
    ----------
    points : (N, 3)
    triangles : (F, 3), of the skin about one eye.
    centre, radius : of the eyeball.
    aside_m : how far beside the middle of the eye it is measured.

    Returns
    -------
    Both edges in metres; the same twice where the eye is closed.
    """
    a, b, c = (points[triangles[:, k]] - centre for k in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    seen = np.abs(area) > 1e-12
    a, b, c, area = a[seen], b[seen], c[seen], area[seen]
    heights = np.arange(-0.011, 0.011, 0.0001)
    y = heights[:, None]
    v = ((aside_m - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (y - a[:, 1])) / area
    w = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (aside_m - a[:, 0])) / area
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    depth = np.where(inside, a[:, 2] + v * (b[:, 2] - a[:, 2]) + w * (c[:, 2] - a[:, 2]), -np.inf)
    ball = np.sqrt(np.maximum(radius**2 - aside_m**2 - heights**2, 0.0))
    bare = heights[(depth.max(axis=1) < ball) & (np.abs(heights) < 0.9 * radius)]
    middle = bare[np.abs(bare + 0.0005) < 0.0075]
    return (float(middle.min()), float(middle.max())) if len(middle) else (0.0, 0.0)
