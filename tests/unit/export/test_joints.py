"""Angles, accelerations and transforms of joints compared with scipy and closed forms."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.export.joints import anatomical_angles, angular_accelerations, world_transforms


@given(st.floats(-1.5, 1.5), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0), st.integers(0, 1000))
def test_angles_come_back(flexion: float, sideways: float, twist: float, seed: int) -> None:
    f_axis, s_axis, t_axis = Rotation.random(random_state=seed).as_matrix()
    swing = Rotation.from_rotvec(flexion * f_axis + sideways * s_axis)
    rotation = (swing * Rotation.from_rotvec(twist * t_axis)).as_quat()
    for sign in (1.0, -1.0):
        angles = anatomical_angles(sign * rotation[:, None, None], np.array([[f_axis, s_axis, t_axis]]))
        np.testing.assert_allclose(angles[:, 0, 0], [flexion, sideways, twist], atol=1e-6)


def test_a_constant_acceleration_is_found() -> None:
    fps, acceleration = 60.0, 5.0
    time_s = np.arange(30) / fps
    rotations = Rotation.from_rotvec(np.outer(acceleration * time_s**2 / 2, [0, 0.6, 0.8])).as_quat().T[:, None]
    np.testing.assert_allclose(angular_accelerations(rotations, fps), acceleration, rtol=1e-6)
    assert angular_accelerations(rotations[..., :1], fps).shape == (1, 0)


def test_world_transforms_chain() -> None:
    translations = np.zeros((2, 3, 3))
    translations[..., 1] = 1.0
    rotations = np.zeros((2, 3, 4))
    rotations[..., 3] = 1.0
    rotations[1, 0] = Rotation.from_euler("z", 90, degrees=True).as_quat()
    world = world_transforms((-1, 0, 1), translations, rotations)
    np.testing.assert_allclose(world[0, 2, :3, 3], [0, 3, 0], atol=1e-12)
    np.testing.assert_allclose(world[1, 2, :3, 3], [-2, 1, 0], atol=1e-12)
