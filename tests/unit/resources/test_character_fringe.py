"""Fringes of the hair of our characters."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Module = Callable[[str], ModuleType]
EYE = np.array([-0.03, 1.5, 0.07])
"""Right eye before a head whose axis is that of y."""
RADIUS_M, CAP_M, CAP_FROM_M = 0.08, 0.004, 0.02


def head(surface: ModuleType) -> tuple[Any, NDArray[np.float64]]:
    """A cap of hair that begins over the eyes of an upright cylinder, and points of the cylinder."""
    angles, heights = np.meshgrid(np.radians(np.arange(-90.0, 91.0, 2.0)), np.arange(0.0, 0.121, 0.004))
    sides = np.stack([-np.sin(angles), np.zeros_like(angles), np.cos(angles)], axis=-1)
    places = sides * (RADIUS_M + CAP_M) + np.array([0.0, 1.0, 0.0]) * (EYE[1] + CAP_FROM_M + heights[..., None])
    rows, columns = angles.shape
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1, 1)
    quads = first + np.array([0, columns, columns + 1, 1])
    flat = places.reshape(-1, 3)
    hair = surface.modelled(
        "hair", flat, np.ones((len(flat), 1)), {"hair": surface.triangulate(quads, flat)}, uvs=np.zeros((len(flat), 2))
    )
    lower = np.linspace(-0.15, 0.2, 120)
    skin = sides[0][None] * RADIUS_M + np.array([0.0, 1.0, 0.0]) * (EYE[1] + lower)[:, None, None]
    return hair, skin.reshape(-1, 3)


def test_a_fringe_falls_from_the_hair_over_the_forehead_and_leaves_the_eyes_free(build_module: Module) -> None:
    fringe, surface = build_module("character_fringe"), build_module("character_surface")
    hair, skin = head(surface)
    painted = np.zeros((64, 64, 4))
    painted[10:50, 20:30, 3] = 1.0
    (strip,) = fringe.strips(painted, ((0.2, 0.1, 0.6, 0.9),))
    made = fringe.with_fringe(hair, skin, EYE, [strip])
    count = sum(layer.count for layer in fringe.LAYERS)
    points = made.positions[len(hair.positions) :].reshape(count, fringe.ROWS, fringe.ACROSS, 3)
    radius = np.hypot(points[..., 0], points[..., 2])
    assert (radius[:, 0] > RADIUS_M + CAP_M).all(), "roots lie on the hair"
    assert (radius > RADIUS_M).all(), "none is in the skin"
    assert radius.max() < RADIUS_M + CAP_M + 0.02
    angles = np.degrees(np.arctan2(-points[..., 0], points[..., 2]))
    ahead = np.abs(angles).max(axis=(1, 2)) < 40.0
    assert ahead.sum() > 20
    assert points[ahead, -1, :, 1].min() > EYE[1]
    assert np.diff(np.sort(angles[ahead, -1, 1])).max() < 8.0, "no gap over the forehead"
    assert abs(angles.mean()) < 3.0, "as many locks on either side"
    faces = made.triangles["hair"][len(hair.triangles["hair"]) :]
    a, b, c = (made.positions[faces[:, corner]] for corner in range(3))
    outwards = np.einsum("nk,nk->n", np.cross(b - a, c - a), a * [1.0, 0.0, 1.0])
    assert (outwards > 0.0).mean() > 0.95
    u, v = made.uvs[len(hair.positions) :].T
    assert (u.min(), u.max()) == pytest.approx((20 / 64, 30 / 64), abs=1 / 64)
    assert v.max() == pytest.approx(1.0 - 10 / 64, abs=1 / 64)


def test_a_painted_lock_with_gaps_is_refused(build_module: Module) -> None:
    painted = np.zeros((64, 64, 4))
    painted[[10, 50], 20:30, 3] = 1.0
    with pytest.raises(ValueError, match="gaps"):
        build_module("character_fringe").strips(painted, ((0.2, 0.1, 0.6, 0.9),))
