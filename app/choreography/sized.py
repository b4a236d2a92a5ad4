"""Scaling of a dance's size: rotations of trunk and arms are moved away from their mean or towards it, within the range
of human joints.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.limbs import within_hinges
from app.rig import quaternion

REACHES_RAD: Final = {
    "spine": 0.6, "chest": 0.6, "head": 0.9, "UpperArm": 1.6, "LowerArm": 1.3, "Hand": 0.9,
}  # fmt: skip
"""Greatest angles in radians of a joint from its mean pose to which a larger motion may grow; a motion that is
farther away already stays as it is there."""


def sized(clip: MotionClip, size: float, hinges: FloatArray) -> MotionClip:
    """Scale the motion of trunk and arms by ``size``, as rotations from their mean pose; the steps are unchanged.

    With a size above 1, angles near the limits of `REACHES_RAD` are increased least.

    Parameters
    ----------
    size : float
        Factor of angles from the mean pose; 1 as captured.
    hinges : (4, 2) float64
        Ranges in radians of knees and elbows, see `app.choreography.limbs.hinge_ranges`.
    """
    if size == 1.0:
        return clip
    rotations = clip.rotations.copy(order="K")
    for at, name in enumerate(SEGMENTS):
        reach_rad = next((reach for part, reach in REACHES_RAD.items() if name.endswith(part)), None)
        if reach_rad is None:
            continue
        middle = quaternion.normalize(rotations[:, at].mean(axis=0))
        away = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(middle), rotations[:, at]))
        factor = _factor(np.linalg.norm(away, axis=-1), size, reach_rad)
        grown = quaternion.from_rotation_vector(away * factor[:, None])
        rotations[:, at] = quaternion.multiply(middle, grown)
    rotations = within_hinges(rotations, clip.rotations, hinges)
    return replace(clip, rotations=quaternion.continuous(rotations))


def _factor(angles_rad: FloatArray, size: float, reach_rad: float) -> FloatArray:
    """Factor (F,) of each angle from the mean pose: ``size`` near the mean; if that is above 1, it falls to 1 at the
    limit ``reach_rad``, or at the largest angle if that is beyond.
    """
    if size < 1.0:
        return np.full(len(angles_rad), size)
    share = np.minimum(angles_rad / max(reach_rad, float(angles_rad.max(initial=0.0))), 1.0)
    return np.asarray(1.0 + (size - 1.0) * np.square(1.0 - np.square(share)))
