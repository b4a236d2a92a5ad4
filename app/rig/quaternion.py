"""Unit quaternions ``xyzw`` (as in glTF and scipy), vectorised over leading axes.

A rotation ``a_from_b`` maps coordinates in frame b to frame a; ``multiply(a_from_b, b_from_c)`` is ``a_from_c``. All
functions broadcast leading axes and return float64. Large results are stored component by component, which makes
arithmetic with single components several times as fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray

ArrayLike = npt.ArrayLike

IDENTITY: FloatArray = np.array([0.0, 0.0, 0.0, 1.0])
IDENTITY.setflags(write=False)

_FEW = 1024
"""Number of quaternions up to which calls of NumPy dominate, so that all products of components are made at once."""
# Components of the right factor, or of its negative (4 to 7), that meet components 3, 0, 1, 2 of the left one; the
# order of summation is fixed, so results are equal to the bit.
_LEFT = np.array([3, 0, 1, 2])
_RIGHT = np.array([[0, 1, 2, 3], [3, 6, 1, 4], [2, 3, 4, 5], [5, 0, 3, 6]])
# Indices of both halves of a cross product.
_NEXT = np.array([[1, 2, 0], [2, 0, 1]])
_PREVIOUS = np.array([[2, 0, 1], [1, 2, 0]])


_CONJUGATE = np.array([-1.0, -1.0, -1.0, 1.0])
# Components of the right factor that meet components 3, 0, 1, 2 of the left one, added or subtracted, for each
# component of the product.
_PRODUCT = (
    ((0, 3, 2, 1), (np.add, np.add, np.subtract)),
    ((1, 2, 3, 0), (np.subtract, np.add, np.add)),
    ((2, 1, 0, 3), (np.add, np.subtract, np.add)),
    ((3, 0, 1, 2), (np.subtract, np.subtract, np.subtract)),
)


def _is_one(a: npt.NDArray[Any], size: int) -> bool:
    """Return whether ``a`` is a single float64 vector of ``size`` numbers, for which plain Python is faster."""
    return a.size == size and a.dtype == np.float64


def _are_few(a: npt.NDArray[Any], b: npt.NDArray[Any]) -> bool:
    few = a.ndim <= 2 and b.ndim <= 2 and len(a) <= _FEW and len(b) <= _FEW
    return few and a.dtype == np.float64 and b.dtype == np.float64


def _rows(a: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return a if a.ndim == 2 else a[None]


def columns(*components: ArrayLike) -> FloatArray:
    """Return vectors (..., n) made of n components (...); in memory, each component is contiguous."""
    result = np.empty((len(components), *np.broadcast(*components).shape))
    for index, values in enumerate(components):
        result[index] = values
    return _together(result)


def repeated(vector: ArrayLike, count: int) -> FloatArray:
    """Return a vector (n,) repeated as (count, n); in memory, each component is contiguous as in `columns`."""
    components = np.empty((np.shape(vector)[0], count))
    components[...] = np.asarray(vector)[:, None]
    return _together(components)


def planes(*shape: int) -> FloatArray:
    """Return an uninitialised array of frames (F, ...) in which each component is contiguous in memory."""
    return np.moveaxis(np.empty((*shape[1:], shape[0])), -1, 0)


def _together(components: npt.NDArray[Any]) -> FloatArray:
    return components.T if components.ndim == 2 else components.transpose((*range(1, components.ndim), 0))


def dot(a: ArrayLike, b: ArrayLike) -> FloatArray:
    """Return the dot products (...) of vectors (..., 3) or (..., 4), with an order of summation independent of the
    memory layout.
    """
    products = np.multiply(a, b)
    total: FloatArray = products[..., 0] + products[..., 2]
    total += products[..., 1] if products.shape[-1] == 3 else products[..., 1] + products[..., 3]
    return total


def multiply(a: ArrayLike, b: ArrayLike) -> FloatArray:
    """Return the product of quaternions (..., 4), the rotation by b and then by a."""
    a, b = np.asarray(a), np.asarray(b)
    if _is_one(a, 4) and _is_one(b, 4):
        ax, ay, az, aw = a.ravel().tolist()
        bx, by, bz, bw = b.ravel().tolist()
        row = (
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        )
        one: FloatArray = np.array(row).reshape(a.shape if a.ndim >= b.ndim else b.shape)
        return one
    if _are_few(a, b):
        factors = _rows(b).T
        terms = _rows(a).T.take(_LEFT, axis=0)[:, None] * np.concatenate((factors, -factors)).take(_RIGHT, axis=0)
        product: FloatArray = terms[0] + terms[1]
        product += terms[2]
        product += terms[3]
        return product.T
    left, right = [a[..., i] for i in (3, 0, 1, 2)], [b[..., i] for i in range(4)]
    shape, kind = np.broadcast(left[0], right[0]).shape, np.result_type(a, b)
    result, term = np.empty((4, *shape), kind), np.empty(shape, kind)
    for component, (order, signs) in enumerate(_PRODUCT):
        total = result[component, ...]
        np.multiply(left[0], right[order[0]], out=total)
        for one, other, with_sign in zip(left[1:], order[1:], signs, strict=True):
            np.multiply(one, right[other], out=term)
            with_sign(total, term, out=total)
    return _together(result.astype(np.float64, copy=False))


def conjugate(q: ArrayLike) -> FloatArray:
    """Return the inverse of unit quaternions (..., 4)."""
    result: FloatArray = np.asarray(q, dtype=np.float64) * _CONJUGATE
    return result


def rotate(q: ArrayLike, v: ArrayLike) -> FloatArray:
    """Rotate vectors (..., 3) by quaternions (..., 4)."""
    q, v = np.asarray(q), np.asarray(v)
    if _is_one(q, 4) and _is_one(v, 3):
        x, y, z, w = q.ravel().tolist()
        vx, vy, vz = v.ravel().tolist()
        tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
        row = (vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx)
        one: FloatArray = np.array(row).reshape(v.shape if v.ndim >= q.ndim else (*q.shape[:-1], 3))
        return one
    if _are_few(q, v):
        components, vectors = _rows(q).T, _rows(v).T
        axis = components.take(_NEXT, axis=0)
        halves = axis * vectors.take(_PREVIOUS, axis=0)
        twice = halves[0] - halves[1]
        twice *= 2.0
        halves = axis * twice.take(_PREVIOUS, axis=0)
        turned: FloatArray = vectors + components[3] * twice
        turned += halves[0]
        turned -= halves[1]
        return turned.T
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    vx, vy, vz = v[..., 0], v[..., 1], v[..., 2]
    # v + 2 w (u x v) + 2 u x (u x v), with t = 2 u x v
    tx, ty, tz = _crossed(x, y, z, vx, vy, vz)
    tx, ty, tz = 2.0 * tx, 2.0 * ty, 2.0 * tz
    result = np.empty((3, *np.shape(tx)))
    for component, (start, along, plus, minus) in enumerate(
        ((vx, tx, (y, tz), (z, ty)), (vy, ty, (z, tx), (x, tz)), (vz, tz, (x, ty), (y, tx)))
    ):
        total = w * along
        total += start
        total += plus[0] * plus[1]
        total -= minus[0] * minus[1]
        result[component] = total
    return _together(result)


def normalize(q: ArrayLike) -> FloatArray:
    """Scale quaternions (..., 4) to length 1; a zero quaternion becomes the identity."""
    result = np.array(q, dtype=np.float64)
    length = np.sqrt(dot(result, result))
    zero = length < 1e-12
    if zero.any():
        result /= np.where(zero, 1.0, length)[..., None]
        result[zero] = IDENTITY
    else:
        result /= length[..., None]
    return result


def from_rotation_vector(v: ArrayLike) -> FloatArray:
    """Return quaternions of rotation vectors (..., 3): unit axis times angle in radians."""
    v = np.asarray(v, dtype=np.float64)
    half = 0.5 * np.sqrt(dot(v, v))
    # sin(angle / 2) / angle, finite at 0
    safe = np.maximum(half, 1e-20)
    result = _together(np.empty((4, *v.shape[:-1])))
    np.multiply(v, (0.5 * np.where(half > 1e-20, np.sin(safe) / safe, 1.0))[..., None], out=result[..., :3])
    result[..., 3] = np.cos(half)
    return result


def to_rotation_vector(q: ArrayLike) -> FloatArray:
    """Return rotation vectors (..., 3), in radians, of quaternions (..., 4), each by the shorter of the two ways."""
    q = np.asarray(q, dtype=np.float64)
    sine = np.sqrt(dot(q[..., :3], q[..., :3]))
    sign = np.where(q[..., 3] < 0.0, -1.0, 1.0)
    angle = 2.0 * np.arctan2(sine, np.abs(q[..., 3]))
    scale = np.where(sine < 1e-9, 2.0, angle / np.where(sine < 1e-9, 1.0, sine))
    vector: FloatArray = q[..., :3] * (sign * scale)[..., None]
    return vector


def from_axis_angle(axis: ArrayLike, angle_rad: ArrayLike) -> FloatArray:
    """Return quaternions that rotate by angles (...) in radians about unit axes (..., 3)."""
    axis, half = np.asarray(axis, dtype=np.float64), 0.5 * np.asarray(angle_rad, dtype=np.float64)
    result = _together(np.empty((4, *np.broadcast(axis[..., 0], half).shape)))
    np.multiply(axis, np.sin(half)[..., None], out=result[..., :3])
    result[..., 3] = np.cos(half)
    return result


def to_matrix(q: ArrayLike) -> FloatArray:
    """Return rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    q = np.asarray(q, dtype=np.float64)
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    result = np.empty((*q.shape[:-1], 3, 3))
    result[..., 0, 0] = 1.0 - 2.0 * (y * y + z * z)
    result[..., 0, 1] = 2.0 * (x * y - z * w)
    result[..., 0, 2] = 2.0 * (x * z + y * w)
    result[..., 1, 0] = 2.0 * (x * y + z * w)
    result[..., 1, 1] = 1.0 - 2.0 * (x * x + z * z)
    result[..., 1, 2] = 2.0 * (y * z - x * w)
    result[..., 2, 0] = 2.0 * (x * z - y * w)
    result[..., 2, 1] = 2.0 * (y * z + x * w)
    result[..., 2, 2] = 1.0 - 2.0 * (x * x + y * y)
    return result


def from_matrix(m: ArrayLike) -> FloatArray:
    """Return quaternions (..., 4) of rotation matrices (..., 3, 3), with w >= 0.

    Of the four algebraic forms, the one with the largest divisor is used (Shepperd 1978).
    """
    m = np.asarray(m, dtype=np.float64)
    if m.size == 9:
        return normalize(_one_from_matrix(m.ravel().tolist())).reshape(*m.shape[:-2], 4)
    return _from_entries([m[..., i, j] for i in range(3) for j in range(3)])


def _from_entries(m: Sequence[FloatArray]) -> FloatArray:
    """Return quaternions (..., 4) of matrices given by their nine entries (...), row by row."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = m
    diagonal = (1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz, 1.0 + xx + yy + zz)
    sums, differences = (zy + yz, xz + zx, yx + xy), (zy - yz, xz - zx, yx - xy)
    forms = (
        (diagonal[0], sums[2], sums[1], differences[0]),
        (sums[2], diagonal[1], sums[0], differences[1]),
        (sums[1], sums[0], diagonal[2], differences[2]),
        (*differences, diagonal[3]),
    )
    result, greatest = np.stack(forms[0]), diagonal[0]
    for form, divisor in zip(forms[1:], diagonal[1:], strict=True):
        greater = divisor > greatest
        if greater.any():
            greatest = np.maximum(greatest, divisor)
            for component, values in enumerate(form):
                np.copyto(result[component, ...], values, where=greater)
    rotations = normalize(_together(result))
    rotations *= np.where(rotations[..., 3] < 0.0, -1.0, 1.0)[..., None]
    return rotations


def _one_from_matrix(m: list[float]) -> tuple[float, ...]:
    xx, xy, xz, yx, yy, yz, zx, zy, zz = m
    diagonal = (1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz, 1.0 + xx + yy + zz)
    best = int(np.argmax(diagonal))
    form = (
        (diagonal[0], yx + xy, xz + zx, zy - yz),
        (yx + xy, diagonal[1], zy + yz, xz - zx),
        (xz + zx, zy + yz, diagonal[2], yx - xy),
        (zy - yz, xz - zx, yx - xy, diagonal[3]),
    )[best]
    return form if not form[3] < 0.0 else tuple(-value for value in form)


def from_frames(x_axis: ArrayLike, y_axis: ArrayLike) -> FloatArray:
    """Return the rotation whose columns are x, y and x cross y; x and y must be unit and orthogonal, (..., 3)."""
    x_axis, y_axis = np.asarray(x_axis, dtype=np.float64), np.asarray(y_axis, dtype=np.float64)
    z_axis = cross(x_axis, y_axis)
    if z_axis.size == 3:
        return from_matrix(np.stack(np.broadcast_arrays(x_axis, y_axis, z_axis), axis=-1))
    return _from_entries([axis[..., i] for i in range(3) for axis in (x_axis, y_axis, z_axis)])


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross product (..., 3) of vectors; faster than `numpy.cross`."""
    if _is_one(a, 3) and _is_one(b, 3):
        x, y, z = a.ravel().tolist()
        u, v, w = b.ravel().tolist()
        row = (y * w - z * v, z * u - x * w, x * v - y * u)
        one: FloatArray = np.array(row).reshape(a.shape if a.ndim >= b.ndim else b.shape)
        return one
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return columns(*_crossed(ax, ay, az, bx, by, bz))


def _crossed(
    ax: FloatArray, ay: FloatArray, az: FloatArray, bx: FloatArray, by: FloatArray, bz: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    x, y, z = ay * bz, az * bx, ax * by
    x -= az * by
    y -= ax * bz
    z -= ay * bx
    return x, y, z


def between(a: ArrayLike, b: ArrayLike) -> FloatArray:
    """Return the shortest rotation from unit vectors a to unit vectors b, (..., 3).

    For opposite vectors, the axis is any vector orthogonal to a.
    """
    a, b = np.broadcast_arrays(np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64))
    result = _together(np.empty((4, *a.shape[:-1])))
    result[..., :3] = cross(a, b)
    result[..., 3] = 1.0 + dot(a, b)
    opposite = result[..., 3] < 1e-9
    if np.any(opposite):
        flipped = a[opposite]
        other = np.where(np.abs(flipped[..., :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        result[opposite, :3] = np.cross(flipped, other)
        result[opposite, 3] = 0.0
    return normalize(result)


def swing_twist(q: ArrayLike, axis: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Split rotations (..., 4) into ``swing * twist`` with the twist about a unit axis (..., 3).

    For half a turn about an orthogonal axis, the twist is the identity.
    """
    q, axis = np.asarray(q, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    along = dot(q[..., :3], axis)
    twist = _together(np.empty((4, *along.shape)))
    twist[..., :3] = along[..., None] * axis
    twist[..., 3] = q[..., 3]
    twist = normalize(twist)
    return multiply(q, conjugate(twist)), twist


def twist_angle(q: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Return the angle, radians in (-pi, pi], of rotations (..., 4) about a unit axis (..., 3)."""
    q, axis = np.asarray(q, dtype=np.float64), np.asarray(axis, dtype=np.float64)
    sign = np.where(q[..., 3] < 0.0, -1.0, 1.0)
    angle: FloatArray = 2.0 * np.arctan2(sign * dot(q[..., :3], axis), sign * q[..., 3])
    return angle


def slerp(a: ArrayLike, b: ArrayLike, share: ArrayLike) -> FloatArray:
    """Interpolate quaternions (..., 4) at constant angular speed along the shorter way; ``share`` (...) is 0 at a."""
    turn = to_rotation_vector(multiply(conjugate(a), b))
    return multiply(a, from_rotation_vector(turn * np.asarray(share, dtype=np.float64)[..., None]))


def continuous(rotations: ArrayLike) -> FloatArray:
    """Return the same rotations (F, J, 4) with signs chosen so that each frame is in the hemisphere of the previous
    one; the same object if it is so already.
    """
    q = np.asarray(rotations, dtype=np.float64)
    turned = np.einsum("fji,fji->fj", q[1:], q[:-1]) < 0.0
    if not turned.any():
        return q
    sides = np.concatenate([np.ones((1, q.shape[1])), np.where(turned, -1.0, 1.0)]).cumprod(axis=0)
    result: FloatArray = q * sides[..., None]
    return result


MANY = 64
"""Number of frames from which frames without motion are searched for."""


def interpolated(values: FloatArray, rotations: FloatArray, value: FloatArray) -> FloatArray:
    """Interpolate rotations (S, n, 4) of n joints, given at S ascending values (S,), at ``value`` (F,); returns (F, n,
    4)."""
    if len(values) == 1:
        return np.broadcast_to(rotations[0], (len(value), *rotations.shape[1:]))
    starts = np.flatnonzero(np.concatenate(([True], value[1:] != value[:-1]))) if len(value) > MANY else value
    if 2 * len(starts) < len(value):
        # Most of the time the value rests.
        resting = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(value)))
        few = np.ascontiguousarray(interpolated(values, rotations, value[starts]).transpose(1, 2, 0))
        return few.take(resting, axis=2).transpose(2, 0, 1)
    place = np.interp(value, values, np.arange(len(values), dtype=np.float64))
    low = np.minimum(place.astype(np.intp), len(values) - 2)
    share = (place - low)[:, None, None]
    components = np.ascontiguousarray(rotations.transpose(1, 2, 0))
    near, far = (components.take(index, axis=2).transpose(2, 0, 1) for index in (low, low + 1))
    return mixed(near, far, share)


def mixed(near: FloatArray, far: FloatArray, share: FloatArray) -> FloatArray:
    """Return normalised linear mixtures of rotations (..., 4), by the shorter way: ``near`` at share 0, ``far`` at
    share 1.
    """
    sign = np.where(dot(near, far) < 0.0, -1.0, 1.0)[..., None]
    mixed: FloatArray = near * (1.0 - share) + far * (sign * share)
    mixed /= np.sqrt(dot(mixed, mixed))[..., None]
    return mixed
