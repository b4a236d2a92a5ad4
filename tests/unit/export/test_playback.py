"""Playback of a scene compared with a slow second implementation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.export.playback import Middles, PlaybackBones, ScenePlayback, Surface
from tests.unit.export.scenes import random_scene, slow_positions_m


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_deformed_vertices(seed: int) -> None:
    scene = random_scene(seed)
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    chosen = np.array([3, 0, 17, 42, 1, 17, 3])  # a landmark may name a vertex twice
    surface = Surface(playback, scene.meshes[0], chosen)
    positions = surface.positions_m(playback.world(2, 6), 2, 6)
    for frame in range(2, 6):
        np.testing.assert_allclose(positions[frame - 2], slow_positions_m(scene, frame)[chosen], atol=1e-12)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_middle_of_a_surface_is_the_mean_of_its_deformed_vertices(seed: int) -> None:
    scene = random_scene(seed)
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    vertices = {"few": [3, 0, 17, 42, 1, 17, 3], "one": [5], "all": [*range(43)]}
    surfaces = {name: Surface(playback, scene.meshes[0], np.array(chosen)) for name, chosen in vertices.items()}
    carriers = {int(joint) for surface in surfaces.values() for joint in surface.skin.joints}
    limbs = PlaybackBones(playback, carriers)
    middles = Middles({name: surface.skin for name, surface in surfaces.items()}, limbs)
    found = middles.places_m(limbs.world(2, 6, limbs.room(9)), playback.morphs(2, 6))
    for name, places_m in zip(middles.names, found, strict=True):
        positions_m = np.stack([slow_positions_m(scene, frame) for frame in range(2, 6)])
        np.testing.assert_allclose(places_m.T, positions_m[:, vertices[name]].mean(axis=1), atol=1e-12)


def test_bones_that_are_still_are_where_they_are_all_the_time() -> None:
    scene = random_scene(1)
    rotations = np.array(scene.clip.rotations_xyzw)
    rotations[:, 1:3] = rotations[:1, 1:3]
    moving = ScenePlayback(scene, scene.clip)
    stopped = ScenePlayback(scene, replace(scene.clip, rotations_xyzw=rotations, translations_cm={}))
    assert not moving.still.all()
    assert stopped.still[1:3].all()
    once = stopped.world(0, 1)
    world = stopped.world(0, stopped.clip.frames)
    places = np.linalg.inv(world[:, stopped.parents[2]]) @ world[:, 2]
    np.testing.assert_allclose(
        places, np.broadcast_to(np.linalg.inv(once[0, stopped.parents[2]]) @ once[0, 2], places.shape), atol=1e-9
    )
