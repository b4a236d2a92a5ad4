"""Parts of a marching uniform: shako with peak and plume, epaulettes, belt, cuffs, and stripes down the trousers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_cloth import Cloth, cut, grid_faces, hull_profile, join, smoothed, to_triangles
from character_garments import band
from scipy.interpolate import LinearNDInterpolator
from wardrobe_pieces import Wearer
from wardrobe_sewn import Sewn, gold, plain, weights_near
from wardrobe_shirt import neck_of
from wardrobe_tunic import TUNIC_M, tunic_drape

OVER_EYES_M, HAIR_M, SHAKO_M = 0.052, 0.020, 0.150
"""Height of a shako's rim over the eyes, room for hair about the head, and its height."""
PEAK_M, AROUND = 0.048, 48
STRIPE_HALF_M, LIFT_M = 0.014, 0.0040
CUFF_M = 0.075
BELT_M = 0.010


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
    """Boards on both shoulders, with a fringe at their outer end; they go with the cloth below them."""
    joint = wearer.tailoring.shoulder
    points = shell.points[np.unique(shell.faces)]
    upper = points[points[:, 1] > joint[1] - 0.01]
    top = LinearNDInterpolator(upper[:, [0, 2]], upper[:, 1])
    parts = []
    for sign in (1.0, -1.0):
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
            rows_of = rings[:, ::-1].reshape(-1, 3)
            faces = grid_faces(len(rings), rings.shape[1], closed=False)[:, ::-1]
            parts.append(gold(to_triangles(Cloth(rows_of, weights_near(shell, rows_of), faces))))
    return parts


def belt(wearer: Wearer, shell: Cloth) -> Sewn:
    """A broad belt over the tunic."""
    tailoring = wearer.tailoring
    fall, at = tunic_drape(wearer), tailoring.belt_m
    out = TUNIC_M + BELT_M
    rows = [(at - 0.023, TUNIC_M - 0.004), (at - 0.022, out), (at + 0.022, out), (at + 0.023, TUNIC_M - 0.004)]
    hoop = band(fall, tailoring.suit, rows)
    columns = len(hoop.points) // len(rows)
    return plain(
        replace(hoop, weights=np.tile(weights_near(shell, hoop.points[columns : 2 * columns]), (len(rows), 1)))
    )


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
    tailoring, fit, parts = wearer.tailoring, wearer.fit, []
    hip, foot = (fit.positions_t[fit.index(f"left{part}")] for part in ("UpperLeg", "Foot"))
    levels = np.arange(float(legs.points[:, 1].min()) - 0.005, tailoring.belt_m - 0.03, 0.012)
    down = (levels - foot[1]) / (hip[1] - foot[1])
    middle = np.stack([foot[0] + (hip[0] - foot[0]) * down, foot[2] + (hip[2] - foot[2]) * down], axis=1)
    heights = np.linspace(levels[0] + 0.008, levels[-1] - 0.02, 48)
    for sign in (1.0, -1.0):
        own = legs.points[legs.points[:, 0] * sign > 0] * np.array([sign, 1.0, 1.0])
        drape = smoothed(hull_profile(own[:, 1], own[:, [0, 2]], levels, middle, 0.02), 1.5, 0.7)
        rows = []
        for half, lift in ((-1.0, 0.0005), (-0.9, LIFT_M), (0.0, LIFT_M), (0.9, LIFT_M), (1.0, 0.0005)):
            angle = half * STRIPE_HALF_M / drape.radius_at(heights, np.zeros(len(heights)))
            radius = drape.radius_at(heights, angle) + lift
            centre = np.stack([np.interp(heights, levels, middle[:, axis]) for axis in range(2)], axis=1)
            x, z = centre[:, 0] + radius * np.cos(angle), centre[:, 1] + radius * np.sin(angle)
            rows.append(np.stack([sign * x, heights, z], axis=1))
        grid = np.stack(rows)[:: int(-sign)]
        points = grid.reshape(-1, 3)
        faces = grid_faces(len(rows), len(heights), closed=False)
        parts.append(to_triangles(Cloth(points, weights_near(legs, points), faces)))
    return plain(join(*parts))
