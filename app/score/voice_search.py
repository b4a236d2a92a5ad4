"""Assigns the notes of chords to voices: a search for the least movement of all players together."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import combinations
from math import comb
from operator import getitem
from typing import NamedTuple, TypeAlias

import numpy as np

# In semitones of movement: costs of a voice that enters while another could have continued, and of one that crosses a
# held voice.
_ENTRY_COST = 12.0
_CROSSING_COST = 12.0
# After a rest of more than half a quarter the distance to the last note counts half.
REST_QUARTERS = 0.5
_AFTER_REST_WEIGHT = 0.5
# Hypotheses kept at each onset (two are all there are for a line between two players), and how much dearer than the
# cheapest they may be; the choices looked at one by one: with more, only the cheapest one is followed.
_BEAM = 2
_HOPELESS_COST = 16.0
_CHOICES = 24
_History: TypeAlias = "tuple[_History, tuple[int, ...]] | None"


class LastPlayed(NamedTuple):
    """Last note of a voice: pitch (-1 before its first note), time from which the voice is free, and end of the note,
    in seconds.
    """

    pitch: int
    free_s: float
    end_s: float


class _Hypothesis(NamedTuple):
    """Candidate of the search for voices: cost of the notes assigned so far, the last note of each voice, and the
    assignment."""

    cost: float
    voices: tuple[LastPlayed, ...]
    history: _History


def assigned_voices(
    onsets: Sequence[float], groups: Sequence[list[LastPlayed]], count: int, rests_s: Sequence[float]
) -> list[tuple[int, ...]]:
    """Assign voices to groups of notes struck together: for each group, the voices of its notes from the highest down.

    A beam search over the onsets, since the cost of a choice shows only when the next chord forces the voices apart.
    """
    everyone = tuple(range(count))
    beam = [_Hypothesis(0.0, (LastPlayed(-1, -1.0, -1.0),) * count, None)]
    for onset, sounding, rest_s in zip(onsets, groups, rests_s, strict=True):
        if len(sounding) == count and len(beam) == 1:  # no choice and no rival, so nothing to compare
            beam = [_Hypothesis(0.0, tuple(sounding), (beam[0].history, everyone))]
            continue
        candidates: list[tuple[float, int, tuple[int, ...]]] = []
        for number, (so_far, voices, _) in enumerate(beam):
            free = [place for place in everyone if voices[place].free_s <= onset]
            costs = _costs(voices, free, sounding, onset, rest_s)
            for places in _choices(len(free), costs):
                cost = so_far + sum(map(getitem, costs, places))
                candidates.append((cost, number, tuple([free[place] for place in places])))
        beam = _best(beam, candidates, sounding)
    chosen: list[tuple[int, ...]] = []
    history = beam[0].history
    while history is not None:
        history, choice = history
        chosen.append(choice)
    return chosen[::-1]


def _best(
    beam: list[_Hypothesis], candidates: list[tuple[float, int, tuple[int, ...]]], sounding: list[LastPlayed]
) -> list[_Hypothesis]:
    """Keep the cheapest of the hypotheses that end in the same state of all voices."""
    candidates.sort()
    states: dict[tuple[LastPlayed, ...], _Hypothesis] = {}
    limit = candidates[0][0] + _HOPELESS_COST
    for cost, number, choice in candidates:
        if cost > limit:
            break
        voices = list(beam[number].voices)
        for voice, note in zip(choice, sounding, strict=True):
            voices[voice] = note
        state = tuple(voices)
        if state not in states:
            states[state] = _Hypothesis(cost, state, (beam[number].history, choice))
            if len(states) == _BEAM:
                break
    return list(states.values())


@cache
def _in_order(free: int, size: int) -> tuple[tuple[int, ...], ...]:
    return tuple(combinations(range(free), size))


def _choices(free: int, costs: list[list[float]]) -> tuple[tuple[int, ...], ...]:
    """Possible assignments of a group's notes to free voices, keeping the order of pitch: for each note, the index of
    its voice. ``costs`` has notes as rows and voices as columns; if there are too many assignments, only the cheapest
    is returned.
    """
    if comb(free, len(costs)) <= _CHOICES:
        return _in_order(free, len(costs))
    from scipy.optimize import linear_sum_assignment  # slow to import and rarely needed

    _, columns = linear_sum_assignment(np.array(costs))
    return (tuple(sorted(columns.tolist())),)


def _costs(
    voices: tuple[LastPlayed, ...], free: list[int], sounding: list[LastPlayed], onset: float, rest_s: float
) -> list[list[float]]:
    """Cost of giving each note of a group (rows) to each free voice (columns)."""
    lines: list[tuple[float, float, int]] = []  # for each voice: cost = constant + weight * distance
    for voice in free:
        pitch, _, end_s = voices[voice]
        if pitch < 0:
            lines.append((_ENTRY_COST + 0.1 * voice, 0.0, pitch))
        elif onset - end_s > rest_s:
            lines.append((_ENTRY_COST, _AFTER_REST_WEIGHT, pitch))
        else:
            lines.append((0.0, 1.0, pitch))
    rows = [[constant + weight * abs(note[0] - last) for constant, weight, last in lines] for note in sounding]
    if len(free) < len(voices):
        for other, held in enumerate(voices):
            if held.free_s > onset:
                for note, row in zip(sounding, rows, strict=True):
                    for place, voice in enumerate(free):
                        if (other < voice) == (held.pitch < note.pitch) and held.pitch != note.pitch:
                            row[place] += _CROSSING_COST
    return rows
