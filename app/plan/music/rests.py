"""Finds rests among the silences between the notes of a part.

MIDI files have no rests: a note that ends early may be detached or followed by a rest. A silence of a beat is a rest,
and so is one that is long, or audible after a long note. Otherwise notes count as detached if they are in a run of
equal steps with equal gates, or if they sound for the same share of their step as most notes of the part.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray, rows_of
from app.plan.music.piece import EPSILON, LineTimes

AUDIBLE_S = 0.3
"""Silence in seconds that is a rest after a long note, regardless of the surrounding notes."""
LONG_NOTE_S = 0.8
"""Sounding time in seconds of a long note, which is never played staccato."""
SILENT_S = 0.75
"""Silence in seconds that is a rest after any note, longer than in any staccato."""
LEAST_BEATS = 0.1
"""Silence in felt beats below which a score has no rest, as before a grace note."""
SAME_STEP = 0.05
"""Greatest relative difference of the steps of a run, which are written equal."""
SAME_GATE = 0.12
"""Greatest difference of sounding shares (0..1) for notes of the same articulation."""
RUN_NOTES = 3
"""Number of consecutive notes that show an articulation; two may be notes with a rest each."""
SLOW_S = 0.5
"""Silence in seconds between notes from which a run needs `SLOW_RUN_NOTES`."""
SLOW_RUN_NOTES = 8
"""Number of notes in a run with long silences; fewer may have a rest each."""
HABIT_SHARE = 0.5
"""Least share of a line's notes with the same articulation for a habit."""
HABIT_NOTES = 6
"""Least number of notes for a habit."""
HABIT_GATE = 0.04
"""Difference of sounding shares within a habit, smaller than within the articulation of a run."""


class Rests(NamedTuple):
    """Rest before each note, arrays (N,); 0 where there is none.

    Attributes
    ----------
    sounding_tick : int64
        Length of the silence as it sounds, in ticks.
    written_tick : int64
        Notated length in ticks.
    lasts_s : float64
        Notated length in seconds, at the tempo of the score.
    """

    sounding_tick: IntArray
    written_tick: IntArray
    lasts_s: FloatArray


def rest_ticks(times: LineTimes, beat_ticks: IntArray) -> IntArray:
    """Length (N,) in ticks of the rest before each note; 0 where the silence is articulation.

    Parameters
    ----------
    times : LineTimes
        The part in notated timing, at the tempo of the score.
    beat_ticks : (N,) int64
        The felt beat at each note: a silence of a beat and more is always a rest.
    """
    rests = times.silence_tick.copy()
    if len(rests) > 1:
        gap = rests[1:]
        silence_s = times.onset_s[1:] - times.played_end_s[:-1]
        is_detached = _detached(times, silence_s) & ~are_certain(times, beat_ticks)[1:]
        gap[is_detached | (gap < LEAST_BEATS * beat_ticks[1:])] = 0
    return rests


def are_certain(times: LineTimes, beat_ticks: IntArray, released: float = 0.0) -> BoolArray:
    """Mask (N,) of silences that are rests in any articulation: they are audible as such (`are_audible`), or last a
    felt beat.
    """
    return are_audible(times, released) | np.concatenate(([False], times.silence_tick[1:] >= beat_ticks[1:]))


def are_audible(times: LineTimes, released: float = 0.0) -> BoolArray:
    """Mask (N,) of silences that are rests by their length in seconds alone.

    Parameters
    ----------
    released : 0..1
        Share of the time to the next onset by which notes of the part are released early; a shorter silence is no rest
        even after a long note.
    """
    silence_s = times.onset_s[1:] - times.played_end_s[:-1]
    audible = (times.duration_s[:-1] >= LONG_NOTE_S - EPSILON) & (silence_s >= AUDIBLE_S - EPSILON)
    audible &= silence_s >= released * np.diff(times.onset_s)
    return np.concatenate(([False], audible | (silence_s >= SILENT_S - EPSILON)))


def _detached(times: LineTimes, silence_s: FloatArray) -> BoolArray:
    """Mask (N-1,) of the silences between notes that are due to detached articulation and so are not rests."""
    steps = np.maximum(np.diff(times.onset_tick), 1).astype(np.float64)
    gates = 1.0 - times.silence_tick[1:] / steps
    silent = times.silence_tick[1:] > 0
    in_a_run = _in_a_run(steps, gates, RUN_NOTES)
    slow = silence_s >= SLOW_S - EPSILON
    if slow.any():
        in_a_run = np.where(slow, _in_a_run(steps, gates, SLOW_RUN_NOTES), in_a_run)
    return np.asarray(silent & (in_a_run | (np.abs(gates - _habit(gates, silent)) < HABIT_GATE)))


def _in_a_run(steps: FloatArray, gates: FloatArray, notes: int) -> BoolArray:
    """Mask (N-1,) of notes in a run of at least ``notes`` notes with equal time to the next onset and equal share of
    sound in it.
    """
    result = np.zeros(len(steps), dtype=bool)
    count = len(steps) - notes + 1
    if count > 0:
        (shortest, longest), (low, high) = (
            (rows.min(axis=0), rows.max(axis=0)) for rows in (rows_of(column, notes) for column in (steps, gates))
        )
        alike = (longest - shortest < SAME_STEP * shortest) & (high - low < SAME_GATE)
        for place in range(notes):
            result[place : place + count] |= alike
    return result


def _habit(gates: FloatArray, silent: BoolArray) -> float:
    """Share of the time to the next onset for which most notes of a part sound; NaN if notes vary too much."""
    counts = np.bincount(np.round(gates[silent] / HABIT_GATE).astype(np.int64), minlength=1)
    usual = float(np.argmax(counts)) * HABIT_GATE
    near = silent & (np.abs(gates - usual) < HABIT_GATE)
    enough = max(HABIT_SHARE * len(gates), HABIT_NOTES)
    return float(np.mean(gates[near])) if np.count_nonzero(near) >= enough else np.nan
