"""Measurement of a face at rest in profile: chin, nose, and the height at which the lips meet."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray

STEPS: Final = 40
BREAK = 0.2
"""Greatest recess of a profile, relative to its height, within a face; at a larger one the face ends."""
CHIN_SHARE = 0.15
"""Lowest part of a face, relative to its height up to the eyes, which is the chin."""
NOSE_OUT, NOSE_BASE, NOSE_LONG = 0.08, (0.6, 0.35), 0.15
"""Proportions of a nose relative to that height: distance in front of the chin, shares of it that are lost at the
nose's base (the second one where the lips lie far in front of the chin), and greatest distance of the base below the
tip. A round face has no nose.
"""
MOUTH_SHARE, MOUTH_SPREAD = 0.63, 0.09
"""Position of the lips between eyes and chin, as a share, and its tolerance."""


def lowest_of_face_m(profile: FloatArray, forward: BoolArray, joint_m: float) -> float:
    """Return the lowest height of a face, in metres, from V points of its front (V, 3).

    ``forward`` (V,) marks the points whose skin faces forward. The face ends above a gap without such points, so that a
    collar below the head's joint (at the height ``joint_m``) is not taken for the chin.
    """
    heights = np.unique(profile[forward, 1])[::-1]
    for above_m, below_m in pairwise(heights):
        between = ~forward & (profile[:, 1] < above_m) & (profile[:, 1] > below_m)
        if below_m < joint_m and above_m - below_m > BREAK * (heights[0] - heights[-1]) and between.any():
            return float(above_m)
    return float(heights[-1])


def nose_base_m(profile: FloatArray, eyes_m: float, chin_m: float) -> float | None:
    """Return the height in metres of the lower end of the nose in a profile of V points (V, 3), between eyes and chin;
    None if no nose protrudes.
    """
    high, deep, long_m = profile[:, 1], profile[:, 2], eyes_m - chin_m
    of_chin_m = chin_m + CHIN_SHARE * long_m
    middle = np.flatnonzero((high > of_chin_m) & (high < eyes_m))
    if not len(middle):
        return None
    tip = middle[np.argmax(deep[middle])]
    out_m = float(deep[tip] - deep[high <= of_chin_m].max())
    if out_m < NOSE_OUT * long_m:
        return None
    for share in NOSE_BASE:
        below = np.flatnonzero((high < high[tip]) & (deep < deep[tip] - share * out_m))
        if len(below):
            # The underside of a nose is level; on a face with few vertices the next one below belongs to the lips or
            # the chin.
            base_m = float(high[(high > high[below].max()) & (high <= high[tip])].min())
            if float(high[tip]) - base_m <= NOSE_LONG * long_m:
                return base_m
    return None


def at_height(profile: FloatArray, height_m: float, patch_m: float, count: int) -> IndexArray:
    """Return the indices of at most ``count`` vertices of a profile (V, 3) near a height, all within ``patch_m`` of it.

    If none is that near, the next vertices above and below are used, repeated so that their mean is near the height.
    """
    off_m = np.abs(profile[:, 1] - height_m)
    if float(off_m.min()) > patch_m:
        over, under = profile[:, 1] >= height_m, profile[:, 1] < height_m
        sets = [np.flatnonzero(side & (off_m <= off_m[side].min() + patch_m)) for side in (over, under) if side.any()]
        if len(sets) == 1:
            return sets[0]
        above_m, below_m = (float(profile[rows, 1].mean()) for rows in sets)
        share = round(count * (height_m - below_m) / (above_m - below_m))
        return np.concatenate([np.resize(sets[0], share), np.resize(sets[1], count - share)])
    nearest = np.argsort(off_m, kind="stable")[:count]
    nearest = nearest[off_m[nearest] <= 3.0 * patch_m]
    foremost: IndexArray = nearest[profile[nearest, 2] > profile[nearest, 2].max() - patch_m]
    return foremost


def notch_m(profile: FloatArray, eyes_m: float, chin_m: float) -> float:
    """Return the height in metres at which a profile of V points (V, 3) recedes between two lips; without such a notch,
    the usual height between eyes and chin.
    """
    steps = np.round((eyes_m - profile[:, 1]) / max(eyes_m - chin_m, 1e-6) * STEPS).astype(np.intp)
    low, high = (round((MOUTH_SHARE + sign * MOUTH_SPREAD) * STEPS) for sign in (-1, 1))
    depths_m = np.array([profile[steps == step, 2].max(initial=-np.inf) for step in range(low, high + 1)])
    known = np.flatnonzero(np.isfinite(depths_m))
    goes_in_m, best = 0.0, round(MOUTH_SHARE * STEPS) - low
    for place in known[1:-1]:
        before_m, behind_m = depths_m[:place].max(), depths_m[place + 1 :].max()
        if min(before_m, behind_m) - depths_m[place] > goes_in_m:
            goes_in_m, best = float(min(before_m, behind_m) - depths_m[place]), int(place)
    return eyes_m - (low + best) / STEPS * (eyes_m - chin_m)
