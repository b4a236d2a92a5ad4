"""A buttoned tunic with a stand-up collar and its trimmings: gakuran, marching jacket, and a close dress."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_cloth import (
    Cloth,
    Profile,
    cut,
    folds,
    grid_faces,
    hang,
    hull_profile,
    join,
    smoothed,
    smoothstep,
    to_triangles,
)
from character_garments import NECK_HALF_WIDTH_M, OFF_NECK_M, above_collar, move_out, neck_ring
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import cKDTree
from wardrobe_fitted import drawn_to
from wardrobe_pieces import Wearer
from wardrobe_sewn import Sewn, gold, plain, weights_near
from wardrobe_shirt import neck_of

COLUMNS = 49
BUTTON_M = 0.0075
NECKLINE_M = 0.108
"""Half of the width of a dress's neckline."""
TUNIC_M = 0.011
"""Distance of a tunic from the drape of the trunk."""
SEWN_M, LIFT_M = 0.005, 0.0012
"""Width of the cloth sewn on a tunic's opening, and its height over the tunic."""


def _normals(cloth: Cloth) -> np.ndarray:
    """Normals (N, 3) of a cloth's vertices."""
    corners = cloth.points[cloth.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(cloth.points)
    for corner in range(3):
        np.add.at(normals, cloth.faces[:, corner], across)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def _grown(cloth: Cloth, out_m: np.ndarray) -> Cloth:
    """The cloth moved out along its normals by `out_m` (N,)."""
    return replace(cloth, points=cloth.points + out_m[:, None] * _normals(cloth))


def tunic_drape(wearer: Wearer) -> Profile:
    """The trunk of a tunic, drawn in a little at the waist."""
    return smoothed(hang(wearer.tailoring.trunk, 0.30), 2.0, 1.5)


def front_of_tunic(shell: Cloth) -> LinearNDInterpolator:
    """z of a tunic's front over (x, y), as far as its sides."""
    points = shell.points[np.unique(shell.faces)]
    near = points[np.abs(points[:, 0]) < 0.18]
    middle = np.median(near[:, 2])
    front = near[near[:, 2] > middle]
    return LinearNDInterpolator(front[:, :2], front[:, 2])


def tunic(wearer: Wearer, low_m: float) -> Cloth:
    """Trunk and sleeves of stiff cloth down to a height: smooth from chest to waist, sleeves of even width."""
    tailoring = wearer.tailoring
    suit, arm = tailoring.suit, tailoring.arm
    points = suit.points
    fall = tunic_drape(wearer)
    angle, _, _ = fall.polar(points[:, 1], points[:, [0, 2]])
    crease = folds(points[:, 1], angle, 0.16, seed=41) * 0.0012
    share = 1 - smoothstep(arm, 0.15, 0.6)
    high = 1 - smoothstep(points[:, 1], tailoring.armpit_m - 0.02, tailoring.shoulder[1] + 0.01)
    low = 1 - smoothstep(points[:, 1], tailoring.armpit_m - 0.12, tailoring.armpit_m - 0.04)
    cloth = _grown(suit, 0.007 * np.ones(len(points)))
    target = fall.radius_at(cloth.points[:, 1], angle) + TUNIC_M + crease
    cloth = replace(cloth, points=move_out(cloth.points, fall, (1, 0, 2), target, share * high))
    cloth = replace(cloth, points=drawn_to(cloth.points, fall, TUNIC_M + crease * high * (1 - low), share * low))
    cloth = _even_sleeves(wearer, cloth)
    cloth = cut(cloth, cloth.points[:, 1] - low_m)
    cloth = cut(cloth, tailoring.wrist_m + 0.006 - np.abs(cloth.points[:, 0]))
    neck = np.maximum(-above_collar(tailoring, cloth.points), np.abs(cloth.points[:, 0]) - NECK_HALF_WIDTH_M)
    return cut(cloth, neck)


def _even_sleeves(wearer: Wearer, cloth: Cloth) -> Cloth:
    tailoring, points = wearer.tailoring, cloth.points.copy()
    levels = np.arange(tailoring.shoulder[0], tailoring.wrist_m + 0.03, 0.01)
    centres = np.tile(tailoring.shoulder[[1, 2]], (len(levels), 1))
    for sign in (1.0, -1.0):
        own = (tailoring.arm > 0.3) & (points[:, 0] * sign > 0)
        arm = points[own] * np.array([sign, 1.0, 1.0])
        solid = tailoring.arm[own] > 0.9
        sleeve = smoothed(hull_profile(arm[solid, 0], arm[solid][:, [1, 2]], levels, centres, 0.016), 4.0, 1.5)
        angle, _, _ = sleeve.polar(arm[:, 0], arm[:, [1, 2]])
        share = (arm[:, 0] - levels[0]) / (levels[-1] - levels[0])
        bend = np.exp(-(((share - 0.5) / 0.2) ** 2))
        crease = folds(arm[:, 0], angle, 0.09, seed=42 if sign > 0 else 43) * 0.0022 * bend
        target = np.maximum(sleeve.radius_at(arm[:, 0], angle), 0.044 - 0.006 * share) + crease
        moved = move_out(arm, sleeve, (0, 1, 2), target, smoothstep(tailoring.arm[own], 0.6, 0.98))
        points[own] = moved * np.array([sign, 1.0, 1.0])
    return replace(cloth, points=points)


def stand_collar(wearer: Wearer, shell: Cloth) -> Cloth:
    """A stand-up collar, closed in front by hooks."""
    tailoring = wearer.tailoring
    columns = np.linspace(-np.pi, np.pi, 73)
    base = neck_ring(tailoring, tailoring.suit, 0.0, columns)
    outward = np.stack([np.sin(columns), np.zeros(73), -np.cos(columns)], axis=1)
    upper = neck_ring(tailoring, neck_of(wearer), 0.026, columns) + OFF_NECK_M * outward
    up = tailoring.collar_normal * 0.8 + np.array([0.0, 0.2, 0.05])
    top = upper + outward * 0.004 + up * 0.003
    rows = [base + outward * 0.003, base + outward * 0.0055, (base + upper) / 2 + outward * 0.006]
    rows += [top + outward * 0.001, top + up * 0.001, top - outward * 0.0025, base + outward * 0.001]
    points = np.concatenate(rows)
    weights = np.tile(weights_near(shell, base), (len(rows), 1))
    return to_triangles(Cloth(points, weights, grid_faces(len(rows), 73, closed=False)))


def neckline(wearer: Wearer, shell: Cloth) -> Cloth:
    """Cloth from the opening of a tunic to the foot of its stand-up collar, so that no gap opens around the neck."""
    tailoring = wearer.tailoring
    columns = np.linspace(-np.pi, np.pi, 73)
    base = neck_ring(tailoring, tailoring.suit, 0.0, columns)
    outward = np.stack([np.sin(columns), np.zeros(73), -np.cos(columns)], axis=1)
    sewn = neck_ring(tailoring, shell, -SEWN_M, columns)
    sewn += LIFT_M * _normals(shell)[cKDTree(shell.points).query(sewn)[1]]
    inside = base + outward * 0.002
    rows = [sewn, (sewn + inside) / 2 + tailoring.collar_normal * 0.004]
    rows = [row[::2] for row in (*rows, inside, inside + tailoring.collar_normal * 0.008)]
    weights = np.tile(weights_near(shell, rows[0]), (len(rows), 1))
    return to_triangles(Cloth(np.concatenate(rows), weights, grid_faces(len(rows), len(rows[0]), closed=False)))


def buttons(shell: Cloth, places: np.ndarray, radius_m: float = BUTTON_M) -> Sewn:
    """Domed buttons on the front at (x, y) places (N, 2)."""
    front = front_of_tunic(shell)
    angles = 2 * np.pi * np.arange(10) / 10
    rings = ((1.0, -0.002), (0.95, 0.0035), (0.55, 0.0060), (0.0, 0.0068))
    parts = []
    for x, y in places:
        depth = float(np.nan_to_num(front(x, y)))
        disc = np.concatenate(
            [
                np.stack(
                    [
                        x + radius_m * r * np.cos(angles),
                        y + radius_m * r * np.sin(angles),
                        np.full(len(angles), depth + out),
                    ],
                    axis=1,
                )
                for r, out in rings
            ]
        )
        weights = np.tile(weights_near(shell, np.array([[x, y, depth]])), (len(disc), 1))
        parts.append(to_triangles(Cloth(disc, weights, grid_faces(len(rings), len(angles), closed=True))))
    return gold(join(*parts))


def ribbon(shell: Cloth, path: np.ndarray, half_m: float, lift_m: float) -> Cloth:
    """A flat ribbon laid on the front of a shell along (x, y) places (K, 2)."""
    front = front_of_tunic(shell)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    rows = []
    for side, lift in ((-1.0, -0.001), (-0.8, lift_m), (0.0, lift_m * 1.3), (0.8, lift_m), (1.0, -0.001)):
        flat = path + side * half_m * across
        depth = front(flat[:, 0], flat[:, 1])
        good = ~np.isnan(depth)
        depth = np.interp(np.arange(len(depth)), np.flatnonzero(good), depth[good])
        rows.append(np.stack([flat[:, 0], flat[:, 1], depth + lift], axis=1))
    points = np.concatenate(rows)
    faces = grid_faces(len(rows), len(path), closed=False)
    return to_triangles(Cloth(points, weights_near(shell, points), faces[:, ::-1]))


def close_dress(wearer: Wearer, waist_m: float) -> Cloth:
    """The bodice of a dress: close to the body, a round neckline, sleeves to below the elbow."""
    tailoring = wearer.tailoring
    suit = tailoring.suit
    fall = smoothed(hang(tailoring.trunk, 1.2), 1.5, 1.5)
    points = suit.points
    angle, _, _ = fall.polar(points[:, 1], points[:, [0, 2]])
    target = fall.radius_at(points[:, 1], angle) + 0.006
    share = (1 - smoothstep(tailoring.arm, 0.15, 0.5)) * (
        1 - smoothstep(points[:, 1], tailoring.armpit_m - 0.03, tailoring.armpit_m + 0.05)
    )
    cloth = _grown(suit, np.full(len(points), 0.004))
    cloth = replace(cloth, points=move_out(cloth.points, fall, (1, 0, 2), target, share))
    cloth = cut(cloth, cloth.points[:, 1] - waist_m)
    along = (tailoring.wrist_m - tailoring.shoulder[0]) * 0.68 + tailoring.shoulder[0]
    cloth = cut(cloth, along - np.abs(cloth.points[:, 0]))
    ahead = smoothstep(cloth.points[:, 2], tailoring.collar_point[2] + 0.02, tailoring.collar_point[2] + 0.12)
    aside = np.clip(np.abs(cloth.points[:, 0]) / 0.13, 0.0, 1.0)
    depth = 0.030 + 0.042 * ahead * np.sqrt(1.0 - aside**2)
    neck = np.maximum(-above_collar(tailoring, cloth.points) - depth, np.abs(cloth.points[:, 0]) - NECKLINE_M)
    return cut(cloth, neck)


def front_strip(shell: Cloth, top_m: float, low_m: float) -> Sewn:
    """The edge where a tunic closes."""
    path = np.stack([np.full(30, 0.012), np.linspace(top_m, low_m, 30)], axis=1)
    return plain(ribbon(shell, path, 0.013, 0.0025))
