"""Checks of single values of a map, each with the key path for its problem."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TypeAlias

from instrument_maps.map_table import Vector

Problem: TypeAlias = tuple[str, str]
"""Key path and fault, such as ``("controls[2].finger", "'right.indx' is not a finger")``."""
UNIT_TOLERANCE = 1e-3
REACH_M = 3.0


def within(path: str, value: float, low: float, high: float) -> Iterator[Problem]:
    if not low <= value <= high:  # also catches nan
        yield path, f"{value:g} is not between {low:g} and {high:g}"


def near_point(path: str, point: Vector) -> Iterator[Problem]:
    if not all(abs(value) <= REACH_M for value in point):  # also catches nan
        yield path, f"{list(point)} is not a point in metres near the instrument"


def unit_vector(path: str, vector: Vector) -> Iterator[Problem]:
    length = math.hypot(*vector)
    if not abs(length - 1) <= UNIT_TOLERANCE:
        yield path, f"{list(vector)} has the length {length:g}, not 1"


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
