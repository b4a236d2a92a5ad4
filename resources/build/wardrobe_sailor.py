"""A sailor uniform's collar, square behind and pointed in front, with its stripes and its scarf."""

from __future__ import annotations

import numpy as np
from character_cloth import Cloth, grid_faces, to_triangles
from scipy.spatial import cKDTree
from wardrobe_pieces import Wearer
from wardrobe_sewn import Sewn, gold, plain, weights_near

ALONG = 49
ACROSS = (0.0, 0.15, 0.35, 0.55, 0.75, 0.84, 0.90, 1.0)
STRIPE = 5
"""Number of the strip between two of `ACROSS` that is a stripe."""
TAIL = (
    (-0.004, 0.008, 0.004),
    (0.03, 0.013, 0.003),
    (0.10, 0.024, 0.002),
    (0.17, 0.031, 0.0015),
    (0.185, 0.012, 0.001),
)
"""Sections of a scarf's end: how far down, half its width, half its depth."""
LIES_M = 0.007


def _normals(cloth: Cloth) -> np.ndarray:
    corners = cloth.points[cloth.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(cloth.points)
    for corner in range(3):
        np.add.at(normals, cloth.faces[:, corner], across)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def _dense(cloth: Cloth) -> tuple[np.ndarray, np.ndarray]:
    """Points and normals of a cloth, at the vertices, the middles of edges and those of faces."""
    normals, faces = _normals(cloth), cloth.faces
    corners = [faces, *(faces[:, pair] for pair in ([0, 1], [1, 2], [2, 0]))]
    means = [
        np.concatenate([values, *(values[own].mean(axis=1) for own in corners)]) for values in (cloth.points, normals)
    ]
    return means[0], means[1] / np.maximum(np.linalg.norm(means[1], axis=1, keepdims=True), 1e-12)


def _lying(wearer: Wearer, cloth: Cloth, points: np.ndarray, lift_m: float) -> np.ndarray:
    """Points (N, 3) moved onto the surface below them: the shirt, or the neck above it."""
    below, normals = (np.concatenate(pair) for pair in zip(_dense(cloth), _dense(wearer.tailoring.suit), strict=True))
    tree = cKDTree(below)
    for reach in (8, 16):
        far, rows = tree.query(points, k=reach)
        shares = 1.0 / (far + 0.003) ** 2
        shares /= shares.sum(axis=1, keepdims=True)
        normal = np.einsum("nk,nka->na", shares, normals[rows])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        # Raised to the highest nearby point of the cloth below, so that nothing comes through.
        height = ((below[rows] - points[:, None]) * normal[:, None]).sum(axis=2).max(axis=1)
        points = points + normal * (height + lift_m)[:, None]
    return points


def _edges(wearer: Wearer) -> tuple[np.ndarray, np.ndarray]:
    """The left half's inner and outer edge (ALONG, 3): from the middle of the back to the point in front."""
    tailoring = wearer.tailoring
    nape, size = tailoring.collar_point, tailoring.shoulder[1] / 1.4
    back, front = nape[2] - 0.05, nape[2] + 0.16
    point = np.array([0.004, nape[1] - 0.185 * size, front])
    off = np.array([[0.0, 0.0, 0.0], [0.045, 0.0, 0.02], [0.066, -0.01, 0.06], [0.046, -0.07, 0.125]])
    inner = np.concatenate([nape + off, point[None]])
    wide = 0.165 * size
    outer = np.array(
        [
            [0.0, nape[1] - 0.15 * size, back],
            [wide * 0.97, nape[1] - 0.15 * size, back],
            [wide, tailoring.shoulder[1] + 0.03, nape[2] + 0.04],
            [wide * 0.80, nape[1] - 0.115 * size, front],
            np.add(point, (0.034, -0.012, 0.0)),
        ]
    )
    share = np.linspace(0.0, 1.0, ALONG)
    knots = np.array([0.0, 0.3, 0.5, 0.75, 1.0])

    def evenly(edge: np.ndarray) -> np.ndarray:
        return np.stack([np.interp(share, knots, edge[:, axis]) for axis in range(3)], axis=1)

    return evenly(inner), evenly(outer)


def sailor_collar(wearer: Wearer, cloth: Cloth) -> tuple[Sewn, Sewn]:
    """The collar on a shirt in the T-pose, and its stripe."""
    inner, outer = _edges(wearer)
    halves: list[list[Cloth]] = [[], []]
    for sign in (1.0, -1.0):
        flat = np.concatenate([inner + (outer - inner) * share for share in ACROSS])
        points = _lying(wearer, cloth, flat * np.array([sign, 1.0, 1.0]), LIES_M)
        points[np.arange(len(ACROSS)) * ALONG, 0] = 0.0
        weights = weights_near(cloth, points)
        faces = grid_faces(len(ACROSS), ALONG, closed=False)
        strip = np.arange(len(faces)) // (ALONG - 1)
        faces = faces[:, ::-1] if sign > 0 else faces
        for number, own in enumerate((strip != STRIPE, strip == STRIPE)):
            used, few = np.unique(faces[own], return_inverse=True)
            halves[number].append(to_triangles(Cloth(points[used], weights[used], few.reshape(-1, 4))))
    collar, stripe = (plain(_both(*half)) for half in halves)
    return collar, stripe


def _both(left: Cloth, right: Cloth) -> Cloth:
    return Cloth(
        np.concatenate([left.points, right.points]),
        np.concatenate([left.weights, right.weights]),
        np.concatenate([left.faces, right.faces + len(left.points)]),
    )


def scarf(wearer: Wearer, cloth: Cloth) -> list[Sewn]:
    """The knot at the collar's point, and the two ends that hang from it."""
    inner, _ = _edges(wearer)
    start = _lying(wearer, cloth, inner[-1:], LIES_M + 0.008)[0]
    parts = []
    angles = 2 * np.pi * np.arange(10) / 10
    oval = np.stack([np.cos(angles), np.zeros(10), np.sin(angles)], axis=1)
    for sign in (1.0, -1.0):
        rows = []
        for down, half, thick in TAIL:
            middle = start + np.array([sign * (0.006 + down * 0.32), -down, 0.0])
            lying = _lying(wearer, cloth, middle[None], LIES_M + 0.004)[0]
            middle[2] = max(lying[2], start[2] - 0.01)
            rows.append(middle + oval * np.array([half, 1.0, thick]))
        points = np.concatenate(rows)
        parts.append(to_triangles(Cloth(points, weights_near(cloth, points), grid_faces(len(rows), 10, closed=True))))
    knot = np.concatenate(
        [
            start + oval * np.array([0.014 * r, 1.0, 0.010 * r]) + np.array([0.0, y, 0.0])
            for r, y in ((0.3, 0.018), (1.0, 0.012), (1.0, -0.012), (0.3, -0.018))
        ]
    )
    parts.append(to_triangles(Cloth(knot, weights_near(cloth, knot), grid_faces(4, 10, closed=True))))
    return [gold(part) for part in parts]
