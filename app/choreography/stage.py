"""Keeps a dancer near the place on stage."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray

STAGE_M: Final = 1.2
"""Distance in metres within which a dancer stays near the place."""
WANDERS_S: Final = 1.2
"""Standard deviation in seconds that separates a path from sway and steps."""
LEAST_ROOM: Final = 0.4
"""Least share of the stage that stays free for paths, however large the sway."""


def on_stage(hips_m: FloatArray, fps: float) -> FloatArray:
    """Scale the path (F, 3) of the hips so that it stays within `STAGE_M` of the dancer's place, with sway, steps and
    heights unchanged.
    """
    way = np.zeros_like(hips_m)
    way[:, [0, 2]] = gaussian_filter1d(hips_m[:, [0, 2]], WANDERS_S * fps, axis=0, mode="nearest")
    sway = np.linalg.norm((hips_m - way) * (1.0, 0.0, 1.0), axis=1)
    wide = 2 * round(2.5 * WANDERS_S * fps) + 1
    room = STAGE_M - gaussian_filter1d(maximum_filter1d(sway, wide, mode="nearest"), WANDERS_S * fps, mode="nearest")
    room = np.maximum(room, LEAST_ROOM * STAGE_M)[:, None]
    far = np.linalg.norm(way, axis=1, keepdims=True)
    return np.asfortranarray(hips_m - way * (1.0 - np.tanh(far / room) * room / np.maximum(far, 1e-9)))
