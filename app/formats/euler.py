"""Conversion of quaternions to continuous Euler angles and back, for whole clips at once.

An order names the three axes of a product from left to right: ``"ZYX"`` means the matrix Rz Ry Rx (FBX's default,
called XYZ there), ``"ZXY"`` means Rz Rx Ry (usual for BVH channels). Source: K. Shoemake, "Euler Angle Conversion",
Graphics Gems IV (1994), for the general form.
"""

from __future__ import annotations

import math

import numpy as np

from app.arrays import AnyFloatArray, FloatArray

# If the cosine of the middle angle is below this, the first angle is not determined by the rotation. Any choice of it
# gives the exact rotation, since the others are computed from it; the error of the middle angle is below this (rad).
_GIMBAL_COSINE = 1e-8

# If no angle changes by more than this, the triple is the nearest: the first and third angles of the other are half a
# turn away.
_SMOOTH_TURNS = 1 / 8

# Frames times joints per block: about fifteen arrays of as many doubles fit a core's cache.
_BLOCK = 8192
_JOINTS = 8
"""Number of joints copied from the clip at a time, since the values of one joint are not adjacent there."""


def euler_degrees(rotations_xyzw: AnyFloatArray, order: str) -> FloatArray:
    """Return the Euler angles of every joint, without jumps between frames.

    Of the two equivalent angle triples the one nearer to the previous frame is used, and full turns are added to avoid
    jumps, so that interpolated angles stay near the rotation.

    Parameters
    ----------
    rotations_xyzw : ndarray, shape (F, J, 4)
        Quaternions of any nonzero length.
    order : str
        Three different axes, e.g. ``"ZYX"``.

    Returns
    -------
    ndarray, shape (J, 3, F), float64
        Angles in degrees for the axes of `order`. At gimbal lock the first angle keeps its last value.
    """
    frame_count, joint_count, _ = rotations_xyzw.shape
    angles = np.empty((joint_count, 3, frame_count))
    step = max(1, _BLOCK // max(1, frame_count))
    for joints in (slice(first, first + _JOINTS) for first in range(0, joint_count, _JOINTS)):
        components = rotations_xyzw[:, joints].transpose(2, 1, 0).astype(np.float64, order="C")
        found = angles[joints].transpose(1, 0, 2)
        rests = (components == components[..., :1]).all(axis=-1).all(axis=0)
        found[:, rests] = _unrolled(_angles(components[:, rests, :1], order))
        moving = np.flatnonzero(~rests)
        for block in (moving[first : first + step] for first in range(0, len(moving), step)):
            found[:, block] = _unrolled(_angles(components[:, block], order))
    return angles


def quaternions(angles_degrees: AnyFloatArray, order: str) -> FloatArray:
    """Return quaternions from Euler angles, the inverse of `euler_degrees`.

    Parameters
    ----------
    angles_degrees : ndarray, shape (..., 3)
        Angles for the axes of `order`.

    Returns
    -------
    ndarray, shape (..., 4), float64
        Unit quaternions xyzw.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    quarter = np.moveaxis(np.asarray(angles_degrees, dtype=np.float64), -1, 0) * (math.pi / 720.0)
    result = np.empty((4, *quarter.shape[1:]))
    # Computing sine and cosine of the half angle from the tangent of the quarter angle is faster than computing both.
    tangent = np.tan(quarter, out=quarter)
    square = tangent * tangent
    sine, cosine = 2.0 * tangent, 1.0 - square
    square += 1.0
    scale = 1.0 / (square[0] * square[1] * square[2])
    # Hamilton product of the first two rotations, then with the third.
    of_i, of_j = sine[0] * cosine[1] * scale, cosine[0] * sine[1] * scale
    of_k, w = sign * sine[0] * sine[1] * scale, cosine[0] * cosine[1] * scale
    result[i] = of_i * cosine[2] + sign * of_j * sine[2]
    result[j] = of_j * cosine[2] - sign * of_i * sine[2]
    result[k] = of_k * cosine[2] + w * sine[2]
    result[3] = w * cosine[2] - of_k * sine[2]
    return np.moveaxis(result, 0, -1)


def matrices(rotations_xyzw: AnyFloatArray) -> FloatArray:
    """Return rotation matrices (..., 3, 3), for column vectors, from quaternions (..., 4) of any nonzero length."""
    q = np.asarray(rotations_xyzw, dtype=np.float64)
    x, y, z, w = np.moveaxis(q, -1, 0)
    s = 2.0 / np.einsum("...i,...i->...", q, q)
    result = np.empty((*q.shape[:-1], 3, 3))
    result[..., 0, 0] = 1 - s * (y * y + z * z)
    result[..., 0, 1] = s * (x * y - z * w)
    result[..., 0, 2] = s * (x * z + y * w)
    result[..., 1, 0] = s * (x * y + z * w)
    result[..., 1, 1] = 1 - s * (x * x + z * z)
    result[..., 1, 2] = s * (y * z - x * w)
    result[..., 2, 0] = s * (x * z - y * w)
    result[..., 2, 1] = s * (y * z + x * w)
    result[..., 2, 2] = 1 - s * (x * x + y * y)
    return result


def _angles(q: FloatArray, order: str) -> FloatArray:
    """Return the principal Euler angles (3, J, F) in radians of quaternions (4, J, F) of J joints in F frames."""
    parts = [_part_angles(q[..., :_BLOCK], order)]
    for start in range(_BLOCK, q.shape[-1], _BLOCK):
        parts.append(_part_angles(q[..., start : start + _BLOCK], order, parts[-1][0, :, -1]))
    return parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1)


def _part_angles(q: FloatArray, order: str, before: FloatArray | None = None) -> FloatArray:
    """Return the principal Euler angles (3, J, F) in radians of quaternions (4, J, F).

    ``before`` has the first angle (J,) of each joint in the previous frame, which is kept at gimbal lock.
    """
    i, j, k = ("XYZ".index(axis) for axis in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    w = q[3]
    s = 2.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + w * w)
    sqi, sqj, sqk = s * q[i], s * q[j], s * q[k]
    ij, ik, jk = sqi * q[j], sqi * q[k], sqj * q[k]
    ii, jj, kk = sqi * q[i], sqj * q[j], sqk * q[k]
    w = sign * w
    iw, jw, kw = sqi * w, sqj * w, sqk * w
    # Entries m[row, column] of the rotation matrix that are needed, named by their axes.
    m_ik, m_jk, m_kk = ik + jw, jk - iw, 1 - (ii + jj)
    m_ji, m_jj, m_ki, m_kj = ij + kw, 1 - (ii + kk), ik - jw, jk + iw

    middle_cosine = np.sqrt(m_jk * m_jk + m_kk * m_kk)
    sine = -sign * m_jk
    first = np.arctan2(sine, m_kk)
    locked = middle_cosine < _GIMBAL_COSINE
    if locked.any():
        last_free = np.where(locked, 0, np.arange(q.shape[-1]))
        np.maximum.accumulate(last_free, axis=-1, out=last_free)
        if before is not None:
            first[:, 0] = np.where(locked[:, 0], before, first[:, 0])
        first = np.take_along_axis(first, last_free, axis=-1)
        cosine, sine = np.cos(first), np.sin(first)
    else:
        cosine, sine = m_kk / middle_cosine, sine / middle_cosine
    middle = np.arctan2(sign * m_ik, middle_cosine)
    # Without the first rotation, Rj Rk remains, whose row j contains the third angle only.
    third = np.arctan2(sign * cosine * m_ji + sine * m_ki, cosine * m_jj + sign * sine * m_kj)
    return np.stack([first, middle, third])


def _unrolled(angles: FloatArray) -> FloatArray:
    """Return angles in degrees (J, 3, F) without jumps between frames, from principal angles in radians (3, J, F) of J
    joints.
    """
    turns = angles * (0.5 / np.pi)
    step = np.diff(turns, axis=-1)
    smooth = ((step > -_SMOOTH_TURNS) & (step < _SMOOTH_TURNS)).all(axis=(0, 2))
    if not smooth.all():
        turns[:, ~smooth] = _without_jumps(turns[:, ~smooth], step[:, ~smooth])
    turns *= 360.0
    return turns


def _without_jumps(turns: FloatArray, step: FloatArray) -> FloatArray:
    """Return angles (3, J, F), in turns, of J joints with their jumps removed; ``step`` are their differences between
    frames. Overwrites both arrays.
    """
    same = np.abs(step - np.rint(step)).sum(axis=0)
    # The other triple is (first + half a turn, half a turn - middle, third + half a turn). Exchanging both triples does
    # not change their distance, so only the frames at which to change over matter.
    step[0] += 0.5
    step[1] = 0.5 - turns[1, :, 1:] - turns[1, :, :-1]
    step[2] += 0.5
    changes = np.abs(step - np.rint(step)).sum(axis=0) < same
    if changes.any():
        other = np.zeros(turns.shape[1:], dtype=bool)
        np.logical_xor.accumulate(changes, axis=-1, out=other[:, 1:])
        turns[0] += 0.5 * other
        turns[1] = np.where(other, 0.5 - turns[1], turns[1])
        turns[2] += 0.5 * other
    turns[..., 1:] -= np.cumsum(np.rint(np.diff(turns, axis=-1)), axis=-1)
    return turns
