"""Capsules around the bones of a body, and their distances."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray

_TINY: Final = 1e-12


class Capsules(NamedTuple):
    """Bones of a body with their surroundings, by bone.

    Attributes
    ----------
    starts_m, ends_m : (B, ..., 3) float64
        World positions of the ends of the bones in metres.
    radii_m : (B,) float64
        Radius about each bone in metres.
    """

    starts_m: FloatArray
    ends_m: FloatArray
    radii_m: FloatArray


def depth_m(some: Capsules, others: Capsules, pairs: tuple[tuple[int, int], ...]) -> FloatArray:
    """Return the greatest depth (...) in metres in which one of some capsules enters one of the others; negative if all
    are apart. ``pairs`` are the compared bones, as indices in ``some`` and in ``others``.
    """
    result: FloatArray | None = None
    for one, other in pairs:
        apart = distance_m(some.starts_m[one], some.ends_m[one], others.starts_m[other], others.ends_m[other])
        depth = some.radii_m[one] + others.radii_m[other] - apart
        result = depth if result is None else np.maximum(result, depth)
    assert result is not None
    return result


def distance_m(start: FloatArray, end: FloatArray, other_start: FloatArray, other_end: FloatArray) -> FloatArray:
    """Return the distance (...) in metres between two line segments, each from a start (..., 3) to an end (..., 3)."""
    way, other_way, between = end - start, other_end - other_start, start - other_start
    length2 = np.maximum(_dot(way, way), _TINY)
    other_length2 = np.maximum(_dot(other_way, other_way), _TINY)
    along, other_along, both = _dot(way, between), _dot(other_way, between), _dot(way, other_way)
    # Parallel segments have no single nearest point; their starts serve as well.
    across = np.maximum(length2 * other_length2 - both * both, _TINY)
    share = np.clip((both * other_along - along * other_length2) / across, 0.0, 1.0)
    other_share = np.clip((both * share + other_along) / other_length2, 0.0, 1.0)
    share = np.clip((both * other_share - along) / length2, 0.0, 1.0)
    apart = between + share[..., None] * way - other_share[..., None] * other_way
    return np.asarray(np.sqrt(_dot(apart, apart)))


def _dot(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[..., 0] * other[..., 0] + one[..., 1] * other[..., 1] + one[..., 2] * other[..., 2])
