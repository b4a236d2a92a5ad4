"""Joint angles in the form that animators expect: relative to the rest pose, in a rotation order suited to
each joint.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.formats.euler import euler_degrees, quaternions

AXES: Final = "XYZ"
PLAIN_ORDER: Final = "ZYX"
"""Rotation order of joints whose axes have no anatomical meaning; FBX uses it by default."""
_ORDERS: Final = tuple("".join(axes) for axes in itertools.permutations(AXES))
_DIGITS: Final = 4
"""Decimals to which sums of cosines are rounded before comparison, so that rounding errors decide nothing."""


def order_along(axes: AnyFloatArray | None) -> str:
    """Return the rotation order, as in `app.formats.euler`, whose axes are nearest to three given ones.

    Parameters
    ----------
    axes : ndarray, shape (3, 3), or None
        One axis per row, in either direction, from the outermost rotation; None for `PLAIN_ORDER`.
    """
    if axes is None:
        return PLAIN_ORDER
    near = np.abs(np.asarray(axes, np.float64))
    sums = [float(sum(near[row, AXES.index(axis)] for row, axis in enumerate(order))) for order in _ORDERS]
    return _ORDERS[int(np.argmax(np.round(sums, _DIGITS)))]


def channel_degrees(
    rotations_xyzw: AnyFloatArray, orders: Sequence[str], rests_xyzw: AnyFloatArray | None = None
) -> FloatArray:
    """Return the angles of joints about their own X, Y and Z, without jumps between frames.

    Parameters
    ----------
    rotations_xyzw : ndarray, shape (F, J, 4)
        Rotations of J joints in F frames.
    orders : sequence of str
        Rotation order of each joint.
    rests_xyzw : ndarray, shape (J, 4), optional
        Rotations at which all angles are 0; by default the identity.

    Returns
    -------
    ndarray, shape (J, 3, F), float64
        Angles in degrees.
    """
    frames, joints, _ = rotations_xyzw.shape
    result = np.empty((joints, len(AXES), frames))
    for order, chosen in _by_order(orders):
        turned = rotations_xyzw[:, chosen]
        if rests_xyzw is not None:
            back = _left_products(np.asarray(rests_xyzw, np.float64)[chosen] * (-1.0, -1.0, -1.0, 1.0))
            turned = np.einsum("jab,fjb->fja", back, turned)
        found = euler_degrees(turned, order)
        for place, axis in enumerate(order):
            result[chosen, AXES.index(axis)] = found[:, place]
    return result


def channel_quaternions(
    degrees: AnyFloatArray, orders: Sequence[str], rests_xyzw: AnyFloatArray | None = None
) -> FloatArray:
    """Return unit quaternions (J, F, 4) of J joints from angles (J, F, 3) in degrees about X, Y and Z; the inverse of
    `channel_degrees`."""
    result = np.empty((*degrees.shape[:-1], 4))
    for order, chosen in _by_order(orders):
        turned = quaternions(degrees[chosen][..., [AXES.index(axis) for axis in order]], order)
        if rests_xyzw is not None:
            turned = np.einsum("jab,jfb->jfa", _left_products(np.asarray(rests_xyzw, np.float64)[chosen]), turned)
        result[chosen] = turned
    return result


def _by_order(orders: Sequence[str]) -> list[tuple[str, list[int]]]:
    """Return each rotation order with the indices of the joints that use it."""
    return [(order, [joint for joint, own in enumerate(orders) if own == order]) for order in dict.fromkeys(orders)]


def _left_products(rotations_xyzw: FloatArray) -> FloatArray:
    """Return the matrices (J, 4, 4) by which a quaternion is multiplied from the left with the normalised rotations (J,
    4) of J joints.
    """
    x, y, z, w = (rotations_xyzw / np.linalg.norm(rotations_xyzw, axis=-1, keepdims=True)).T
    return np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]]).transpose(2, 0, 1)
