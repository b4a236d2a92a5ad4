"""Playing a scene back, against a slow second implementation."""

from __future__ import annotations

import numpy as np
import pytest

from app.export.playback import Playback, Surface
from tests.unit.export.scenes import random_scene, slow_positions_m


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_deformed_vertices(seed: int) -> None:
    scene = random_scene(seed)
    assert scene.clip is not None
    playback = Playback(scene, scene.clip)
    chosen = np.array([3, 0, 17, 42, 1, 17, 3])  # a landmark may name a vertex twice
    surface = Surface(playback, scene.meshes[0], chosen)
    positions = surface.positions_m(playback.world(2, 6), 2, 6)
    for frame in range(2, 6):
        np.testing.assert_allclose(positions[frame - 2], slow_positions_m(scene, frame)[chosen], atol=1e-12)
