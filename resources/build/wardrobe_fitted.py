"""Parts of garments drawn onto smooth drapes: straight trouser legs, and the part of a coat below its waist."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_cloth import (
    Cloth,
    Profile,
    folds,
    grid_faces,
    hang,
    hull_profile,
    smoothed,
    smoothstep,
    to_triangles,
)
from character_surface import Surface
from scipy.interpolate import LinearNDInterpolator
from scipy.ndimage import gaussian_filter
from wardrobe_pieces import Wearer, few_bones
from wardrobe_seated import OVER_LAP_M, on_lap
from wardrobe_sewn import moved_to, weights_near

EASE_M, HEM_M = 0.009, 0.050
"""Distance of trouser legs from the drape of the legs, and height of their hem over the sole of the base mesh."""
SEAT_M = 0.006
"""Greatest distance of trousers from the hull of seat and waist."""
TAPER = 0.075
AROUND, FLARE = 73, 0.04
LAP_M, LAP_OUT_M = 0.06, 0.012
"""Height over the belt from which jackets go with the lap, and their distance from the drape of the trunk."""

THROAT_M, UNDER_M = (0.07, 0.20, 0.02), 0.05
"""Extent of the throat from the point of the collar: to the sides, downwards, and least distance ahead; and depth of
its upper edge under that point."""
OVER_SKIN_M, AROUND_M = 0.005, 0.015
"""Least distance of a shirt's front from the skin of the throat, and width about it of what is moved with it."""


def drawn_to(points: np.ndarray, profile: Profile, out_m: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Points (N, 3) moved in or out to `out_m` (N,) off a profile about the Y axis, by `share` (N,)."""
    angle, radius, centre = profile.polar(points[:, 1], points[:, [0, 2]])
    wanted = radius + (profile.radius_at(points[:, 1], angle) + out_m - radius) * share
    moved = points.copy()
    moved[:, 0] = centre[:, 0] + wanted * np.cos(angle)
    moved[:, 2] = centre[:, 1] + wanted * np.sin(angle)
    return moved


def leg_drape(wearer: Wearer) -> Profile:
    """A left trouser leg that hangs straight from the thigh, slightly tapered to the hem."""
    tailoring, fit = wearer.tailoring, wearer.fit
    hip, foot = (fit.positions_t[fit.index(f"left{part}")] for part in ("UpperLeg", "Foot"))
    leg = tailoring.suit.points[(tailoring.suit.points[:, 0] > 0) & (tailoring.arm < 0.3)]
    levels = np.arange(tailoring.foot_m + 0.10, tailoring.crotch_m + 0.005, 0.01)
    down = (levels - foot[1]) / (hip[1] - foot[1])
    middle = np.stack([foot[0] + (hip[0] - foot[0]) * down, foot[2] + (hip[2] - foot[2]) * down], axis=1)
    hulls = hull_profile(leg[:, 1], leg[:, [0, 2]], levels, middle, 0.016)
    return smoothed(hang(hulls, TAPER), 4.0, 1.5)


def _close_seat(wearer: Wearer, places: np.ndarray) -> np.ndarray:
    """Points (N, 3) of trousers, drawn in at seat and waist to lie under other garments."""
    tailoring = wearer.tailoring
    angle, radius, _ = tailoring.trunk.polar(places[:, 1], places[:, [0, 2]])
    out_m = np.minimum(radius - tailoring.trunk.radius_at(places[:, 1], angle), SEAT_M)
    share = smoothstep(places[:, 1], tailoring.crotch_m, tailoring.crotch_m + 0.12)
    return drawn_to(places, tailoring.trunk, out_m, share)


def straight_legs(wearer: Wearer, trousers: Surface) -> Surface:
    """Trousers of an asset with smooth, straight legs and level hems; seat and waist stay."""
    tailoring, fit = wearer.tailoring, wearer.fit
    weights = trousers.weights.copy()
    for side in ("left", "right"):
        # Below the ankle cloth hangs from the shin, whatever the foot does.
        shin = fit.index(f"{side}LowerLeg")
        for bone in ("Foot", "Toes"):
            weights[:, shin] += weights[:, fit.index(f"{side}{bone}")]
            weights[:, fit.index(f"{side}{bone}")] = 0.0
    places = fit.to_t_pose(trousers.positions, trousers.weights)
    places = _close_seat(wearer, places)
    drape, top = leg_drape(wearer), tailoring.crotch_m
    parts = [fit.index(f"{side}{part}Leg") for side in ("left", "right") for part in ("Upper", "Lower")]
    left = weights[:, parts[:2]].sum(axis=1) - weights[:, parts[2:]].sum(axis=1)
    for sign in (1.0, -1.0):
        own = (left * sign > 0) & (places[:, 1] < top + 0.04)
        leg = places[own] * np.array([sign, 1.0, 1.0])
        low, hem = float(leg[:, 1].min()), tailoring.foot_m + HEM_M
        # Let down or taken up to a level hem, a little lower behind.
        reach = np.clip((tailoring.knee_m - leg[:, 1]) / (tailoring.knee_m - low - 0.012), 0.0, 1.0)
        below = leg[:, 1] < tailoring.knee_m
        angle, _, _ = drape.polar(leg[:, 1], leg[:, [0, 2]])
        leg[below, 1] = tailoring.knee_m - reach[below] * (tailoring.knee_m - hem)
        knee = np.exp(-(((leg[:, 1] - tailoring.knee_m) / 0.12) ** 2))
        break_m = 1.0 - smoothstep(leg[:, 1], hem + 0.03, hem + 0.16)
        crease = folds(leg[:, 1], angle, 0.10, seed=31 if sign > 0 else 32) * (0.0012 * knee + 0.0016 * break_m)
        share = 1.0 - smoothstep(leg[:, 1], top - 0.10, top + 0.02)
        draped = drawn_to(leg, drape, EASE_M + crease, share)
        draped[:, 0] = np.maximum(draped[:, 0], np.minimum(leg[:, 0], 0.004))
        places[own] = draped * np.array([sign, 1.0, 1.0])
    return moved_to(wearer, replace(trousers, weights=few_bones(weights)), places)


def tail(
    wearer: Wearer,
    body: Cloth,
    below: Cloth,
    heights: np.ndarray,
    profile: Profile,
    out_m: float,
    lies_m: float = OVER_LAP_M,
) -> Cloth:
    """The part of a coat below its waist, from the highest to the lowest of `heights`, `out_m` off a drape; its upper
    edge goes with the `body` of the coat, its hem with the trousers `below` it, or lies `lies_m` over the lap.
    """
    angles = 2 * np.pi * np.arange(AROUND) / (AROUND - 1)
    rows = []
    for height in heights:
        middle = [np.interp(height, profile.levels, profile.centres[:, axis]) for axis in range(2)]
        radius = profile.radius_at(np.full(AROUND, height), angles) + out_m + FLARE * (heights[0] - height)
        rows.append(
            np.stack(
                [middle[0] + radius * np.cos(angles), np.full(AROUND, height), middle[1] + radius * np.sin(angles)], 1
            )
        )
    points = np.concatenate(rows)
    legs = weights_near(below, points).reshape(len(heights), AROUND, -1)
    weights = gaussian_filter(legs, (1.0, 2.5, 0.0), mode=("nearest", "wrap", "nearest")).reshape(len(points), -1)
    weights = on_lap(wearer, below, points, weights, AROUND, lies_m)
    near = smoothstep(points[:, 1], heights[0] - 0.07, heights[0] - 0.01)[:, None]
    weights = near * weights_near(body, points) + (1.0 - near) * weights
    return to_triangles(Cloth(points, few_bones(weights), grid_faces(len(heights), AROUND, closed=False)))


def weights_with(wearer: Wearer, outer: Cloth, below: Cloth, from_m: float) -> np.ndarray:
    """Weights (N, J) of a garment whose part below a height in the T-pose moves as the one below it does, with no step
    between."""
    arms = [index for index, name in enumerate(wearer.fit.names) if "Arm" in name or "Hand" in name]
    share = 1.0 - smoothstep(outer.points[:, 1], from_m - 0.10, from_m)
    share = (share * (outer.weights[:, arms].sum(axis=1) < 0.3))[:, None]
    return few_bones((1.0 - share) * outer.weights + share * weights_near(below, outer.points))


def going_with(wearer: Wearer, outer: Surface, below: Cloth, from_m: float) -> Surface:
    """A garment whose part below a height in the T-pose moves as the garment below it does."""
    cloth = Cloth(wearer.fit.to_t_pose(outer.positions, outer.weights), outer.weights, outer.all_triangles())
    moving = replace(outer, weights=weights_with(wearer, cloth, below, from_m))
    return moved_to(wearer, moving, cloth.points)


def over_lap(wearer: Wearer, body: Cloth, below: Cloth, lies_m: float = OVER_LAP_M) -> Cloth:
    """A grid about the hips that lies `lies_m` over the lap of a seated player in the trousers or skirt `below` it,
    for the weights of jackets and shirts."""
    waist, hem_m = wearer.tailoring.belt_m + LAP_M, float(body.points[:, 1].min()) - 0.01
    drape = smoothed(hang(wearer.tailoring.trunk, 0.30), 2.0, 1.5)
    rows = int(np.ceil((waist - hem_m) / 0.02)) + 1
    return tail(wearer, body, below, np.linspace(waist, hem_m, rows), drape, LAP_OUT_M, lies_m)


def over_throat(wearer: Wearer, points: np.ndarray, linen: np.ndarray) -> np.ndarray:
    """Points (N, 3) of a jacket of which the linen, triangles (T, 3), is moved ahead of the skin of the throat, and
    all that lies before it by as much."""
    collar = wearer.tailoring.collar_point

    def at_throat(places: np.ndarray) -> np.ndarray:
        off = places - collar
        high = (off[:, 1] < -UNDER_M) & (off[:, 1] > -THROAT_M[1])
        return high & (np.abs(off[:, 0]) < THROAT_M[0]) & (off[:, 2] > THROAT_M[2])

    suit = wearer.tailoring.suit.points
    skin = suit[at_throat(suit)]
    rows = np.unique(linen)
    rows = rows[at_throat(points[rows])]
    depth = LinearNDInterpolator(skin[:, :2], skin[:, 2])(points[rows, :2])
    lack = np.nan_to_num(np.maximum(depth + OVER_SKIN_M - points[rows, 2], 0.0))
    rows, lack = rows[lack > 0.0], lack[lack > 0.0]
    moved, near = points.copy(), np.flatnonzero(points[:, 2] > collar[2] + THROAT_M[2])
    far = np.linalg.norm(points[near, None, :2] - points[None, rows, :2], axis=2)
    moved[near, 2] += (lack * np.exp(-((far / AROUND_M) ** 2))).max(axis=1, initial=0.0)
    return moved
