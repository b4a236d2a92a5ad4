"""Arrivals of the body in a dance (minima of its speed), and a time map that puts them on the beats.

A body arrives at a minimum of the mean speed of its joints. Its time depends on the complete dance, since blends and
standing feet change speeds, and changing time shifts minima. So arrivals are found in a draft of the dance, and again
for every following time map.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.accent_grid import AccentGrid
from app.choreography.clip import MotionClip
from app.choreography.music_offset import speed_minima
from app.choreography.warp import TimeMap, map_with_arrivals, nearest_s

SMOOTHING_S: Final = 5.0 / 60.0
"""Standard deviation in seconds of the Gaussian that smooths speed before arrivals are found (Li et al., "AI
Choreographer: Music Conditioned 3D Dance Generation with AIST++", ICCV 2021).
"""
NEAR_S: Final = 3.0 / 60.0
"""Distance in seconds within which an arrival meets a beat (ibid.)."""
FPS: Final = 60.0
"""Rate in frames per second at which arrivals are found."""
LEAST_SPEED: Final = 0.3
"""Least speed of a draft, relative to the source, at which its motion is useful."""
FALLS_SHARE: Final = 0.15
"""Weight of footfalls in how well a dance meets the beats."""
COPIES: Final = 240
"""Number of shifted copies of footfalls with which they are compared."""
AS_WELL: Final = 0.1
"""Share of copies that meet the beats as well from which footfalls are taken to be random."""
BY_CHANCE: Final = 0.2
"""Cost of random footfalls."""
TRIES: Final = 3
"""Greatest number of time maps tried after the first one."""


def joint_speed_m_s(clip: MotionClip) -> FloatArray:
    """Return the mean speed (F,) of the joints, scaled to the body's size."""
    joints = clip.world().positions_m[:, 1:]
    return np.asarray(np.linalg.norm(np.gradient(joints, axis=0), axis=-1).mean(axis=-1) * float(clip.fps))


def smoothed(speed_m_s: FloatArray, fps: float) -> FloatArray:
    """Smooth a speed (F,) over time, so that arrivals can be found in it."""
    return np.asarray(gaussian_filter1d(speed_m_s, SMOOTHING_S * fps, mode="nearest"))


def arrival_frames(speed_m_s: FloatArray, fps: float) -> IntArray:
    """Find the arrivals of a body: frames of the minima of a speed (F,)."""
    return speed_minima(speed_m_s, fps, SMOOTHING_S)[0]


def alignment(arrivals_s: FloatArray, beats_s: FloatArray) -> float:
    """Score, 0..2, of the match between arrivals of the body and beats: the sum of the closeness of each arrival to its
    nearest beat, and of each beat to its nearest arrival.

    Closeness to beats is the beat alignment of Li et al., "AI Choreographer", ICCV 2021; the reverse is that of Siyao
    et al., "Bailando: 3D Dance Generation by Actor-Critic GPT with Choreographic Memory", CVPR 2022.
    """
    if not len(arrivals_s) or not len(beats_s):
        return 0.0
    return _closeness(arrivals_s, beats_s) + _closeness(beats_s, arrivals_s)


def _closeness(moments_s: FloatArray, others_s: FloatArray) -> float:
    """Mean closeness of moments to the nearest of others, both ascending."""
    return float(np.exp(-np.square(nearest_s(moments_s, others_s)) / (2.0 * NEAR_S**2)).mean())


def beats_met(arrivals_s: FloatArray, falls_s: FloatArray, grid: AccentGrid) -> float:
    """Score how well a dance meets the beats, higher is better: body arrivals on beats of the piece, and footfalls on
    beats that dancers feel.
    """
    felt_s = grid.times_s[grid.on_beat]
    met = alignment(arrivals_s, grid.times_s[grid.strengths == 1.0]) + FALLS_SHARE * alignment(falls_s, felt_s)
    return met - BY_CHANCE * chance_of_falls(falls_s, felt_s)


def chance_of_falls(falls_s: FloatArray, beats_s: FloatArray) -> float:
    """Estimate whether footfalls meet the beats only by chance: 0 if they fit better than shifted copies of themselves
    do, rising to 1 if a share `AS_WELL` of the copies fits as well. Copies are shifted evenly over the piece and wrap
    around its end.
    """
    if len(beats_s) < 2 or not len(falls_s):
        return 0.0
    length_s = float(np.ptp(beats_s))
    shifts_s = length_s * np.arange(COPIES) / COPIES
    places_s = beats_s[0] + (falls_s - beats_s[0] + shifts_s[:, None]) % length_s
    after = np.clip(np.searchsorted(beats_s, places_s), 1, len(beats_s) - 1)
    off_s = np.minimum(np.abs(beats_s[after] - places_s), np.abs(places_s - beats_s[after - 1]))
    fits = np.exp(-np.square(off_s) / (2.0 * NEAR_S**2)).mean(axis=1)
    return float(min(1.0, (fits[1:] >= fits[0]).mean() / AS_WELL))


def best_arrival_map(
    speed_m_s: FloatArray,
    draft_s: FloatArray,
    shown: TimeMap,
    plain: TimeMap,
    grid: AccentGrid,
    falls: FloatArray,
) -> TimeMap:
    """Improve the time map of a dance in a few steps, so that arrivals and footfalls meet beats, and return the best
    map.

    Parameters
    ----------
    speed_m_s : (F,) float64
        Mean speed of the joints in a draft of the dance, made with the time map ``shown``.
    draft_s : (F,) float64
        Times of its frames in seconds.
    shown : TimeMap
        Time map of the draft.
    plain : TimeMap
        Time map with a knot only at the place of each segment (see `app.choreography.warp.map_with_arrivals`).
    falls : (N,) float64
        Times of footfalls in the draft in seconds.
    """
    along, speeds = shown.at(draft_s)
    seen = speeds > LEAST_SPEED
    if seen.sum() < 2:
        return shown
    along, speed = along[seen], (speed_m_s / np.maximum(speeds, LEAST_SPEED))[seen]
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
