"""Bars that return in a piece, so that a dancer can take up again what was danced to them before."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import FloatArray, IntArray
from app.choreography.rhythm import Rhythm

POSITIONS: Final = 12
"""Places in a beat at which hits are distinguished: thirds and quarters of it."""
AROUND_BARS: Final = 2
"""A bar returns together with so many bars before and after it."""
APART_BARS: Final = 4
"""Return after fewer bars is no return, but a figure that goes on."""
UNUSUAL: Final = 1.0
"""Standard deviations by which a return is more alike than two bars of the piece are in the mean."""
LEAST_MORE: Final = 0.05
"""And at least by this much, as a cosine: where all bars are alike, none of them returns."""
_NEAR_BEATS: Final = 1e-3
GOES_ON: Final = 0.05
"""Bars in a row return in a row unless others are more alike than this."""


def returning_bars(rhythm: Rhythm) -> IntArray:
    """(B,) the earlier bar that each bar returns to; -1 where there is none.

    Bars are between the downbeats; what is struck in them, and when, is compared.
    """
    alike = _along_phrases(likeness_of_bars(rhythm))
    bars = len(alike)
    found = np.full(bars, -1, np.int64)
    pairs = alike[np.tril_indices(bars, -APART_BARS)]
    if not len(pairs):
        return found
    least = float(pairs.mean()) + max(LEAST_MORE, UNUSUAL * float(pairs.std()))
    for bar in range(APART_BARS, bars):
        earlier = alike[bar, : bar - APART_BARS + 1]
        best = int(earlier.argmax())
        goes_on = int(found[bar - 1]) + 1
        if found[bar - 1] >= 0 and goes_on < len(earlier) and earlier[goes_on] >= earlier[best] - GOES_ON:
            best = goes_on
        if earlier[best] >= least:
            found[bar] = best
    return found


def likeness_of_bars(rhythm: Rhythm) -> FloatArray:
    """(B, B) cosines of what is struck in the bars, by sound, place and strength."""
    downbeats = np.flatnonzero(rhythm.bar_beats == 0)
    if len(downbeats) < 2:
        return np.zeros((0, 0))
    beats = np.diff(downbeats)
    hits = np.interp(rhythm.hits_s, rhythm.beats_s, np.arange(len(rhythm.beats_s)))
    places = np.rint(POSITIONS * hits).astype(np.int64)
    bar = np.searchsorted(POSITIONS * downbeats, places, side="right") - 1
    inside = (bar >= 0) & (bar < len(beats))
    sounds, sound = np.unique(rhythm.symbols[inside], return_inverse=True)
    struck = np.zeros((len(beats), max(1, len(sounds)), POSITIONS * int(beats.max())))
    here = bar[inside]
    np.add.at(struck, (here, sound, places[inside] - POSITIONS * downbeats[here]), rhythm.strengths[inside])
    # No drummer is exact.
    flat = gaussian_filter1d(struck, 0.7, axis=-1, mode="constant").reshape(len(beats), -1)
    flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-9)
    return np.asarray((flat @ flat.T) * (beats[:, None] == beats[None, :]))


def returning_places(rhythm: Rhythm, times_s: FloatArray) -> IntArray:
    """(G,) of some times, ascending, the number of the earlier one that each returns to: at the same place of the bar
    that returns; -1 where there is none."""
    downbeats = np.flatnonzero(rhythm.bar_beats == 0)
    found = np.full(len(times_s), -1, np.int64)
    earlier = returning_bars(rhythm)
    if not (earlier >= 0).any():
        return found
    beats = np.interp(times_s, rhythm.beats_s, np.arange(len(rhythm.beats_s), dtype=np.float64))
    bar = np.searchsorted(downbeats, beats + _NEAR_BEATS, side="right") - 1
    returns = (bar >= 0) & (bar < len(earlier))
    returns[returns] = earlier[bar[returns]] >= 0
    before = beats[returns] - downbeats[bar[returns]] + downbeats[earlier[bar[returns]]]
    at = np.searchsorted(beats, before - _NEAR_BEATS)
    found[returns] = np.where(np.abs(beats[at] - before) < _NEAR_BEATS, at, -1)
    return found


def _along_phrases(alike: FloatArray) -> FloatArray:
    """Mean likeness of each pair of bars and of those before and after both."""
    bars = len(alike)
    total, count = np.zeros_like(alike), np.zeros_like(alike)
    for by in range(-AROUND_BARS, AROUND_BARS + 1):
        first, last = max(0, -by), bars - max(0, by)
        if last > first:
            total[first:last, first:last] += alike[first + by : last + by, first + by : last + by]
            count[first:last, first:last] += 1.0
    return np.asarray(total / np.maximum(count, 1.0))
