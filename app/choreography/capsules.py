"""Capsules around the bones of a body, and their distances."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray

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

    def at(self, bone: int, frames: IntArray) -> Capsules:
        """Return one capsule in frames (N,), the second axis of the positions."""
        here = slice(bone, bone + 1)
        return Capsules(self.starts_m[here, frames], self.ends_m[here, frames], self.radii_m[here])


class _Bone(NamedTuple):
    """Components (P, ...) of the starts of bones and of their ways to their ends, and their squared lengths."""

    start: tuple[FloatArray, FloatArray, FloatArray]
    way: tuple[FloatArray, FloatArray, FloatArray]
    length2: FloatArray


def depth_m(some: Capsules, others: Capsules, pairs: tuple[tuple[int, int], ...]) -> FloatArray:
    """Return the greatest depth (...) in metres in which one of some capsules enters one of the others; negative if all
    are apart. ``pairs`` are the compared bones, as indices in ``some`` and in ``others``.
    """
    one, other = (
        _bones(every.starts_m, every.ends_m, np.array(bones))
        for every, bones in zip((some, others), zip(*pairs, strict=True), strict=True)
    )
    apart = _distance_m(one, other)
    radii = np.array([some.radii_m[bone] + others.radii_m[another] for bone, another in pairs])
    return np.asarray((radii.reshape(-1, *(1,) * (apart.ndim - 1)) - apart).max(axis=0))


def _bones(starts: FloatArray, ends: FloatArray, bones: IntArray) -> _Bone:
    # Arithmetic with contiguous components is several times as fast.
    x, y, z = (starts[..., axis][bones] for axis in range(3))
    ways = (ends[..., 0][bones] - x, ends[..., 1][bones] - y, ends[..., 2][bones] - z)
    return _Bone((x, y, z), ways, np.maximum(_dot(ways, ways), _TINY))


def _distance_m(one: _Bone, other: _Bone) -> FloatArray:
    """Distances (P, ...) in metres between pairs of bones."""
    between = (one.start[0] - other.start[0], one.start[1] - other.start[1], one.start[2] - other.start[2])
    along, other_along, both = _dot(one.way, between), _dot(other.way, between), _dot(one.way, other.way)
    # Parallel bones have no single nearest point; their starts serve as well.
    across = np.maximum(one.length2 * other.length2 - both * both, _TINY)
    share = _part(both * other_along - along * other.length2, across)
    other_share = _part(both * share + other_along, other.length2)
    share = _part(both * other_share - along, one.length2)
    x, y, z = (
        gap + share * way - other_share * other_way
        for gap, way, other_way in zip(between, one.way, other.way, strict=True)
    )
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def _part(of: FloatArray, whole: FloatArray) -> FloatArray:
    return np.asarray(np.minimum(np.maximum(of / whole, 0.0), 1.0))


def _dot(one: tuple[FloatArray, ...], other: tuple[FloatArray, ...]) -> FloatArray:
    return np.asarray(one[0] * other[0] + one[1] * other[1] + one[2] * other[2])
