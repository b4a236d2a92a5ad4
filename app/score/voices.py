"""Voice leading: the notes of one track to the players who share it.

Two notes sound together if one is struck while the other still sounds for more than 30 ms; a shorter overlap is legato.
As many voices as notes ever sound together share the notes, voice 0 being the highest. Notes struck together go to voices
in their order, so player 1 has the upper note of a chord of two. Where one line sounds in a track of two voices, MIDI
does not say whether it is meant for one player or for both: it goes to *one* voice, so that no note is lost or doubled,
namely to the one that makes the least movement in all: a line stays with its player until a chord forces
otherwise, and the other rests.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, groupby
from math import comb
from typing import NamedTuple, TypeAlias

import numpy as np
from scipy.optimize import linear_sum_assignment

from app.score.model import Note
from app.score.tempo import TempoMap

LEGATO_OVERLAP_S = 0.030

# In semitones of movement. A voice that comes in while another could have gone on, and one that crosses a held voice.
_ENTRY_COST = 4.0
_CROSSING_COST = 12.0
# After a rest of more than half a quarter, the distance to the last note counts half.
_REST_QUARTERS = 0.5
_AFTER_REST_WEIGHT = 0.5

# Hypotheses kept, and choices looked at one by one, per onset; with more, only the cheapest choice of each is followed.
_BEAM = 8
_CHOICES = 24

_History: TypeAlias = "tuple[_History, tuple[int, ...]] | None"


class _Hypothesis(NamedTuple):
    """Who plays what so far: per voice its last pitch (-1 before the first), when it is free and when it ended."""

    cost: float
    pitches: tuple[int, ...]
    free_ticks: tuple[float, ...]
    end_ticks: tuple[float, ...]
    history: _History


def split_voices(notes: Sequence[Note], tempo_map: TempoMap) -> list[tuple[Note, ...]]:
    """Share the notes of one track among as few players as can play them.

    Parameters
    ----------
    notes : sequence of Note
        By onset.
    tempo_map : TempoMap

    Returns
    -------
    list of tuple of Note
        Voice 0, the highest, first; every note in exactly one voice, none empty. Within a voice by onset.
    """
    if not notes:
        return []
    onsets = np.array([note.onset_tick for note in notes], np.float64)
    ends = np.array([note.end_tick for note in notes], np.float64)
    if (onsets[1:] >= ends[:-1]).all():
        return [tuple(notes)]
    releases = np.maximum(tempo_map.ticks(tempo_map.seconds(ends) - LEGATO_OVERLAP_S), onsets + 0.5)
    started = np.searchsorted(onsets, onsets, side="right")
    count = int((started - np.searchsorted(np.sort(releases), onsets + 1e-6, side="right")).max())
    if count == 1:
        return [tuple(notes)]
    voices: list[list[Note]] = [[] for _ in range(count)]
    groups, chosen = _assign(notes, releases.tolist(), count, _REST_QUARTERS * tempo_map.ticks_per_quarter)
    for group, choice in zip(groups, chosen, strict=True):
        for index, voice in zip(group, choice, strict=True):
            voices[voice].append(notes[index])
    return [tuple(voice) for voice in voices if voice]


def _assign(
    notes: Sequence[Note], releases: Sequence[float], count: int, rest_ticks: float
) -> tuple[list[list[int]], list[tuple[int, ...]]]:
    """Notes struck together, by falling pitch, as indices; and for each group the voices that play it."""
    groups = [
        sorted(group, key=lambda index: -notes[index].pitch)
        for _, group in groupby(range(len(notes)), key=lambda index: notes[index].onset_tick)
    ]
    nobody = (-1.0,) * count
    beam = [_Hypothesis(0.0, (-1,) * count, nobody, nobody, None)]
    for group in groups:
        onset = notes[group[0]].onset_tick
        pitches = [notes[index].pitch for index in group]
        ends = [(releases[index], notes[index].end_tick) for index in group]
        best: dict[tuple[tuple[int, ...], tuple[float, ...]], _Hypothesis] = {}
        for hypothesis in beam:
            free = [voice for voice in range(count) if hypothesis.free_ticks[voice] <= onset + 1e-6]
            # With no choice and no rival the cost says nothing.
            forced = len(free) == len(group) and len(beam) == 1
            costs = [] if forced else _costs(hypothesis, free, pitches, onset, rest_ticks)
            for choice, cost in _choices(free, len(group), costs):
                following = _follow(hypothesis, choice, cost, pitches, ends)
                key = following.pitches, following.end_ticks
                if key not in best or following.cost < best[key].cost:
                    best[key] = following
        beam = sorted(best.values(), key=lambda hypothesis: hypothesis.cost)[:_BEAM]
    chosen: list[tuple[int, ...]] = []
    history = beam[0].history
    while history is not None:
        history, choice = history
        chosen.append(choice)
    return groups, chosen[::-1]


def _choices(free: list[int], size: int, costs: list[list[float]]) -> list[tuple[tuple[int, ...], float]]:
    """The ways to give a group to free voices in order, and what each costs."""
    if not costs:
        return [(tuple(free), 0.0)]
    if comb(len(free), size) > _CHOICES:
        _, columns = linear_sum_assignment(np.array(costs))
        return [_cost_of(tuple(sorted(columns.tolist())), free, costs)]
    return [_cost_of(places, free, costs) for places in combinations(range(len(free)), size)]


def _cost_of(places: tuple[int, ...], free: list[int], costs: list[list[float]]) -> tuple[tuple[int, ...], float]:
    return tuple(free[place] for place in places), sum(row[place] for row, place in zip(costs, places, strict=True))


def _costs(
    hypothesis: _Hypothesis, free: list[int], pitches: list[int], onset: int, rest_ticks: float
) -> list[list[float]]:
    """The cost of each note of a group (rows) in each free voice (columns)."""
    held = [
        (voice, pitch) for voice, pitch in enumerate(hypothesis.pitches) if hypothesis.free_ticks[voice] > onset + 1e-6
    ]
    rows = []
    for pitch in pitches:
        row = []
        for voice in free:
            last = hypothesis.pitches[voice]
            if last < 0:
                cost = _ENTRY_COST + 0.1 * voice
            elif onset - hypothesis.end_ticks[voice] > rest_ticks:
                cost = _ENTRY_COST + _AFTER_REST_WEIGHT * abs(pitch - last)
            else:
                cost = float(abs(pitch - last))
            for other, sounding in held:
                if (other < voice and sounding < pitch) or (other > voice and sounding > pitch):
                    cost += _CROSSING_COST
            row.append(cost)
        rows.append(row)
    return rows


def _follow(
    hypothesis: _Hypothesis,
    choice: tuple[int, ...],
    cost: float,
    pitches: list[int],
    ends: list[tuple[float, int]],
) -> _Hypothesis:
    last, free, end = list(hypothesis.pitches), list(hypothesis.free_ticks), list(hypothesis.end_ticks)
    for voice, pitch, (release, note_end) in zip(choice, pitches, ends, strict=True):
        last[voice], free[voice], end[voice] = pitch, release, note_end
    total = hypothesis.cost + cost
    return _Hypothesis(total, tuple(last), tuple(free), tuple(end), (hypothesis.history, choice))
