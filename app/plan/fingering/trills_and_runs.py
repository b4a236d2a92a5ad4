"""Detects figures with fingerings of their own: trills and tremolos, glissandi, chromatic runs, attacks.

Each function processes times and pitches of the whole part at once.
"""

from __future__ import annotations

import numpy as np

from app.arrays import BoolArray, IntArray, rows_of
from app.plan.music.piece import LineTimes

TRILL_S = 0.15
"""A trill or tremolo is at least `TRILL_NOTES` notes of at most this length that alternate between two pitches."""
TRILL_NOTES = 4
WIDEST_TRILL, WIDEST_TREMOLO = 2, 12
"""Widest interval of a trill and of a tremolo, in semitones."""
TREMOLO_S = 0.09
"""Longest step in seconds of a tremolo, which is wider than a trill; slower ones are figures of accompaniment."""
GLISSANDO_STEPS = 3
"""Least number of semitones of a glissando: in one direction, each within `TRILL_S`, without a gap."""
CHROMATIC_S = 0.3
"""Longest step in seconds of a chromatic run; slower ones leave time for the full fingering."""
TOUCHING_S = 0.01
"""Silence in seconds below which two notes are slurred."""
TOLERANCE = 1e-9


def _runs(steps: BoolArray, least: int) -> BoolArray:
    """Mask of the steps marked in ``steps`` that are in runs of at least ``least`` marked steps."""
    result = np.zeros(len(steps), dtype=bool)
    if len(steps) < least:
        return result
    begun: BoolArray = np.logical_and.reduce(rows_of(steps, least))
    for shift in range(least):
        result[shift : shift + len(begun)] |= begun
    return result


def trill_steps(times: LineTimes) -> BoolArray:
    """Mask (N-1,) of the steps from a note to the next that belong to a trill or tremolo."""
    count = len(times.pitch)
    result = np.zeros(max(count - 1, 0), dtype=bool)
    if count < TRILL_NOTES:
        return result
    interval = np.diff(times.pitch)
    width = np.abs(interval)
    longest_s = np.where(width <= WIDEST_TRILL, TRILL_S, TREMOLO_S)
    quick = (np.diff(times.onset_s) <= longest_s + TOLERANCE) & (width > 0) & (width <= WIDEST_TREMOLO)
    turns = _runs(quick[1:] & quick[:-1] & (interval[1:] == -interval[:-1]), TRILL_NOTES - 2)
    result[:-1] |= turns
    result[1:] |= turns
    return result


def glissando_steps(times: LineTimes) -> BoolArray:
    """Mask (N-1,) of the steps from a note to the next that belong to a glissando (see `GLISSANDO_STEPS`)."""
    interval = np.diff(times.pitch)
    quick = np.diff(times.onset_s) <= TRILL_S + TOLERANCE
    slurred = times.onset_s[1:] - times.played_end_s[:-1] < TOUCHING_S
    joined = quick & slurred
    return _runs(joined & (interval == 1), GLISSANDO_STEPS) | _runs(joined & (interval == -1), GLISSANDO_STEPS)


def chromatic_notes(times: LineTimes) -> BoolArray:
    """Mask (N,) of notes in chromatic runs: reached and left by semitones, for neighbours within `CHROMATIC_S`.

    One of these notes is the semitone below: fingerings for chromatic runs add a key to its fingering.
    """
    near = np.diff(times.onset_s) <= CHROMATIC_S + TOLERANCE
    interval = np.diff(times.pitch)
    semitone = np.abs(interval) == 1
    result = np.zeros(len(times.pitch), dtype=bool)
    result[:-1] |= near & (interval == -1)
    result[1:] |= near & (interval == 1)
    result[:-1] &= ~(near & ~semitone)
    result[1:] &= ~(near & ~semitone)
    return result


def attacked_notes(times: LineTimes, register: IntArray, trill: BoolArray) -> BoolArray:
    """Mask (N,) of notes whose attack needs a helping fingering: tongued, or slurred to from a lower register, outside
    trills.

    Parameters
    ----------
    register : (N,) int64
        Number of register breaks below each note.
    trill : (N-1,) bool
        Mask of steps within trills, from `trill_steps`.
    """
    result = np.ones(len(times.pitch), dtype=bool)
    tongued = ~times.slurs_next[:-1]
    result[1:] = (tongued | (register[1:] > register[:-1])) & ~trill
    return result
