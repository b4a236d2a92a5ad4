"""Start of the music within a motion, found from the beats of both.

The beats of a motion are the local minima of the summed speed of the body (Li et al., "AI Choreographer: Music
Conditioned 3D Dance Generation with AIST++", ICCV 2021), where it stops or turns. They are matched with the hits and
beats of the music at every offset; the confidence is the advantage of the best offset over the next.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.clip import MotionClip
from app.choreography.features import joint_points_m
from app.choreography.peaks import prominent_peaks
from app.choreography.rhythm import Rhythm
from app.errors import Message

SMOOTHING_S: Final = 0.04
"""Standard deviation in seconds of the Gaussian that smooths speed before minima are found."""
PROMINENCE: Final = 0.05
"""Least prominence of a minimum relative to the median speed."""
GRID_S: Final = 0.005
"""Step of the tried offsets in seconds."""
TOLERANCE_S: Final = 0.05
"""Distance in seconds within which a beat of the motion meets the music (3 frames at 60 frames per second, as in beat
alignment).
"""
LEAST_OVERLAP: Final = 0.5
"""Least overlap of motion and music relative to the shorter one."""
APART_S: Final = 0.15
"""Distance in seconds below which offsets count as equal."""
CONFIDENT: Final = 0.3
"""Confidence from which an offset is reliable. Measured: for CMU clips with unrelated drums of the Groove MIDI set the
greatest was 0.26; with drums made from the clips' own beats no offset above it was wrong.
"""
BEAT_STRENGTH: Final = 0.25
"""Strength of a beat; a hit has its velocity 0..1, a downbeat twice this value."""


@dataclass(frozen=True)
class MusicOffset:
    """Start of the music within a recording, with its confidence.

    Attributes
    ----------
    offset_s : float
        Time of the motion at the music's first tick in seconds; negative if the music begins earlier.
    confidence : float
        Confidence, 0..1, see `CONFIDENT`: 0 if another offset fits as well, as for unrelated music or equal bars; 1 if
        no other offset fits at all.
    """

    offset_s: float
    confidence: float


def offset_doubt(offset_s: float, confidence: float | None) -> Message | None:
    """Return a message that an offset may be wrong; None if it is reliable, or the user's own (``confidence`` None).

    Parameters
    ----------
    offset_s : float
        Time of the motion file at the music's first tick in seconds.
    """
    if confidence is None or confidence >= CONFIDENT:
        return None
    return Message("learn.offset_unsure", {"offset_s": offset_s, "confidence": confidence, "least": CONFIDENT})


def find_offset(clip: MotionClip, rhythm: Rhythm) -> MusicOffset:
    """Find the offset at which the beats of a motion best match the hits and beats of the music; 0 with confidence 0 if
    there are none.

    If the music is long enough to sound during the whole motion, it does, unless another offset is clearly better.
    """
    frames, strengths = motion_beats(clip)
    times_s = np.concatenate([rhythm.hits_s, rhythm.beats_s])
    weights = np.concatenate([rhythm.strengths, BEAT_STRENGTH * np.where(rhythm.bar_beats == 0, 2.0, 1.0)])
    if not len(frames) or not len(times_s):
        return MusicOffset(0.0, 0.0)
    motion = _pulses(frames / float(clip.fps), strengths, clip.length_s)
    music = _pulses(times_s, weights, float(times_s.max()))
    fit, lags = _fit(motion, music)
    best = _best(fit, lags, len(motion), len(music))
    others = fit[np.abs(lags - lags[best]) * GRID_S > APART_S]
    if fit[best] <= 0.0:
        return MusicOffset(0.0, 0.0)
    confidence = max(0.0, 1.0 - max(0.0, float(others.max(initial=0.0))) / float(fit[best]))
    return MusicOffset(round(float(lags[best]) * GRID_S, 3), confidence)


def _best(fit: FloatArray, lags: IntArray, motion: int, music: int) -> int:
    """Index of the best fit (K,) among those at which music with the given number of samples covers the whole motion;
    of all if none of these is comparably good. A fit to half of the motion is good by chance more easily.
    """
    best = int(np.argmax(fit))
    shared = min(lags[best] + music, motion) - max(lags[best], 0)
    covers = (lags <= 0) & (lags + music >= motion)
    if not covers.any():
        return best
    least = (1.0 - CONFIDENT) * np.sqrt(shared / motion)
    covering = int(np.flatnonzero(covers)[np.argmax(fit[covers])])
    return covering if fit[covering] >= least * fit[best] else best


def motion_beats(clip: MotionClip) -> tuple[IntArray, FloatArray]:
    """Return the frames of local minima of the body's summed speed, with their depths.

    Returns
    -------
    frames : (N,) int64
        Frames of the minima, ascending.
    strengths : (N,) float64
        Prominence of each minimum relative to the greatest, 0..1.
    """
    if len(clip) < 3:
        return np.zeros(0, np.int64), np.zeros(0)
    frames, depths = speed_minima(summed_speed_m_s(clip), float(clip.fps), SMOOTHING_S)
    return frames, depths / depths.max(initial=1e-6)


def summed_speed_m_s(clip: MotionClip) -> FloatArray:
    """Sum (F,) of the speeds of all points of the body, in m/s."""
    return np.asarray(np.linalg.norm(np.gradient(joint_points_m(clip), axis=0), axis=-1).sum(axis=-1) * float(clip.fps))


def speed_minima(speed: FloatArray, fps: float, smoothing_s: float) -> tuple[IntArray, FloatArray]:
    """Return the frames of local minima of a speed smoothed by a Gaussian, with their depths."""
    smooth = gaussian_filter1d(speed, smoothing_s * fps, mode="nearest")
    return prominent_peaks(-smooth, max(PROMINENCE * float(np.median(smooth)), 1e-6))


def _pulses(times_s: FloatArray, weights: FloatArray, length_s: float) -> FloatArray:
    """Sample a pulse train on a grid (N,) from 0 to ``length_s`` in steps of `GRID_S`: a bump of the given weight at
    each time, minus the mean.
    """
    pulses = np.zeros(round(length_s / GRID_S) + 1)
    np.add.at(pulses, np.clip(np.round(times_s / GRID_S).astype(np.int64), 0, len(pulses) - 1), weights)
    bumps = gaussian_filter1d(pulses, TOLERANCE_S / np.sqrt(2.0) / GRID_S, mode="constant")
    centred: FloatArray = bumps - bumps.mean()
    return centred


def _fit(motion: FloatArray, music: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the correlation (K,), -1..1, of the overlapping parts of motion and music at each lag, and the lags (K,)
    in grid steps."""
    lags = np.arange(-(len(music) - 1), len(motion))
    from scipy.signal import correlate  # slow to import and used only when a dance is learned

    shared = correlate(np.ones_like(motion), np.ones_like(music), method="fft").round()
    enough = shared >= LEAST_OVERLAP * min(len(motion), len(music))
    both = correlate(motion, music, method="fft")[enough]
    of_motion = correlate(motion**2, np.ones_like(music), method="fft")[enough]
    of_music = correlate(np.ones_like(motion), music**2, method="fft")[enough]
    power = np.sqrt(np.maximum(of_motion, 0.0) * np.maximum(of_music, 0.0))
    return both / np.maximum(power, 1e-9 * power.max(initial=1e-9)), lags[enough]
