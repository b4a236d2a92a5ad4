"""Rows of the takes lane as arrays, in seconds of the piece; without drawing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.identity_cache import IdentityCache
from app.project.edit.placed_takes import BEFORE, recorded_of, take_cleaned, take_notes
from app.project.model import CompSpan, PlayerTakes, Project
from app.score.clean import Cleaned, Fault
from app.score.model import ControllerCurve, Note
from app.score.take import Played, Take
from app.score.tempo import TempoMap
from widgets.timeline.model.geometry import StepCurve, TimeSpans

_KEPT: Final[IdentityCache[tuple[TimeSpans, IntArray, IntArray]]] = IdentityCache(128)
_LEFT_OUT: Final[IdentityCache[tuple[TimeSpans, IntArray, tuple[Fault, ...]]]] = IdentityCache(128)
_BREATH: Final[IdentityCache[StepCurve | None]] = IdentityCache(128)


@dataclass(frozen=True, eq=False)
class TakeRow:
    """A row of the takes lane.

    Attributes
    ----------
    take : Take or None
        Take; None for the notes before the first take.
    kept : TimeSpans
        Time spans of the notes that remain after cleaning.
    pitches, onset_ticks : int64 array
        Pitch and onset of each of these notes.
    left_out : TimeSpans
        Time spans of the notes that cleaning omits, as played.
    left_out_pitches : int64 array
        Their pitches.
    faults : tuple of Fault
        Reason for the omission of each.
    breath : StepCurve or None
        Recorded breath, 0..1; None if it was not recorded.
    """

    take: Take | None
    kept: TimeSpans
    pitches: IntArray
    onset_ticks: IntArray
    left_out: TimeSpans
    left_out_pitches: IntArray
    faults: tuple[Fault, ...]
    breath: StepCurve | None

    @property
    def take_id(self) -> str:
        """Id of the take, empty for the notes before the first take."""
        return BEFORE if self.take is None else self.take.id


def rows_of(project: Project, player_id: str) -> tuple[TakeRow, ...]:
    """Return the row of the notes before the first take, then those of the takes in order; empty without recordings."""
    recorded = project.takes.get(player_id)
    if recorded is None or not recorded.takes:
        return ()
    clock = project.score.tempo_map
    return (_before(recorded, clock), *(_row(project, player_id, take, clock) for take in recorded.takes))


def owners(comp: Sequence[CompSpan], ticks: IntArray) -> IntArray:
    """Return for each tick (N,) the index of the comp's span that contains it; -1 for none."""
    if not comp:
        return np.full(len(ticks), -1, np.int64)
    starts = np.array([span.start_tick for span in comp], np.int64)
    ends = np.array([span.end_tick for span in comp], np.int64)
    index = np.searchsorted(starts, ticks, side="right") - 1
    return np.where((index >= 0) & (ticks < ends[index]), index, -1)


def span_at(comp: Sequence[CompSpan], tick: float, end_tick: int) -> CompSpan:
    """Return the span of the comp (the part assembled from takes) at a tick; between used spans the gap, which ends at
    ``end_tick`` at the latest.
    """
    start = 0
    for span in comp:
        if tick < span.start_tick:
            return CompSpan(start, span.start_tick, BEFORE)
        if tick < span.end_tick:
            return span
        start = span.end_tick
    return CompSpan(start, max(end_tick, start + 1), BEFORE)


def edges(comp: Sequence[CompSpan], end_tick: int) -> tuple[tuple[CompSpan, CompSpan], ...]:
    """Return all pairs of adjacent spans of a comp (the part assembled from takes), with gaps as spans; the last ends
    at ``end_tick``.
    """
    met: list[CompSpan] = []
    at = 0
    for span in comp:
        met += [CompSpan(at, span.start_tick, BEFORE)] if at < span.start_tick else []
        met.append(span)
        at = span.end_tick
    met += [CompSpan(at, end_tick, BEFORE)] if at < end_tick else []
    return tuple(pairwise(met))


def pitch_range(rows: Sequence[TakeRow]) -> tuple[int, int]:
    """Return the lowest and highest pitch of all rows, at least an octave apart, as the common scale of the rows."""
    found = [pitches for row in rows for pitches in (row.pitches, row.left_out_pitches) if len(pitches)]
    if not found:
        return 60, 72
    low, high = min(int(each.min()) for each in found), max(int(each.max()) for each in found)
    missing = max(12 - (high - low), 0)
    return low - missing // 2, high + (missing + 1) // 2


def _before(recorded: PlayerTakes, clock: TempoMap) -> TakeRow:
    kept, pitches, ticks = _kept(recorded.before_notes, clock)
    breath = next((curve for curve in recorded.before_curves if curve.kind == "breath"), None)
    steps = None if breath is None else _BREATH.step(_drawn_breath, breath, clock)
    none = np.empty(0, np.float64)
    return TakeRow(None, kept, pitches, ticks, TimeSpans(none, none), np.empty(0, np.int64), (), steps)


def _row(project: Project, player_id: str, take: Take, clock: TempoMap) -> TakeRow:
    kept, pitches, ticks = _kept(take_notes(project, player_id, take.id), clock)
    clean = take_cleaned(project, player_id, take.id)
    left_out, left_pitches, faults = _LEFT_OUT.step(_left_out, clean, take.tempo_map, clock)
    breath = _BREATH.step(_played_breath, take.played, take.tempo_map, clock)
    return TakeRow(take, kept, pitches, ticks, left_out, left_pitches, faults, breath)


def _kept(notes: tuple[Note, ...], clock: TempoMap) -> tuple[TimeSpans, IntArray, IntArray]:
    return _KEPT.step(_kept_arrays, notes, clock)


def _kept_arrays(notes: tuple[Note, ...], clock: TempoMap) -> tuple[TimeSpans, IntArray, IntArray]:
    onsets = np.array([note.onset_tick for note in notes], np.int64)
    ends = np.array([note.end_tick for note in notes], np.int64)
    pitches = np.array([note.pitch for note in notes], np.int64)
    return TimeSpans(clock.seconds(onsets), clock.seconds(ends)), pitches, onsets


def _left_out(clean: Cleaned, own: TempoMap, clock: TempoMap) -> tuple[TimeSpans, IntArray, tuple[Fault, ...]]:
    index = [number for number, fault in enumerate(clean.faults) if fault]
    spans = TimeSpans(_moved(clean.onsets_s[index], own, clock), _moved(clean.ends_s[index], own, clock))
    return spans, clean.pitches[index], tuple(clean.faults[number] for number in index)


def _played_breath(played: Played, own: TempoMap, clock: TempoMap) -> StepCurve | None:
    curve = played.curves.get("breath")
    return None if curve is None else StepCurve(_moved(curve.times_s, own, clock), curve.values)


def _drawn_breath(curve: ControllerCurve, clock: TempoMap) -> StepCurve:
    return StepCurve(clock.seconds(np.array(curve.ticks, np.float64)), np.array(curve.values, np.float64))


def _moved(seconds: FloatArray, own: TempoMap, clock: TempoMap) -> FloatArray:
    """Convert times (N,) of a take, recorded at the tempi in ``own``, to seconds of the piece, whose tempi are now
    ``clock``.
    """
    return clock.seconds(own.ticks(seconds))


def comp_of(project: Project, player_id: str) -> tuple[CompSpan, ...]:
    """Return the spans of a player's part assembled from takes, each with its take."""
    return recorded_of(project, player_id).comp
