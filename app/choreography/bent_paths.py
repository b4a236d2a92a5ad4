"""Paths bent minimally, so that their speed changes within a limit."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray

ROUNDS: Final = 400
STEP: Final = 1.0 / 16.0
"""Share of an excess removed at a time: the inverse of the largest eigenvalue of the second difference times its
transpose, stable with momentum.
"""


def bent(path: FloatArray, most: float, held: BoolArray, rounds: int = ROUNDS) -> FloatArray:
    """Limit the second differences of a path by iterative projections.

    Parameters
    ----------
    path : (N, 3) float64
        Positions in metres, or turns in radians, from frame to frame.
    most : float
        Greatest length of a second difference, in the unit of the path.
    held : (N,) bool
        Frames whose positions stay.
    rounds : int
        Greatest number of projections.

    Returns
    -------
    (N, 3) float64
        Path as near as possible to the given one.
    """
    moved, before, back = np.zeros_like(path), np.zeros_like(path), np.zeros_like(path)
    free = ~held[:, None]
    possible = ~(held[:-2] & held[1:-1] & held[2:])
    for number in range(rounds):
        # Nesterov's momentum needs far fewer rounds for long stretches.
        ahead = moved - before
        ahead *= number / (number + 3.0)
        ahead += moved
        bends = path + ahead
        bends = bends[1:] - bends[:-1]
        bends = bends[1:] - bends[:-1]
        size = np.sqrt(np.add.reduce(bends * bends, axis=-1, keepdims=True))
        if not number % 20 and size[possible].max(initial=0.0) <= most * 1.001:
            break
        share = most / np.maximum(size, 1e-12)
        np.subtract(1.0, share, out=share)
        bends *= np.maximum(0.0, share, out=share)
        back[:-2] = bends
        back[-2:] = 0.0
        back[1:-1] -= 2.0 * bends
        back[2:] += bends
        before, moved = moved, free * (ahead - STEP * back)
    return path + moved
