"""Beats of music played without a metronome: a tempo map that follows the player.

The beats are found by dynamic programming over an onset envelope (Ellis, 2007, "Beat tracking by dynamic programming",
Journal of New Music Research 36).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.errors import AppError
from app.score.tempo import TempoChange, TempoMap

_RATE_HZ: Final = 200
"""Rate in Hz of the envelope: 5 ms, finer than the precision of beats."""
_SPREAD_S: Final = 0.02
_LEAST_NOTES: Final = 8
TIGHTNESS: Final = 60.0
"""Cost of differences between consecutive beats; the usual value of 100 is for bands that keep time."""
_SMOOTHED: Final = 32
"""Standard deviation of the Gaussian that smooths the envelope, as the denominator of a fraction of a beat (Ellis)."""
_SLOWEST_US, _FASTEST_US = 2_000_000.0, 200_000.0


def find_beats(onsets_s: FloatArray, ends_s: FloatArray, start_bpm: float = 100.0) -> FloatArray:
    """Find the times of the beats in music played freely.

    Parameters
    ----------
    onsets_s, ends_s : float64, shape (n,)
        Start and end of each note in seconds. Longer notes begin on beats more often.
    start_bpm : float
        Likely tempo; decides between a beat and one twice as fast or slow.

    Returns
    -------
    float64, shape (beats,)
        Times of the beats, ascending; the first is at or before the first note, the last at or after the last note.

    Raises
    ------
    AppError
        There are too few notes to find a beat.
    """
    if len(onsets_s) < _LEAST_NOTES:
        raise AppError("take.too_few_notes", count=len(onsets_s), least=_LEAST_NOTES)
    first_s = float(onsets_s[0]) - 1.0
    envelope = np.zeros(int(np.ceil((float(onsets_s[-1]) - first_s + 2.0) * _RATE_HZ)))
    times_s = first_s + np.arange(len(envelope)) / _RATE_HZ
    for onset_s, end_s in zip(onsets_s.tolist(), ends_s.tolist(), strict=True):
        weight = 0.5 + min(max(end_s - onset_s, 0.0), 1.0)
        low, high = np.searchsorted(times_s, [onset_s - 4 * _SPREAD_S, onset_s + 4 * _SPREAD_S])
        envelope[low:high] += weight * np.exp(-0.5 * ((times_s[low:high] - onset_s) / _SPREAD_S) ** 2)
    frames = _tracked(envelope, 60.0 * _RATE_HZ / _likely_bpm(envelope, start_bpm))
    beats = _settled(times_s[frames], onsets_s)
    if len(beats) < 2:
        raise AppError("take.no_beats")
    return _covering(beats, float(onsets_s[0]), float(onsets_s[-1]))


def _tracked(envelope: FloatArray, period: float) -> IndexArray:
    """Choose the frames of the beats: the path through the envelope with the greatest sum whose distances stay near
    ``period`` frames.
    """
    reach = round(period)
    kernel = np.exp(-0.5 * (np.arange(-(reach // 4), reach // 4 + 1) * _SMOOTHED / period) ** 2)
    strength = np.convolve(envelope / envelope.std(), kernel, "same")
    # Beats are at least half a period apart, so a block of that many frames has all its predecessors before it.
    least, most = max(reach // 2, 1), 2 * reach
    lags = np.arange(most, least - 1, -1)
    cost = TIGHTNESS * np.log(lags / period) ** 2
    score = np.concatenate([np.zeros(most), strength])
    before = np.full(len(score), -1)
    for first in range(most, len(score), least):
        last = min(first + least, len(score))
        ways = np.lib.stride_tricks.sliding_window_view(score[first - most : last - least], len(lags)) - cost
        best = ways.argmax(axis=1)
        gain = ways[np.arange(last - first), best]
        # If no predecessor has a positive score, the beat is the first one.
        score[first:last] += np.maximum(gain, 0.0)
        before[first:last] = np.where(gain > 0.0, np.arange(first, last) - lags[best], -1)
    beats = [len(score) - 2 * reach + int(score[-2 * reach :].argmax())]
    while before[beats[-1]] >= most:
        beats.append(int(before[beats[-1]]))
    return np.array(beats[::-1]) - most


def _likely_bpm(envelope: FloatArray, start_bpm: float) -> float:
    """Tempo with the highest autocorrelation of the envelope; a log-normal prior around ``start_bpm`` has a standard
    deviation of an octave.
    """
    import scipy.fft  # slow to import and used only here

    size = scipy.fft.next_fast_len(2 * len(envelope), real=True)
    alike = scipy.fft.irfft(np.abs(scipy.fft.rfft(envelope, size)) ** 2, size)
    lags = np.arange(round(_FASTEST_US * _RATE_HZ / 1e6), min(round(_SLOWEST_US * _RATE_HZ / 1e6), len(envelope)))
    bpm = 60.0 * _RATE_HZ / lags
    likely = np.log1p(1e6 * np.maximum(alike[lags] / alike[0], 0.0)) - 0.5 * np.log2(bpm / start_bpm) ** 2
    return float(bpm[np.argmax(likely)])


def tempo_of_beats(beats_s: FloatArray, ticks_per_quarter: int) -> TempoMap:
    """Create a tempo map in which every beat is a quarter; the first beat is at tick 0 and second 0.

    A bar line cannot be found in onsets alone: the first beat begins one.
    """
    lengths_us = np.clip(np.diff(beats_s) * 1e6, _FASTEST_US, _SLOWEST_US)
    changes = [TempoChange(index * ticks_per_quarter, float(length)) for index, length in enumerate(lengths_us)]
    return TempoMap.of_changes(ticks_per_quarter, changes)


def _settled(beats_s: FloatArray, onsets_s: FloatArray) -> FloatArray:
    """Move each beat (N,) in seconds to the nearest note onset, if one is close, since the envelope in which beats were
    found has a coarser time grid than the onsets.
    """
    if not len(beats_s):
        return beats_s
    after = np.clip(np.searchsorted(onsets_s, beats_s), 1, len(onsets_s) - 1)
    nearest = np.where(
        np.abs(onsets_s[after] - beats_s) < np.abs(onsets_s[after - 1] - beats_s), onsets_s[after], onsets_s[after - 1]
    )
    return np.where(np.abs(nearest - beats_s) <= 2 * _SPREAD_S, nearest, beats_s)


def _covering(beats_s: FloatArray, first_s: float, last_s: float) -> FloatArray:
    """Add beats before the first and after the last of ``beats_s`` (N,) until they cover the span from the first note
    to the last, at the distance of the nearest beats.
    """
    inside = beats_s[(beats_s > first_s - 2 * _SPREAD_S) & (beats_s < last_s + 2 * _SPREAD_S)]
    beats_s = inside if len(inside) >= 2 else beats_s
    lead, tail = beats_s[1] - beats_s[0], beats_s[-1] - beats_s[-2]
    before = max(int(np.ceil((beats_s[0] - first_s) / lead - 1e-6)), 0)
    after = max(int(np.ceil((last_s - beats_s[-1]) / tail - 1e-6)), 0)
    start = beats_s[0] - lead * np.arange(before, 0, -1)
    end = beats_s[-1] + tail * np.arange(1, after + 1)
    return np.concatenate([start, beats_s, end])
