"""Concert trousers, and collar and placket of a shirt, draped over the base mesh's helper suit in the T-pose."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from character_cloth import (
    Cloth,
    Profile,
    border_loops,
    catmull_clark,
    cloth_surface,
    cut,
    folds,
    grid_faces,
    hang,
    hull_profile,
    join,
    relaxed,
    smoothed,
    smoothstep,
    to_triangles,
)
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface
from scipy.interpolate import LinearNDInterpolator
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

SEAM_M = 1e-4
"""Distance off the middle up to which vertices lie on the seam between the legs."""
CREASE_M = (0.08, 0.13)
"""Width to either side, and height over the crotch, of the crease of trousers."""
WAISTBAND_M = 0.036
NECK_HALF_WIDTH_M = 0.11
OFF_NECK_M = 0.004

Front = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""z of the foremost layer of a cloth over x and y."""


@dataclass(frozen=True)
class Tailoring:
    """A body's measures in the T-pose, metres, and the refined suit that clothes are cut from.

    `suit` holds triangles; `arm` is each vertex' share of arm and hand bones; `trunk` the drape of the torso by height,
    `collar_point` and `collar_normal` the plane of the collar's seam (normal towards the head).
    """

    suit: Cloth
    arm: np.ndarray
    trunk: Profile
    belt_m: float
    crotch_m: float
    armpit_m: float
    shoulder: np.ndarray
    wrist_m: float
    knee_m: float
    foot_m: float
    collar_point: np.ndarray
    collar_normal: np.ndarray


def _is_arm(name: str) -> bool:
    return any(part in name for part in ("Arm", "Hand", "Thumb", "Index", "Middle", "Ring", "Little"))


def measure(source: Source, fit: SkeletonFit) -> Tailoring:
    """The measures of a body and its refined suit."""
    group = source.groups["helper-tights"].vertices
    used, faces = np.unique(group, return_inverse=True)
    points = fit.to_t_pose(source.vertices[used], fit.weights[used])
    suit = to_triangles(catmull_clark(Cloth(points, fit.weights[used], faces.reshape(group.shape))))
    joint = {name: fit.positions_t[index] for index, name in enumerate(fit.names)}
    arm = suit.weights[:, [index for index, name in enumerate(fit.names) if _is_arm(name)]].sum(axis=1)
    trunk_points = suit.points[arm < 0.5]
    belt = (joint["spine"][1] + joint["chest"][1]) / 2
    middle = suit.points[np.abs(suit.points[:, 0]) < 0.01]
    crotch = float(middle[middle[:, 1] > joint["leftUpperLeg"][1] * 0.7, 1].min())
    shoulder = joint["leftUpperArm"]
    levels = np.arange(crotch - 0.06, shoulder[1], 0.01)
    centres = np.array(
        [
            [0.0, np.ptp(z) / 2 + z.min()]
            for z in (trunk_points[np.abs(trunk_points[:, 1] - y) < 0.02, 2] for y in levels)
        ]
    )
    trunk = hull_profile(trunk_points[:, 1], trunk_points[:, [0, 2]], levels, centres, 0.016)
    nape = joint["neck"] + np.array([0.0, 0.020, -0.05])
    notch = joint["leftShoulder"] * np.array([0.0, 1.0, 1.0]) + np.array([0.0, 0.032, 0.045])
    across = notch - nape
    normal = np.array([0.0, across[2], -across[1]])
    return Tailoring(
        suit=suit,
        arm=arm,
        trunk=smoothed(trunk, 1.5, 1.0),
        belt_m=float(belt),
        crotch_m=crotch,
        armpit_m=float(shoulder[1] - 0.045 * joint["head"][1]),
        shoulder=shoulder,
        wrist_m=float(joint["leftHand"][0]),
        knee_m=float(joint["leftLowerLeg"][1]),
        foot_m=float(suit.points[:, 1].min()),
        collar_point=nape,
        collar_normal=normal / np.linalg.norm(normal),
    )


def above_collar(tailoring: Tailoring, points: np.ndarray) -> np.ndarray:
    """(N,) signed distance of T-pose points to the plane of the collar's seam, positive towards the head."""
    return (points - tailoring.collar_point) @ tailoring.collar_normal


def weights_from(cloth: Cloth, points: np.ndarray) -> np.ndarray:
    distances, nearest = cKDTree(cloth.points).query(points, k=4)
    shares = 1.0 / (distances + 0.002) ** 2
    weights = np.einsum("nk,nkj->nj", shares, cloth.weights[nearest])
    return weights / weights.sum(axis=1, keepdims=True)


def move_out(
    points: np.ndarray, profile: Profile, axes: tuple[int, int, int], target: np.ndarray, share: np.ndarray
) -> np.ndarray:
    """Move points from the profile's axis out to the radius `target` (N,) if they are nearer, by `share` (N,)."""
    along, first, second = axes
    angle, radius, centre = profile.polar(points[:, along], points[:, [first, second]])
    grown = radius + np.maximum(target - radius, 0.0) * share
    moved = points.copy()
    moved[:, first] = centre[:, 0] + grown * np.cos(angle)
    moved[:, second] = centre[:, 1] + grown * np.sin(angle)
    return moved


def front_of(cloth: Cloth) -> LinearNDInterpolator:
    """z of the foremost layer of a cloth over (x, y)."""
    points = cloth.points[np.unique(cloth.faces)]
    near = points[(np.abs(points[:, 0]) < 0.12) & (points[:, 2] > np.median(points[np.abs(points[:, 0]) < 0.12, 2]))]
    return LinearNDInterpolator(near[:, :2], near[:, 2])


def neck_ring(tailoring: Tailoring, cloth: Cloth, height_m: float, angles: np.ndarray) -> np.ndarray:
    """Points (N, 3) at which the plane `height_m` above the collar's seam intersects a cloth, by angle about the neck
    (0 at the nape; the last angle equals the first one).
    """
    neck = cut(
        cloth,
        np.maximum(height_m - above_collar(tailoring, cloth.points), np.abs(cloth.points[:, 0]) - NECK_HALF_WIDTH_M),
    )
    ring = max((neck.points[loop] for loop in border_loops(neck.faces)), key=lambda points: points[:, 1].mean())
    middle = tailoring.collar_point + np.array([0.0, 0.0, 0.05])
    around = np.arctan2(ring[:, 0], middle[2] - ring[:, 2])
    order = np.argsort(around)
    once = angles[:-1]
    found = np.stack([np.interp(once, around[order], ring[order, axis], period=2 * np.pi) for axis in range(3)], axis=1)
    found = gaussian_filter1d(found, 1.5, axis=0, mode="wrap")
    return np.concatenate([found, found[:1]])


def collar(tailoring: Tailoring, shirt: Cloth, front: Front, neck: Cloth, longer_m: float = 0.0) -> Cloth:
    """A turned-down collar on the shirt's neck seam, buttoned, its points spread; it stands about a `neck` of skin, and
    falls `longer_m` lower behind."""
    columns = np.linspace(-np.pi, np.pi, 73)
    outward = np.stack([np.sin(columns), np.zeros(73), -np.cos(columns)], axis=1)
    base = neck_ring(tailoring, tailoring.suit, 0.0, columns)
    upper = neck_ring(tailoring, neck, 0.026, columns) + OFF_NECK_M * outward
    up = tailoring.collar_normal * 0.8 + np.array([0.0, 0.2, 0.05])
    throat = smoothstep(np.abs(columns), 0.62 * np.pi, np.pi)[:, None]
    top = (
        upper
        + outward * (0.004 + 0.005 * throat - 0.007 * np.sin(columns)[:, None] ** 2)
        + up * (0.006 - 0.006 * throat)
    )
    rise = top - base
    proud = outward * (0.001 + 0.006 * throat)
    rows = [base - up * 0.008 - outward * 0.001, base + proud, base + rise * 0.5 + proud, top]
    rows += [top + up * 0.0025 + outward * 0.0025, top + outward * 0.0055]
    length = 0.036 + 0.026 * throat + longer_m * (1.0 - throat)
    spread = np.sign(columns)[:, None] * np.array([1.0, 0.0, 0.0]) * 0.034 * throat**2
    for share in (0.35, 0.7, 1.0):
        off = outward * (0.0055 + 0.003 * share + 0.7 * longer_m * (1.0 - throat) * share)
        fall = top + off - rise * (length / 0.036) * share + spread * share
        lying = front(fall[:, 0], fall[:, 1])
        lying = np.where(np.isnan(lying), -1.0, lying)
        fall[:, 2] = np.where(throat[:, 0] > 0.02, np.maximum(fall[:, 2], lying + 0.004), fall[:, 2])
        rows.append(fall)
    points = np.concatenate(rows)
    weights = np.tile(weights_from(shirt, base + outward * 0.001), (len(rows), 1))
    return to_triangles(Cloth(points, weights, grid_faces(len(rows), 73, closed=False)))


def placket(tailoring: Tailoring, shirt: Cloth, front: Front, top_m: float) -> tuple[Cloth, Cloth]:
    """The buttoned strip down the front, and its buttons."""
    heights = np.linspace(top_m, tailoring.belt_m - 0.02, 40)
    columns = np.array([-0.0165, -0.0155, 0.0, 0.0155, 0.0165])
    lift = np.array([-0.0015, 0.0018, 0.0022, 0.0018, -0.0015])
    x, y = np.meshgrid(columns, heights)
    z = front(x.ravel(), y.ravel()) + np.tile(lift, len(heights))
    points = np.stack([x.ravel(), y.ravel(), z], axis=1)
    strip = to_triangles(Cloth(points, weights_from(shirt, points), grid_faces(len(heights), 5, closed=False)[:, ::-1]))
    buttons = []
    angles = 2 * np.pi * np.arange(12) / 12
    for height in np.arange(top_m - 0.03, tailoring.belt_m + 0.03, -0.085):
        depth = float(front(0.0, height)) + 0.0022
        rings = [(0.0055, 0.0), (0.0055, 0.0018), (0.0035, 0.0022), (0.0, 0.0016)]
        disc = np.concatenate(
            [
                np.stack([r * np.cos(angles), height + r * np.sin(angles), np.full(12, depth + out)], axis=1)
                for r, out in rings
            ]
        )
        weights = np.tile(weights_from(shirt, np.array([[0.0, height, depth]])), (len(disc), 1))
        buttons.append(to_triangles(Cloth(disc, weights, grid_faces(len(rings), 12, closed=True))))
    return strip, join(*buttons)


def band(profile: Profile, suit: Cloth, rows: list[tuple[float, float]]) -> Cloth:
    """A ring round the waist from (height, distance from the drape) rows."""
    columns = 72
    angles = 2 * np.pi * np.arange(columns) / columns
    level = float(np.mean([height for height, _ in rows]))
    centre = np.array([np.interp(level, profile.levels, profile.centres[:, k]) for k in range(2)])
    points = np.concatenate(
        [
            np.stack(
                [centre[0] + radius * np.cos(angles), np.full(columns, height), centre[1] + radius * np.sin(angles)],
                axis=1,
            )
            for height, radius in ((h, profile.radius_at(np.full(columns, h), angles) + out) for h, out in rows)
        ]
    )
    # All points of a column have the same weights: a belt does not shear.
    column = weights_from(suit, np.stack([points[:columns, 0], np.full(columns, level), points[:columns, 2]], axis=1))
    return to_triangles(
        Cloth(points, np.tile(column, (len(rows), 1)), grid_faces(len(rows), columns, closed=True)[:, ::-1])
    )


def _leg_drape(tailoring: Tailoring, leg: np.ndarray, hip: np.ndarray) -> Profile:
    """A left trouser leg: falling from the seat, tapered to the hem."""
    levels = np.arange(tailoring.foot_m + 0.10, tailoring.crotch_m + 0.005, 0.01)
    centres = np.tile([hip[0], hip[2] - 0.005], (len(levels), 1))
    hulls = hull_profile(leg[:, 1], leg[:, [0, 2]], levels, centres, 0.016)
    slopes = 0.085 + 0.25 * smoothstep(levels, tailoring.crotch_m - 0.22, tailoring.crotch_m)
    return smoothed(hang(hulls, slopes), 3.0, 1.0)


def trousers(tailoring: Tailoring, fit: SkeletonFit) -> Surface:
    """Straight-cut trousers with a waistband and a belt."""
    suit = tailoring.suit
    points = suit.points
    drape = smoothed(hang(tailoring.trunk, 0.4), 2.0, 1.5)
    angle, radius, _ = drape.polar(points[:, 1], points[:, [0, 2]])
    target = drape.radius_at(points[:, 1], angle) + 0.007
    # Only the outside of the seat: cloth between the legs is not moved.
    share = smoothstep(points[:, 1], tailoring.crotch_m - 0.04, tailoring.crotch_m + 0.04) * (tailoring.arm < 0.3)
    share *= smoothstep(radius / target, 0.45, 0.8)
    # Towards the crotch cloth goes in between the legs in a crease, not under a ledge.
    aside = smoothstep(np.abs(points[:, 0]), 0.0, CREASE_M[0])
    seam_m = float(points[np.abs(points[:, 0]) < SEAM_M, 1].min())
    above = smoothstep(points[:, 1], seam_m, seam_m + CREASE_M[1])
    moved = move_out(points, drape, (1, 0, 2), target, share * np.maximum(aside, above))
    joint = fit.positions_t[fit.index("leftUpperLeg")]
    for sign in (1.0, -1.0):
        own = (points[:, 0] * sign > 0) & (points[:, 1] < tailoring.crotch_m + 0.02)
        leg = moved[own] * np.array([sign, 1.0, 1.0])
        profile = _leg_drape(tailoring, points[own] * np.array([sign, 1.0, 1.0]), joint)
        leg_angle, _, _ = profile.polar(leg[:, 1], leg[:, [0, 2]])
        low = 1 - smoothstep(leg[:, 1], tailoring.foot_m + 0.09, tailoring.foot_m + 0.22)
        knee = np.exp(-(((leg[:, 1] - tailoring.knee_m) / 0.10) ** 2))
        crease = folds(leg[:, 1], leg_angle, 0.07, seed=31 if sign > 0 else 32) * (0.0014 * low + 0.0012 * knee)
        target = profile.radius_at(leg[:, 1], leg_angle) + 0.007 + crease
        share = 1 - smoothstep(leg[:, 1], tailoring.crotch_m - 0.03, tailoring.crotch_m + 0.015)
        draped = move_out(leg, profile, (1, 0, 2), target, share)
        draped[:, 0] = np.maximum(draped[:, 0], np.minimum(leg[:, 0], 0.003))
        moved[own] = draped * np.array([sign, 1.0, 1.0])
    weights = suit.weights.copy()
    for side in ("left", "right"):
        # Below the ankle cloth hangs from the shin, whatever the foot does.
        shin = fit.index(side + "LowerLeg")
        for bone in ("Foot", "Toes"):
            weights[:, shin] += weights[:, fit.index(side + bone)]
            weights[:, fit.index(side + bone)] = 0.0
    between_legs = 1 - smoothstep(np.abs(moved[:, 0]), 0.05, 0.10)
    near_crotch = np.exp(-(((moved[:, 1] - seam_m) / 0.07) ** 2)) * between_legs * (tailoring.arm < 0.1)
    cloth = relaxed(Cloth(moved, weights, suit.faces), near_crotch, 80)
    cloth = cut(cloth, tailoring.belt_m - 0.005 - cloth.points[:, 1])
    cloth = cut(cloth, cloth.points[:, 1] - (tailoring.foot_m + 0.115))
    # The hem is let down to the shoe from where the ankle was cut off, a little lower behind.
    top, cut_m, hem_m = tailoring.knee_m, tailoring.foot_m + 0.115, tailoring.foot_m + 0.046
    points = cloth.points.copy()
    low = points[:, 1] < top
    reach = (top - points[low, 1]) / (top - cut_m)
    slope = 0.16 * (points[low, 2] - joint[2]) * smoothstep(reach, 0.7, 1.0)
    points[low, 1] = top - reach * (top - hem_m) + slope
    cloth = replace(cloth, points=points)
    belt = tailoring.belt_m
    waistband = band(
        tailoring.trunk,
        suit,
        [(belt - WAISTBAND_M, 0.005), (belt - WAISTBAND_M, 0.010), (belt, 0.010), (belt + 0.002, 0.008), (belt, 0.004)],
    )
    leather = [(belt - 0.033, 0.009), (belt - 0.032, 0.0125), (belt - 0.004, 0.0125), (belt - 0.003, 0.009)]
    return cloth_surface(
        "trousers", {"trousers": join(cloth, waistband), "belt": band(tailoring.trunk, suit, leather)}, fit
    )
