"""What is asked of joints: world transforms, human ranges, angular accelerations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def world_transforms(parents: Sequence[int], parent_from_joint: FloatArray) -> FloatArray:
    """World transforms of a hierarchy.

    Parameters
    ----------
    parents : sequence of int
        Parent of each joint, -1 for a root; a parent stands before its children.
    parent_from_joint : (F, J, 4, 4) float64

    Returns
    -------
    (F, J, 4, 4) float64
    """
    world = np.empty_like(parent_from_joint)
    for joint, parent in enumerate(parents):
        if parent < 0:
            world[:, joint] = parent_from_joint[:, joint]
        else:
            world[:, joint] = world[:, parent] @ parent_from_joint[:, joint]
    return world


def rotation_vectors(quaternions: FloatArray) -> FloatArray:
    """Rotation vectors (axis times angle, radians, the short way) of unit quaternions xyzw; any leading shape."""
    signs = np.where(quaternions[..., 3:] < 0.0, -1.0, 1.0)
    vector = quaternions[..., :3] * signs
    sine = np.linalg.norm(vector, axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, np.abs(quaternions[..., 3:]))
    # sin(a/2) ~ a/2 near zero, so the factor tends to 2.
    factor = np.where(sine > 1e-9, angle / np.maximum(sine, 1e-9), 2.0)
    result: FloatArray = vector * factor
    return result


def multiply(a: FloatArray, b: FloatArray) -> FloatArray:
    """Hamilton product of quaternions xyzw; the rotation ``b`` first."""
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=-1,
    )


def conjugate(quaternions: FloatArray) -> FloatArray:
    """Inverse of unit quaternions."""
    return quaternions * np.array([-1.0, -1.0, -1.0, 1.0])


def anatomical_angles(rotations: FloatArray, flexion: FloatArray, sideways: FloatArray, twist: FloatArray) -> FloatArray:
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
    along = rotations[:, :3] @ twist
    twist_angle = 2.0 * np.arctan2(along, rotations[:, 3])
    twist_angle = (twist_angle + np.pi) % (2.0 * np.pi) - np.pi
    half = twist_angle / 2.0
    twist_rotation = np.concatenate([np.sin(half)[:, None] * twist, np.cos(half)[:, None]], axis=-1)
    swing = rotation_vectors(multiply(rotations, conjugate(twist_rotation)))
    return np.stack([swing @ flexion, swing @ sideways, twist_angle], axis=-1)


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
    steps = rotation_vectors(multiply(conjugate(rotations[:-1]), rotations[1:])) * fps
    result: FloatArray = np.linalg.norm(np.diff(steps, axis=0), axis=-1) * fps
    return result
