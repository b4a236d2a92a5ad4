"""Types of arrays for the whole program (shapes and units are documented where arrays are used), and a running
median.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
AnyFloatArray: TypeAlias = npt.NDArray[np.floating]
"""Array of floats of any precision."""
SingleArray: TypeAlias = npt.NDArray[np.float32]
IntArray: TypeAlias = npt.NDArray[np.int64]
IndexArray: TypeAlias = npt.NDArray[np.intp]
"""Array of indices into another array, as made by NumPy."""
AnyIntArray: TypeAlias = npt.NDArray[np.integer]
"""Array of integers of any size."""
BoolArray: TypeAlias = npt.NDArray[np.bool_]
ComplexArray: TypeAlias = npt.NDArray[np.complex128]


def rows_of(values: npt.NDArray[Any], count: int) -> npt.NDArray[Any]:
    """View of shape (count, N - count + 1) in which each column has ``count`` neighbouring values of an array (N,); N
    is at least ``count``.
    """
    return np.array([values[place : len(values) - count + 1 + place] for place in range(count)])


def running_medians(values: AnyFloatArray | IntArray, count: int) -> FloatArray:
    """Return medians (N - count + 1,) of ``count`` (odd) neighbouring values; faster than `numpy.median`."""
    rows = rows_of(np.asarray(values, np.float64), count)
    rows.sort(axis=0)
    return np.asarray(rows[count // 2])
