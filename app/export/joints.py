"""World transforms, joint angles and angular accelerations of exported skeletons."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion

_LEAST, _SMALL = 1e-24, 1e-9

_LEAST, _SMALL = 1e-24, 1e-9


def world_transforms(parents: Sequence[int], translations: FloatArray, rotations: FloatArray) -> FloatArray:
    """Compute the world transforms of a hierarchy.

    Parameters
    ----------
    parents : sequence of int
        Parent of each joint, -1 for a root; parents come first.
    translations : (F, J, 3) float64
        Translation in the parent's frame.
    rotations : (F, J, 4) float64
        ``parent_from_joint``, unit quaternions xyzw.

    Returns
    -------
    (F, J, 4, 4) float64
        ``world_from_joint``.
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


def world_rows(parents: Sequence[int], local: Sequence[FloatArray], world: FloatArray) -> None:
    """Compute the world transforms of a hierarchy component by component, with few long products per joint.

    Parameters
    ----------
    parents : sequence of int
        See `world_transforms`.
    local : sequence of (3, 4, F) or (3, 4, 1) float64
        ``parent_from_joint`` of each joint without the last row; a single frame for constant ones.
    world : (J, 3, 4, F) float64
        Array to be filled.
    """
    product = np.empty(world.shape[1:])
    for joint, (parent, own) in enumerate(zip(parents, local, strict=True)):
        if parent < 0:
            world[joint] = own
            continue
        above = world[parent]
        placed = np.multiply(above[:, 0, None], own[0], out=world[joint])
        placed += np.multiply(above[:, 1, None], own[1], out=product)
        placed += np.multiply(above[:, 2, None], own[2], out=product)
        placed[:, 3] += above[:, 3]


def matrix_rows(turns: FloatArray, rows: FloatArray) -> None:
    """Write rotation matrices of quaternions (4, ...) of any length into rows (3, 3, ...); a zero quaternion is the
    identity.
    """
    x, y, z, w = turns
    twice = 2.0 / np.maximum(x * x + y * y + z * z + w * w, _LEAST)
    sx, sy, sz = twice * x, twice * y, twice * z
    xx, yy, zz, xy, xz, yz = sx * x, sy * y, sz * z, sx * y, sx * z, sy * z
    xw, yw, zw = sx * w, sy * w, sz * w
    for axis, (one, other) in enumerate(((yy, zz), (xx, zz), (xx, yy))):
        np.subtract(1.0, one + other, out=rows[axis, axis])
    for (row, column), even, odd in (((0, 1), xy, zw), ((2, 0), xz, yw), ((1, 2), yz, xw)):
        np.subtract(even, odd, out=rows[row, column])
        np.add(even, odd, out=rows[column, row])


def anatomical_angles(turns: FloatArray, axes: FloatArray) -> FloatArray:
    """Return the flexion, sideways and twist angles of local joint rotations, ``rotation = swing * twist``.

    Parameters
    ----------
    turns : (4, J, F) float64
        Unit quaternions xyzw.
    axes : (J, 3, 3) float64
        Orthogonal unit axes of each joint for flexion, sideways bend and twist (`metadata.skeleton_profile.JointAxes`).

    Returns
    -------
    (3, J, F) float64
        Angles in radians: flexion, sideways, twist.
    """
    across, twist = axes[:, :2], axes[:, 2:]
    sums = np.concatenate([across, np.cross(twist, across), twist], axis=1) @ turns[:3].transpose(1, 0, 2)
    along, w = sums[:, 4], turns[3]
    # The twist is the part of the rotation about the axis, the swing the remainder.
    length = np.sqrt(along * along + w * w)
    half_turn = length < 1e-12
    length[half_turn] = 1.0
    cosine, sine = w / length, along / length
    cosine[half_turn] = 1.0
    # Components of the swing's quaternion along the two other axes, and its scalar part.
    swing_w = cosine * w + sine * along
    scale = _angle_per_sine(np.sqrt(np.maximum(1.0 - swing_w * swing_w, 0.0)), swing_w)
    result = np.empty((3, *w.shape))
    for axis in range(2):
        result[axis] = (cosine * sums[:, axis] - sine * sums[:, 2 + axis]) * scale
    result[2] = 2.0 * np.arctan2(np.where(w < 0.0, -along, along), np.abs(w))
    return result


def angular_accelerations(turns: FloatArray, fps: float) -> FloatArray:
    """Return the magnitude of the angular acceleration of local rotations, by second difference.

    Parameters
    ----------
    turns : (4, J, F) float64
        Unit quaternions xyzw.
    fps : float
        Frames per second.

    Returns
    -------
    (J, max(F - 2, 0)) float64
        Acceleration in rad/s2 at frames 1 .. F - 2.
    """
    (ax, ay, az, aw), (bx, by, bz, bw) = turns[..., :-1], turns[..., 1:]
    # From each frame to the next: the inverse of the first rotation times the second.
    steps = np.stack(
        [
            aw * bx - ax * bw - ay * bz + az * by,
            aw * by + ax * bz - ay * bw - az * bx,
            aw * bz - ax * by + ay * bx - az * bw,
        ]
    )
    cosine = aw * bw + ax * bx + ay * by + az * bz
    sine = np.sqrt(np.einsum("i...,i...->...", steps, steps))
    steps *= np.where(cosine < 0.0, -fps, fps) * _angle_per_sine(sine, np.abs(cosine))
    changes = np.diff(steps, axis=-1)
    result: FloatArray = np.sqrt(np.einsum("i...,i...->...", changes, changes)) * fps
    return result


def _angle_per_sine(sine: FloatArray, cosine: FloatArray) -> FloatArray:
    """Return the ratio of a rotation's angle to the sine of its half, from sine and cosine of the half angle; 2 for no
    rotation."""
    small = sine < _SMALL
    return np.where(small, 2.0, 2.0 * np.arctan2(sine, cosine) / np.where(small, 1.0, sine))
