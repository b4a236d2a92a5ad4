"""Vertices have at most four influences wherever removing others moves no vertex by more than half a millimetre."""

from __future__ import annotations

import itertools
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import nnls

from app.export.character import character_scene
from app.export.influences import FEW_MM, MOST_INFLUENCES, with_few_influences
from app.export.playback import ScenePlayback, Surface
from app.formats.scene import Scene
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.rig.characters.character_library import character_named
from tests.gui.conftest import quartet_project
from tests.support.performed import player_motion
from tests.unit.formats import scenes


def _places_m(scene: Scene, mesh: int, vertices: np.ndarray) -> np.ndarray:
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    world = playback.world(0, scene.clip.frames)
    return Surface(playback, scene.meshes[mesh], vertices).positions_m(world, 0, scene.clip.frames)


def test_a_players_skin_has_four_influences_and_is_where_it_was() -> None:
    performance = Performance(quartet_project())
    player = performance.project.players[0]
    span = bars_span(performance, Fraction(30), (1, 4), 1)
    character = character_of(player)
    before = max(int(np.count_nonzero(mesh.weights, axis=1).max()) for mesh in character_named(character.id).meshes)
    assert before > MOST_INFLUENCES, "else there is nothing to show"
    scene = character_scene(character, player_motion(performance, player, span), "p", "t")
    (mesh,) = scene.meshes
    counts = np.count_nonzero(mesh.weights, axis=1)
    assert (counts > MOST_INFLUENCES).sum() < 0.001 * len(counts)
    np.testing.assert_allclose(np.asarray(mesh.weights, float).sum(axis=1), 1.0, atol=1e-6)
    assert mesh.weights.min() >= 0.0


def test_vertices_are_near_where_all_their_bones_took_them_or_keep_them() -> None:
    """Six influences with random weights: some vertices need only four, most do not."""
    given = scenes.character(Fraction(30), amplitude_rad=0.05)
    shares = np.array([1.0, 0.3, 0.2, 0.0, 0.02, 0.01])
    strong = [
        replace(mesh, weights=mesh.weights * shares / (mesh.weights @ shares)[:, None], morphs=mesh.morphs[:1])
        for mesh in given.meshes
    ]
    assert given.clip is not None
    weights = {"jawOpen": 0.05 * given.clip.morph_weights["jawOpen"]}
    given = replace(given, clip=replace(given.clip, morph_weights=weights))
    given = replace(given, meshes=tuple(strong))
    found = with_few_influences(given)
    fewer = 0
    for number, (mine, theirs) in enumerate(zip(given.meshes, found.meshes, strict=True)):
        vertices = np.arange(len(mine.vertices_cm))
        off_mm = 1000.0 * np.linalg.norm(
            _places_m(found, number, vertices) - _places_m(given, number, vertices), axis=-1
        )
        assert off_mm.max() <= FEW_MM + 1e-6
        counts = np.count_nonzero(theirs.weights, axis=1)
        np.testing.assert_allclose(theirs.weights.sum(axis=1), 1.0, atol=1e-9)
        changed = counts < np.count_nonzero(mine.weights, axis=1)
        assert (counts[changed] <= MOST_INFLUENCES).all()
        fewer += int(changed.sum())
    assert fewer > 10


def test_a_vertex_that_keeps_more_than_four_bones_moves_too_far_with_any_four() -> None:
    """Judged by nonnegative least squares over the vertex's own positions at every frame, with the morphs."""
    given = scenes.character(Fraction(30), amplitude_rad=0.05)
    shares = np.array([1.0, 0.3, 0.2, 0.0, 0.02, 0.01])
    meshes = tuple(
        replace(mesh, weights=mesh.weights * shares / (mesh.weights @ shares)[:, None], morphs=mesh.morphs[:1])
        for mesh in given.meshes
    )
    found = with_few_influences(replace(given, meshes=meshes))
    kept = 0
    for number, mesh in enumerate(found.meshes):
        for vertex in np.flatnonzero(np.count_nonzero(mesh.weights, axis=1) > MOST_INFLUENCES)[:12].tolist():
            alone = []
            for slot in np.flatnonzero(mesh.weights[vertex]).tolist():
                weights = np.zeros(mesh.weights.shape)
                weights[:, slot] = 1.0
                one = replace(found, meshes=(*found.meshes[:number], replace(mesh, weights=weights)))
                alone.append(_places_m(one, number, np.array([vertex])).reshape(-1, 3))
            asked = _places_m(found, number, np.array([vertex])).reshape(-1, 3)
            for four in itertools.combinations(alone, MOST_INFLUENCES):
                ways = np.stack(four, axis=-1).reshape(-1, MOST_INFLUENCES)
                share = nnls(np.r_[ways, np.full((1, MOST_INFLUENCES), 1e3)], np.r_[asked.ravel(), 1e3])[0]
                off_mm = 1000.0 * np.linalg.norm((ways @ share - asked.ravel()).reshape(-1, 3), axis=1)
                assert off_mm.max() > FEW_MM
            kept += 1
    assert kept > 2


@pytest.mark.parametrize("make", [scenes.instrument])
def test_a_mesh_with_few_influences_stays_the_same_object(make: object) -> None:
    scene = make(Fraction(30))
    assert with_few_influences(scene) is scene
