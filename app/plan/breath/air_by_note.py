"""Air supply at each note, given the breaths in rests, in silences and by hand."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.plan.breath.catch_breath_lengths import Room, catch_lengths_s, drop_lengths_s
from app.plan.breath.lungs import drawn_share, levels, with_circular_breathing
from app.plan.breath.score_for_breath import Breather, BreathScore
from app.plan.model import BreathEvent
from app.plan.music.piece import EPSILON


class GivenBreaths(NamedTuple):
    """Breaths that are decided before the search for catch breaths: in rests, in silences and by hand.

    Attributes
    ----------
    generated : tuple of BreathEvent
        Breaths that the rules made in rests.
    kept : tuple of BreathEvent
        The generated ones without those removed or set by hand.
    may : (N,) bool
        Mask of notes before which the rules may add a breath.
    """

    generated: tuple[BreathEvent, ...]
    kept: tuple[BreathEvent, ...]
    by_hand: tuple[BreathEvent, ...]
    may: BoolArray


class AirStock(NamedTuple):
    """Air supply without catch breaths, and the air that catch breaths could add.

    Attributes
    ----------
    used, steady_used : (N + 1,) float
        As in `BreathScore`, less the air gained by breaths within notes and through the nose.
    refill : (N,) float
        Share of the lungs filled by the breath before each note.
    air_s : (N,) float
        Seconds of air available at each note.
    """

    used: FloatArray
    steady_used: FloatArray
    refill: FloatArray
    air_s: FloatArray
    room: Room


def air_stock(breather: Breather, score: BreathScore, given: GivenBreaths, spare: dict[int, BreathEvent]) -> AirStock:
    """Return the air used by each note, and the air that a breath before each note can add, as input of the search for
    catch breaths."""
    times, lung_s = breather.times, score.lung_s
    used, steady_used, refill = air_taken(breather, score, given, spare)
    length_s = catch_lengths_s(score.steady, times, score.rests.sounding_tick)
    for index, event in spare.items():
        length_s[index] = _lasts_s(score, breather, event)
    if score.gaps is not None:
        length_s = np.where(score.gaps.played, score.gaps.length_s, length_s)
        drop_s, dropped = np.zeros(len(breather.notes)), np.zeros(len(breather.notes), np.int64)
    else:
        drop_s, dropped = drop_lengths_s(score.steady, times)
    if breather.parameters.circular_breathing:
        used = with_circular_breathing(used, lung_s, refill)
        steady_used = with_circular_breathing(steady_used, lung_s, refill)
    air_s = levels(used, lung_s, refill) * lung_s
    room = Room(length_s, drop_s, dropped).with_marks(breather.marked, times)
    return AirStock(used, steady_used, refill, air_s, room)


def air_taken(
    breather: Breather, score: BreathScore, given: GivenBreaths, spare: Collection[int] = ()
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the air used before each note, as played and at the score's tempo (each (N + 1,), see `BreathScore`), and
    the share (N,) of the lungs that the breath before each note fills. Breaths before the notes with the indices
    ``spare`` are not counted.
    """
    refill = np.zeros(len(breather.notes))
    within: dict[int, list[_Within]] = {}
    for event in (*given.kept, *given.by_hand):
        index = breather.number_of(event)
        share = max(0.0, drawn_share(_lasts_s(score, breather, event)) * (event.depth if event.corrected else 1.0))
        if event.is_within:
            within.setdefault(index, []).append(_Within(event.start_s, event.end_s, share))
        elif event.draws_air and index not in spare:
            refill[index] = share
    if not within:
        return score.used, score.steady_used, refill
    spent = [np.diff(used) for used in (score.used, score.steady_used)]
    for index, breaths in within.items():
        _breathe_within(breather, index, sorted(breaths), spent, refill, score.lung_s)
    used, steady_used = (np.concatenate(([0.0], np.cumsum(column))) for column in spent)
    return used, steady_used, refill


class _Within(NamedTuple):
    """A breath taken while a note is held: its start and end, and the share of the lungs it fills."""

    start_s: float
    end_s: float
    share: float


def _breathe_within(
    breather: Breather,
    index: int,
    breaths: list[_Within],
    spent: list[FloatArray],
    refill: FloatArray,
    lung_s: float,
) -> None:
    """Subtract the air inhaled within note ``index`` from ``spent`` (air used by each note, changed in place) and set
    the ``refill`` of the lungs after it. Lungs are counted from note to note, so the air used before the first breath
    is added to the previous note, as if the breaths came before this note.
    """
    onset_s, end_s = float(breather.times.onset_s[index]), float(breather.times.played_end_s[index])
    first_s, last_s = max(breaths[0].start_s - onset_s, 0.0), max(end_s - breaths[-1].end_s, 0.0)
    held_s = end_s - breaths[0].start_s - sum(breath.end_s - breath.start_s for breath in breaths)
    brought_s = sum(breath.share for breath in breaths[1:]) * lung_s
    for column in spent:
        rate = float(column[index]) / max(end_s - onset_s, EPSILON)
        before_s = first_s * rate
        column[index] = max(last_s * rate, held_s * rate - brought_s)
        if index and refill[index] == 0.0:
            column[index - 1] += before_s
        else:
            column[index] = max(column[index], before_s)
    refill[index] = max(refill[index], min(breaths[0].share, 1.0))


def _lasts_s(score: BreathScore, breather: Breather, event: BreathEvent) -> float:
    """Return the length of a breath in seconds; for one in a rest, at the tempo of the score."""
    index, length_s = breather.number_of(event), event.end_s - event.start_s
    if index == 0 or event.corrected or score.gaps is not None or event.is_within:
        return length_s
    rest_s = float(score.written.onset_s[index] - score.written.played_end_s[index - 1])
    return min(length_s, rest_s) if rest_s > 0.0 else length_s
