"""Conversion of a take's notes and curves to the score."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.errors import AppError
from app.identity_cache import IdentityCache
from app.project.alignment import AlignmentPart, align
from app.project.ids import MOST_TAKE_NOTES, take_note_id
from app.project.limits import LAST_TICK
from app.project.model import PlayerTakes, Project
from app.project.snap_grid import Grid
from app.score.clean import Cleaned, cleaned
from app.score.metre_map import MetreMap
from app.score.model import ControllerCurve, Note
from app.score.take import Cleaning, Take


@dataclass(frozen=True, eq=False)
class _Placed:
    """Notes of a take placed in the piece, and their onsets as arrays (N,): in ticks as played, ascending, and in ticks
    of the score.
    """

    notes: tuple[Note, ...]
    played: FloatArray
    here: FloatArray

    def moved(self, ticks: FloatArray) -> FloatArray:
        """Return the new ticks (N,) of moments of the take: shifted like the notes around them, interpolated linearly
        between onsets, so that order is kept.
        """
        if not len(self.played):
            return ticks
        # Aligned notes may pass each other, but the breath must not run backwards.
        here = np.maximum.accumulate(self.here)
        by = np.interp(ticks, self.played, here - self.played)
        return np.asarray(ticks + by, np.float64)


BEFORE: Final = ""
"""Id that stands for the part before the first take."""
_PLACED: Final[IdentityCache[_Placed]] = IdentityCache(64)
_CURVES: Final[IdentityCache[tuple[ControllerCurve, ...]]] = IdentityCache(64)


def recorded_of(project: Project, player_id: str) -> PlayerTakes:
    """Return the takes of a player; without takes, an empty list that stores the part as it is."""
    recorded = project.takes.get(player_id)
    if recorded is not None:
        return recorded
    part = project.part(project.player(player_id))
    return PlayerTakes((), (), part.notes, part.curves)


def take_notes(project: Project, player_id: str, take_id: str) -> tuple[Note, ...]:
    """Return the notes of a take as they would be in the part: cleaned, aligned to score and grid, in the piece's
    ticks.

    A note matched with one of the score keeps that note's id, so that its corrections apply.
    """
    return _placed(project, player_id, take_id).notes


def take_cleaned(project: Project, player_id: str, take_id: str) -> Cleaned:
    """Return the result of cleaning a take: the remaining notes, and the omitted ones with reasons."""
    return cleaned(recorded_with(project, player_id, take_id).take(take_id))


def take_curves(project: Project, player_id: str, take_id: str) -> tuple[ControllerCurve, ...]:
    """Return breath, bite and other controllers of a take in the piece's ticks, moved with the take's notes."""
    take = recorded_with(project, player_id, take_id).take(take_id)
    placed = _placed(project, player_id, take_id)
    return _CURVES.step(_curves, take, placed)


def recorded_with(project: Project, player_id: str, take_id: str) -> PlayerTakes:
    recorded = recorded_of(project, player_id)
    if take_id != BEFORE and take_id not in {take.id for take in recorded.takes}:
        raise AppError("take.none", take=take_id)
    return recorded


def source_of(project: Project, player_id: str, take_id: str) -> tuple[tuple[Note, ...], tuple[ControllerCurve, ...]]:
    """Return the notes and curves of a take, or those of the part before the first take."""
    if take_id == BEFORE:
        recorded = recorded_of(project, player_id)
        return recorded.before_notes, recorded.before_curves
    return take_notes(project, player_id, take_id), take_curves(project, player_id, take_id)


def _placed(project: Project, player_id: str, take_id: str) -> _Placed:
    recorded, score = recorded_with(project, player_id, take_id), project.score
    take, before = recorded.take(take_id), recorded.before_notes
    return _PLACED.step(_place, take, before, _same(score.metre_map))


@lru_cache(maxsize=64)
def _same(metre_map: MetreMap) -> MetreMap:
    """Return one shared object for equal metre maps, since every edit of the score makes a new one."""
    return metre_map


def _place(take: Take, before: tuple[Note, ...], metre_map: MetreMap) -> _Placed:
    clean = cleaned(take)
    kept = [index for index in clean.kept[:MOST_TAKE_NOTES] if clean.ends_s[index] > 0.0]
    onsets = np.maximum(take.tempo_map.ticks(clean.onsets_s[kept]), 0.0)
    ends = np.minimum(take.tempo_map.ticks(clean.ends_s[kept]), LAST_TICK)
    ids = [take_note_id(take.number, index) for index in kept]
    pitches = clean.pitches[kept].tolist()
    played = onsets
    if take.cleaning.align > 0.0:
        onsets, ends, ids, pitches = _aligned(take.cleaning.align, onsets, ends, ids, pitches, before, metre_map)
    if take.cleaning.quantise > 0.0:
        onsets, ends = _quantised(take.cleaning, onsets, ends, metre_map)
    notes = [
        Note(id, round(onset), max(round(end) - round(onset), 1), pitch, velocity)
        for id, onset, end, pitch, velocity in zip(
            ids, onsets.tolist(), ends.tolist(), pitches, clean.velocities[kept].tolist(), strict=True
        )
        if round(onset) < LAST_TICK
    ]
    return _Placed(tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch))), played, onsets)


def _aligned(
    strength: float,
    onsets: FloatArray,
    ends: FloatArray,
    ids: list[str],
    pitches: list[int],
    before: tuple[Note, ...],
    metre_map: MetreMap,
) -> tuple[FloatArray, FloatArray, list[str], list[int]]:
    """Align the notes of a take with those of the score ``before``, by ``strength`` 0..1.

    Return onsets and ends in ticks, ids and pitches. Matched notes get pitch and id of the score's note; the others
    move with their neighbours, so that order is kept.
    """
    quarter = metre_map.ticks_per_quarter
    order = np.lexsort((np.array(pitches), onsets))
    played = AlignmentPart(
        onsets[order] / quarter, (ends - onsets)[order] / quarter, np.array(pitches, np.int64)[order]
    )
    pairs = align(AlignmentPart.of(before, quarter), played)
    if not len(pairs):
        return onsets, ends, ids, pitches
    meant = [before[index] for index in pairs[:, 0].tolist()]
    found = order[pairs[:, 1]]
    at, by = onsets[found], np.array([note.onset_tick for note in meant]) - onsets[found]
    moved = strength * np.interp(onsets, at, by)
    moved_ends = strength * np.interp(ends, at, by)
    lengths = np.maximum(ends + moved_ends - onsets - moved, 1.0)
    ids, pitches = list(ids), list(pitches)
    for index, note in zip(found.tolist(), meant, strict=True):
        ids[index], pitches[index] = note.id, note.pitch
        lengths[index] += strength * (note.duration_tick - lengths[index])
    onsets = np.maximum(onsets + moved, 0.0)
    return onsets, onsets + lengths, ids, pitches


def _quantised(
    cleaning: Cleaning, onsets: FloatArray, ends: FloatArray, metre_map: MetreMap
) -> tuple[FloatArray, FloatArray]:
    """Move onsets (ticks) towards the grid by the strength in the cleaning settings. Return onsets and ends (N,); the
    end of a legato note moves with the next onset.
    """
    grid = Grid(Fraction(cleaning.grid_quarters).limit_denominator(960))
    by = cleaning.quantise * np.array([grid.snap(metre_map, onset) - onset for onset in onsets.tolist()])
    if not len(onsets):
        return onsets, ends
    ends_by = np.interp(ends, onsets, by) if np.all(np.diff(onsets) > 0.0) else by
    new = np.maximum(onsets + by, 0.0)
    return new, np.maximum(ends + ends_by, new + 1.0)


def _curves(take: Take, placed: _Placed) -> tuple[ControllerCurve, ...]:
    curves = []
    for kind, curve in take.played.curves.items():
        ticks = np.rint(placed.moved(take.tempo_map.ticks(curve.times_s))).astype(np.int64)
        # Values sent before the piece apply at its beginning; the last of several at one tick counts.
        ticks, values = np.maximum(ticks[ticks <= LAST_TICK], 0), curve.values[ticks <= LAST_TICK]
        last = np.append(ticks[1:] != ticks[:-1], True)[: len(ticks)]
        if len(ticks):
            curves.append(ControllerCurve(kind, tuple(ticks[last].tolist()), tuple(values[last].tolist())))
    return tuple(curves)
