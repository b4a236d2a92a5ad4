"""Quaternions are equal to the bit regardless of memory layout and of how many are computed at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from app.arrays import FloatArray
from app.rig import quaternion

MANY = 70


def _unit(size: int, seed: int) -> FloatArray:
    vectors = np.random.default_rng(seed).normal(size=(MANY, size))
    result: FloatArray = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return result


Q, R, V, W = _unit(4, 1), _unit(4, 2), _unit(3, 3), _unit(3, 4)
ANGLES = np.linspace(-3.0, 3.0, MANY)

CALLS: dict[str, tuple[Callable[..., Any], tuple[FloatArray, ...]]] = {
    "multiply": (quaternion.multiply, (Q, R)),
    "rotate": (quaternion.rotate, (Q, V)),
    "cross": (quaternion.cross, (V, W)),
    "dot of 3": (quaternion.dot, (V, W)),
    "dot of 4": (quaternion.dot, (Q, R)),
    "normalize": (quaternion.normalize, (3.0 * Q,)),
    "from_rotation_vector": (quaternion.from_rotation_vector, (V,)),
    "to_rotation_vector": (quaternion.to_rotation_vector, (Q,)),
    "from_axis_angle": (quaternion.from_axis_angle, (V, ANGLES)),
    "from_frames": (quaternion.from_frames, (V, np.cross(V, W) / np.linalg.norm(np.cross(V, W), axis=1)[:, None])),
    "between": (quaternion.between, (V, W)),
    "twist_angle": (quaternion.twist_angle, (Q, V)),
    "slerp": (quaternion.slerp, (Q, R, np.full(MANY, 0.3))),
}


@pytest.mark.parametrize("name", CALLS)
def test_values_do_not_depend_on_memory(name: str) -> None:
    """Neither on the order of components and frames, nor on how many frames are computed at once."""
    function, arguments = CALLS[name]
    by_rows = function(*arguments)
    by_columns = function(*(np.asfortranarray(argument) for argument in arguments))
    few = np.concatenate(
        [function(*(argument[part] for argument in arguments)) for part in np.split(np.arange(MANY), 7)]
    )
    one = np.concatenate([function(*(argument[[0]] for argument in arguments))])
    assert by_columns.tobytes() == by_rows.tobytes() == few.tobytes()
    assert one.tobytes() == by_rows[:1].tobytes()


def test_many_lie_component_after_component() -> None:
    """Arithmetic with one component of many then accesses consecutive memory."""
    for made in (quaternion.multiply(Q, R), quaternion.rotate(Q, V), quaternion.columns(ANGLES, 0.0, ANGLES)):
        assert made[:, 0].flags.c_contiguous
    repeated = quaternion.repeated(np.array([1.0, 2.0, 3.0]), 5)
    assert repeated.shape == (5, 3)
    assert repeated[4].tolist() == [1.0, 2.0, 3.0]
