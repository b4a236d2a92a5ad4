"""Removal of unintended notes from a recorded take.

A wind controller sends a note for every change of fingers and breath: a short wrong note when a finger is late, a
repeated note when a key bounces, an inaudible note while the breath fades. Legato notes overlap. Excluded notes are
returned with the reason, so that the editor can show them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Final, Literal, TypeAlias

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.score.take import Cleaning, Controlled, Played, Take

Fault: TypeAlias = Literal["", "ghost", "silent", "slip", "double"]
"""Reason for excluding a note: short and soft (ghost), no audible breath (silent), a late finger or octave key (slip),
struck twice (double); empty for a note that is kept.
"""

SILENT_SHARE: Final = 0.4
"""Hysteresis of audibility: a note whose breath stays below this share of `Cleaning.ghost_loudness` is inaudible
regardless of its length; one that exceeds `ghost_loudness` is audible, however short.
"""
_FLICKER_VELOCITY: Final = 10
"""Velocity up to which a note without audible breath is unintentional; see `_ALIVE_S` for louder ones."""
_ALIVE_S: Final = 3.0
"""Seconds around a note without audible breath within which a louder note is unintentional too."""
_TOUCHING_S: Final = 0.012
"""Gap in seconds below which notes are legato."""
_OCTAVES: Final = (12, 24)
_OCTAVE_SLIP_S: Final = 0.13
"""Longest slip of the octave keys, in seconds; see `_BESIDE_SLIP`."""
_BESIDE_SLIP: Final = 1.8
"""Factor by which the notes before and after a slip are longer than it; notes of similar lengths are a figure."""
_PULSE_NOTES: Final = 8
"""Number of notes before and after a note whose median time between onsets is the pulse; unknown with fewer
than three.
"""
_PULSES: Final = (0.25, 0.5, 1.0, 2.0, 3.0, 4.0)
"""Multiples of the pulse by which onsets are separated."""
_ON_TIME: Final = 0.1
"""Logarithm of the factor by which a note must be closer to the pulse than the ornament before it."""
_RESTRUCK_S: Final = 0.06
"""Gap in seconds below which a repeated note was not struck again if the breath continues; tonguing would have
interrupted the breath.
"""
_GOES_ON: Final = 0.7
"""Share of the breath before and after a gap above which the breath continues."""
_STROKE_VELOCITY, _LIKE_BREATH = 10, 0.15
"""Change of velocity from which a note was struck again, and relative change of the breath above which the velocity is
attributed to the breath, which many controllers send as velocity.
"""
_STROKES, _STEADY = 3, 0.15
"""Least number of strokes of one pitch in equal steps, and relative difference of equal steps, for intentional
repetition.
"""
_DETACHED: Final = 0.5
"""Share of the changes of pitch within a breath with a gap, from which the player separates notes without breathing;
see `_LEAST_CHANGES`.
"""
_LEAST_CHANGES: Final = 4
"""Least number of changes of pitch for `_DETACHED` to apply."""
_AROUND_S: Final = (0.15, 0.02)
"""Start and end, in seconds before and after a moment, of the two windows in which the breath is compared."""
_TRILL_S, _TRILL_SEMITONES, _TRILL_NOTES = 0.16, 4, 5
"""Longest note in seconds, widest interval in semitones and least number of alternating notes of a trill."""


@dataclass(frozen=True, eq=False)
class Cleaned:
    """Result of cleaning a take; every array is as long as the take's notes.

    Attributes
    ----------
    onsets_s, ends_s : float64
        Corrected times of kept notes; times as played of excluded ones.
    pitches, velocities : int64
        Pitch and velocity of each note.
    """

    onsets_s: FloatArray
    ends_s: FloatArray
    pitches: IntArray
    velocities: IntArray
    faults: tuple[Fault, ...]

    @property
    def kept(self) -> list[int]:
        """Indices of the notes that were not removed."""
        return [index for index, fault in enumerate(self.faults) if not fault]


def cleaned(take: Take) -> Cleaned:
    """Clean the notes of a take by the take's settings; cached."""
    return clean_notes(take.played, take.cleaning)


@lru_cache(maxsize=64)
def clean_notes(notes: Played, cleaning: Cleaning) -> Cleaned:
    """Clean notes of a take or of an imported track by the given settings."""
    onsets, ends = notes.onsets_s.copy(), notes.ends_s.copy()
    sent = _is_sent(notes, cleaning)
    loudness = np.where(sent, loudest(notes), notes.velocities / 127.0)
    trills = _trills(notes)
    faults: list[Fault] = [""] * len(notes)
    # Inaudible notes are removed first; the other faults are those of the remaining notes.
    audible = []
    for index in range(len(notes)):
        if cleaning.ghost_s and sent[index] and loudness[index] < SILENT_SHARE * cleaning.ghost_loudness:
            faults[index] = "silent"
        elif ends[index] - onsets[index] < cleaning.ghost_s and loudness[index] < cleaning.ghost_loudness:
            faults[index] = "ghost"
        else:
            audible.append(index)
    struck = _struck_again(audible, notes)
    held = -1
    for place, index in enumerate(audible):
        following = audible[place + 1] if place + 1 < len(audible) else -1
        if held >= 0 and not struck[index] and _is_double(held, index, onsets, ends, notes, cleaning):
            faults[index] = "double"
            ends[held] = max(ends[held], ends[index])
        elif held < 0 or following < 0 or not cleaning.ghost_s or trills[index]:
            held = index
        elif _is_octave_slip(held, index, following, onsets, ends, notes) and (
            notes.pitches[following] == notes.pitches[held] or not _is_before_its_note(held, place, audible, onsets)
        ):
            faults[index] = "slip"
            if notes.pitches[following] != notes.pitches[held]:
                # The fingers were in place: the intended note began with the slip.
                onsets[following] = onsets[index]
                ends[held] = max(ends[held], onsets[index])
            else:
                ends[held] = max(ends[held], onsets[following])
        elif ends[index] - onsets[index] < cleaning.ghost_s and _touches(held, index, following, onsets, ends):
            # The previous note is extended to the intended one.
            faults[index] = "slip"
            ends[held] = max(ends[held], onsets[following])
        else:
            held = index
    kept = [index for index, fault in enumerate(faults) if not fault]
    for index, following in pairwise(kept):
        ends[index] = min(ends[index], onsets[following] + cleaning.overlap_s)
    out = np.array([bool(fault) for fault in faults], bool)
    onsets[out], ends[out] = notes.onsets_s[out], notes.ends_s[out]
    return Cleaned(onsets, ends, notes.pitches, notes.velocities, tuple(faults))


def _is_sent(notes: Played, cleaning: Cleaning) -> BoolArray:
    """Mask (N,) of notes that the player meant to sound: the breath was up around them, or their velocity is so low
    that it follows the breath itself. False for notes without breath whose velocity is high all the same.
    """
    breath = notes.curves.get("breath")
    if breath is None:
        return np.zeros(len(notes), bool)
    around = highest(breath, notes.onsets_s - _ALIVE_S, notes.ends_s + _ALIVE_S)
    audible = around >= SILENT_SHARE * cleaning.ghost_loudness
    return np.asarray(audible | (notes.velocities <= _FLICKER_VELOCITY))


def _trills(notes: Played) -> BoolArray:
    """Mask (N,) of the notes that belong to a trill."""
    found = np.zeros(len(notes), bool)
    if len(notes) < _TRILL_NOTES:
        return found
    pitches, lasts_s = notes.pitches, np.diff(notes.onsets_s)
    steps = np.abs(np.diff(pitches))
    # From each note to the one after the next.
    turns = (pitches[2:] == pitches[:-2]) & (steps[:-1] > 0) & (steps[:-1] <= _TRILL_SEMITONES)
    turns &= lasts_s[1:] <= _TRILL_S
    first = 0
    for place in range(len(turns) + 1):
        if place == len(turns) or not turns[place]:
            if place - first + 2 >= _TRILL_NOTES:
                found[first : place + 2] = True
            first = place + 1
    return found


def loudest(notes: Played) -> FloatArray:
    """Return the loudness (N,) of each note, 0..1: its highest breath value; without breath data its velocity."""
    breath = notes.curves.get("breath")
    if breath is None:
        return notes.velocities / 127.0
    return highest(breath, notes.onsets_s, notes.ends_s)


def highest(curve: Controlled, starts_s: FloatArray, ends_s: FloatArray) -> FloatArray:
    """Highest value (N,) of a controller within each span from ``starts_s`` to ``ends_s``, both ends included."""
    values = np.concatenate(([0.0], curve.values, [0.0]))
    first = np.searchsorted(curve.times_s, starts_s, side="right")
    last = np.maximum(np.searchsorted(curve.times_s, ends_s, side="right"), first) + 1
    # Pairs of bounds: reduceat's results between the end of a pair and the next beginning are dropped.
    bounds = np.stack([first, last], axis=1).ravel()
    peaks: FloatArray = np.maximum.reduceat(values, bounds)[::2] if len(bounds) else np.empty(0)
    return peaks


def _is_double(
    held: int,
    index: int,
    onsets: FloatArray,
    ends: FloatArray,
    notes: Played,
    cleaning: Cleaning,
) -> bool:
    if notes.pitches[held] != notes.pitches[index] or not cleaning.double_s:
        return False
    silence_s = max(onsets[index] - ends[held], 0.0)
    if silence_s <= _RESTRUCK_S and _goes_on(notes, ends[held], onsets[index]):
        return True
    again_s = min(onsets[index] - onsets[held], silence_s)
    # Two tongue strokes leave longer notes than a key that bounces.
    bounced = (
        ends[index] - onsets[index] < 2 * cleaning.double_s or onsets[index] - onsets[held] < 2 * cleaning.double_s
    )
    return bool(again_s < cleaning.double_s and bounced)


def _goes_on(notes: Played, end_s: float, onset_s: float) -> bool:
    """Return whether the take has breath data and the breath does not stop from ``end_s``, the end of one note, to
    ``onset_s``, the onset of the next.
    """
    breath = notes.curves.get("breath")
    if breath is None or not len(breath.times_s):
        return False
    first_s, last_s = min(end_s, onset_s) - _AROUND_S[1], max(end_s, onset_s) + _AROUND_S[1]
    inside = breath.values[(breath.times_s > first_s) & (breath.times_s < last_s)]
    least = min([*inside.tolist(), *breath.at(np.array([first_s, last_s])).tolist()])
    before, after = (
        float(breath.at(np.linspace(start_s, stop_s, 8)).max())
        for start_s, stop_s in ((first_s - _AROUND_S[0], first_s), (last_s, last_s + _AROUND_S[0]))
    )
    # Breath that only rises or falls slowly continues too.
    return bool(least > 0.0 and least >= _GOES_ON * min(before, after))


def _is_octave_slip(
    held: int,
    index: int,
    following: int,
    onsets: FloatArray,
    ends: FloatArray,
    notes: Played,
) -> bool:
    """Return whether note ``index`` comes from a slipped octave key: it is one or two octaves from the note
    ``following``, and short between the long legato notes ``held`` and ``following``.
    """
    lasts_s = ends[index] - onsets[index]
    beside_s = min(ends[held] - onsets[held], ends[following] - onsets[following])
    if lasts_s > _OCTAVE_SLIP_S or beside_s < _BESIDE_SLIP * lasts_s:
        return False
    if not _octave(notes, index, following):
        return False
    breathes = "breath" not in notes.curves or _goes_on(notes, onsets[index], ends[index])
    return breathes and _touches(held, index, following, onsets, ends)


def _is_before_its_note(held: int, place: int, audible: list[int], onsets: FloatArray) -> bool:
    """Return whether a short note is a grace note: then the note after it is on the local pulse. If the short note
    itself is on the pulse, it is a slipped octave key.
    """
    index, following = audible[place], audible[place + 1]
    around = onsets[audible[max(place - _PULSE_NOTES, 0) : place]], onsets[audible[place + 1 :][: _PULSE_NOTES + 1]]
    apart_s = np.concatenate([np.diff(some) for some in around])
    apart_s = apart_s[apart_s > _OCTAVE_SLIP_S]
    if len(apart_s) < 3:
        return False
    pulse_s = float(np.median(apart_s))
    after = [float(onsets[audible[place + 2]])] if place + 2 < len(audible) else []

    def off(onset_s: float) -> float:
        steps_s = [onset_s - float(onsets[held]), *(next_s - onset_s for next_s in after)]
        return sum(min(abs(math.log(max(step_s, 1e-3) / (pulse_s * one))) for one in _PULSES) for step_s in steps_s)

    return off(float(onsets[following])) + _ON_TIME < off(float(onsets[index]))


def _struck_again(audible: list[int], notes: Played) -> BoolArray:
    """Mask (N,) of notes that repeat the previous pitch on purpose although the breath continues: their velocity
    differs, they are in a row of equal strokes, or the player detaches all notes without breath.
    """
    struck = np.zeros(len(notes), bool)
    breath = notes.curves.get("breath")
    if breath is None or len(audible) < 2:
        return struck
    pairs = list(pairwise(audible))
    gaps_s = np.array([notes.onsets_s[after] - notes.ends_s[before] for before, after in pairs])
    same = np.array([notes.pitches[before] == notes.pitches[after] for before, after in pairs])
    near = np.flatnonzero(gaps_s <= _RESTRUCK_S)
    goes_on = np.zeros(len(pairs), bool)
    goes_on[near] = [_goes_on(notes, notes.ends_s[pairs[at][0]], notes.onsets_s[pairs[at][1]]) for at in near]
    changes = goes_on & ~same
    detached = np.count_nonzero(changes & (gaps_s > _TOUCHING_S))
    if np.count_nonzero(changes) >= _LEAST_CHANGES and detached >= _DETACHED * np.count_nonzero(changes):
        struck[audible] = True
        return struck
    again = goes_on & same & (gaps_s > 0.0)
    steps_s = np.array([notes.onsets_s[after] - notes.onsets_s[before] for before, after in pairs])
    # Time at which each note reaches its level.
    begun = breath.at(notes.onsets_s + 2 * _AROUND_S[1])
    edges = np.flatnonzero(np.diff(np.concatenate(([False], again, [False])).astype(np.int8)))
    for first, last in edges.reshape(-1, 2).tolist():
        row, steps = pairs[first:last], steps_s[first:last]
        steady = len(row) >= _STROKES - 1 and float(steps.max()) <= (1.0 + _STEADY) * float(steps.min())
        for before, after in row:
            other = abs(int(notes.velocities[after]) - int(notes.velocities[before])) >= _STROKE_VELOCITY
            alike = abs(begun[after] - begun[before]) <= _LIKE_BREATH * begun[before]
            struck[after] = steady or (other and alike)
    return struck


def _octave(notes: Played, index: int, other: int) -> bool:
    return abs(int(notes.pitches[index] - notes.pitches[other])) in _OCTAVES


def _touches(held: int, index: int, following: int, onsets: FloatArray, ends: FloatArray) -> bool:
    """Return whether note ``index`` is so short that it only connects the notes ``held`` and ``following``, which are
    legato."""
    before_s, after_s = onsets[index] - ends[held], onsets[following] - ends[index]
    return bool(before_s <= _TOUCHING_S and after_s <= _TOUCHING_S and ends[following] > onsets[following])
