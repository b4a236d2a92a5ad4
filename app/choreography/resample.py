"""Resamples a captured motion at another frame rate."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from scipy.interpolate import CubicSpline

from app.choreography.clip import MotionClip
from app.rig import quaternion


def resampled(clip: MotionClip, fps: Fraction) -> MotionClip:
    """Return the motion at a frame rate, from its first frame to at most its last; the same object at its own rate.

    Values between frames follow cubic splines, so that speed is continuous.
    """
    if fps == clip.fps or len(clip) < 2:
        return MotionClip(clip.shape, fps, clip.hips_m, clip.rotations)
    count = int((len(clip) - 1) / clip.fps * fps) + 1
    frames = np.arange(count) * float(clip.fps / fps)
    known = np.arange(len(clip))
    # Neighbouring quaternions have the same sign and are close, so their components can be interpolated.
    rotations = quaternion.normalize(CubicSpline(known, clip.rotations)(frames))
    return MotionClip(clip.shape, fps, CubicSpline(known, clip.hips_m)(frames), rotations)
