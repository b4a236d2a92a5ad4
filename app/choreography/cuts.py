"""Cuts of a motion into basic motions: minimum, maximum, minimum of the angular acceleration of the whole body.

Source: K. Kameda, I. Watanabe, M. Yamamoto, "Music Driven Computer Animation Based On HMM". Weights, filters, floor and
prominence are specific to this program; all are in seconds and radians and local, so that a cut depends neither on the
frame rate nor on distant parts of the clip.
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
"""Cut-off in Hz of the low-pass filter applied to rotations before two differentiations. Voluntary human motion is
below 6 Hz (D. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed. 2009, chapter 3); at 4 Hz white noise
of 0.5 degrees at 60 frames per second leaves an acceleration of about 1 rad/s^2.
"""
ORDER: Final = 2
"""Order of the Butterworth filter, which runs forwards and backwards: no delay, twice the order."""
SPREAD_S: Final = 0.065
"""Standard deviation in seconds of the Gaussian that averages squared accelerations, so that acceleration and
deceleration of a quick movement are one motion.
"""
FLOOR_RAD_S2: Final = 3.0
"""Acceleration below which the body rests (noise, breathing). Dancers' median is 12 to 23 rad/s^2."""
PROMINENCE: Final = 1.15
"""Least ratio of a maximum to the higher of the adjacent minima (measured: fewer are lost to noise with a ratio than
with a difference).
"""
LEAST_SPAN_S: Final = 0.2
"""Least distance of maxima in seconds; of nearer ones the higher is used."""
LONGEST_REST_S: Final = 0.5
"""Longest rest in seconds included in a motion before or after it; the remainder belongs to no motion."""
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
"""Weights of the segments' accelerations in the mean: roughly the mass of the body beyond the joint; low for hands and
feet, whose capture is least exact.
"""


@dataclass(frozen=True, order=True)
class Cut:
    """A captured motion between two minima of the body's angular acceleration: the frames of the first minimum, of the
    maximum after it (the accent), and of the next minimum.

    The motion is ``start`` to ``end`` (half-open); the next cut starts at ``end``, or later after a long rest.
    """

    start: int
    accent: int
    end: int


@dataclass(frozen=True, eq=False)
class Segmentation:
    """A curve of acceleration, and the cuts of a clip.

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
    """Return the cuts of a clip. Frames before the first and after the last minimum belong to no cut, and a motionless
    clip has none.
    """
    curve = angular_acceleration(clip)
    fps = float(clip.fps)
    height = np.log(np.maximum(curve, FLOOR_RAD_S2))
    from scipy.signal import find_peaks  # slow to import; the learning dialog opens without it

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
    """Measure the angular acceleration of the whole body: weighted root mean square over the segments, each relative to
    its parent.

    Returns
    -------
    (F,) float64
        Filtered values in rad/s^2; zero if the clip is too short.
    """
    if len(clip) < 3:
        return np.zeros(len(clip))
    fps = float(clip.fps)
    smooth = quaternion.normalize(_low_pass(clip.rotations, fps))
    steps = quaternion.multiply(quaternion.conjugate(smooth[:-1]), smooth[1:])
    speed = quaternion.to_rotation_vector(steps) * fps
    # A velocity lies between two frames, an acceleration at the frame between two velocities.
    squares = np.sum((np.diff(speed, axis=0) * fps) ** 2, axis=-1)
    weights = np.array([WEIGHTS[name] for name in SEGMENTS])
    mean = np.pad(squares @ (weights / weights.sum()), 1, mode="edge")
    curve: FloatArray = np.sqrt(gaussian_filter1d(mean, SPREAD_S * fps, mode="nearest"))
    return curve


def _minimum(height: FloatArray, first: int, last: int, rest: int) -> tuple[int, int]:
    """Find the minimum of the curve ``height`` (F,) between two frames. Returns the last frame of the motion before it
    and the first frame of the motion after it, which are equal unless there is a rest longer than twice ``rest``
    frames.
    """
    part = height[first : last + 1]
    lowest = first + np.flatnonzero(part == part.min())
    middle = int(lowest[len(lowest) // 2])
    return min(middle, int(lowest[0]) + rest), max(middle, int(lowest[-1]) - rest)


def _low_pass(rotations: FloatArray, fps: float) -> FloatArray:
    """Return rotations after a Butterworth filter over the frames without delay; unfiltered if the frame rate is too
    low.
    """
    if 0.45 * fps <= CUT_OFF_HZ:
        return rotations
    from scipy.signal import butter, sosfiltfilt  # slow to import

    sections = butter(ORDER, CUT_OFF_HZ, fs=fps, output="sos")
    filtered: FloatArray = sosfiltfilt(sections, rotations, axis=0, padlen=min(len(rotations) - 1, int(fps)))
    return filtered
