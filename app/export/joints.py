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
    vector, w = rotations[:, :3].T, rotations[:, 3]
    axes = np.stack([flexion, sideways])
    # The twist has the part of the rotation that is about its axis, and the swing what is left.
    along, square = twist @ vector, twist @ twist
    length = np.sqrt(along * along * square + w * w)
    half_turn = length < 1e-12
    length = np.where(half_turn, 1.0, length)
    cosine, sine = np.where(half_turn, 1.0, w / length), along / length
    # What the swing's quaternion has along the two other axes, and its scalar part.
    swing = cosine * (axes @ vector) - sine * (np.outer(axes @ twist, w) + np.cross(twist, axes) @ vector)
    swing_w = cosine * w + sine * along
    across = np.sqrt(np.maximum(1.0 - swing_w * swing_w, 0.0))
    small = across < 1e-7
    swing *= np.where(small, 2.0, 2.0 * np.arctan2(across, swing_w) / np.where(small, 1.0, across))
    turn = 2.0 * np.arctan2(np.where(w < 0.0, -along, along) * square, np.abs(w))
    return np.stack([*swing, turn], axis=-1)


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
    x, y, z, w = np.ascontiguousarray(np.moveaxis(rotations, -1, 0))
    before, after = ([part[steps] for part in (x, y, z, w)] for steps in (np.s_[:-1], np.s_[1:]))
    (ax, ay, az, aw), (bx, by, bz, bw) = before, after
    # From each frame to the next: the first one's inverse, times the second.
    turns = np.stack(
        [
            aw * bx - ax * bw - ay * bz + az * by,
            aw * by + ax * bz - ay * bw - az * bx,
            aw * bz - ax * by + ay * bx - az * bw,
        ]
    )
    cosine = aw * bw + ax * bx + ay * by + az * bz
    sine = np.sqrt(np.einsum("i...,i...->...", turns, turns))
    small = sine < 1e-9
    scale = np.where(small, 2.0, 2.0 * np.arctan2(sine, np.abs(cosine)) / np.where(small, 1.0, sine))
    turns *= np.where(cosine < 0.0, -fps, fps) * scale
    changes = np.diff(turns, axis=1)
    result: FloatArray = np.sqrt(np.einsum("i...,i...->...", changes, changes)) * fps
    return result
