"""Skinning against a loop over vertices and joints."""

from typing import Any

import numpy as np
import pytest

from app.rig import skinning
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.model import Character
from app.rig.skeleton import JointTransforms, forward
from tests.support.deformed import deform

MORPHS = ("jawOpen", "mouthPucker")


@pytest.fixture(scope="module")
def posed() -> tuple[Character, JointTransforms, dict[str, np.ndarray]]:
    character = character_named(next(iter(bundled_characters())))
    generator = np.random.default_rng(11)
    rotations = generator.normal(size=(2, len(character.skeleton.names), 4)) * 0.2 + [0.0, 0.0, 0.0, 1.0]
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    weights = {name: generator.uniform(size=2) for name in MORPHS}
    return character, forward(character.skeleton, rotations), weights


def _slow(
    character: Character,
    mesh_name: str,
    vertex: int,
    transforms: JointTransforms,
    morphs: dict[str, np.ndarray],
    frame: int,
) -> np.ndarray:
    mesh = skinning.mesh_named(character, mesh_name)
    point = mesh.positions_m[vertex].astype(float)
    for morph in mesh.morphs:
        if morph.name in morphs and vertex in morph.vertices:
            point = point + morphs[morph.name][frame] * morph.deltas_m[list(morph.vertices).index(vertex)]
    result = np.zeros(3)
    for joint, weight in zip(mesh.joints[vertex], mesh.weights[vertex], strict=True):
        bind = character.joint_from_mesh[joint]
        world = transforms.matrices()[frame, transforms.place(int(joint))]
        result += weight * (world[:, :3] @ (bind[:3, :3] @ point + bind[:3, 3]) + world[:, 3])
    return result


def test_vertices_and_morphs_are_where_the_loop_puts_them(posed: tuple[Any, ...]) -> None:
    character, transforms, morphs = posed
    body = skinning.mesh_named(character, "body")
    moved = next(morph for morph in body.morphs if morph.name == "jawOpen")
    vertices = np.unique(np.concatenate([np.arange(0, len(body.positions_m), 401), moved.vertices[::97]]))
    found = deform(skinning.patch(character, body, vertices), transforms, morphs)
    for frame in range(2):
        expected = [_slow(character, "body", int(v), transforms, morphs, frame) for v in vertices]
        np.testing.assert_allclose(found[frame], expected, atol=1e-6)


def test_a_landmark_is_the_mean_of_its_vertices(posed: tuple[Any, ...]) -> None:
    character, transforms, morphs = posed
    names = tuple(character.landmarks)
    found = skinning.landmark_positions(character, names, transforms, morphs)
    for place, name in enumerate(names):
        mark = character.landmarks[name]
        part = skinning.patch(character, skinning.mesh_named(character, mark.mesh), mark.vertices)
        mean = deform(part, transforms, morphs).mean(axis=1)
        np.testing.assert_allclose(found[:, place], mean, atol=1e-9)


def test_the_joints_a_landmark_needs_are_enough(posed: tuple[Any, ...]) -> None:
    character, transforms, _ = posed
    names = ("lips.contact", "left.index.pad")
    needed = skinning.landmark_joints(character, names)
    assert set(needed) < set(transforms.joints)
    places = [transforms.place(joint) for joint in needed]
    few = JointTransforms(needed, transforms.positions_m[:, places], transforms.rotations[:, places])
    np.testing.assert_allclose(
        skinning.landmark_positions(character, names, few),
        skinning.landmark_positions(character, names, transforms),
        atol=1e-12,
    )


def test_morphs_of_one_vertex_add_up() -> None:
    identity = np.eye(4)[None, :3]
    morphs = {"left": np.array([[1.0, 0.0, 0.0]]), "up": np.array([[0.0, 2.0, 0.0]])}
    skin = skinning.Skin(np.zeros((1, 3)), np.array([0]), np.ones((1, 1)), identity, morphs)
    world = np.broadcast_to(np.eye(4), (2, 1, 4, 4))
    weights = {"left": np.array([1.0, 0.5]), "up": np.array([0.0, 0.5])}
    assert skin.deformed(world, weights)[:, 0].tolist() == [[1.0, 0.0, 0.0], [0.5, 1.0, 0.0]]
