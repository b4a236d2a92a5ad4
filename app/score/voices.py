"""Voice leading: the notes of one track to the players who share it.

Two notes sound together if one is struck while the other still sounds for more than 30 ms; a shorter overlap is legato.
As many voices as notes ever sound together share the notes, voice 0 being the highest. Notes struck together go to
voices in their order, so player 1 has the upper note of a chord of two. Where one line sounds in a track of two voices,
MIDI does not say whether it is meant for one player or for both: it goes to *one* voice, so that no note is lost or
doubled, namely to the one that makes the least movement in all: a line stays with its player until a chord forces
otherwise, and the other rests.

At most `MOST_VOICES` players share a track. Where more notes sound at once, those struck first stay, of those struck
together the highest, and the rest is left out: no section divides further, so the track is none.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from heapq import heappop, heappush
from itertools import chain, combinations, pairwise
from math import comb
from operator import getitem
from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from app.score.model import Note
from app.score.tempo import TempoMap

LEGATO_OVERLAP_S = 0.030
MOST_VOICES: Final = 16
_ROUNDING_TICKS = 1e-6

# In semitones of movement: for a voice that comes in while another could have gone on, and for one that crosses a held
# one.
_ENTRY_COST = 12.0
_CROSSING_COST = 12.0
# After a rest of more than half a quarter, the distance to the last note counts half.
_REST_QUARTERS = 0.5
_AFTER_REST_WEIGHT = 0.5

# Hypotheses kept at each onset (two are all there are for a line between two players), and how much dearer than the
# cheapest they may be; the choices looked at one by one: with more, only the cheapest one is followed.
_BEAM = 2
_HOPELESS_COST = 16.0
_CHOICES = 24

Floats: TypeAlias = npt.NDArray[np.float64]
_History: TypeAlias = "tuple[_History, tuple[int, ...]] | None"


class _Voice(NamedTuple):
    """What a player did last: pitch (-1 before the first note), when the player is free, when the note ended."""

    pitch: int
    free_tick: float
    end_tick: float


class _Hypothesis(NamedTuple):
    """Who plays what so far, and what it cost."""

    cost: float
    voices: tuple[_Voice, ...]
    history: _History


class _Spans(NamedTuple):
    """When notes sound, in ticks: a note's release is where another one may begin in its voice."""

    onsets: Floats
    ends: Floats
    releases: Floats

    def together(self) -> int:
        """How many notes sound at once at most."""
        started = np.searchsorted(self.onsets, self.onsets, side="right")
        return int((started - np.searchsorted(np.sort(self.releases), self.onsets, side="right")).max())


def _spans(notes: Sequence[Note], tempo_map: TempoMap) -> _Spans:
    onsets = np.array([note.onset_tick for note in notes], np.float64)
    ends = onsets + np.array([note.duration_tick for note in notes], np.float64)
    releases = tempo_map.ticks(tempo_map.seconds(ends) - LEGATO_OVERLAP_S) - _ROUNDING_TICKS
    return _Spans(onsets, ends, np.maximum(releases, onsets + 0.5))


def is_one_voice(notes: Sequence[Note], tempo_map: TempoMap) -> bool:
    """Whether one player can play the notes, which are by onset."""
    return not notes or _spans(notes, tempo_map).together() == 1


def split_voices(notes: Sequence[Note], tempo_map: TempoMap, most: int = MOST_VOICES) -> list[tuple[Note, ...]]:
    """Share the notes of one track among as few players as can play them.

    Parameters
    ----------
    notes : sequence of Note
        By onset.
    tempo_map : TempoMap
    most : int
        Voices.

    Returns
    -------
    list of tuple of Note
        Voice 0, the highest, first; every note in exactly one voice (in none where more than ``most`` sound at once),
        no voice empty. Within a voice by onset.
    """
    if not notes:
        return []
    spans = _spans(notes, tempo_map)
    count = spans.together()
    if count == 1:
        return [tuple(notes)]
    onsets, ends, releases = spans
    pitches = np.array([note.pitch for note in notes])
    order = np.lexsort((-pitches, onsets))
    if count > most:
        order, count = order[_first(onsets[order], releases[order], most)], most
    begins = np.flatnonzero(np.diff(onsets[order], prepend=-1.0))
    played = list(map(_Voice, pitches[order].tolist(), releases[order].tolist(), ends[order].tolist()))
    groups = [played[begin:end] for begin, end in pairwise([*begins.tolist(), len(order)])]
    struck = onsets[order][begins].tolist()
    rest_ticks = _REST_QUARTERS * tempo_map.ticks_per_quarter
    voices: list[list[Note]] = [[] for _ in range(count)]
    players = chain.from_iterable(_assign(struck, groups, count, rest_ticks))
    for index, voice in zip(order.tolist(), players, strict=True):
        voices[voice].append(notes[index])
    return [tuple(voice) for voice in voices if voice]


def _first(onsets: Floats, releases: Floats, most: int) -> list[int]:
    """The notes, by onset, that find a free voice if each takes one until its release."""
    sounding: list[float] = []
    kept = []
    for index, (onset, release) in enumerate(zip(onsets.tolist(), releases.tolist(), strict=True)):
        while sounding and sounding[0] <= onset:
            heappop(sounding)
        if len(sounding) < most:
            heappush(sounding, release)
            kept.append(index)
    return kept


def _assign(
    onsets: Sequence[float], groups: Sequence[list[_Voice]], count: int, rest_ticks: float
) -> list[tuple[int, ...]]:
    """For each group of notes struck together, highest first, the voices that play them.

    A beam search over the onsets: what a choice costs shows only when the next chord forces the voices apart.
    """
    everybody = tuple(range(count))
    beam = [_Hypothesis(0.0, (_Voice(-1, -1.0, -1.0),) * count, None)]
    for onset, sounding in zip(onsets, groups, strict=True):
        if len(sounding) == count and len(beam) == 1:  # no choice, no rival: nothing to weigh
            beam = [_Hypothesis(0.0, tuple(sounding), (beam[0].history, everybody))]
            continue
        candidates: list[tuple[float, int, tuple[int, ...]]] = []
        for number, (so_far, voices, _) in enumerate(beam):
            free = [place for place in everybody if voices[place].free_tick <= onset]
            costs = _costs(voices, free, sounding, onset, rest_ticks)
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
    beam: list[_Hypothesis], candidates: list[tuple[float, int, tuple[int, ...]]], sounding: list[_Voice]
) -> list[_Hypothesis]:
    """The cheapest hypotheses that leave the voices in different states."""
    candidates.sort()
    states: dict[tuple[_Voice, ...], _Hypothesis] = {}
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
    """The ways to give a group (rows) to free voices (columns) in order; of too many the cheapest alone."""
    if comb(free, len(costs)) <= _CHOICES:
        return _in_order(free, len(costs))
    from scipy.optimize import linear_sum_assignment  # heavy, and seldom needed

    _, columns = linear_sum_assignment(np.array(costs))
    return (tuple(sorted(columns.tolist())),)


def _costs(
    voices: tuple[_Voice, ...], free: list[int], sounding: list[_Voice], onset: float, rest_ticks: float
) -> list[list[float]]:
    """The cost of each note of a group (rows) in each free voice (columns)."""
    lines: list[tuple[float, float, int]] = []  # per voice: cost = constant + weight * distance
    for voice in free:
        pitch, _, end_tick = voices[voice]
        if pitch < 0:
            lines.append((_ENTRY_COST + 0.1 * voice, 0.0, pitch))
        elif onset - end_tick > rest_ticks:
            lines.append((_ENTRY_COST, _AFTER_REST_WEIGHT, pitch))
        else:
            lines.append((0.0, 1.0, pitch))
    rows = [[constant + weight * abs(note[0] - last) for constant, weight, last in lines] for note in sounding]
    if len(free) < len(voices):
        for other, held in enumerate(voices):
            if held.free_tick > onset:
                for note, row in zip(sounding, rows, strict=True):
                    for place, voice in enumerate(free):
                        if (other < voice) == (held.pitch < note.pitch) and held.pitch != note.pitch:
                            row[place] += _CROSSING_COST
    return rows
