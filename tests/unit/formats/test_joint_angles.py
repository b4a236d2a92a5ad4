"""Angles of joints with individual orders and rest rotations compared with scipy's."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.formats.joint_angles import AXES, PLAIN_ORDER, channel_degrees, channel_quaternions, order_along

ORDERS = tuple("".join(axes) for axes in itertools.permutations(AXES))


def test_angles_are_those_of_the_turn_from_rest_by_scipy() -> None:
    random = np.random.default_rng(3)
    frames, rests = 40, Rotation.random(len(ORDERS), random_state=4)
    turned = Rotation.from_rotvec(random.uniform(-2, 2, (frames * len(ORDERS), 3)))
    rotations = (Rotation.from_quat(np.tile(rests.as_quat(), (frames, 1))) * turned).as_quat().reshape(frames, -1, 4)
    degrees = channel_degrees(rotations, ORDERS, rests.as_quat())
    assert degrees.shape == (len(ORDERS), 3, frames)
    for joint, order in enumerate(ORDERS):
        angles = degrees[joint][[AXES.index(axis) for axis in order]].T
        found = rests[joint] * Rotation.from_euler(order, angles, degrees=True)
        assert (found.inv() * Rotation.from_quat(rotations[:, joint])).magnitude().max() < 1e-7
    back = channel_quaternions(degrees.transpose(0, 2, 1), ORDERS, rests.as_quat())
    assert np.abs(np.abs(np.einsum("jfa,fja->jf", back, rotations)) - 1.0).max() < 1e-12


def test_all_angles_are_nothing_at_rest() -> None:
    rests = Rotation.random(len(ORDERS), random_state=5).as_quat()
    assert np.abs(channel_degrees(rests[None], ORDERS, rests)).max() < 1e-6


@pytest.mark.parametrize("order", ORDERS)
def test_the_order_is_that_of_the_nearest_axes_either_way_round(order: str) -> None:
    axes = np.eye(3)[[AXES.index(axis) for axis in order]] * [[1.0], [-1.0], [1.0]]
    bent = Rotation.from_rotvec([0.3, -0.2, 0.25]).apply(axes)
    assert order_along(axes) == order_along(bent) == order


def test_the_order_does_not_hang_on_rounding() -> None:
    """Axes midway between two choices give the same order on every machine."""
    half = Rotation.from_euler("Z", 45, degrees=True).apply(np.eye(3))
    random = np.random.default_rng(6)
    assert {order_along(half + random.normal(scale=1e-9, size=(3, 3))) for _ in range(20)} == {order_along(half)}


def test_axes_that_mean_nothing_have_the_plain_order() -> None:
    assert order_along(None) == PLAIN_ORDER
