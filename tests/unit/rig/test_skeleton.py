"""Forward kinematics against a slow product of matrices."""

import numpy as np
from scipy.spatial.transform import Rotation

from app.rig import skeleton as fk
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.model import Skeleton


def _slow(skeleton: Skeleton, rotations: np.ndarray, hips_m: np.ndarray, joint: int) -> np.ndarray:
    local = np.eye(4)
    local[:3, :3] = Rotation.from_quat(rotations[joint]).as_matrix()
    local[:3, 3] = hips_m if skeleton.names[joint] == "hips" else skeleton.offsets_m[joint]
    parent = skeleton.parents[joint]
    return local if parent < 0 else _slow(skeleton, rotations, hips_m, parent) @ local


def _pose(skeleton: Skeleton, frames: int) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(5)
    rotations = generator.normal(size=(frames, len(skeleton.names), 4))
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    return rotations, generator.normal(size=(frames, 3))


def test_every_joint_is_where_the_matrices_put_it() -> None:
    skeleton = character_named(next(iter(bundled_characters()))).skeleton
    rotations, hips = _pose(skeleton, 3)
    found = fk.forward(skeleton, rotations, hips)
    for frame in range(3):
        for joint in range(len(skeleton.names)):
            expected = _slow(skeleton, rotations[frame], hips[frame], joint)
            np.testing.assert_allclose(found.of(joint)[0][frame], expected[:3, 3], atol=1e-12)
            np.testing.assert_allclose(found.matrices()[frame, joint, :, :3], expected[:3, :3], atol=1e-12)


def test_some_joints_bring_their_ancestors_and_no_others() -> None:
    skeleton = character_named(next(iter(bundled_characters()))).skeleton
    rotations, hips = _pose(skeleton, 2)
    requested = skeleton.index("rightIndexDistal")
    some, everything = fk.forward(skeleton, rotations, hips, [requested]), fk.forward(skeleton, rotations, hips)
    assert some.joints == fk.ancestors(skeleton, requested)
    np.testing.assert_array_equal(some.of(requested)[0], everything.of(requested)[0])


def test_the_rest_pose_is_the_sum_of_offsets() -> None:
    skeleton = character_named(next(iter(bundled_characters()))).skeleton
    still = np.tile([0.0, 0.0, 0.0, 1.0], (1, len(skeleton.names), 1))
    np.testing.assert_allclose(fk.forward(skeleton, still).positions_m[0], fk.rest_positions(skeleton), atol=1e-15)
