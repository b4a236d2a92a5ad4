"""Eyes: balls with a cornea that stands proud, and pictures of iris, limbus and white over them.

One surface: the cornea's shape and shine over a picture of the iris, since few programs draw a clear shell alike.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from character_cloth import grid_faces, smoothstep
from character_surface import Surface, modelled, triangulate
from character_textures import Texture, jpeg, noise, to_linear, to_srgb

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit
    from character_source import Source

EYE_PX = 512
IRIS_M, PUPIL_M = 0.0059, 0.0019
"""Radii: irises are 11.7 mm wide, whoever's they are (Rüfer, Schröder, Erb 2005)."""
BULGE_M = 0.0011
SEEN_RAD = float(np.radians(80.0))
"""Angle from the axis of gaze at which the picture ends."""
IRIS_SHARE = 0.42
"""Share of the picture's radius that the iris takes."""
SEGMENTS, BACK_RAD = 32, float(np.radians(140.0))
VEIN_COUNT = 26


def eyeballs(source: Source, fit: SkeletonFit) -> Surface:
    """Two eyeballs that turn with their joints; texture coordinates run outwards from the middle of the pupil."""
    points, weights, triangles, uvs = [], [], [], []
    start = 0
    for side, letter in (("left", "l"), ("right", "r")):
        joint = fit.index(side + "Eye")
        centre = fit.world_from_joint_rest[joint, :3, 3]
        helper = source.vertices[np.unique(source.groups[f"helper-{letter}-eye"].vertices)]
        radius = float(np.ptp(helper[:, 0]) / 2)
        iris = float(np.arcsin(IRIS_M / radius))
        polar = np.concatenate(
            [np.linspace(0.0, iris, 7), [iris * 1.07, iris * 1.2], np.linspace(iris * 1.4, SEEN_RAD, 6), [BACK_RAD]]
        )
        out = BULGE_M * np.maximum(0.0, 1 - (polar / (iris * 1.12)) ** 2)
        angles = 2 * np.pi * np.arange(SEGMENTS) / SEGMENTS
        around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        ring = np.concatenate(
            [
                np.concatenate([np.sin(p) * around, np.full((SEGMENTS, 1), np.cos(p))], axis=1) * (radius + o)
                for p, o in zip(polar, out, strict=True)
            ]
        )
        share = np.interp(polar, [0.0, iris, SEEN_RAD], [0.0, IRIS_SHARE, 1.0])
        points.append(centre + ring)
        uvs.append(
            0.5 + 0.498 * (share[:, None, None] * around).reshape(-1, 2) * [1.0 if side == "left" else -1.0, 1.0]
        )
        rows = np.zeros((len(ring), len(fit.names)))
        rows[:, joint] = 1.0
        weights.append(rows)
        triangles.append(start + triangulate(grid_faces(len(polar), SEGMENTS, closed=True)[:, ::-1], points[-1]))
        start += len(ring)
    return modelled(
        "eyes",
        np.concatenate(points),
        np.concatenate(weights),
        {"eyes": np.concatenate(triangles)},
        uvs=np.concatenate(uvs),
    )


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


def eye_colour(name: str, iris_linear: tuple[float, float, float], pupil_m: float = PUPIL_M) -> Texture:
    """The base colour of an eye: pupil, iris of radial fibres, dark limbus, and a white that reddens outwards."""
    axis = (np.arange(EYE_PX) + 0.5) / EYE_PX * 2 - 1
    x, y = np.meshgrid(axis, -axis)
    share, angle = np.hypot(x, y), np.arctan2(y, x)
    inside = np.clip(share / IRIS_SHARE, 0.0, 1.0)
    # Fibres: noise drawn out along the radius, wound around once so that it closes.
    turn = angle / (2 * np.pi) % 1.0
    wound = noise(512, 2.5, 24, 22)[(inside * 40).astype(int), (turn * 512).astype(int) % 512]
    coarse = noise(512, 6, 60, 23)[(inside * 60).astype(int), (turn * 512).astype(int) % 512]
    pupil = pupil_m / IRIS_M
    ring = np.exp(-(((inside - 0.52 - 0.03 * coarse) / 0.11) ** 2))
    value = 0.78 + 0.22 * wound + 0.14 * coarse
    value = value * (0.75 + 0.45 * smoothstep(inside, 0.35, 0.9)) * (1 - 0.82 * smoothstep(inside, 0.84, 1.0))
    iris = np.asarray(iris_linear) * np.clip(value, 0.1, 2.0)[..., None]
    warm = np.asarray(iris_linear) * [1.5, 1.15, 0.6] + [0.02, 0.008, 0.0]
    iris = iris * (1 - 0.45 * ring[..., None]) + 0.45 * ring[..., None] * warm * np.clip(value, 0.1, 2)[..., None]
    iris *= smoothstep(inside, pupil - 0.03, pupil + 0.05)[..., None]
    outer = np.clip((share - IRIS_SHARE) / (1 - IRIS_SHARE), 0.0, 1.0)
    white = to_linear(np.array([0.86, 0.83, 0.80])) * (1 + 0.02 * noise(EYE_PX, 8, 80, 24)[..., None])
    redden = 0.10 + 0.55 * smoothstep(outer, 0.15, 0.9)
    white = white * (1 - redden[..., None] * np.array([0.10, 0.34, 0.36]))
    white = white * (1 - 0.55 * _veins(angle, share)[..., None] * np.array([0.25, 0.9, 0.9]))
    edge = smoothstep(share, IRIS_SHARE * 0.96, IRIS_SHARE * 1.09)[..., None]
    # The limbus: sclera turns bluish grey before the iris begins.
    rim = np.exp(-(((share - IRIS_SHARE * 1.05) / 0.035) ** 2))[..., None]
    white = white * (1 - 0.35 * rim * np.array([1.0, 0.92, 0.85]))
    return jpeg(name, to_srgb(iris * (1 - edge) + white * edge))
