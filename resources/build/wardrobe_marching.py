"""Parts of a marching uniform: shako with peak and plume, epaulettes, belt, cuffs, and stripes down the trousers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_cloth import Cloth, cut, grid_faces, hang, join, smoothed, to_triangles
from character_garments import band
from scipy.interpolate import LinearNDInterpolator
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree
from wardrobe_pieces import Wearer
from wardrobe_sewn import Sewn, gold, plain, weights_near
from wardrobe_shirt import neck_of

OVER_EYES_M, HAIR_M, SHAKO_M = 0.052, 0.020, 0.150
"""Height of a shako's rim over the eyes, room for hair about the head, and its height."""
PEAK_M, AROUND = 0.048, 48
STRIPE_HALF_M, LIFT_M = 0.014, 0.0025
CUFF_M = 0.075


def _rigid(wearer: Wearer, rings: np.ndarray, bone: str, *, closed: bool = True) -> Cloth:
    """A surface through rows (K, N, 3) of points that goes with one bone."""
    count, columns = rings.shape[:2]
    weights = np.zeros((count * columns, len(wearer.fit.names)))
    weights[:, wearer.fit.index(bone)] = 1.0
    return to_triangles(Cloth(rings.reshape(-1, 3), weights, grid_faces(count, columns, closed=closed)[:, ::-1]))


def shako(wearer: Wearer) -> tuple[list[Sewn], list[Sewn], list[Sewn]]:
    """The shako's body; band, peak and badge; and its plume."""
    eye = wearer.fit.positions_t[wearer.fit.index("leftEye")]
    skin, rim = neck_of(wearer).points, float(eye[1]) + OVER_EYES_M
    head = skin[(skin[:, 1] > rim) & (skin[:, 1] < rim + 0.03)]
    half = np.array([np.abs(head[:, 0]).max(), np.ptp(head[:, 2]) / 2]) + HAIR_M
    middle = head[:, 2].min() + half[1] - HAIR_M
    angles = 2 * np.pi * np.arange(AROUND) / AROUND

    def ring(high: float, wide: float, lean: float = 0.10) -> np.ndarray:
        across, along = half[0] * wide * np.sin(angles), half[1] * wide * np.cos(angles)
        return np.stack([across, rim + high + lean * along, middle + along - 0.12 * high], axis=1)

    rows = ((0.004, 0.97), (0.0, 1.0), (0.06, 1.0), (SHAKO_M, 1.07), (SHAKO_M + 0.004, 1.06), (SHAKO_M - 0.006, 0.0))
    body = _rigid(wearer, np.stack([ring(*row) for row in rows]), "head")
    hoops = [((0.0, 1.0), (0.001, 1.02), (0.020, 1.02), (0.021, 1.0)), ((0.134, 1.05), (0.136, 1.08), (0.148, 1.085))]
    metal = [gold(_rigid(wearer, np.stack([ring(*row) for row in hoop]), "head")) for hoop in hoops]
    fan = np.linspace(-0.42 * np.pi, 0.42 * np.pi, 25)
    edge = np.stack([half[0] * np.sin(fan), np.full(25, rim + 0.002), middle + half[1] * np.cos(fan)], axis=1)
    out = np.stack([0.10 * np.sin(fan), -0.45 * np.cos(fan) ** 2, np.cos(fan)], axis=1) * PEAK_M
    edge[:, 1] += 0.10 * half[1] * np.cos(fan)
    lower = np.array([0.0, -0.002, 0.0])
    peak = np.stack([edge, edge + out, edge + out + lower, edge + lower])
    metal.append(gold(_rigid(wearer, peak, "head", closed=False)))
    front = np.array([0.0, rim + 0.075 + 0.10 * half[1], middle + half[1] * 1.02 - 0.12 * 0.075])
    few = 2 * np.pi * np.arange(14) / 14
    disc = [(0.024, -0.004), (0.023, 0.004), (0.012, 0.007), (0.0, 0.008)]
    badge = [front + np.stack([r * np.cos(few), r * np.sin(few), np.full(14, z)], axis=1) for r, z in disc]
    metal.append(gold(_rigid(wearer, np.stack(badge)[:, ::-1], "head")))
    foot = np.array([0.0, rim + SHAKO_M - 0.03 + 0.10 * half[1], middle + half[1] * 1.09 - 0.12 * SHAKO_M])
    stem = ((0.0, 0.006), (0.03, 0.014), (0.09, 0.019), (0.13, 0.014), (0.14, 0.0))
    feather = [foot + np.stack([r * np.sin(few), np.full(14, y), r * np.cos(few)], axis=1) for y, r in stem]
    return [plain(body)], metal, [plain(_rigid(wearer, np.stack(feather), "head"))]


def epaulettes(wearer: Wearer, shell: Cloth) -> list[Sewn]:
    """Boards on both shoulders, with a fringe at their outer end; they go with the collar bone."""
    joint = wearer.tailoring.shoulder
    points = shell.points[np.unique(shell.faces)]
    upper = points[points[:, 1] > joint[1] - 0.01]
    top = LinearNDInterpolator(upper[:, [0, 2]], upper[:, 1])
    parts = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        x = np.linspace(joint[0] * 0.52, joint[0] + 0.004, 9)
        rows = []
        for z, lift in ((-0.031, -0.004), (-0.029, 0.011), (0.0, 0.014), (0.029, 0.011), (0.031, -0.004)):
            flat = np.stack([sign * x, np.full(9, joint[2] + z)], axis=1)
            high = top(flat)
            high = np.interp(np.arange(9), np.flatnonzero(~np.isnan(high)), high[~np.isnan(high)])
            # A board: straight from its inner to its outer end.
            rows.append(
                np.stack([flat[:, 0], np.maximum(high, np.linspace(high[0], high[-1], 9)) + lift, flat[:, 1]], 1)
            )
        board = np.stack(rows)
        end = board[:, -1]
        away = np.array([sign, 0.0, 0.0])
        fringe = np.stack([end, end + 0.006 * away, end + 0.010 * away - [0.0, 0.038, 0.0], end - [0.0, 0.038, 0.0]])
        for rings in (board[:: int(sign)], fringe[:: int(sign)]):
            parts.append(gold(_rigid(wearer, rings[:, ::-1], f"{side}Shoulder", closed=False)))
    return parts


def belt(wearer: Wearer) -> Sewn:
    """A broad belt over the tunic."""
    tailoring = wearer.tailoring
    fall, at = smoothed(hang(tailoring.trunk, 0.12), 2.0, 1.5), tailoring.belt_m
    rows = [(at - 0.022, 0.012), (at - 0.021, 0.027), (at + 0.021, 0.027), (at + 0.022, 0.012)]
    return plain(band(fall, tailoring.suit, rows))


def cuffs(wearer: Wearer, shell: Cloth) -> Sewn:
    """Ends of sleeves in another cloth."""
    own = cut(shell, np.abs(shell.points[:, 0]) - (wearer.tailoring.wrist_m - CUFF_M))
    points = own.points.copy()
    for sign in (1.0, -1.0):
        side = points[:, 0] * sign > 0
        _, place = np.unique(np.round(points[side, 0], 2), return_inverse=True)
        counts = np.bincount(place.reshape(-1))
        centres = [np.bincount(place.reshape(-1), points[side, axis]) / counts for axis in (1, 2)]
        off = points[side][:, 1:] - np.stack(centres, axis=1)[place.reshape(-1)]
        points[side, 1:] += LIFT_M * off / np.maximum(np.linalg.norm(off, axis=1, keepdims=True), 1e-6)
    return plain(replace(own, points=points))


def stripes(wearer: Wearer, legs: Cloth) -> Sewn:
    """Stripes down the outer seams of trousers."""
    tailoring, parts = wearer.tailoring, []
    heights = np.linspace(tailoring.belt_m - 0.05, float(legs.points[:, 1].min()) + 0.004, 60)
    tree = cKDTree(legs.points)
    middle = wearer.fit.positions_t[wearer.fit.index("leftUpperLeg")][2]
    for sign in (1.0, -1.0):
        own = legs.points[legs.points[:, 0] * sign > 0.02]
        outer = np.array([np.abs(own[np.abs(own[:, 1] - y) < 0.02, 0]).max() for y in heights])
        places = own[
            [
                np.argmin(np.abs(own[:, 1] - y) * 3 + (x - np.abs(own[:, 0])))
                for x, y in zip(outer, heights, strict=True)
            ]
        ]
        depth = gaussian_filter1d(np.where(np.abs(places[:, 2] - middle) < 0.05, places[:, 2], middle), 6.0)
        rows = []
        for z, lift in ((-STRIPE_HALF_M, LIFT_M / 2), (0.0, LIFT_M), (STRIPE_HALF_M, LIFT_M / 2)):
            flat = np.stack([sign * (outer - 0.004), heights, depth + z], axis=1)
            _, rows_near = tree.query(flat, k=6)
            x = np.abs(legs.points[rows_near, 0]).max(axis=1)
            rows.append(np.stack([sign * (gaussian_filter1d(x, 2.0) + lift), heights, depth + z], axis=1))
        grid = np.stack(rows)[:: int(sign)]
        points = grid.reshape(-1, 3)
        faces = grid_faces(3, len(heights), closed=False)
        parts.append(to_triangles(Cloth(points, weights_near(legs, points), faces)))
    return plain(join(*parts))
