"""Quaternions compared with scipy's rotations."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.rig import quaternion

seeds = st.integers(0, 2**32 - 1)


def _some(seed: int, count: int = 17) -> tuple[Rotation, Rotation, np.ndarray]:
    generator = np.random.default_rng(seed)
    return (
        Rotation.from_quat(generator.normal(size=(count, 4))),
        Rotation.from_quat(generator.normal(size=(count, 4))),
        generator.normal(size=(count, 3)),
    )


def _same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.allclose(np.abs(np.einsum("...i,...i->...", a, b)), 1.0, atol=1e-12))


@given(seeds)
def test_products_inverses_and_rotated_vectors_are_scipys(seed: int) -> None:
    a, b, vectors = _some(seed)
    assert _same(quaternion.multiply(a.as_quat(), b.as_quat()), (a * b).as_quat())
    assert _same(quaternion.conjugate(a.as_quat()), a.inv().as_quat())
    np.testing.assert_allclose(quaternion.rotate(a.as_quat(), vectors), a.apply(vectors), atol=1e-12)


@given(seeds)
def test_matrices_and_rotation_vectors_are_scipys(seed: int) -> None:
    a, _, _ = _some(seed)
    np.testing.assert_allclose(quaternion.to_matrix(a.as_quat()), a.as_matrix(), atol=1e-12)
    assert _same(quaternion.from_matrix(a.as_matrix()), a.as_quat())
    np.testing.assert_allclose(quaternion.to_rotation_vector(a.as_quat()), a.as_rotvec(), atol=1e-9)
    assert _same(quaternion.from_rotation_vector(a.as_rotvec()), a.as_quat())


@given(seeds, st.floats(-np.pi + 1e-6, np.pi - 1e-6))
def test_a_twist_is_found_again_and_the_swing_has_none(seed: int, angle: float) -> None:
    generator = np.random.default_rng(seed)
    axis = generator.normal(size=3)
    axis /= np.linalg.norm(axis)
    across = np.cross(axis, generator.normal(size=3))
    across /= np.linalg.norm(across)
    swing = Rotation.from_rotvec(across * generator.uniform(0.0, 3.0))
    whole = (swing * Rotation.from_rotvec(axis * angle)).as_quat()
    found_swing, found_twist = quaternion.swing_twist(whole, axis)
    assert _same(found_swing, swing.as_quat())
    assert _same(found_twist, Rotation.from_rotvec(axis * angle).as_quat())
    assert abs(float(quaternion.twist_angle(whole, axis)) - angle) < 1e-9


@given(seeds)
def test_the_shortest_turn_between_two_directions(seed: int) -> None:
    _, _, a = _some(seed)
    _, _, b = _some(seed + 1)
    a /= np.linalg.norm(a, axis=1, keepdims=True)
    b /= np.linalg.norm(b, axis=1, keepdims=True)
    turn = quaternion.between(a, b)
    np.testing.assert_allclose(quaternion.rotate(turn, a), b, atol=1e-9)
    angle = 2.0 * np.arccos(np.clip(np.abs(turn[:, 3]), 0.0, 1.0))
    np.testing.assert_allclose(angle, np.arccos(np.clip(np.einsum("fi,fi->f", a, b), -1.0, 1.0)), atol=1e-6)


def test_opposite_directions_are_half_a_turn_apart() -> None:
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    turned = quaternion.rotate(quaternion.between(axes, -axes), axes)
    np.testing.assert_allclose(turned, -axes, atol=1e-12)


@given(seeds, st.floats(0.0, 1.0))
def test_slerp_goes_the_short_way_at_constant_speed(seed: int, share: float) -> None:
    a, b, _ = _some(seed)
    found = quaternion.slerp(a.as_quat(), b.as_quat(), share)
    whole, part = (a.inv() * b).magnitude(), (a.inv() * Rotation.from_quat(found)).magnitude()
    np.testing.assert_allclose(part, share * whole, atol=1e-7)


@given(seeds, st.sampled_from([(None, None), (1, None), (None, 3), (5, 5), (1, 4), (4, 1)]))
def test_few_are_the_same_to_the_bit_as_many(seed: int, shapes: tuple[int | None, int | None]) -> None:
    generator = np.random.default_rng(seed)
    turns, others, vectors = (
        np.where(values < -1.5, -0.0, values)
        for values in (
            generator.normal(size=(*(() if count is None else (count,)), width))
            for count, width in zip((shapes[0], shapes[1], shapes[1]), (4, 4, 3), strict=True)
        )
    )
    for function, right in ((quaternion.multiply, others), (quaternion.rotate, vectors)):
        few = function(turns, right)
        many = function(np.broadcast_to(turns, (200, *np.broadcast_shapes((1, 4), turns.shape))), right)
        assert few.tobytes() == many[0].reshape(few.shape).tobytes()
