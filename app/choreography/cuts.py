"""Cuts of a motion into basic motions: minimum, maximum, minimum of the angular acceleration of the whole body.

Source: K. Kameda, I. Watanabe, M. Yamamoto, "Music Driven Computer Animation Based On HMM". Weights, filters, floor and
prominence are ours; all are stated in seconds and radians and are local, so that a cut depends neither on the frame
rate nor on what the clip holds some seconds away.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion

SIDES: Final = ("left", "right")
CUT_OFF_HZ: Final = 4.0
"""Rotations are low-pass filtered before they are differentiated twice. Voluntary human motion is below 6 Hz
(D. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed. 2009, chapter 3); at 4 Hz white noise of
0.5 degrees at 60 frames per second leaves an acceleration of about 1 rad/s^2."""
ORDER: Final = 2
"""Order of the Butterworth filter, which runs forwards and backwards: no delay, twice the order."""
SPREAD_S: Final = 0.065
"""Standard deviation of the Gaussian over which the squares of the accelerations are averaged: speeding up and slowing
down of one quick move are one motion."""
FLOOR_RAD_S2: Final = 3.0
"""Acceleration below which the body rests: noise of the capture, breathing. Dancers are at 12 to 23 rad/s^2 half of the
time."""
PROMINENCE: Final = 1.15
"""A maximum counts that is this many times the higher of the minima beside it (measured: fewer are lost to noise with a
ratio than with a difference)."""
LEAST_SPAN_S: Final = 0.2
"""Least distance of maxima; the higher of two nearer ones counts."""
LONGEST_REST_S: Final = 0.5
"""A motion takes no more than this of a rest before or after it; what is left between two motions belongs to none."""
WEIGHTS: Final = {
    "hips": 2.0,
    "spine": 1.0,
    "chest": 1.0,
    "head": 0.5,
    **{f"{side}UpperArm": 1.0 for side in SIDES},
    **{f"{side}LowerArm": 0.5 for side in SIDES},
    **{f"{side}Hand": 0.1 for side in SIDES},
    **{f"{side}UpperLeg": 1.5 for side in SIDES},
    **{f"{side}LowerLeg": 1.0 for side in SIDES},
    **{f"{side}Foot": 0.25 for side in SIDES},
}
"""Weights of the segments' accelerations in the mean: roughly the mass of the body beyond the joint; hands and feet,
which the capture knows worst, count little."""


@dataclass(frozen=True, order=True)
class Cut:
    """Frames of a minimum, of the maximum after it, and of the next minimum.

    ``start`` to ``end`` (half-open) is the motion; the next cut starts at ``end`` or, after a long rest, later.
    """

    start: int
    accent: int
    end: int


@dataclass(frozen=True, eq=False)
class Segmentation:
    """A curve and where it cuts a clip.

    Attributes
    ----------
    curve_rad_s2 : (F,) float64
        See `angular_acceleration`.
    cuts : tuple of Cut
        Ascending and without overlap.
    """

    curve_rad_s2: FloatArray
    cuts: tuple[Cut, ...]


def segment(clip: MotionClip) -> Segmentation:
    """Cut a clip; what is before its first and after its last minimum belongs to no cut, and a still clip has none."""
    curve = angular_acceleration(clip)
    fps = float(clip.fps)
    height = np.log(np.maximum(curve, FLOOR_RAD_S2))
    from scipy.signal import find_peaks  # heavy; a dialog that learns nothing yet is up before

    peaks, _ = find_peaks(height, prominence=np.log(PROMINENCE), distance=max(1.0, LEAST_SPAN_S * fps))
    bounds = [0, *peaks.tolist(), len(curve) - 1]
    minima = [_minimum(height, start, stop, round(LONGEST_REST_S * fps)) for start, stop in pairwise(bounds)]
    return Segmentation(
        curve,
        tuple(
            Cut(start, accent, end)
            for ((_, start), (end, _)), accent in zip(pairwise(minima), peaks.tolist(), strict=True)
        ),
    )


def angular_acceleration(clip: MotionClip) -> FloatArray:
    """Weighted root mean square of the segments' angular accelerations, each relative to what carries it.

    Returns
    -------
    (F,) float64
        rad/s^2, filtered; zero where the clip is too short to have an acceleration.
    """
    if len(clip) < 3:
        return np.zeros(len(clip))
    fps = float(clip.fps)
    smooth = quaternion.normalize(_low_pass(clip.rotations, fps))
    steps = quaternion.multiply(quaternion.conjugate(smooth[:-1]), smooth[1:])
    speed = quaternion.to_rotation_vector(steps) * fps
    # A velocity belongs between two frames, an acceleration to the frame between two velocities.
    squares = np.sum((np.diff(speed, axis=0) * fps) ** 2, axis=-1)
    weights = np.array([WEIGHTS[name] for name in SEGMENTS])
    mean = np.pad(squares @ (weights / weights.sum()), 1, mode="edge")
    curve: FloatArray = np.sqrt(gaussian_filter1d(mean, SPREAD_S * fps, mode="nearest"))
    return curve


def _minimum(height: FloatArray, first: int, last: int, rest: int) -> tuple[int, int]:
    """Return where the motion before a minimum ends, and the motion after it starts: one frame, but for a long rest."""
    part = height[first : last + 1]
    lowest = first + np.flatnonzero(part == part.min())
    middle = int(lowest[len(lowest) // 2])
    return min(middle, int(lowest[0]) + rest), max(middle, int(lowest[-1]) - rest)


def _low_pass(rotations: FloatArray, fps: float) -> FloatArray:
    """Butterworth filter over the frames, without delay; nothing where the frame rate holds no such frequency."""
    if 0.45 * fps <= CUT_OFF_HZ:
        return rotations
    from scipy.signal import butter, sosfiltfilt  # heavy, as above

    sections = butter(ORDER, CUT_OFF_HZ, fs=fps, output="sos")
    filtered: FloatArray = sosfiltfilt(sections, rotations, axis=0, padlen=min(len(rotations) - 1, int(fps)))
    return filtered
