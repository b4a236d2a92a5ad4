"""Rotations whose numbers follow one another."""

from __future__ import annotations

import numpy as np

from app.arrays import AnyFloatArray, SingleArray


def continuous(rotations_xyzw: AnyFloatArray) -> SingleArray:
    """Unit quaternions (F, ..., 4) of which none is further from the frame before than its opposite would be.

    A rotation has two quaternions; a reader that interpolates the numbers would turn the long way round between two
    that are far apart.
    """
    values = np.array(rotations_xyzw, dtype=np.float64)
    values /= np.linalg.norm(values, axis=-1, keepdims=True)
    turned = np.einsum("f...i,f...i->f...", values[1:], values[:-1]) < 0
    opposite = np.logical_xor.accumulate(turned, axis=0)
    values[1:] *= np.where(opposite, -1.0, 1.0)[..., None]
    return values.astype(np.float32)
