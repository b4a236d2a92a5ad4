"""Sewn parts of outfits in the T-pose: skirts, socks, ties, collars, braid, buttons, hats."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from character_cloth import Cloth, Profile, cut, grid_faces, hull_profile, join, smoothed, smoothstep, to_triangles
from character_garments import above_collar, move_out
from character_surface import Surface, modelled, smooth_normals
from scipy.spatial import cKDTree
from wardrobe_atlas import CHECK, GOLD, plain_uvs, spot_uvs
from wardrobe_pieces import Wearer, few_bones
from wardrobe_seated import seated_weights

PLEATS, PER_PLEAT = 24, 4
WELT_M = (0.0025, 0.03)
"""Thickness of the upper edge of socks, and height over which they become so thick."""
EVEN_M, EVEN_OVER = 0.018, 48
"""Radius and number of the vertices over which weights of the upper edge of socks are averaged."""
SKIRT_BONES = 5
"""Bones that a skirt goes with between the legs: hips, thighs and shins."""
OUTER_M, LOWER = (0.15, 0.22), (0.25, 1.0)
"""Distances off the middle, and shares of a skirt's length, between which the other leg gets its share of a skirt."""
INSTEP_M = 0.12
"""Height over the sole of the base mesh from which feet come before the shins."""
LEAST_SLICE = 8
"""Least number of vertices in a slice of a garment."""
FARTHEST_M = 0.030
"""Greatest distance in metres by which a garment is widened to cover another one."""


@dataclass(frozen=True)
class Sewn:
    """A piece in the T-pose with its texture coordinates (N, 2); `folded` over, it faces outwards as it was made."""

    cloth: Cloth
    uvs: np.ndarray
    folded: bool = False


def plain(cloth: Cloth) -> Sewn:
    """A piece of plain cloth, laid on its part of the atlas as seen from the front."""
    return Sewn(cloth, plain_uvs(cloth.points[:, 0], cloth.points[:, 1]))


def gold(cloth: Cloth) -> Sewn:
    """A piece of smooth shining material: metal, braid, silk."""
    spread = np.ptp(cloth.points, axis=0)[:2].max() + 1e-9
    return Sewn(cloth, spot_uvs(GOLD, (cloth.points[:, :2] - cloth.points[:, :2].min(axis=0)) / spread))


def facing_out(sewn: Sewn) -> Sewn:
    """A piece whose faces are turned away from its middle."""
    if sewn.folded:
        return sewn
    cloth = sewn.cloth
    corners = cloth.points[cloth.faces] - cloth.points.mean(axis=0)
    volume = np.einsum("na,na->", np.cross(corners[:, 0], corners[:, 1]), corners[:, 2])
    return sewn if volume > 0.0 else replace(sewn, cloth=replace(cloth, faces=cloth.faces[:, ::-1]))


def garment(name: str, parts: dict[str, list[Sewn]], wearer: Wearer, bones: int = 4) -> Surface:
    """Pieces by material as one surface of an outfit's file, all facing out."""
    outwards = {material: [facing_out(one) for one in own] for material, own in parts.items()}
    return sewn_surface(name, outwards, wearer, bones)


def sewn_surface(name: str, parts: dict[str, list[Sewn]], wearer: Wearer, bones: int = 4) -> Surface:
    """Pieces by material as one surface of the file."""
    pieces = [piece for own in parts.values() for piece in own]
    whole = join(*(piece.cloth for piece in pieces))
    weights = few_bones(whole.weights, bones)
    triangles, start = {}, 0
    for material, own in parts.items():
        count = sum(len(piece.cloth.faces) for piece in own)
        triangles[material] = whole.faces[start : start + count]
        start += count
    places = wearer.fit.to_rest_pose(whole.points, weights)
    return modelled(name, places, weights, triangles, uvs=np.concatenate([piece.uvs for piece in pieces]))


def weights_near(cloth: Cloth, points: np.ndarray) -> np.ndarray:
    """Skin weights (N, J) of a cloth's six nearest vertices."""
    far, rows = cKDTree(cloth.points).query(points, k=6)
    shares = 1.0 / (far + 0.004) ** 2
    return np.einsum("nk,nkj->nj", shares / shares.sum(axis=1, keepdims=True), cloth.weights[rows])


def _leg_weights(wearer: Wearer, points: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Skin weights of cloth that hangs from the hips around both legs; `left` (N,) is the left leg's share."""
    fit = wearer.fit
    weights = np.zeros((len(points), len(fit.names)))
    hip, knee = (fit.positions_t[fit.index(f"left{part}Leg")] for part in ("Upper", "Lower"))
    hips = smoothstep(points[:, 1], hip[1] - 0.13, hip[1] + 0.09)
    shin = 1.0 - smoothstep(points[:, 1], knee[1] - 0.10, knee[1] + 0.08)
    weights[:, fit.index("hips")] = hips
    for side, share in (("left", left), ("right", 1.0 - left)):
        weights[:, fit.index(f"{side}UpperLeg")] = (1.0 - hips) * share * (1.0 - shin)
        weights[:, fit.index(f"{side}LowerLeg")] = (1.0 - hips) * share * shin
    return weights


def _about_both_legs(wearer: Wearer, low: float, high: float) -> Profile:
    """Hull of trunk and both legs by height."""
    suit, tailoring = wearer.tailoring.suit, wearer.tailoring
    own = tailoring.arm < 0.3
    levels = np.arange(low - 0.01, high + 0.02, 0.015)
    points = suit.points[own]
    middle = wearer.fit.positions_t[wearer.fit.index("hips")][2]
    centres = np.tile([0.0, middle], (len(levels), 1))
    hulls = hull_profile(points[:, 1], points[:, [0, 2]], levels, centres, 0.02)
    return smoothed(hulls, 2.0, 1.5)


@dataclass(frozen=True)
class Skirt:
    """A skirt from waist to hem (heights, m), how much wider it becomes per metre, how deep its pleats are, how far off
    the middle cloth goes with one leg alone, the share of its width at the hips that a row keeps of the one above, and
    the share of the other leg in the hem at the sides, which keeps it beside thighs that turn outwards.
    """

    top_m: float
    hem_m: float
    flare: float
    pleat_m: float
    rows: int = 12
    between_m: float = 0.09
    kept: float = 0.997
    other_leg: float = 0.0


def skirt(wearer: Wearer, shape: Skirt, *, checked: bool = False) -> Sewn:
    """A skirt about both legs that falls from the hips."""
    profile = _about_both_legs(wearer, shape.hem_m, shape.top_m)
    columns = PLEATS * PER_PLEAT
    angles = 2 * np.pi * np.arange(columns + 1) / columns
    heights = np.linspace(shape.top_m, shape.hem_m, shape.rows)
    saw = np.tile([0.0, 1.0, 0.55, 0.15], PLEATS)
    saw = np.append(saw, saw[0])
    # Heads of pleats are sewn down over the hips.
    widest = np.zeros(columns + 1)
    rows, uvs = [], []
    for height in heights:
        down = shape.top_m - height
        ease = 0.003 + 0.006 * smoothstep(np.array([down]), 0.0, 0.12)[0]
        # Cloth hangs over the feet, not around them.
        level = max(height, wearer.tailoring.foot_m + INSTEP_M)
        hull = profile.radius_at(np.full(columns + 1, level), angles) + ease
        widest = np.maximum(widest, hull) if down < 0.25 else np.maximum(widest * shape.kept, hull)
        open_pleat = shape.pleat_m * smoothstep(np.array([down]), 0.04, 0.30)[0]
        radius = widest + shape.flare * down**1.3 + open_pleat * (saw - 0.4)
        middle = np.array([np.interp(height, profile.levels, profile.centres[:, k]) for k in range(2)])
        rows.append(
            np.stack(
                [
                    middle[0] + radius * np.cos(angles),
                    np.full(columns + 1, height),
                    middle[1] + radius * np.sin(angles),
                ],
                axis=1,
            )
        )
        turn = angles / (2 * np.pi)
        if checked:
            uvs.append(spot_uvs(CHECK, np.stack([turn, np.full(columns + 1, down / 0.55)], axis=1)))
        else:
            uvs.append(plain_uvs(turn * 1.6 - 0.8, np.full(columns + 1, height)))
    points = np.concatenate(rows)
    faces = grid_faces(shape.rows, columns + 1, closed=False)[:, ::-1]
    left = _left_share(points, shape)
    weights = seated_weights(wearer, points, _leg_weights(wearer, points, left), columns + 1, left)
    return Sewn(to_triangles(Cloth(points, weights, faces[:, ::-1])), np.concatenate(uvs))


def _left_share(points: np.ndarray, shape: Skirt) -> np.ndarray:
    """The left leg's share (N,) of what both legs move of a skirt."""
    x, down = points[:, 0], shape.top_m - points[:, 1]
    other = shape.other_leg * smoothstep(np.abs(x), *OUTER_M) * smoothstep(down / (shape.top_m - shape.hem_m), *LOWER)
    share = smoothstep(x, -shape.between_m, shape.between_m)
    return share + (1.0 - 2.0 * share) * other


def _layer(suit: Cloth, out_m: float | np.ndarray) -> Cloth:
    corners = suit.points[suit.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(suit.points)
    for corner in range(3):
        np.add.at(normals, suit.faces[:, corner], across)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return replace(suit, points=suit.points + out_m * normals)


def shell(wearer: Wearer, low_m: float, high_m: float, out_m: float) -> Sewn:
    """A close layer over the legs between two heights: socks, with a welt at their upper edge."""
    suit = wearer.tailoring.suit
    welt_m = WELT_M[0] * smoothstep(suit.points[:, 1], high_m - WELT_M[1], high_m)
    layer = _layer(suit, out_m + welt_m[:, None])
    layer = cut(layer, 0.3 - _arm_share(wearer, layer))
    layer = cut(layer, high_m - layer.points[:, 1])
    layer = cut(layer, layer.points[:, 1] - low_m)
    # Knees bend an edge across the skin's edges in steps.
    share = smoothstep(layer.points[:, 1], high_m - 2.0 * WELT_M[1], high_m - WELT_M[1])[:, None]
    weights = (1.0 - share) * layer.weights + share * _even_weights(suit, layer.points)
    return plain(_with_rim(replace(layer, weights=weights), out_m + WELT_M[0]))


def _even_weights(cloth: Cloth, points: np.ndarray) -> np.ndarray:
    """Skin weights (N, J) at places (N, 3) as means of a cloth's around them."""
    far, rows = cKDTree(cloth.points).query(points, k=EVEN_OVER)
    shares = np.exp(-((far / EVEN_M) ** 2))
    return np.einsum("nk,nkj->nj", shares / shares.sum(axis=1, keepdims=True), cloth.weights[rows])


def _with_rim(cloth: Cloth, in_m: float) -> Cloth:
    """A cloth with its highest edges turned inwards to the skin, so that they are as thick as knitwear."""
    edges = cloth.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, index, uses = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    upper = edges[index[uses == 1]]
    upper = upper[(cloth.points[upper, 1] > cloth.points[:, 1].max() - 1e-4).all(axis=1)]
    rows, own = np.unique(upper, return_inverse=True)
    own = own.reshape(-1, 2)
    inner = cloth.points[rows].copy()
    for side in (inner[:, 0] > 0.0, inner[:, 0] <= 0.0):
        off = inner[side][:, [0, 2]] - inner[side][:, [0, 2]].mean(axis=0)
        inner[np.ix_(side, [0, 2])] -= in_m * off / np.linalg.norm(off, axis=1, keepdims=True)
    start = len(cloth.points)
    faces = [np.column_stack([upper[:, 1], upper[:, 0], start + own[:, 0]])]
    faces.append(np.column_stack([upper[:, 1], start + own[:, 0], start + own[:, 1]]))
    points, weights = np.concatenate([cloth.points, inner]), np.concatenate([cloth.weights, cloth.weights[rows]])
    return Cloth(points, weights, np.concatenate([cloth.faces, *faces]))


def neck_band(wearer: Wearer, low_m: float, high_m: float, out_m: float, half_m: float = 0.13) -> Sewn:
    """Close layer around the neck between two heights above the collar's seam, up to a distance on either side."""
    layer = _layer(wearer.tailoring.suit, out_m)
    layer = cut(layer, half_m - np.abs(layer.points[:, 0]))
    layer = cut(layer, high_m - above_collar(wearer.tailoring, layer.points))
    return plain(cut(layer, above_collar(wearer.tailoring, layer.points) - low_m))


def _arm_share(wearer: Wearer, cloth: Cloth) -> np.ndarray:
    """Share (N,) of arms and hands in a cloth's weights."""
    names = wearer.fit.names
    arms = [index for index, name in enumerate(names) if any(part in name for part in ("Arm", "Hand"))]
    return cloth.weights[:, arms].sum(axis=1)


def _surround(points: np.ndarray, middle_m: float) -> bool:
    """True if a slice (N, 3) of a garment goes around the body's middle: the hull of a part of it would not."""
    angles = np.sort(np.arctan2(points[:, 2] - middle_m, points[:, 0]))
    return len(points) >= LEAST_SLICE and np.diff(angles, append=angles[:1] + 2.0 * np.pi).max() < np.pi


def over(
    wearer: Wearer, outer: Cloth, inner: Cloth, from_m: float, margin_m: float, farthest_m: float = FARTHEST_M
) -> Cloth:
    """Garment moved out below a height until it covers another one, but no farther than `farthest_m`; sleeves are
    unchanged."""
    low = float(outer.points[:, 1].min()) - 0.02
    # The hull is incomplete at the upper edge of the garment below.
    from_m = min(from_m, float(inner.points[:, 1].max()) - 0.02)
    levels = np.arange(low, from_m + 0.04, 0.012)
    arm = _arm_share(wearer, inner) < 0.3
    points = inner.points[arm]
    middle = wearer.fit.positions_t[wearer.fit.index("hips")][2]
    levels = levels[[_surround(points[np.abs(points[:, 1] - level) < 0.02], middle) for level in levels]]
    centres = np.tile([0.0, middle], (len(levels), 1))
    profile = smoothed(hull_profile(points[:, 1], points[:, [0, 2]], levels, centres, 0.02), 1.0, 1.0)
    angle, radius, _ = profile.polar(outer.points[:, 1], outer.points[:, [0, 2]])
    target = profile.radius_at(outer.points[:, 1], angle) + margin_m
    share = 1.0 - smoothstep(outer.points[:, 1], from_m, from_m + 0.05)
    share *= _arm_share(wearer, outer) < 0.3
    target = np.minimum(target, radius + farthest_m)
    return replace(outer, points=move_out(outer.points, profile, (1, 0, 2), target, share))


def moved_to(wearer: Wearer, surface: Surface, points: np.ndarray) -> Surface:
    """A surface with its vertices at other T-pose places."""
    return smooth_normals(replace(surface, positions=wearer.fit.to_rest_pose(points, surface.weights)))


def _loft(sections: list[np.ndarray], weights: np.ndarray) -> Cloth:
    """A closed tube through sections (K, 3) each, all with one weight (J,)."""
    count = len(sections[0])
    points = np.concatenate(sections)
    faces = grid_faces(len(sections), count, closed=True)
    return to_triangles(Cloth(points, np.tile(weights, (len(points), 1)), faces))


def _rounded(centre: np.ndarray, half_high: float, half_deep: float, count: int = 10) -> np.ndarray:
    """A flat oval section (K, 3) across X."""
    angles = 2 * np.pi * np.arange(count) / count
    return centre + np.stack([np.zeros(count), half_high * np.sin(angles), half_deep * np.cos(angles)], axis=1)


def bow_tie(wearer: Wearer, front: np.ndarray) -> Sewn:
    """A bow tie whose knot lies at a place (3,)."""
    weights = weights_near(wearer.tailoring.suit, front[None] - np.array([0.0, 0.01, 0.02]))[0]
    parts = []
    for sign in (1.0, -1.0):
        outline = ((0.004, 0.0075), (0.012, 0.011), (0.030, 0.0165), (0.050, 0.021), (0.054, 0.0205), (0.0545, 0.001))
        sections = [
            _rounded(front + np.array([sign * x, 0.0, -3.0 * x * x - 0.001]), high, 0.0045 if x < 0.053 else 0.001)
            for x, high in outline
        ]
        wing = _loft(sections, weights)
        parts.append(Cloth(wing.points, wing.weights, wing.faces if sign < 0 else wing.faces[:, ::-1]))
    knot = [
        _rounded(front + np.array([x, 0.0, 0.002]), high, deep)
        for x, high, deep in (
            (-0.0085, 0.001, 0.001),
            (-0.008, 0.0085, 0.005),
            (0.008, 0.0085, 0.005),
            (0.0085, 0.001, 0.001),
        )
    ]
    parts.append(_loft(knot, weights))
    return gold(join(*parts))


def throat(wearer: Wearer, points: np.ndarray, above_m: float) -> np.ndarray:
    """Foremost point (3,) in the middle of a garment in the T-pose, at a height above the collar's seam."""
    middle = points[np.abs(points[:, 0]) < 0.02]
    ring = middle[np.abs(above_collar(wearer.tailoring, middle) - above_m) < 0.012]
    ring = ring[ring[:, 2] > wearer.tailoring.collar_point[2] + 0.03]
    place = ring[np.argmax(ring[:, 2])]
    return np.array([0.0, place[1], place[2]])
