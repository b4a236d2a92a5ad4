"""How long a catch breath before each note of a line may be."""

from __future__ import annotations

import numpy as np

from app.plan.line import IntArray, LineTimes
from app.plan.lungs import EPSILON
from app.plan.model import FloatArray

CATCH_MIN_S = 0.12
"""A gasp shorter than this brings no air."""
CATCH_MAX_S = 0.4
CATCH_NOTE_SHARE = 0.5
"""A catch breath takes at most this part of the note before it ..."""
CATCH_MOST_SHARE = 0.5
"""... unless that would be no gasp: out of a short note as much as a gasp needs, at most this part."""


def catch_lengths_s(times: LineTimes, rests: IntArray) -> FloatArray:
    """(N,): how long a catch breath before each note may be: the rest there, else also a part of the note before.

    Parameters
    ----------
    rests : (N,) int64
        Ticks of rest before each note; a silence without a rest is the end of a detached note.
    """
    gap = gaps_s(times)
    before = np.insert(times.duration_s[:-1], 0, 0.0)
    tail = np.maximum(CATCH_NOTE_SHARE * before, np.minimum(CATCH_MIN_S - gap, CATCH_MOST_SHARE * before))
    length = np.where((gap >= CATCH_MIN_S) & (rests > 0), gap, gap + tail)
    return np.asarray(np.minimum(length, CATCH_MAX_S), dtype=np.float64)


def drop_lengths_s(times: LineTimes) -> FloatArray:
    """(N,): how long a catch breath before each note may be that takes the place of the note before; 0 where it would
    be no gasp, or where the note before is the first."""
    step_s = np.diff(times.onset_s, prepend=times.onset_s[:1])
    step_s[:2] = 0.0
    return np.where(step_s >= CATCH_MIN_S - EPSILON, np.minimum(step_s, CATCH_MAX_S), 0.0)


def gaps_s(times: LineTimes) -> FloatArray:
    """(N,): the silence before each note; 0 before the first."""
    gap: FloatArray = np.maximum(times.onset_s - np.insert(times.played_end_s[:-1], 0, times.onset_s[0]), 0.0)
    return gap
