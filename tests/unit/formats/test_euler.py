"""Continuous Euler angles compared with scipy's."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy
from scipy.spatial.transform import Rotation

from app.formats import euler

ORDERS = ["".join(axes) for axes in itertools.permutations("XYZ")]

# Components with many zeros and ones, so that gimbal lock and half turns are met.
COMPONENTS = st.sampled_from([0.0, 1.0, -1.0, 0.5**0.5]) | st.floats(-1, 1, allow_subnormal=False)
QUATERNIONS = st_numpy.arrays(np.float64, (7, 2, 4), elements=COMPONENTS).filter(
    lambda q: bool((np.linalg.norm(q, axis=-1) > 1e-3).all())
)


def _error_rad(quaternions: np.ndarray, rotations: Rotation) -> float:
    given = Rotation.from_quat(quaternions.reshape(-1, 4))
    return float((given.inv() * rotations).magnitude().max())


@pytest.mark.parametrize("order", ORDERS)
@given(quaternions=QUATERNIONS)
@settings(max_examples=60, deadline=None)
def test_the_angles_are_the_rotation_by_scipy(order: str, quaternions: np.ndarray) -> None:
    angles = euler.euler_degrees(quaternions, order).transpose(2, 0, 1)
    by_scipy = Rotation.from_euler(order, angles.reshape(-1, 3), degrees=True)  # capitals: axes that turn along
    assert _error_rad(quaternions, by_scipy) < 3e-8


@pytest.mark.parametrize("order", ORDERS)
def test_quaternions_are_the_angles_by_scipy(order: str) -> None:
    angles = np.random.default_rng(1).uniform(-720, 720, (50, 3))
    assert _error_rad(euler.quaternions(angles, order), Rotation.from_euler(order, angles, degrees=True)) < 1e-12


def test_matrices_are_scipys() -> None:
    quaternions = np.random.default_rng(2).normal(size=(20, 4))
    np.testing.assert_allclose(euler.matrices(quaternions), Rotation.from_quat(quaternions).as_matrix(), atol=1e-14)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("axis", range(3))
def test_a_steady_turn_never_jumps(order: str, axis: int) -> None:
    """Five turns about each axis, one degree per frame: the angles increase continuously, also when the middle one
    passes 90 degrees.
    """
    degrees = np.arange(1800.0)
    vectors = np.zeros((1800, 3))
    vectors[:, "XYZ".index(order[axis])] = degrees
    quaternions = Rotation.from_rotvec(vectors, degrees=True).as_quat()[:, None]
    angles = euler.euler_degrees(quaternions, order)[0]
    np.testing.assert_allclose(angles[axis], degrees, atol=1e-5)
    np.testing.assert_allclose(np.delete(angles, axis, axis=0), 0.0, atol=1e-5)


@pytest.mark.parametrize("order", ORDERS)
def test_smooth_motion_takes_the_shortest_way(order: str) -> None:
    """Away from gimbal lock no angle changes faster between frames than the rotation allows."""
    time = np.arange(2000)[:, None] * 0.01
    vectors = np.sin(time * [1.0, 1.3, 0.7]) * [0.9, 0.8, 0.9]
    quaternions = Rotation.from_rotvec(vectors).as_quat()[:, None]
    quaternions[::3] *= -1  # the same rotations
    angles = euler.euler_degrees(quaternions, order)[0]
    assert np.abs(np.diff(angles, axis=1)).max() < 10.0


def test_unrolled_angles_interpolate_near_the_rotation() -> None:
    """Midway between two frames, the mean of the angles gives the rotation there, as in readers that interpolate."""
    time = np.arange(0, 20, 0.01)[:, None]
    vectors = np.sin(time * [1.0, 1.3, 0.7]) * [2.0, 1.2, 2.5]
    quaternions = Rotation.from_rotvec(vectors).as_quat()[:, None]
    angles = euler.euler_degrees(quaternions[::2], "ZYX")[0]
    middle = Rotation.from_euler("ZYX", (angles[:, 1:] + angles[:, :-1]).T / 2, degrees=True)
    errors = (Rotation.from_quat(quaternions[1:-1:2, 0]).inv() * middle).magnitude()
    assert np.median(errors) < 1e-3
    assert np.quantile(errors, 0.99) < 0.05


def test_many_joints_at_once_are_each_by_itself() -> None:
    """The blocks in which the work is done have no influence."""
    quaternions = np.random.default_rng(5).normal(size=(5000, 9, 4)).cumsum(axis=0)
    together = euler.euler_degrees(quaternions, "ZXY")
    for joint in range(9):
        np.testing.assert_array_equal(together[joint], euler.euler_degrees(quaternions[:, joint : joint + 1], "ZXY")[0])
