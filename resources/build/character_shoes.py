"""Laced black shoes: an upper over the helper suit's foot, on a leather sole with a heel."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_cloth import (
    Cloth,
    cloth_surface,
    cut,
    grid_faces,
    hull_profile,
    join,
    smoothed,
    smoothstep,
    to_triangles,
)
from character_garments import Tailoring
from character_skeleton import SkeletonFit
from character_surface import Surface
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

SOLE_M = 0.018


TOE_ROOM_M = 0.012
TOP_LINE_M = 0.074


def _upper(tailoring: Tailoring, foot: Cloth) -> Cloth:
    """The foot, a little larger, with room before the toes and a smooth toe box."""
    points = foot.points.copy()
    centre = points.mean(axis=0)
    height = points[:, 1] - tailoring.foot_m
    length = np.ptp(points[:, 2])
    share = (points[:, 2] - points[:, 2].min()) / length
    low = 1 - smoothstep(height, 0.03, 0.07)
    points[:, 0] = centre[0] + (points[:, 0] - centre[0]) * (1 + 0.05 * low)
    points[:, 2] += TOE_ROOM_M * smoothstep(share, 0.55, 1.0) - 0.004 * (1 - smoothstep(share, 0.0, 0.15))
    points[:, 1] += 0.004 * smoothstep(height, 0.0, 0.02) * smoothstep(share, 0.5, 0.8)
    return replace(foot, points=points)


def _sole(tailoring: Tailoring, upper: Cloth) -> Cloth:
    """A welted sole with the outline of the upper, a heel and a hollow under the arch."""
    low = upper.points[upper.points[:, 1] < tailoring.foot_m + 0.035][:, [0, 2]]
    centre = (low.max(axis=0) + low.min(axis=0)) / 2
    outline = smoothed(
        hull_profile(np.zeros(len(low)), low, np.array([0.0, 1.0]), np.stack([centre, centre]), 2.0), 0.01, 0.8
    )
    angles = 2 * np.pi * np.arange(72) / 72
    radius = outline.radius_at(np.zeros(72), angles)
    start, length = low[:, 1].min(), np.ptp(low[:, 1])
    rings = []
    for shrink, level in (
        (-0.006, 0.014),
        (0.0005, 0.0125),
        (0.0035, 0.009),
        (0.0035, -SOLE_M + 0.001),
        (0.002, -SOLE_M),
        (0.012, -SOLE_M),
        (0.03, -SOLE_M),
        (9.0, -SOLE_M),
    ):
        inward = shrink if shrink > 0.0035 else 0.0
        reach = np.maximum(radius - inward, 0.0) + (shrink if not inward else 0.002)
        if shrink == 9.0:
            reach = np.zeros(72)
        x, z = centre[0] + reach * np.cos(angles), centre[1] + reach * np.sin(angles)
        share = (z - start) / length
        y = np.full(72, tailoring.foot_m + level)
        if level < 0:
            arch = smoothstep(share, 0.26, 0.285) * (1 - smoothstep(share, 0.45, 0.62))
            y += 0.008 * arch + 0.006 * smoothstep(share, 0.88, 1.05)
        rings.append(np.stack([x, y, z], axis=1))
    points = np.concatenate(rings)
    nearest = cKDTree(upper.points).query(points)[1]
    weights = gaussian_filter1d(upper.weights[nearest].reshape(len(rings), 72, -1), 2.0, axis=1, mode="wrap").reshape(
        len(points), -1
    )
    weights = np.tile(weights.reshape(len(rings), 72, -1)[2], (len(rings), 1, 1))
    # The last ring is one point under the arch: it moves as the edge beside it, and not with the toes in front of it.
    weights[-1] = weights[-1, 0]
    faces = grid_faces(len(rings), 72, closed=True)
    return to_triangles(Cloth(points, weights.reshape(len(points), -1), faces))


def shoes(tailoring: Tailoring, fit: SkeletonFit) -> Surface:
    """Both shoes."""
    suit = tailoring.suit
    both = cut(suit, tailoring.foot_m + TOP_LINE_M - suit.points[:, 1])
    parts = []
    for sign in (1.0, -1.0):
        upper = _upper(tailoring, cut(both, both.points[:, 0] * sign))
        parts.append(join(upper, _sole(tailoring, upper)))
    return cloth_surface("shoes", {"shoes": join(*parts)}, fit)


def soles(surface: Surface, fit: SkeletonFit) -> dict[str, dict[str, object]]:
    """Vertices of each shoe that stand on the floor in the T-pose."""
    t_pose = fit.to_t_pose(surface.positions, surface.weights)
    low = t_pose[:, 1] < t_pose[:, 1].min() + 0.004
    sides = {"left": low & (t_pose[:, 0] > 0), "right": low & (t_pose[:, 0] < 0)}
    return {
        side: {"mesh": surface.name, "vertices": [int(i) for i in np.flatnonzero(flags)]}
        for side, flags in sides.items()
    }
