"""Sorts frames of motion so that similar ones are neighbours, which makes the search for depths faster."""

from __future__ import annotations

import numpy as np

from app.arrays import IndexArray, SingleArray


def order_by_similarity(places_m: SingleArray, block: int, least: int) -> IndexArray:
    """Sort frames so that a set of points has similar positions in all frames of a block.

    Frames are repeatedly halved by the coordinate that differs most among them.

    Parameters
    ----------
    places_m : (F, N) float32
        Coordinates of the points.
    block : int
        Frames per block, a power of two; F is a multiple of it.
    least : int
        Number of frames below which the order is kept.

    Returns
    -------
    (F,) int
        Frames in their new order. Halves, quarters and so on of a block are similar too.
    """
    order = np.arange(len(places_m))
    ranges = [(0, len(order) // block)]
    while ranges:
        first, last = ranges.pop()
        if last - first < 2:
            continue
        half = (first + last) // 2
        rows = order[first * block : last * block]
        widest = int(np.argmax(places_m[rows].var(axis=0)))
        order[first * block : last * block] = rows[
            np.argpartition(places_m[rows, widest], (half - first) * block, kind="introselect")
        ]
        ranges += [(first, half), (half, last)]
    size = block
    while size > least:
        parts = order.reshape(-1, size)
        values = places_m[parts]
        widest_of = np.argmax(values.var(axis=1), axis=1)
        chosen = np.take_along_axis(values, widest_of[:, None, None], axis=2)[..., 0]
        order = np.take_along_axis(parts, np.argsort(chosen, axis=1, kind="stable"), axis=1).ravel()
        size //= 2
    return order
