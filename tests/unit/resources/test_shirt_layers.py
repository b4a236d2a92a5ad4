"""Layers under a shirt end where the shirt covers them, so that they do not show through it on other bodies."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

STEP_M = 0.004


def _plane(cloth: ModuleType, low: float, high: float, z: float) -> object:
    """A sheet that faces ahead, 0.2 m wide, between two heights."""
    x, y = np.arange(-0.1, 0.1 + STEP_M / 2, STEP_M), np.arange(low, high + STEP_M / 2, STEP_M)
    across, up = np.meshgrid(x, y)
    points = np.stack([across.ravel(), up.ravel(), np.full(across.size, z)], axis=1)
    quads = cloth.grid_faces(len(y), len(x), closed=False)
    return cloth.to_triangles(cloth.Cloth(points, np.ones((len(points), 1)), quads))


def test_the_layer_about_the_neck_ends_a_little_below_the_shirts_edge(
    build_module: Callable[[str], ModuleType], monkeypatch: pytest.MonkeyPatch
) -> None:
    # The source of bodies needs packages of a build.
    source = ModuleType("character_source")
    source.__dict__["__getattr__"] = lambda name: object
    monkeypatch.setitem(sys.modules, "character_source", source)
    shirt, cloth = build_module("wardrobe_shirt"), build_module("character_cloth")
    tailoring = SimpleNamespace(
        suit=_plane(cloth, -0.08, 0.04, 0.0), collar_point=np.zeros(3), collar_normal=np.array([0.0, 1.0, 0.0])
    )
    edge_m = -0.02
    over = _plane(cloth, -0.2, edge_m, 0.003)
    whole, seen = shirt.neck_under(SimpleNamespace(tailoring=tailoring), over)
    before, after = whole.cloth.points, seen.cloth.points
    assert before[:, 1].min() < edge_m - 0.03
    middle = np.abs(after[:, 0]) < 0.08
    assert edge_m - 0.02 < after[middle, 1].min() < edge_m - 0.004
    assert np.isclose(after[:, 1].max(), before[:, 1].max()), "all that shows stays"
    lowest = after[middle & (after[:, 1] < edge_m - 0.008)]
    assert (lowest[:, 2] < before[:, 2].min() - 0.001).all(), "what is covered lies deeper"
    assert np.allclose(after[after[:, 1] > edge_m + STEP_M, 2], before[:, 2].min(), atol=6e-4)
