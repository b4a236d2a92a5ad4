"""Which silences between the notes of a line are rests of the score.

A MIDI file has no rests: a note that stops early may be followed by one, or may be played detached. Notes that follow
one another in equal steps and all sound for the same part of them are articulated so; and so is every note that
sounds for the part of its step that most notes of the line do.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from app.plan.line import IntArray, LineTimes
from app.plan.model import FloatArray

BoolArray = npt.NDArray[np.bool_]

SAME_STEP = 0.12
"""Steps that differ by less of their length are played as equal ones."""
SAME_GATE = 0.12
"""Parts of the step that sound (0..1) which differ by less are the same articulation."""
RUN_NOTES = 3
"""So many notes in a row show an articulation; a pair may be two notes with a rest each."""
HABIT_SHARE = 0.5
"""What at least this part of a line's notes do is its habit ..."""
HABIT_GATE = 0.04
"""... which is kept more closely than a run's articulation."""


def rest_ticks(times: LineTimes, beat_ticks: IntArray) -> IntArray:
    """(N,): how long a rest of the score comes before each note, ticks; 0 where the silence is articulation.

    Parameters
    ----------
    beat_ticks : (N,) int64
        The felt beat at each note: a silence of a beat and more is always a rest.
    """
    rests = times.silence_tick.copy()
    if len(rests) > 1:
        gap = rests[1:]
        gap[_detached(times) & (gap < beat_ticks[1:])] = 0
    return rests


def _detached(times: LineTimes) -> BoolArray:
    """(N-1,): whether the silence after each note but the last is its articulation."""
    steps = np.maximum(np.diff(times.onset_tick), 1).astype(np.float64)
    gates = 1.0 - times.silence_tick[1:] / steps
    silent = times.silence_tick[1:] > 0
    return silent & (_in_a_run(steps, gates) | (np.abs(gates - _habit(gates, silent)) < HABIT_GATE))


def _in_a_run(steps: FloatArray, gates: FloatArray) -> BoolArray:
    """(N-1,): whether a note stands in a run of equal steps with equal gates."""
    result = np.zeros(len(steps), dtype=bool)
    if len(steps) >= RUN_NOTES:
        alike = np.abs(np.diff(steps)) < SAME_STEP * np.minimum(steps[1:], steps[:-1])
        alike &= np.abs(np.diff(gates)) < SAME_GATE
        runs = np.all(np.lib.stride_tricks.sliding_window_view(alike, RUN_NOTES - 1), axis=1, keepdims=True)[:, 0]
        for place in range(RUN_NOTES):
            result[place : place + len(runs)] |= runs
    return result


def _habit(gates: FloatArray, silent: BoolArray) -> float:
    """The part of their steps that most notes of a line sound for; nan where there is no such habit."""
    counts = np.bincount(np.round(gates[silent] / HABIT_GATE).astype(np.int64), minlength=1)
    usual = float(np.argmax(counts)) * HABIT_GATE
    near = silent & (np.abs(gates - usual) < HABIT_GATE)
    return float(np.mean(gates[near])) if np.count_nonzero(near) >= max(HABIT_SHARE * len(gates), RUN_NOTES) else np.nan
