"""Contacts of the feet with the floor in a motion."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, label, minimum_filter1d

from app.arrays import BoolArray, FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.body_speeds import runs
from app.choreography.clip import MotionClip
from app.rig import quaternion
from app.rig.skeleton import JointTransforms

STANDS_M_S: Final = 0.20
"""Speed in metres per second of its tip below which a foot starts to stand."""
LEAVES_M_S: Final = 0.29
"""Speed in metres per second above which a standing foot leaves."""
NEAR_M: Final = 0.03
"""Greatest height in metres of a standing foot above its lowest height within `AROUND_S`."""
AROUND_S: Final = 2.0
LEAST_S: Final = 0.07
"""Least duration of a stand in seconds."""
SMOOTH_S: Final = 0.025
"""Standard deviation in seconds of the Gaussian that smooths speed, so that a frame of noise is no step."""


def tips_m(clip: MotionClip, world: JointTransforms | None = None) -> FloatArray:
    """World positions (F, 2, 3) of the tips of the left and the right foot; ``world`` are the clip's transforms, if
    known.
    """
    joints = [1 + SEGMENTS.index(foot) for foot in FEET]
    world = clip.world(joints) if world is None else world
    tips = quaternion.planes(len(clip), 2, 3)
    for foot, joint in enumerate(joints):
        ankle_m, turned = world.of(joint)
        np.add(ankle_m, quaternion.rotate(turned, clip.shape.ends_m[ENDS.index(FEET[foot])]), out=tips[:, foot])
    return tips


def foot_contacts(clip: MotionClip) -> BoolArray:
    """Mask (F, 2) of the frames in which the left and the right foot stand on the floor, judged by speed and height of
    their tips, with hysteresis.
    """
    fps, tips = float(clip.fps), tips_m(clip)
    if len(clip) < 2:
        return np.ones((len(clip), 2), bool)
    speed = np.linalg.norm(np.gradient(tips, axis=0), axis=-1) * fps
    speed = gaussian_filter1d(speed, SMOOTH_S * fps, axis=0, mode="nearest")
    result = np.zeros(speed.shape, bool)
    around = max(1, round(AROUND_S * fps))
    for foot in range(2):
        height = tips[:, foot, 1]
        lowest = minimum_filter1d(height, 2 * around + 1, mode="nearest")
        low = height < lowest + NEAR_M
        result[:, foot] = _hysteresis(low & (speed[:, foot] < STANDS_M_S), low & (speed[:, foot] < LEAVES_M_S))
        for start, stop in runs(result[:, foot]):
            if stop - start < LEAST_S * fps:
                result[start:stop, foot] = False
    return result


def _hysteresis(begins: BoolArray, goes_on: BoolArray) -> BoolArray:
    """Return a mask (F,) of those runs of ``goes_on`` that contain a frame of ``begins``, so that a contact begins
    strictly and ends late."""
    spans, _ = label(goes_on)
    held = np.unique(spans[begins & goes_on])
    return np.asarray(np.isin(spans, held[held > 0]))
