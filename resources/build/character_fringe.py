"""Fringes: locks that a style of hair does not have, laid from the front of the scalp over the forehead.

The locks show those that are painted for the tail of the style, from root to tip.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from character_surface import Surface, vertex_normals
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

AXIS_M: Final = 0.07
"""Distance of the head's axis behind the eyes."""
SAMPLES: Final = 4
"""Parts into which the edges of triangles are divided to find points between their corners."""
FRINGED: Final = {
    "fringe01": (
        "ponytail01",
        (
            (0.012, 0.52, 0.102, 0.96),
            (0.105, 0.56, 0.192, 0.955),
            (0.445, 0.50, 0.53, 0.95),
            (0.862, 0.53, 0.925, 0.96),
        ),
    )
}
"""Styles that are others with a fringe: the other, and the painted locks that it shows (`strips`)."""
TIP: Final = 0.9
"""Share of a painted lock from root to tip that is shown: the rest is single hairs."""
ROWS, ACROSS = 6, 3
"""Rows of vertices along a lock, and vertices across it."""
BEFORE_SCALP_M: Final = 0.0004
"""Height of roots over the scalp's hair."""
ANGLE_DEG, RANGE_M, SMOOTH = 4.0, 0.003, 1.0
"""Reach about an angle and a height within which skin and hair are found, and deviation in rows of a lock that is
evened.
"""


@dataclass(frozen=True)
class Layer:
    """Locks side by side, mirrored about the middle of the face.

    Attributes
    ----------
    angles_deg : tuple of float
        Angles about the head's axis of the first and the last lock, from the middle.
    count : int
        Locks, also of the other side.
    top_m, bottom_m : (float, float)
        Heights over the eyes of roots and tips, at the first and at the last angle.
    lift_m : float
        Greatest height over the skin.
    width_m : float
        Width of a lock.
    """

    angles_deg: tuple[float, float]
    count: int
    top_m: tuple[float, float]
    bottom_m: tuple[float, float]
    lift_m: float
    width_m: float


LAYERS: Final = (
    Layer((0.0, 50.0), 27, (0.090, 0.072), (0.026, 0.008), 0.006, 0.017),
    Layer((2.0, 47.0), 22, (0.098, 0.078), (0.028, 0.014), 0.009, 0.013),
    Layer((53.0, 68.0), 10, (0.070, 0.060), (-0.025, -0.075), 0.006, 0.015),
)
UNEVEN: Final = {"angle_deg": 1.2, "bottom_m": 0.0055, "lift_m": 0.0015, "width": 0.15, "sweep_deg": 2.5}
"""Deviations of single locks."""
LEAST_WIDTH, BOW_M, BELOW_EYES_M = 0.25, 0.0015, 0.12
"""Least share of a lock's width; by how much its middle stands before its sides; how far down skin is looked at."""


def strips(painted: np.ndarray, boxes: tuple[tuple[float, float, float, float], ...]) -> list[np.ndarray]:
    """Texture coordinates (ROWS, 2, 2) of the sides of painted locks from root to tip.

    Parameters
    ----------
    painted : (H, W, 4) the picture.
    boxes : left, top, right and bottom around a lock, as shares of the picture.
    """
    height, width = painted.shape[:2]
    found = []
    for left, top, right, bottom in boxes:
        first, start = round(top * height), round(left * width)
        part = painted[first : round(bottom * height), start : round(right * width), 3] > 0.5
        rows = np.flatnonzero(part.any(axis=1))
        chosen = np.linspace(rows[0], rows[0] + TIP * (rows[-1] - rows[0]), ROWS).astype(int)
        sides = np.array([np.flatnonzero(part[row])[[0, -1]] for row in chosen if part[row].any()], dtype=float)
        if len(sides) < ROWS:
            raise ValueError("a painted lock has gaps")
        u = (sides + start + 0.5) / width
        v = 1.0 - (chosen + first + 0.5) / height
        found.append(np.stack([u, np.repeat(v[:, None], 2, axis=1)], axis=-1))
    return found


class _Head:
    """Radii of skin and hair about the axis of a head by angle and height."""

    def __init__(self, skin: np.ndarray, hair: np.ndarray, axis_z: float) -> None:
        self._trees = []
        for points in (skin, hair):
            off = points - np.array([0.0, 0.0, axis_z])
            angle, radius = np.degrees(np.arctan2(-off[:, 0], off[:, 2])), np.hypot(off[:, 0], off[:, 2])
            scaled = np.stack([angle / ANGLE_DEG, points[:, 1] / RANGE_M], axis=1)
            self._trees.append((cKDTree(scaled), radius))

    def radius(self, angle_deg: np.ndarray, height: np.ndarray) -> np.ndarray:
        """Radii (N,) in metres of the outermost of skin and hair near angles and heights (N,)."""
        asked = np.stack([angle_deg / ANGLE_DEG, height / RANGE_M], axis=1)
        radii = []
        for tree, radius in self._trees:
            near = tree.query_ball_point(asked, 1.0)
            radii.append([radius[rows].max() if rows else 0.0 for rows in near])
        return np.max(radii, axis=0)


def _between_vertices(surface: Surface) -> np.ndarray:
    """Points (N, 3) of a surface's triangles, also between their corners."""
    corners = surface.positions[surface.all_triangles()]
    steps = [(i / SAMPLES, j / SAMPLES) for i in range(SAMPLES + 1) for j in range(SAMPLES + 1 - i)]
    shares = np.array([(1.0 - one - two, one, two) for one, two in steps])
    return np.einsum("sk,nkd->nsd", shares, corners).reshape(-1, 3)


def with_fringe(surface: Surface, skin_m: np.ndarray, right_eye_m: np.ndarray, locks: list[np.ndarray]) -> Surface:
    """A style of hair with a fringe, whose locks show some of the painted ones (`strips`).

    Parameters
    ----------
    skin_m : (N, 3) points of the skin, metres.
    right_eye_m : (3,) middle of the right eye.
    """
    rng = np.random.Generator(np.random.PCG64(47))
    axis_z = float(right_eye_m[2]) - AXIS_M
    near = skin_m[skin_m[:, 1] > right_eye_m[1] - BELOW_EYES_M]
    head = _Head(near, _between_vertices(surface), axis_z)
    along = np.linspace(0.0, 1.0, ROWS)
    rising = np.sin(np.pi * np.minimum(along, 0.75) / 1.5)
    result = surface
    for layer in LAYERS:
        for number in range(layer.count):
            share = abs(2.0 * number / (layer.count - 1) - 1.0)
            side = 1.0 if 2 * number >= layer.count else -1.0
            first, last = layer.angles_deg
            angle = side * (first + share * (last - first)) + rng.normal(0.0, UNEVEN["angle_deg"])
            top, bottom = (one + share * (two - one) for one, two in (layer.top_m, layer.bottom_m))
            heights = right_eye_m[1] + top + (bottom + rng.normal(0.0, UNEVEN["bottom_m"]) - top) * along
            angles = angle + rng.normal(0.0, UNEVEN["sweep_deg"]) * along**2
            lift = BEFORE_SCALP_M + (layer.lift_m + rng.normal(0.0, UNEVEN["lift_m"])) * rising
            radius = gaussian_filter1d(head.radius(angles, heights), SMOOTH) + np.maximum(lift, BEFORE_SCALP_M)
            width = layer.width_m * (1.0 + rng.normal(0.0, UNEVEN["width"]))
            strip = locks[int(rng.integers(len(locks)))]
            result = _with_lock(result, np.stack([angles, heights, radius], axis=1), width, axis_z, strip)
    return result


def _with_lock(surface: Surface, middle: np.ndarray, width: float, axis_z: float, strip: np.ndarray) -> Surface:
    """The surface with one lock; `middle` (ROWS, 3) are its angles, heights and radii about the head's axis."""
    across = np.linspace(-0.5, 0.5, ACROSS)
    angles, heights, radius = middle.T
    # A lock is as wide as its picture at every height, but where that is a single hair.
    painted = strip[:, 1, 0] - strip[:, 0, 0]
    wide = width * np.maximum(painted / painted.max(), LEAST_WIDTH)
    turned = np.radians(angles)[:, None] + wide[:, None] * across / radius[:, None]
    bowed = radius[:, None] + BOW_M * (1.0 - 4.0 * across**2)
    level = np.repeat(heights[:, None], ACROSS, axis=1)
    points = np.stack([-np.sin(turned) * bowed, level, np.cos(turned) * bowed + axis_z], axis=-1).reshape(-1, 3)
    shares = across + 0.5
    uvs = (strip[:, :1] * (1.0 - shares)[None, :, None] + strip[:, 1:] * shares[None, :, None]).reshape(-1, 2)
    row, column = np.meshgrid(np.arange(ROWS - 1), np.arange(ACROSS - 1), indexing="ij")
    corner = (row * ACROSS + column).ravel()
    upper = np.stack([corner, corner + 1, corner + ACROSS], axis=1)
    lower = np.stack([corner + 1, corner + ACROSS + 1, corner + ACROSS], axis=1)
    faces = np.concatenate([upper, lower])
    normals = vertex_normals(points, faces)
    if ((points - [0.0, points[:, 1].mean(), axis_z]) * normals).sum() < 0.0:
        faces, normals = faces[:, [0, 2, 1]], -normals
    nearest = cKDTree(surface.positions).query(points[:1])[1].repeat(len(points))
    (material,) = surface.triangles
    return replace(
        surface,
        positions=np.concatenate([surface.positions, points]),
        normals=np.concatenate([surface.normals, normals]),
        uvs=np.concatenate([surface.uvs, uvs]),
        weights=np.concatenate([surface.weights, surface.weights[nearest]]),
        triangles={material: np.concatenate([surface.triangles[material], faces + len(surface.positions)])},
        morphs={},
        origin=np.concatenate([surface.origin, np.full(len(points), -1)]),
    )
