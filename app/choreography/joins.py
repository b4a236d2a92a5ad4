"""Joins between motions: which motions can follow each other, and a blend without a visible seam (H6).

Two motions are compared at a join as point clouds of the body shortly before, at and shortly after it, so that poses
and velocities both count; the second is rotated about the vertical and moved over the floor for the best fit (L. Kovar,
M. Gleicher, F. Pighin, "Motion Graphs", SIGGRAPH 2002). The remaining difference fades out from its initial velocity
(D. Bollo, "Inertialization", GDC 2018): a quintic with given initial value and slope that ends at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import ComplexArray, FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.features import joint_points_m, size_m
from app.rig import quaternion

AROUND_S: Final = (-0.1, 0.0, 0.1)
"""Times in seconds about a join at which bodies are compared."""
_HEAVY: Final = {"leftFoot": 2.0, "rightFoot": 2.0, "leftHand": 0.7, "rightHand": 0.7, "head": 0.7}
"""Weights of parts in a difference, which shows most at standing feet and least at hands."""
FADE_S: Final = 0.45
"""Time in seconds within which the difference of two motions fades out."""
MOST_CARRIED_RAD: Final = 0.6
"""Angle in radians by which a difference of speeds may turn a joint before it has faded out; one that would turn it
farther fades sooner, but not within less than `LEAST_FADE_S`."""
LEANS_RAD: Final = 0.1
"""Angle in radians that takes the place of `MOST_CARRIED_RAD` for the lean of the hips, which all of the body shows."""
LEAST_FADE_S: Final = 0.18
_CARRIED: Final = 0.198
"""Maximum of the quintic with slope 1 at the start, relative to its time."""


class Clouds:
    """Points of bodies in given frames, by which frames are compared regardless of place and direction.

    Parameters
    ----------
    places : sequence of (clip, frame)
        Index of the clip and frame of each of N bodies.

    Attributes
    ----------
    flat : (N, P) complex128
        Positions on the floor as ``z + i x``, in metres of a body of 1.7 m, relative to ``middle``.
    middle : (N,) complex128
        Weighted middle of the points on the floor, as ``flat``.
    height : (N, P) float64
        Heights of the P points in metres.
    """

    def __init__(self, clips: Sequence[MotionClip], places: Sequence[tuple[int, int]]) -> None:
        points = [joint_points_m(clip) * (STATURE_M / size_m(clip)) for clip in clips]
        found = []
        for clip, frame in places:
            steps = [frame + round(offset_s * float(clips[clip].fps)) for offset_s in AROUND_S]
            found.append(points[clip][np.clip(steps, 0, len(clips[clip]) - 1)].reshape(-1, 3))
        cloud = np.array(found).reshape(len(found), -1, 3)
        flat = cloud[..., 2] + 1j * cloud[..., 0]
        self.middle: ComplexArray = flat @ _WEIGHTS
        self.flat: ComplexArray = flat - self.middle[:, None]
        self.height: FloatArray = cloud[..., 1]


STATURE_M: Final = 1.7
_UP: Final = np.array([0.0, 1.0, 0.0])
_WEIGHTS: FloatArray = np.tile([_HEAVY.get(name, 1.0) for name in (*SEGMENTS, *ENDS)], len(AROUND_S))
_WEIGHTS /= _WEIGHTS.sum()


def distances_m(before: Clouds, after: Clouds) -> FloatArray:
    """Distances (N, M) in metres between each of N bodies and each of M bodies: root mean square over their points,
    with each pair turned and moved over the floor for the best match.
    """
    turned = np.abs((before.flat.conj() * _WEIGHTS) @ after.flat.T)
    flat = _square(np.abs(before.flat), np.abs(after.flat)) - 2.0 * turned
    high = _square(before.height, after.height) - 2.0 * (before.height * _WEIGHTS) @ after.height.T
    return np.asarray(np.sqrt(np.maximum(flat + high, 0.0)))


def _square(before: FloatArray, after: FloatArray) -> FloatArray:
    summed: FloatArray = (before**2 @ _WEIGHTS)[:, None] + (after**2 @ _WEIGHTS)[None, :]
    return summed


def best_turn_rad(before: ComplexArray, after: ComplexArray) -> float:
    """Return the rotation about +Y in radians that aligns one body with another; both are P points as in
    `Clouds.flat`."""
    return float(np.angle((after.conj() * before) @ _WEIGHTS))


def facing_apart(rotations: FloatArray) -> FloatArray:
    """Split the rotation of the hips in (F, B, 4) into their lean, which takes its place, and their facing, which is
    added as the last of (F, B + 1, 4)."""
    facing = quaternion.from_axis_angle(_UP, quaternion.twist_angle(rotations[:, 0], _UP))
    result = np.concatenate([rotations, facing[:, None]], axis=1)
    result[:, 0] = quaternion.multiply(quaternion.conjugate(facing), rotations[:, 0])
    return result


def facing_together(rotations: FloatArray) -> FloatArray:
    """Undo `facing_apart`."""
    result = rotations[:, :-1].copy()
    result[:, 0] = quaternion.multiply(rotations[:, -1], rotations[:, 0])
    return result


def fading_difference(value: FloatArray, slope: FloatArray, times_s: FloatArray, fade_s: float = FADE_S) -> FloatArray:
    """Return a difference that fades out.

    Parameters
    ----------
    value, slope : (...)
        Value at time 0, and its rate of change per second.
    times_s : (T,) float64
        Times in seconds, from 0 on.

    Returns
    -------
    (T, ...) float64
        Quintic with this value and slope and no curvature at 0, and all three 0 from ``fade_s`` on.
    """
    # Basis of the quintic: value 1 and slope 0, value 0 and slope 1 at the start, curvature 0; all 0 at the end.
    u = np.clip(times_s / fade_s, 0.0, 1.0).reshape(-1, *(1,) * np.ndim(value))
    return np.asarray(_fading_value(u) * value + _fading_slope(u) * (fade_s * np.asarray(slope)))


def fading_turn(
    turn: FloatArray,
    spin_rad_s: FloatArray,
    times_s: FloatArray,
    carried_rad: float | FloatArray = MOST_CARRIED_RAD,
    fade_s: float = FADE_S,
) -> FloatArray:
    """Return a difference of rotations that fades out, (T, B, 3) rotation vectors at T times of B joints.

    Parameters
    ----------
    turn, spin_rad_s : (B, 3) or (T, B, 3) float64
        Rotation vector of each joint at time 0, and its rate of change per second; the same for all times, or each time
        with its own.
    times_s : (T,) float64
        From 0 on.
    carried_rad : float or (B,) float64
        Greatest angle by which the rate of change may turn each joint.
    fade_s : float
        Time in seconds in which the difference fades out.
    """
    far_s = carried_rad / (_CARRIED * np.maximum(np.linalg.norm(spin_rad_s, axis=-1), 1e-9))
    fades_s = np.clip(far_s, LEAST_FADE_S, fade_s)
    carried = _fading_slope(np.clip(times_s[:, None] / fades_s, 0.0, 1.0))[..., None] * fades_s[..., None] * spin_rad_s
    held = _fading_value(np.clip(times_s / fade_s, 0.0, 1.0))[:, None, None] * turn
    return np.asarray(held + carried)


def _fading_value(u: FloatArray) -> FloatArray:
    """Quintic with value 1 and slope 0 at 0, and value and slope 0 at 1; no curvature at either."""
    rest = 1.0 - u
    return np.asarray(rest**3 * (1.0 + 3.0 * u + 6.0 * u * u))


def _fading_slope(u: FloatArray) -> FloatArray:
    """Quintic with value 0 and slope 1 at 0, and value, slope and curvature 0 at 1."""
    return np.asarray((1.0 - u) ** 3 * u * (1.0 + 3.0 * u))
