"""Choice of quaternion signs so that sequences of rotations are continuous."""

from __future__ import annotations

import numpy as np

from app.arrays import AnyFloatArray, SingleArray


def continuous(rotations_xyzw: AnyFloatArray) -> SingleArray:
    """Return unit quaternions (F, ..., 4) with signs chosen so that each is close to the previous frame's.

    Both signs mean the same rotation, but a program that interpolates the numbers would rotate the long way round
    between opposite signs.
    """
    values = np.array(rotations_xyzw, dtype=np.float64)
    values /= np.linalg.norm(values, axis=-1, keepdims=True)
    turned = np.einsum("f...i,f...i->f...", values[1:], values[:-1]) < 0
    opposite = np.logical_xor.accumulate(turned, axis=0)
    values[1:] *= np.where(opposite, -1.0, 1.0)[..., None]
    return values.astype(np.float32)
