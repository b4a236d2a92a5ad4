"""What is asked of joints: world transforms, human ranges, angular accelerations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from app.rig import quaternion

FloatArray = npt.NDArray[np.float64]


def world_transforms(parents: Sequence[int], translations: FloatArray, rotations: FloatArray) -> FloatArray:
    """World transforms of a hierarchy.

    Parameters
    ----------
    parents : sequence of int
        Parent of each joint, -1 for a root; a parent stands before its children.
    translations : (F, J, 3) float64
        In the parent's frame.
    rotations : (F, J, 4) float64
        ``parent_from_joint``, unit quaternions xyzw.

    Returns
    -------
    (F, J, 4, 4) float64
    """
    frames, joints, _ = translations.shape
    local = np.zeros((joints, frames, 4, 4))
    local[..., :3, :3] = quaternion.to_matrix(rotations.swapaxes(0, 1))
    local[..., :3, 3] = translations.swapaxes(0, 1)
    local[..., 3, 3] = 1.0
    for joint, parent in enumerate(parents):
        if parent >= 0:
            local[joint] = local[parent] @ local[joint]
    return local.swapaxes(0, 1)


def anatomical_angles(
    rotations: FloatArray, flexion: FloatArray, sideways: FloatArray, twist: FloatArray
) -> FloatArray:
    """Flexion, sideways and twist angles of one joint's local rotations, ``rotation = swing * twist``.

    Parameters
    ----------
    rotations : (F, 4) float64
        Unit quaternions xyzw.
    flexion, sideways, twist : (3,) float64
        Unit axes at right angles (`metadata.model.JointAxes`).

    Returns
    -------
    (F, 3) float64
        Radians, in that order.
    """
    swing, turn = quaternion.swing_twist(rotations, twist)
    vector = quaternion.to_rotation_vector(swing)
    return np.stack([vector @ flexion, vector @ sideways, quaternion.twist_angle(turn, twist)], axis=-1)


def angular_accelerations(rotations: FloatArray, fps: float) -> FloatArray:
    """Size of the angular acceleration of local rotations, by second difference.

    Parameters
    ----------
    rotations : (F, J, 4) float64
    fps : float

    Returns
    -------
    (max(F - 2, 0), J) float64
        rad/s2, at the frames 1 .. F - 2.
    """
    steps = quaternion.multiply(quaternion.conjugate(rotations[:-1]), rotations[1:])
    velocities = quaternion.to_rotation_vector(steps) * fps
    result: FloatArray = np.linalg.norm(np.diff(velocities, axis=0), axis=-1) * fps
    return result
