"""Angles, accelerations and transforms of joints, against scipy and closed forms."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.export.joints import (
    anatomical_angles,
    angular_accelerations,
    conjugate,
    multiply,
    rotation_vectors,
    world_transforms,
)

seeds = st.integers(0, 2**32 - 1)


@given(seeds)
def test_rotation_vectors_and_products_are_scipys(seed: int) -> None:
    a, b = Rotation.random(8, random_state=seed % 1000), Rotation.random(8, random_state=seed % 1000 + 1)
    np.testing.assert_allclose(rotation_vectors(a.as_quat()), a.as_rotvec(), atol=1e-9)
    product = Rotation.from_quat(multiply(a.as_quat(), b.as_quat()))
    assert np.max((product * (a * b).inv()).magnitude()) < 1e-9
    unit = multiply(a.as_quat(), conjugate(a.as_quat()))
    np.testing.assert_allclose(np.abs(unit[:, 3]), 1.0)


def test_a_tiny_rotation_keeps_its_size() -> None:
    vectors = np.array([[1e-10, 0, 0], [0, 1e-6, 0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(rotation_vectors(Rotation.from_rotvec(vectors).as_quat()), vectors, atol=1e-15)


@given(st.floats(-1.5, 1.5), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0), seeds)
def test_angles_come_back(flexion: float, sideways: float, twist: float, seed: int) -> None:
    axes = Rotation.random(random_state=seed % 1000).as_matrix()
    f_axis, s_axis, t_axis = axes
    swing = Rotation.from_rotvec(flexion * f_axis + sideways * s_axis)
    rotation = (swing * Rotation.from_rotvec(twist * t_axis)).as_quat()
    for sign in (1.0, -1.0):
        angles = anatomical_angles(sign * rotation[None], f_axis, s_axis, t_axis)
        np.testing.assert_allclose(angles[0], [flexion, sideways, twist], atol=1e-6)


def test_a_constant_acceleration_is_found() -> None:
    fps, acceleration = 60.0, 5.0
    time_s = np.arange(30) / fps
    rotations = Rotation.from_rotvec(np.outer(acceleration * time_s**2 / 2, [0, 0.6, 0.8])).as_quat()[:, None]
    np.testing.assert_allclose(angular_accelerations(rotations, fps), acceleration, rtol=1e-6)
    assert angular_accelerations(rotations[:1], fps).shape == (0, 1)


def test_world_transforms_chain() -> None:
    local = np.tile(np.eye(4), (2, 3, 1, 1))
    local[:, :, 1, 3] = 1.0
    local[1, 0, :3, :3] = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    world = world_transforms((-1, 0, 1), local)
    np.testing.assert_allclose(world[0, 2, :3, 3], [0, 3, 0], atol=1e-12)
    np.testing.assert_allclose(world[1, 2, :3, 3], [-2, 1, 0], atol=1e-12)
