"""Arms and legs compared with trigonometry: reachable targets are reached, bones keep their lengths, nothing jumps."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.rig import quaternion
from app.rig.ik import SOFT_SHARE, Limb, LimbPose, solve_limb

LIMB = Limb(
    upper=0,
    lower=1,
    end=2,
    upper_vector_m=np.array([0.28, -0.01, 0.005]),
    lower_vector_m=np.array([0.25, 0.0, 0.01]),
    hinge_axis=np.array([0.0, -1.0, 0.0]),
    twist_share=0.5,
)
seeds = st.integers(0, 2**32 - 1)


def _targets(seed: int, shortest: float, longest: float, count: int = 23) -> tuple[np.ndarray, ...]:
    generator = np.random.default_rng(seed)
    root = generator.normal(size=(count, 3))
    direction = generator.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    target = root + direction * generator.uniform(shortest, longest, size=(count, 1)) * LIMB.length_m
    rotations = generator.normal(size=(2, count, 4))
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    return root, target, rotations[0], rotations[1], generator.normal(size=(count, 3))


def _world(pose: LimbPose, root: np.ndarray, parent: np.ndarray) -> tuple[np.ndarray, ...]:
    upper = quaternion.multiply(parent, pose.upper)
    lower = quaternion.multiply(upper, pose.lower)
    middle = root + quaternion.rotate(upper, LIMB.upper_vector_m)
    end = middle + quaternion.rotate(lower, LIMB.lower_vector_m)
    return middle, end, quaternion.multiply(lower, pose.end)


@given(seeds)
def test_what_is_in_reach_is_reached_with_the_requested_rotation(seed: int) -> None:
    root, target, parent, rotation, pole = _targets(seed, 0.2, 1.0 - SOFT_SHARE)
    pose = solve_limb(LIMB, root, parent, target, rotation, pole)
    _, end, turned = _world(pose, root, parent)
    np.testing.assert_allclose(end, target, atol=1e-9)
    np.testing.assert_allclose(np.abs(np.einsum("fi,fi->f", turned, rotation)), 1.0, atol=1e-9)
    assert pose.miss_m.max() < 1e-9


@given(seeds)
def test_the_middle_joint_points_to_the_pole(seed: int) -> None:
    root, target, parent, rotation, pole = _targets(seed, 0.3, 0.9)
    middle, _, _ = _world(solve_limb(LIMB, root, parent, target, rotation, pole), root, parent)
    line = (target - root) / np.linalg.norm(target - root, axis=1, keepdims=True)
    off = middle - root
    off = off - line * np.einsum("fi,fi->f", off, line)[:, None]
    beside = np.cross(line, pole)
    np.testing.assert_allclose(np.einsum("fi,fi->f", off, beside), 0.0, atol=1e-9)
    assert np.all(np.einsum("fi,fi->f", off, pole) > 0.0)


@given(seeds)
def test_a_far_target_is_approached_and_reported(seed: int) -> None:
    root, target, parent, rotation, pole = _targets(seed, 1.1, 2.0)
    pose = solve_limb(LIMB, root, parent, target, rotation, pole)
    _, end, _ = _world(pose, root, parent)
    np.testing.assert_allclose(np.linalg.norm(end - target, axis=1), pose.miss_m, atol=1e-9)
    assert np.all(np.linalg.norm(end - root, axis=1) <= LIMB.length_m + 1e-9)


def test_the_elbow_does_not_pop_near_full_extension() -> None:
    count = 2001
    distance = np.linspace(0.9, 1.1, count) * LIMB.length_m
    root, target = np.zeros((count, 3)), distance[:, None] * np.array([0.0, 0.0, 1.0])
    still = np.tile(quaternion.IDENTITY, (count, 1))
    pose = solve_limb(LIMB, root, still, target, still, np.array([0.0, -1.0, 0.0]))
    turned = quaternion.multiply(quaternion.conjugate(pose.lower[:-1]), pose.lower[1:])
    bend = np.linalg.norm(quaternion.to_rotation_vector(turned), axis=1)
    # Without the soft limit the last step to the straight arm turns the elbow by 0.03 rad.
    assert bend.max() < 0.004
    reached = distance - pose.miss_m
    assert np.all(np.diff(reached) > 0.0)
    assert pose.miss_m[distance <= LIMB.length_m].max() < 0.005 * LIMB.length_m


@given(seeds)
def test_half_of_the_hands_turn_goes_to_the_forearm(seed: int) -> None:
    root, target, parent, rotation, pole = _targets(seed, 0.3, 0.9)
    axis = LIMB.lower_vector_m / np.linalg.norm(LIMB.lower_vector_m)
    shared = solve_limb(LIMB, root, parent, target, rotation, pole)
    bare = solve_limb(
        Limb(0, 1, 2, LIMB.upper_vector_m, LIMB.lower_vector_m, LIMB.hinge_axis, 0.0),
        root,
        parent,
        target,
        rotation,
        pole,
    )
    whole = quaternion.twist_angle(bare.end, axis)
    np.testing.assert_allclose(quaternion.twist_angle(shared.end, axis), 0.5 * whole, atol=1e-9)


@given(seeds)
def test_a_target_nearer_than_the_folded_limb_is_missed_by_as_much(seed: int) -> None:
    root, target, parent, rotation, pole = _targets(seed, 0.0, 0.9 * abs(LIMB.upper_m - LIMB.lower_m) / LIMB.length_m)
    pose = solve_limb(LIMB, root, parent, target, rotation, pole)
    _, end, _ = _world(pose, root, parent)
    np.testing.assert_allclose(np.linalg.norm(end - root, axis=1), LIMB.upper_m - LIMB.lower_m, atol=2e-6)
    np.testing.assert_allclose(np.linalg.norm(end - target, axis=1), pose.miss_m, atol=1e-9)
