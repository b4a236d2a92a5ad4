"""Eyes: balls with a cornea that stands proud, and pictures of iris, limbus and white over them.

One surface: the cornea's shape and shine over a picture of the iris, since few programs draw a clear shell alike.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from character_cloth import grid_faces, smoothstep
from character_mouth import PATCHES_LEFT, WET, mouth_patches
from character_surface import Surface, modelled, triangulate
from character_textures import Texture, jpeg, noise, to_linear, to_srgb

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit
    from character_source import Source

IRIS_PX, WET_PX = 256, 512
IRIS_M, PUPIL_M = 0.0059, 0.0019
"""Radii in metres; irises are 11.7 mm wide in all people (Rüfer, Schröder, Erb 2005)."""
BULGE_M = 0.0011
SEEN_RAD = float(np.radians(80.0))
"""Angle from the axis of gaze at which the picture of the white ends."""
WHITE_SHARE, WHITE_MIDDLE = 0.36, 0.375
"""Radius and centre (both axes) of the white in the texture for wet surfaces, as shares of its size."""
IRIS_SHARE = 0.42
"""Share of the white's radius that the iris takes."""
IRIS_MEAN_LINEAR = 0.35
"""Mean of the grey iris, by which a colour of eyes is divided to tint it."""
SEGMENTS, BACK_RAD = 32, float(np.radians(140.0))
AROUND = np.stack([f(2 * np.pi * np.arange(SEGMENTS) / SEGMENTS) for f in (np.cos, np.sin)], axis=1)
VEIN_COUNT = 26
LID_SHADE = (0.60, (0.02, 0.50)), (0.55, (0.0, 0.8))
"""Share by which the upper lid's shadow darkens white and iris at most, and where it begins and ends, as heights over
the middle in shares of their radii."""


def eyeballs(source: Source, fit: SkeletonFit) -> Surface:
    """Two eyeballs that turn with their joints; both materials' coordinates run outwards from the axis of gaze."""
    points, weights, uvs = [], [], []
    triangles: dict[str, list[np.ndarray]] = {"iris": [], WET: []}
    start = 0
    for side, letter in (("left", "l"), ("right", "r")):
        joint = fit.index(side + "Eye")
        centre = fit.world_from_joint_rest[joint, :3, 3]
        helper = source.vertices[np.unique(source.groups[f"helper-{letter}-eye"].vertices)]
        radius = float(np.linalg.norm(helper - centre, axis=1).mean())
        iris = float(np.arcsin(IRIS_M / radius))
        inner = np.linspace(0.0, iris, 7)
        outer = np.concatenate([[iris, iris * 1.07, iris * 1.2], np.linspace(iris * 1.4, SEEN_RAD, 6), [BACK_RAD]])
        shares = (inner / iris * 0.49, np.interp(outer, [iris, SEEN_RAD], [IRIS_SHARE, 1.0]) * WHITE_SHARE)
        for polar, share, middle, material in zip((inner, outer), shares, (0.5, WHITE_MIDDLE), triangles, strict=True):
            ball = centre + _rings(polar, radius + BULGE_M * np.maximum(0.0, 1 - (polar / (iris * 1.12)) ** 2))
            points.append(ball)
            # The same picture, mirrored, for the right eye.
            turned = AROUND * [1.0 if side == "left" else -1.0, 1.0]
            uvs.append(middle + (share[:, None, None] * turned).reshape(-1, 2))
            faces = grid_faces(len(polar), SEGMENTS, closed=True)[:, ::-1]
            triangles[material].append(start + triangulate(faces, ball))
            rows = np.zeros((len(ball), len(fit.names)))
            rows[:, joint] = 1.0
            weights.append(rows)
            start += len(ball)
    faces = {name: np.concatenate(parts) for name, parts in triangles.items()}
    return modelled("eyes", np.concatenate(points), np.concatenate(weights), faces, uvs=np.concatenate(uvs))


def _rings(polar: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """(R * SEGMENTS, 3) points of rings about the axis of gaze."""
    ahead = np.ones((SEGMENTS, 1))
    rings = [
        np.concatenate([np.sin(angle) * AROUND, np.cos(angle) * ahead], axis=1) * far
        for angle, far in zip(polar, distance, strict=True)
    ]
    return np.concatenate(rings)


def _veins(angle: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Fine winding vessels from the corners of the eye towards the iris."""
    rng = np.random.Generator(np.random.PCG64(21))
    found = np.zeros_like(share)
    for number in range(VEIN_COUNT):
        side = 0.0 if number % 2 else np.pi
        bearing = side + rng.normal(0.0, 0.55)
        phase, waves, sway = rng.uniform(0, 6.3), rng.uniform(18, 40), rng.uniform(0.02, 0.07)
        inner = rng.uniform(0.55, 0.85)
        path = bearing + sway * np.sin(waves * share + phase) + 0.35 * sway * np.sin(2.7 * waves * share + 2 * phase)
        off = np.abs((angle - path + np.pi) % (2 * np.pi) - np.pi) * share
        width = 0.0035 * rng.uniform(0.5, 1.2)
        found = np.maximum(found, np.exp(-((off / width) ** 2)) * smoothstep(share, inner - 0.05, inner + 0.2))
    return found


def _polar(size: int, middle: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Distance from the middle of a picture in shares of a radius, and angle, per pixel."""
    axis = (np.arange(size) + 0.5) / size
    x, y = np.meshgrid(axis - middle, (1 - axis) - middle)
    return np.hypot(x, y) / radius, np.arctan2(y, x)


def _under_lid(share: np.ndarray, angle: np.ndarray, shade: tuple[float, tuple[float, float]]) -> np.ndarray:
    """Light that the upper lid and its lashes let through, painted since few programs shade eyes so finely."""
    most, (low, high) = shade
    return 1.0 - most * smoothstep(share * np.sin(angle), low, high)


def iris_colour(name: str, pupil_m: float = PUPIL_M) -> Texture:
    """A grey iris, warmer about the pupil: radial fibres, dark limbus, black pupil."""
    share, angle = _polar(IRIS_PX, 0.5, 0.49)
    inside = np.clip(share, 0.0, 1.0)
    # Fibres: noise drawn out along the radius, wound around once so that it closes.
    turn = (angle / (2 * np.pi) % 1.0 * 512).astype(int) % 512
    wound = noise(512, 2.5, 24, 22)[(inside * 10).astype(int), turn]
    coarse = noise(512, 6, 60, 23)[(inside * 24).astype(int), turn]
    value = np.clip(0.78 + 0.22 * wound + 0.14 * coarse, 0.1, 2.0) * (0.75 + 0.45 * smoothstep(inside, 0.35, 0.9))
    body = (inside > pupil_m / IRIS_M + 0.05) & (inside < 0.84)
    grey = np.repeat((value / value[body].mean() * IRIS_MEAN_LINEAR)[..., None], 3, axis=2)
    ring = 0.5 * np.exp(-(((inside - 0.52 - 0.03 * coarse) / 0.11) ** 2))[..., None]
    grey *= 1 + ring * np.array([0.7, 0.25, -0.3])
    grey *= (1 - 0.9 * smoothstep(inside, 0.72, 0.97))[..., None]
    grey *= _under_lid(share, angle, LID_SHADE[1])[..., None]
    return jpeg(name, to_srgb(grey * smoothstep(inside, pupil_m / IRIS_M - 0.03, pupil_m / IRIS_M + 0.05)[..., None]))


def wet_colour(name: str) -> Texture:
    """The white of the eyes, which reddens outwards and darkens towards the limbus, beside the patches of the mouth."""
    share, angle = _polar(WET_PX, WHITE_MIDDLE, WHITE_SHARE)
    outer = np.clip((share - IRIS_SHARE) / (1 - IRIS_SHARE), 0.0, 1.0)
    white = to_linear(np.array([0.765, 0.735, 0.71])) * (1 + 0.02 * noise(WET_PX, 8, 80, 24)[..., None])
    redden = 0.08 + 0.50 * smoothstep(outer, 0.15, 0.9)
    white = white * (1 - redden[..., None] * np.array([0.10, 0.34, 0.36]))
    white = white * (1 - 0.55 * _veins(angle, share)[..., None] * np.array([0.25, 0.9, 0.9]))
    # The limbus: the white turns bluish grey, then dark, before the iris begins.
    rim = np.exp(-(np.maximum(share - IRIS_SHARE, 0.0) / 0.055))[..., None]
    white = white * (1 - 0.93 * rim**1.5 * np.array([1.0, 0.97, 0.94]))
    white = white * _under_lid(share, angle, LID_SHADE[0])[..., None]
    right = (np.arange(WET_PX) + 0.5 >= PATCHES_LEFT * WET_PX)[None, :, None]
    return jpeg(name, to_srgb(np.where(right, mouth_patches(WET_PX), white)))
