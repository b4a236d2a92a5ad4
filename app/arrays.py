"""The types of arrays, once: what a shape or a unit adds is said where an array is used; and neighbours in them."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
AnyFloatArray: TypeAlias = npt.NDArray[np.floating]
"""Any precision."""
SingleArray: TypeAlias = npt.NDArray[np.float32]
IntArray: TypeAlias = npt.NDArray[np.int64]
IndexArray: TypeAlias = npt.NDArray[np.intp]
"""Places in another array, as NumPy itself makes them."""
AnyIntArray: TypeAlias = npt.NDArray[np.integer]
"""Any size."""
BoolArray: TypeAlias = npt.NDArray[np.bool_]
ComplexArray: TypeAlias = npt.NDArray[np.complex128]


def rows_of(values: npt.NDArray[Any], count: int) -> npt.NDArray[Any]:
    """(count, N - count + 1): in each column ``count`` neighbouring values; N is at least ``count``."""
    return np.array([values[place : len(values) - count + 1 + place] for place in range(count)])


def running_medians(values: AnyFloatArray | IntArray, count: int) -> FloatArray:
    """(N - count + 1,): medians of ``count`` neighbouring values, an odd number; faster than by `numpy.median`."""
    rows = rows_of(np.asarray(values, np.float64), count)
    rows.sort(axis=0)
    return np.asarray(rows[count // 2])
