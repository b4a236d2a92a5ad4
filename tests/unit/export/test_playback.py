"""Playing a scene back, against a slow second implementation."""

from __future__ import annotations

import numpy as np
import pytest

from app.export.penetration import Hands
from app.export.playback import Playback, Surface
from app.export.proxy import signed_distance
from instrument_maps.model import Capsule, Cone, Ring
from tests.unit.export.scenes import random_scene, slow_positions_m


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_deformed_vertices(seed: int) -> None:
    scene = random_scene(seed)
    assert scene.clip is not None
    playback = Playback(scene, scene.clip)
    chosen = np.array([3, 0, 17, 42, 1])
    surface = Surface(playback, scene.meshes[0], chosen)
    positions = surface.positions_m(playback.world(2, 6), 2, 6)
    for frame in range(2, 6):
        np.testing.assert_allclose(positions[frame - 2], slow_positions_m(scene, frame)[chosen], atol=1e-12)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_penetration_leaves_nothing_out(seed: int) -> None:
    scene = random_scene(seed, vertices=300, frames=9)
    assert scene.clip is not None
    playback = Playback(scene, scene.clip)
    shapes = (
        Capsule("root", (-0.03, 0.0, 0.0), (0.05, 0.02, 0.0), 0.02),
        Cone("part", (0.0, 0.0, 0.0), (0.0, 0.04, 0.0), 0.03, 0.01),
        Ring("part", (0.0, -0.05, 0.0), (0.0, 0.0, 1.0), 0.03, 0.01),
    )
    nodes = {"root": np.tile(np.eye(4), (9, 1, 1)), "part": np.tile(np.eye(4), (9, 1, 1))}
    nodes["part"][:, :3, 3] = np.linspace(-0.03, 0.03, 27).reshape(9, 3)
    # The chain of this scene turns at random, far more than a hand bends, so vertices leave their groups' radius;
    # only the frames of a gentle motion are comparable.
    scene.clip.rotations_xyzw[1:] = scene.clip.rotations_xyzw[0]
    hands = Hands(playback, scene.meshes[0], np.arange(300), shapes)
    depths = hands.depths_m(playback.world(0, 9), nodes, 0, 9)
    for frame in range(9):
        points = slow_positions_m(scene, frame)
        deepest = 0.0
        for shape in shapes:
            local = points - nodes[shape.node][frame, :3, 3]
            deepest = max(deepest, float(-signed_distance(shape, local).min()))
        assert depths[frame] == pytest.approx(max(deepest, 0.0), abs=1e-9)
    assert depths.max() > 0.005
