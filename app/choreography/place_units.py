"""Units of the positions and of the bones of a motion file, which may be two."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import permutations
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import FEET
from app.errors import Message
from app.formats.bvh.clip import BvhClip

HIPS_OVER_LEGS: Final = (0.5, 1.5)
"""Height of the hips over the floor, most of the time, as a part of the legs' length."""
FLAT_PART: Final = 0.4
"""Share of the legs' length by which the lower foot's height may vary more with positions in another unit."""
PLACE_UNITS_M: Final = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}
"""Units, in metres, that the positions and the bones of a file may have, independently of each other."""
LEGS_M: Final = (0.6, 1.2)
"""Plausible lengths of legs in metres."""
NEAR_FACTOR: Final = 4.0
"""Ratio of two units (inches and centimetres) below which the height of the hips alone does not show which one it
is."""
NEAR_ZERO: Final = 0.3
"""Height above zero of the lower ankle, as a part of the legs' length, up to which the floor is at zero."""
SLIDES_LESS: Final = 0.8
"""Greatest step of the slower foot with such a unit, relative to its step with the unit of the bones."""
SLIDES_AT_ZERO: Final = 1.4
"""The same if the floor is at zero with that unit only: 0.1 to 1.23 in files with two units, 1.5 and more in others."""


def place_units(positions: FloatArray, bones: Mapping[str, int]) -> tuple[str, str] | None:
    """Return the unit of the hips' positions and that of the bones if these are two; None if they are one.

    The hips are about as high above the floor as the legs are long, and with the right unit the lower foot stays at
    the floor.

    Parameters
    ----------
    positions : ndarray, shape (F, J, 3)
        World positions of J joints, Y up.
    """
    hips, feet = positions[:, bones["hips"]], positions[:, [bones[name] for name in FEET]]
    leg = [bones[f"left{name}"] for name in ("UpperLeg", "LowerLeg", "Foot")]
    length = float(np.linalg.norm(np.diff(positions[0, leg], axis=0), axis=1).sum())
    away = feet - hips[:, None]

    def height_varies(factor: float) -> float:
        return float(np.ptp(np.percentile(factor * hips[:, 1] + away[..., 1].min(axis=1), (5, 95))))

    def is_at_zero(factor: float) -> bool:
        lowest = factor * hips[:, 1] + away[..., 1].min(axis=1)
        return abs(float(np.percentile(lowest, 5))) < NEAR_ZERO * length

    def steps(factor: float) -> float:
        ways = np.diff(factor * hips[:, None] + away, axis=0)
        return float(np.linalg.norm(ways, axis=-1).min(axis=1).sum())

    found = []
    likely = [name for name, unit_m in PLACE_UNITS_M.items() if LEGS_M[0] < length * unit_m < LEGS_M[1]]
    usual = float(np.median(hips[:, 1])) / length
    for unit, bones_unit in permutations(PLACE_UNITS_M, 2):
        factor = PLACE_UNITS_M[unit] / PLACE_UNITS_M[bones_unit]
        if not HIPS_OVER_LEGS[0] < factor * usual < HIPS_OVER_LEGS[1]:
            continue
        if max(factor, 1.0 / factor) < NEAR_FACTOR:
            wrong = not HIPS_OVER_LEGS[0] < usual < HIPS_OVER_LEGS[1]
            slides = steps(factor) / max(steps(1.0), 1e-9 * length)
            fits = (wrong and slides < SLIDES_LESS) or (
                is_at_zero(factor) and not is_at_zero(1.0) and slides < SLIDES_AT_ZERO
            )
        else:
            fits = height_varies(factor) <= height_varies(1.0) + FLAT_PART * length
        if fits:
            found.append((bones_unit not in likely, abs(math.log(factor * usual)), unit, bones_unit))
    return min(found)[2:] if found else None


def with_places(bvh: BvhClip, hips: int, unit: str, bones_unit: str) -> BvhClip:
    """Return a clip with the positions of the hips and all their ancestors in the unit of the bones."""
    factor = PLACE_UNITS_M[unit] / PLACE_UNITS_M[bones_unit]
    above = {hips}
    while (parent := bvh.parents[min(above)]) >= 0:
        above.add(parent)
    moved = {joint: way * factor if joint in above else way for joint, way in bvh.translations_cm.items()}
    guess = Message("motion.place_unit", {"unit": unit, "bones": bones_unit})
    root = bvh.root_translation_cm * factor
    return replace(bvh, root_translation_cm=root, translations_cm=moved, guesses=(*bvh.guesses, guess))
