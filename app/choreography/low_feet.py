"""Raises feet that move low over the floor from one place to another, which would skid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import free, legs_to, rest_tip_m
from app.choreography.foot_plants import FootPlant, InAir, planted_frames

CLEARS_M: Final = 0.012
"""Least height in metres of a foot's tip that is far from where it stood and will stand."""
CLEARS_WITHIN_M: Final = 0.028
"""Distance in metres from such a place within which most of that height is gained."""
RAISES_S: Final = 0.03
"""Standard deviation in seconds over which a low foot is raised before and after."""
LANDS_S: Final = 0.05
"""Time in seconds beside a stand within which that begins and ends."""


def cleared_m(tip_m: FloatArray, standing: Sequence[FootPlant], rest_m: float) -> FloatArray:
    """Return the heights (F,) of the path (F, 3) of a foot's tip, raised where it would move low over the floor from
    one plant to the next; ``rest_m`` is the height of a standing tip.
    """
    height = tip_m[:, 1] - rest_m
    if standing:
        air = InAir.between(standing, len(tip_m))
        least, own = CLEARS_M * _shares(tip_m, standing, air), height[air.frames]
        # Smooth maximum of both, the least height itself where that is 0.
        height[air.frames] = 0.5 * (own + least + np.hypot(own - least, 0.5 * least))
    return height + rest_m


def with_feet_cleared(clip: MotionClip, standing: Sequence[FootPlant]) -> MotionClip:
    """Return the motion with feet raised smoothly where limits of their accelerations lowered them again; the same
    object if none is too low.
    """
    fps, on_floor, world = float(clip.fps), planted_frames(standing, len(clip)), clip.world()
    tips, wide = tips_m(clip, world).copy(order="K"), 2 * round(2.0 * RAISES_S * fps) + 1
    low_m = np.zeros(on_floor.shape)
    for foot in range(2):
        own = [stand for stand in standing if stand.foot == foot]
        if not own:
            continue
        air, tip = InAir.between(own, len(clip)), tips[:, foot]
        least = CLEARS_M * _shares(tip, own, air) + rest_tip_m(clip, foot)
        low_m[air.frames, foot] = np.maximum(least - tip[air.frames, 1], 0.0)
        raised = gaussian_filter1d(
            maximum_filter1d(low_m[:, foot], wide, mode="nearest"), RAISES_S * fps, mode="nearest"
        )
        tip[:, 1] += raised * free(on_floor[:, foot], fps, LANDS_S)
    return legs_to(clip, world, tips, on_floor, turned_back=False) if low_m.any() else clip


def _shares(tip_m: FloatArray, standing: Sequence[FootPlant], air: InAir) -> FloatArray:
    """Return factors (N,) of the least height of a foot's tip in the air: 0 where it stood or will stand, 1 far from
    there.
    """
    places = np.array([stand.place_m for stand in standing])
    x, z = tip_m[air.frames, 0], tip_m[air.frames, 2]
    near = np.full(len(air.frames), np.inf)
    for stands in (air.before, air.after):
        away2 = np.square(x - places[stands, 0][air.spans]) + np.square(z - places[stands, 2][air.spans])
        near = np.minimum(near, np.where((stands >= 0)[air.spans], away2, np.inf))
    return np.asarray(-np.expm1(-near / CLEARS_WITHIN_M**2))
