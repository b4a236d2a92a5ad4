"""How long a catch breath before each note of a line may be.

It is taken in the silence there, and out of the tail of the note before; where that is too little, notes are left out
for it, and the one before them is shortened: as players do in running notes that nothing interrupts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.plan.line import IntArray, LineTimes
from app.plan.lungs import EPSILON
from app.plan.model import FloatArray

CATCH_MIN_S = 0.2
"""A shorter gasp is no breath: a litre at 5 to 8 litres a second, the most that healthy adults breathe in with."""
CATCH_MAX_S = 0.4
CATCH_NOTE_SHARE = 0.5
"""A catch breath takes at most this part of the note before it ..."""
LEAST_SOUNDING_S = 1.0 / 24.0
"""... unless that would be no breath: then as much as one needs, but for the shortest staccato."""
MOST_DROPPED = 2
"""Notes that may be left out for one breath."""


@dataclass(frozen=True, eq=False)
class Room:
    """What a catch breath before each note may be, each (N,); 0 where there is none.

    Attributes
    ----------
    length_s : float64
        How long it is, with every note begun.
    drop_s : float64
        How long it is where notes are left out for it; only where there is no other.
    dropped : int64
        How many notes before it are left out.
    """

    length_s: FloatArray
    drop_s: FloatArray
    dropped: IntArray

    @property
    def lasts_s(self) -> FloatArray:
        """(N,): how long it is, of the one kind or the other."""
        return np.where(self.length_s > 0.0, self.length_s, self.drop_s)


def catch_lengths_s(times: LineTimes, rests: IntArray) -> FloatArray:
    """(N,): how long a catch breath before each note may be: the rest there, else also a part of the note before.

    Parameters
    ----------
    rests : (N,) int64
        Ticks of rest before each note; a silence without a rest is the end of a detached note.
    """
    gap = gaps_s(times)
    before = np.insert(times.duration_s[:-1], 0, 0.0)
    tail = np.maximum(CATCH_NOTE_SHARE * before, np.minimum(CATCH_MIN_S - gap, before - LEAST_SOUNDING_S))
    length = np.where((gap >= CATCH_MIN_S) & (rests > 0), gap, gap + tail)
    length[0] = 0.0
    return np.where(length >= CATCH_MIN_S - EPSILON, np.minimum(length, CATCH_MAX_S), 0.0)


def drop_lengths_s(times: LineTimes) -> tuple[FloatArray, IntArray]:
    """How long a catch breath before each note may be that takes the place of the notes before, and of how many: as
    few as will do. The first note of a line is never left out.

    Returns
    -------
    (N,) float64, (N,) int64
        0 where `MOST_DROPPED` notes give no breath either.
    """
    count = len(times.onset_s)
    length_s, dropped = np.zeros(count), np.zeros(count, np.int64)
    gap = gaps_s(times)
    for notes in range(MOST_DROPPED, 0, -1):
        if count <= notes + 1:
            continue
        span_s = times.onset_s[notes + 1 :] - times.onset_s[1:-notes]
        span_s = span_s + gap[1:-notes] + CATCH_NOTE_SHARE * times.duration_s[: -notes - 1]
        enough = np.flatnonzero(span_s >= CATCH_MIN_S - EPSILON)
        length_s[enough + notes + 1] = np.minimum(span_s[enough], CATCH_MAX_S)
        dropped[enough + notes + 1] = notes
    return length_s, dropped


def gaps_s(times: LineTimes) -> FloatArray:
    """(N,): the silence before each note; 0 before the first."""
    gap: FloatArray = np.maximum(times.onset_s - np.insert(times.played_end_s[:-1], 0, times.onset_s[0]), 0.0)
    return gap
