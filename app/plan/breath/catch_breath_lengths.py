"""Available time for a catch breath before each note of a part.

A catch breath uses the silence before the note and part of the previous note's tail. If that is too short, notes are
left out and the note before them is shortened, as players do in uninterrupted running notes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray, IntArray
from app.plan.breath.lungs import FULL_BREATH_S
from app.plan.music.piece import EPSILON, LineTimes, gaps_s

CATCH_MIN_S = 0.2
"""Shortest catch breath in seconds: a litre at 5 to 8 litres a second, the greatest inspiratory flow of
healthy adults.
"""
CATCH_MAX_S = 0.4
"""Longest catch breath in seconds; see `UNHURRIED_SHARE`."""
UNHURRIED_SHARE = 1.0 / 3.0
"""Greatest share of the previous note for which a catch breath may be as long as a full breath."""
CATCH_NOTE_SHARE = 0.5
"""Largest share of the note before it that a catch breath takes; see `LEAST_SOUNDING_S`."""
LEAST_SOUNDING_S = 1.0 / 24.0
"""Seconds of the previous note that still sound if `CATCH_NOTE_SHARE` would leave no time for a breath."""
LEAST_PLAYED_S = 0.01
"""Least seconds that may remain of a note that was played shorter than written."""
MOST_DROPPED = 2
"""Greatest number of notes omitted for one breath."""


@dataclass(frozen=True, eq=False)
class Room:
    """Time for a catch breath before each note, each array (N,); 0 where none is possible.

    Attributes
    ----------
    length_s : float64
        Length in seconds without leaving out a note.
    drop_s : float64
        Length in seconds if notes are left out; 0 where ``length_s`` is not.
    dropped : int64
        Number of notes before it that are left out.
    """

    length_s: FloatArray
    drop_s: FloatArray
    dropped: IntArray

    @property
    def lasts_s(self) -> FloatArray:
        """Length (N,) in seconds of a catch breath before each note, with or without notes left out."""
        return np.where(self.length_s > 0.0, self.length_s, self.drop_s)

    def with_marks(self, marked: Sequence[int], times: LineTimes) -> Room:
        """Apply breath marks of the score: before marked notes the breath may be as long as the previous note allows,
        however short, and notes around marks are not left out for other breaths.

        Parameters
        ----------
        times : LineTimes
            Times of the notes as they sound.
        """
        if not marked:
            return self
        before_s = np.append(0.0, times.duration_s[:-1])
        most_s = gaps_s(times) + np.maximum(before_s - LEAST_PLAYED_S, before_s / 2.0)
        length_s, at = self.length_s.copy(), np.array(marked)
        length_s[at] = np.where(length_s[at] > 0.0, length_s[at], np.minimum(most_s[at], CATCH_MIN_S))
        until = np.searchsorted(at, np.arange(len(length_s)))
        free = until == np.searchsorted(at, np.arange(len(length_s)) - self.dropped)
        return Room(length_s, np.where(free, self.drop_s, 0.0), self.dropped)

    def left_out(self, catches: Sequence[int]) -> tuple[int, ...]:
        """Return the indices of the notes that are dropped to make room for the given catch breaths."""
        dropping = [index for index in catches if self.length_s[index] == 0.0]
        return tuple(note for index in dropping for note in range(index - int(self.dropped[index]), index))

    def apart(self, catches: Sequence[int]) -> list[int]:
        """Drop catch breaths before notes that are themselves left out for the next catch breath."""
        gone = set(self.left_out(catches))
        return [index for index in catches if index not in gone]


def catch_lengths_s(score: LineTimes, times: LineTimes, rests: IntArray) -> FloatArray:
    """Longest catch breath (N,) in seconds before each note: the rest plus a part of the previous note.

    Parameters
    ----------
    score : LineTimes
        Times at the tempo of the score, which decide whether a breath is possible.
    times : LineTimes
        Times as they sound, which may leave less room.
    rests : (N,) int64
        Ticks of rest before each note; a silence without a rest is the end of a detached note.
    """
    length = np.minimum(_length_s(score, rests, LEAST_SOUNDING_S), _length_s(times, rests, LEAST_PLAYED_S))
    length[0] = 0.0
    unhurried_s = gaps_s(score) + UNHURRIED_SHARE * np.concatenate(([0.0], score.duration_s[:-1]))
    most_s = np.clip(unhurried_s, CATCH_MAX_S, FULL_BREATH_S)
    return np.where(length >= CATCH_MIN_S - EPSILON, np.minimum(length, most_s), 0.0)


def _length_s(times: LineTimes, rests: IntArray, least_s: float) -> FloatArray:
    gap = gaps_s(times)
    before = np.concatenate(([0.0], times.duration_s[:-1]))
    tail = np.maximum(CATCH_NOTE_SHARE * before, np.minimum(CATCH_MIN_S - gap, before - least_s))
    return np.asarray(np.where((gap >= CATCH_MIN_S) & (rests > 0), gap, gap + tail), dtype=np.float64)


def drop_lengths_s(score: LineTimes, times: LineTimes) -> tuple[FloatArray, IntArray]:
    """Longest catch breath before each note, in seconds, if some notes just before it are left out for it, and the
    number of notes that takes (as few as possible). The first note of a part is never left out.

    Parameters
    ----------
    score, times : LineTimes
        As of `catch_lengths_s`.

    Returns
    -------
    (N,) float64, (N,) int64
        Length in seconds and number of notes; 0 if even `MOST_DROPPED` notes give no breath.
    """
    count = len(times.onset_s)
    length_s, dropped = np.zeros(count), np.zeros(count, np.int64)
    for notes in range(MOST_DROPPED, 0, -1):
        if count <= notes + 1:
            continue
        written_s, _ = _left_out_s(score, notes)
        least_s, most_s = _left_out_s(times, notes)
        lasts_s = np.clip(written_s, least_s, most_s)
        enough = np.flatnonzero(np.minimum(written_s, lasts_s) >= CATCH_MIN_S - EPSILON)
        length_s[enough + notes + 1] = np.minimum(lasts_s[enough], CATCH_MAX_S)
        dropped[enough + notes + 1] = notes
    return length_s, dropped


def _left_out_s(times: LineTimes, notes: int) -> tuple[FloatArray, FloatArray]:
    """Usual and longest duration, each (N - notes - 1,), of a breath for which ``notes`` successive notes are left out,
    for each place in a part of N notes.
    """
    span_s = times.onset_s[notes + 1 :] - times.onset_s[1:-notes] + gaps_s(times)[1:-notes]
    before_s = times.duration_s[: -notes - 1]
    share_s = CATCH_NOTE_SHARE * before_s
    return span_s + share_s, span_s + np.maximum(share_s, np.minimum(CATCH_MIN_S, before_s - LEAST_PLAYED_S))
