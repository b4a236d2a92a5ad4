"""Arrivals of the body in a dance, and a time map that puts them on the beats.

A body arrives where the mean speed of its joints has a minimum. Where that is depends on the dance as it is seen: faded
joins and feet that stand change speeds, and time that goes faster and slower moves their minima. So it is looked up in
a draft of the dance, and again for every time map that follows.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.features import points_m
from app.choreography.music_offset import speed_minima
from app.choreography.warp import TimeMap, map_with_arrivals

SMOOTHING_S: Final = 5.0 / 60.0
"""Standard deviation of the Gaussian over which speed is averaged to find where the body arrives (Li et al., "AI
Choreographer: Music Conditioned 3D Dance Generation with AIST++", ICCV 2021)."""
NEAR_S: Final = 3.0 / 60.0
"""An arrival meets a beat at about this distance (ibid.)."""
FPS: Final = 60.0
"""Arrivals are looked for at this rate."""
LEAST_SPEED: Final = 0.3
"""Least speed of a draft at which its motion is seen well enough."""
FALLS_SHARE: Final = 0.3
"""Share of footfalls in how well a dance meets the beats."""
TRIES: Final = 3
"""Most time maps that are tried after the first one."""


def joint_speed_m_s(clip: MotionClip) -> FloatArray:
    """(F,) mean speed of the joints of a body of its size."""
    joints = points_m(clip)[:, : len(SEGMENTS)]
    return np.asarray(np.linalg.norm(np.gradient(joints, axis=0), axis=-1).mean(axis=-1) * float(clip.fps))


def smoothed(speed_m_s: FloatArray, fps: float) -> FloatArray:
    """(F,) a speed as arrivals are found in it."""
    return np.asarray(gaussian_filter1d(speed_m_s, SMOOTHING_S * fps, mode="nearest"))


def arrival_frames(speed_m_s: FloatArray, fps: float) -> IntArray:
    """Frames in which a body arrives that goes at a speed (F,)."""
    return speed_minima(speed_m_s, fps, SMOOTHING_S)[0]


def alignment(arrivals_s: FloatArray, beats_s: FloatArray) -> float:
    """Return how well arrivals meet beats, 0..2: each arrival its nearest beat, and each beat its nearest arrival.

    The sum of beat alignment as of Li et al. (ibid.) and as of Siyao et al., "Bailando: 3D Dance Generation by
    Actor-Critic GPT with Choreographic Memory", CVPR 2022.
    """
    if not len(arrivals_s) or not len(beats_s):
        return 0.0
    fits = np.exp(-np.square(arrivals_s[:, None] - beats_s[None, :]) / (2.0 * NEAR_S**2))
    return float(fits.max(axis=1).mean() + fits.max(axis=0).mean())


def best_arrival_map(
    draft: MotionClip, first_s: float, shown: TimeMap, plain: TimeMap, grid: AccentGrid, falls: FloatArray
) -> TimeMap:
    """The map by which a dance arrives best, of a few that follow from one another.

    Parameters
    ----------
    draft : MotionClip
        The dance as it is seen by one map.
    first_s : float
        Time of its frame 0.
    shown : TimeMap
        That map.
    plain : TimeMap
        With a knot at each segment's place: see `app.choreography.warp.map_with_arrivals`.
    falls : (N,) float64
        Times at which feet come down in the draft.
    """
    along, speeds = shown.at(first_s + np.arange(len(draft)) / float(draft.fps))
    seen = speeds > LEAST_SPEED
    if seen.sum() < 2:
        return shown
    along, speed = along[seen], (joint_speed_m_s(draft) / np.maximum(speeds, LEAST_SPEED))[seen]
    times_s = np.arange(plain.times_s[0], plain.times_s[-1], 1.0 / FPS)
    falls_along, _ = shown.at(falls)
    beats_s, felt_s = grid.times_s[grid.strengths == 1.0], grid.times_s[grid.on_beat]
    best, best_value, tried = shown, -1.0, shown
    for number in range(1 + TRIES):
        places, rates = tried.at(times_s)
        frames = arrival_frames(np.interp(places, along, speed) * rates, FPS)
        value = alignment(times_s[frames], beats_s) + FALLS_SHARE * alignment(tried.when(falls_along), felt_s)
        if value > best_value:
            best, best_value = tried, value
        if number < TRIES:
            tried = map_with_arrivals(plain, places[frames], grid, falls_along)
    return best
