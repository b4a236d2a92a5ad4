"""Onsets of single notes in a recording, found by the rise of partials that no other note has.

A note is searched for near the time of its beat. It stays there if the result is uncertain: if its partials rise
little, at several moments alike, or sound in another part already.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.audio.features import Sound, tuning
from app.audio.score_sound import ANALYSIS_RATE_HZ, analysis_sound
from app.audio.track import Samples
from app.errors import Progress
from app.score.model import Score

_HOP: Final = 110
_STEP_S: Final = _HOP / ANALYSIS_RATE_HZ
_SIZE: Final = 2048
_PARTIALS: Final = 6
_REACH_S: Final = 0.09
"""Distance in seconds from the time by the beat within which an onset is searched for."""
_EDGE_S: Final = 0.03
"""Length in seconds of the sound after a moment that is compared with the sound before it."""
_USUAL_S: Final = 0.05
"""Standard deviation in seconds of the expected time."""
_LEAST_RISE: Final = 1.5
"""Natural logarithm of the least increase of partials at a clear onset."""
_UNIQUE: Final = 0.75
"""A second moment must rise by less than this share of the best one."""
_BESIDE_S: Final = 0.12
"""Notes closer than this time in seconds share partials."""
_APART: Final = 0.9
"""Least distance in semitones of different partials."""
_LEAST_PARTIALS: Final = 2
_LEAST_NOTES: Final = 8
"""Least number of notes of a part needed to estimate its instrument's onset delay."""


def note_onsets(
    samples: Samples, rate_hz: int, score: Score, offset_s: float, progress: Progress = lambda share: None
) -> dict[str, float]:
    """Find the delay in seconds of single notes of a recording against the score, by note id; notes without a clear
    onset are omitted.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        Samples of the recording.
    score : Score
        Score aligned with the recording.
    offset_s : float
        Second of the score at which the samples begin.
    progress : callable
        Called regularly with the completed share 0..1.
    """
    sound = analysis_sound(samples, rate_hz)
    middle = len(sound) // 2
    tuned = tuning(sound[max(middle - 30 * ANALYSIS_RATE_HZ, 0) : middle + 30 * ANALYSIS_RATE_HZ], ANALYSIS_RATE_HZ)
    notes = [note for part in score.parts for note in part.notes]
    begin_s = score.tempo_map.seconds(np.array([note.onset_tick for note in notes], np.float64)) - offset_s
    end_s = score.tempo_map.seconds(np.array([note.end_tick for note in notes], np.float64)) - offset_s
    pitches = np.array([note.pitch for note in notes], np.float64) + tuned
    floor = 1e-5 * float(np.square(sound, dtype=np.float64).mean()) * _SIZE**2 + 1e-12
    shifts: dict[str, float] = {}
    for index, note in enumerate(notes):
        if index % 100 == 0:
            progress(index / len(notes))
        at_s = float(begin_s[index])
        beside = (begin_s < at_s + _BESIDE_S) & (end_s > at_s - _BESIDE_S)
        beside[index] = False
        hz = _own_partials(float(pitches[index]), pitches[beside])
        shift_s = _shift(sound, at_s, hz, floor) if len(hz) >= _LEAST_PARTIALS else None
        if shift_s is not None:
            shifts[note.id] = shift_s
    return _without_lateness(score, shifts)


def _own_partials(pitch: float, others: FloatArray) -> FloatArray:
    """Frequencies (K,) in Hz of the partials of a note that none of the other sounding notes shares."""
    numbers = np.arange(1, _PARTIALS + 1)
    own = pitch + 12.0 * np.log2(numbers)
    theirs = others[:, None] + 12.0 * np.log2(np.arange(1, 2 * _PARTIALS + 1))
    apart = np.abs(own[:, None] - theirs.ravel()).min(axis=1) if theirs.size else np.full(len(own), np.inf)
    hz: FloatArray = 440.0 * 2.0 ** ((own[apart > _APART] - 69.0) / 12.0)
    return hz[hz < 0.45 * ANALYSIS_RATE_HZ]


def _without_lateness(score: Score, shifts: dict[str, float]) -> dict[str, float]:
    """Subtract from the shift of each note, seconds by note id, the median shift of its part, so that a player who is
    always late stays in place."""
    result = {}
    for part in score.parts:
        own = {note.id: shifts[note.id] for note in part.notes if note.id in shifts}
        if len(own) >= _LEAST_NOTES:
            common_s = float(np.median([*own.values()]))
            result.update({id: shift_s - common_s for id, shift_s in own.items()})
    return result


def _shift(sound: Sound, at_s: float, hz: FloatArray, floor: float) -> float | None:
    """Find the time, relative to the moment ``at_s``, at which the frequencies ``hz`` begin to sound; None if it is
    unclear.
    """
    reach = round((_REACH_S + 2 * _EDGE_S) / _STEP_S)
    centre = round(at_s * ANALYSIS_RATE_HZ)
    first = centre - reach * _HOP - _SIZE // 2
    last = centre + reach * _HOP + _SIZE // 2
    if first < 0 or last > len(sound):
        return None
    # Short windows for high notes, longer ones where partials lie close.
    size = int(np.clip(4.0 * ANALYSIS_RATE_HZ / hz[0], 256, _SIZE))
    starts = centre + _HOP * np.arange(-reach, reach + 1) - size // 2
    frames = np.lib.stride_tricks.sliding_window_view(sound, size)[starts] * np.hanning(size)
    waves = np.exp(-2j * np.pi * np.outer(np.arange(size), hz) / ANALYSIS_RATE_HZ)
    power = np.abs(frames @ waves) ** 2 * (_SIZE / size) ** 2
    rise = _rise(np.log(power + floor))
    shifts = _STEP_S * np.arange(-reach, reach + 1)
    likely = np.where(np.abs(shifts) <= _REACH_S, rise * np.exp(-0.5 * (shifts / _USUAL_S) ** 2), 0.0)
    best = int(likely.argmax())
    other = np.where(np.abs(shifts - shifts[best]) > 1.2 * _EDGE_S, likely, 0.0).max()
    if rise[best] < _LEAST_RISE or other > _UNIQUE * likely[best]:
        return None
    return float(shifts[best])


def _rise(level: FloatArray) -> FloatArray:
    """Return the increase (n,) from just before to just after each frame, averaged over the columns."""
    width = max(round(_EDGE_S / _STEP_S), 1)
    sums = np.concatenate((np.zeros((1, level.shape[1])), np.cumsum(level, axis=0)))
    mean = (sums[width:] - sums[:-width]) / width
    result = np.zeros(len(level))
    result[width : len(mean)] = (mean[width:] - mean[:-width]).clip(-1.0, 4.0).mean(axis=1)
    return result
