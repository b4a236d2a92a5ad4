"""Edits of takes: adding, cleaning, and combining them into the part (the comp).

Takes are stored as played. The comp is a list of spans of the part, each with the take that its notes came from. Using
a take in a span changes only that span, so corrections elsewhere stay; a note of a take has the same id each time it is
inserted, so that its corrections apply again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, Final

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import AppError
from app.identity_cache import IdentityCache
from app.project import limits
from app.project.check import take_faults
from app.project.edit.length import with_score
from app.project.edit.placed_takes import BEFORE, recorded_of, recorded_with, source_of, take_curves, take_notes
from app.project.ids import fresh_take_ids
from app.project.limits import LAST_TICK
from app.project.model import CompSpan, PlayerTakes, Project
from app.project.names import clean_name
from app.score.beats_of_free_playing import find_beats, tempo_of_beats
from app.score.clean import cleaned
from app.score.model import ControllerCurve, Note
from app.score.take import Cleaning, Take

_STEPS: Final[IdentityCache[tuple[IntArray, FloatArray]]] = IdentityCache(16)


def add_takes(project: Project, player_id: str, takes: Sequence[Take]) -> tuple[Project, tuple[str, ...]]:
    """Add recorded takes; returns the project and the new ids.

    Raises
    ------
    AppError
        There are too many takes, or one is invalid.
    """
    count = sum(len(recorded.takes) for recorded in project.takes.values()) + len(takes)
    if count > limits.MOST_TAKES:
        raise AppError("take.too_many", most=limits.MOST_TAKES)
    ids = fresh_take_ids(project, len(takes))
    named = tuple(msgspec.structs.replace(take, id=id) for take, id in zip(takes, ids, strict=True))
    for take in named:
        for place, detail in take_faults(take, "take"):
            raise AppError("take.invalid", place=place, detail=detail)
    recorded = recorded_of(project, player_id)
    return _with(project, player_id, msgspec.structs.replace(recorded, takes=(*recorded.takes, *named))), ids


def rename_take(project: Project, player_id: str, take_id: str, name: str) -> Project:
    """Rename a take; a name without visible characters changes nothing."""
    requested = clean_name(name)[: limits.MOST_NAME]
    return _changed(project, player_id, take_id, name=requested) if requested else project


def colour_take(project: Project, player_id: str, take_id: str, colour: str) -> Project:
    """Set the display colour of a take, ``"#rrggbb"``; empty for the player's colour."""
    return _changed(project, player_id, take_id, colour=colour)


def remove_take(project: Project, player_id: str, take_id: str) -> Project:
    """Delete a take; notes of it in the part stay, as ordinary notes."""
    recorded = recorded_with(project, player_id, take_id)
    takes = tuple(take for take in recorded.takes if take.id != take_id)
    comp = tuple(span for span in recorded.comp if span.take_id != take_id)
    return _with(project, player_id, msgspec.structs.replace(recorded, takes=takes, comp=comp))


def move_take(project: Project, player_id: str, take_id: str, before: int) -> Project:
    """Move a take before the one with index ``before`` in the list of takes."""
    recorded = recorded_with(project, player_id, take_id)
    take = recorded.take(take_id)
    first = [one for one in recorded.takes[:before] if one is not take]
    last = [one for one in recorded.takes[before:] if one is not take]
    return _with(project, player_id, msgspec.structs.replace(recorded, takes=(*first, take, *last)))


# Comp


def comp(project: Project, player_id: str, take_id: str, start_tick: int, end_tick: int) -> Project:
    """Use a take in a span of the part; `BEFORE` is the part's content before the first take.

    Notes are selected by their onsets. A note of the part that reaches into the span is cut at the first new note, and
    a new one where the part continues.

    Raises
    ------
    AppError
        There is no such take.
    """
    start_tick, end_tick = max(start_tick, 0), min(end_tick, LAST_TICK)
    if start_tick >= end_tick:
        return project
    recorded = recorded_with(project, player_id, take_id)
    notes, curves = source_of(project, player_id, take_id)
    requested = [note for note in notes if start_tick <= note.onset_tick < end_tick]
    project = _replaced(project, player_id, requested, curves, start_tick, end_tick)
    spans = comp_with(recorded.comp, start_tick, end_tick, take_id)
    return _with(project, player_id, msgspec.structs.replace(recorded, comp=spans))


def comp_whole(project: Project, player_id: str, take_id: str) -> Project:
    """Use a whole take in the player's part."""
    if take_id == BEFORE:
        return comp(project, player_id, take_id, 0, LAST_TICK)
    take = recorded_with(project, player_id, take_id).take(take_id)
    # A note played slightly early belongs to the first beat; earlier notes are left out.
    slack = project.score.ticks_per_quarter // 8
    start, end = round(take.start_tick), round(take.end_tick)
    return comp(project, player_id, take_id, max(start, 0) if start <= slack else start, end)


def comp_with(spans: tuple[CompSpan, ...], start_tick: int, end_tick: int, take_id: str) -> tuple[CompSpan, ...]:
    """Return the comp (the part assembled from takes) with a span of a take inserted over existing ones; adjacent spans
    of one take are merged.
    """
    result = []
    for span in spans:
        if span.start_tick < start_tick:
            result.append(msgspec.structs.replace(span, end_tick=min(span.end_tick, start_tick)))
        if span.end_tick > end_tick:
            result.append(msgspec.structs.replace(span, start_tick=max(span.start_tick, end_tick)))
    if take_id != BEFORE:
        result.append(CompSpan(start_tick, end_tick, take_id))
    joined: list[CompSpan] = []
    for span in sorted(result, key=lambda span: span.start_tick):
        if joined and joined[-1].take_id == span.take_id and joined[-1].end_tick == span.start_tick:
            joined[-1] = msgspec.structs.replace(joined[-1], end_tick=span.end_tick)
        else:
            joined.append(span)
    return tuple(joined)


def set_cleaning(project: Project, player_id: str, take_id: str, cleaning: Cleaning) -> Project:
    """Change the cleaning of a take; its notes in the part are updated, except those changed by hand."""
    recorded = recorded_with(project, player_id, take_id)
    if recorded.take(take_id).cleaning == cleaning:
        return project
    before = {note.id: note for note in take_notes(project, player_id, take_id)}
    project = _changed(project, player_id, take_id, cleaning=cleaning)
    after = take_notes(project, player_id, take_id)
    for span in recorded.comp:
        if span.take_id == take_id:
            project = _recleaned(project, player_id, before, after, span)
    return project


# Takes without a score


def beats_of(project: Project, player_id: str, take_id: str) -> FloatArray:
    """Return the beats in seconds of a take played without a metronome. The first call is slow, since its library
    compiles.

    Raises
    ------
    AppError
        Other parts have notes, or too few notes or no beats were found.
    """
    _require_free(project, player_id)
    clean = cleaned(recorded_with(project, player_id, take_id).take(take_id))
    kept = clean.kept
    return find_beats(clean.onsets_s[kept], clean.ends_s[kept])


def follow_beats(project: Project, player_id: str, take_id: str, beats_s: FloatArray) -> Project:
    """Set the tempo of the piece from a freely played take: its first beat begins the piece. Raises AppError if other
    parts have notes.
    """
    _require_free(project, player_id)
    recorded = recorded_with(project, player_id, take_id)
    take = recorded.take(take_id)
    tempo_map = tempo_of_beats(beats_s, project.score.ticks_per_quarter)
    shift_us = round(float(beats_s[0]) * 1e6)
    take = msgspec.structs.replace(
        take,
        tempo_map=tempo_map,
        start_us=take.start_us - shift_us,
        end_us=take.end_us - shift_us,
        times_us=tuple(time_us - shift_us for time_us in take.times_us),
    )
    takes = tuple(take if one.id == take_id else one for one in recorded.takes)
    project = with_score(project, msgspec.structs.replace(project.score, tempo_map=tempo_map))
    project = _with(project, player_id, msgspec.structs.replace(recorded, takes=takes))
    return comp(project, player_id, take_id, 0, LAST_TICK)


def _require_free(project: Project, player_id: str) -> None:
    """Raise AppError if any part other than the player's has notes."""
    for part in project.score.parts:
        if part.notes and part.id != project.player(player_id).part_id:
            raise AppError("take.not_free", part=part.name)


# Helpers


def _with(project: Project, player_id: str, recorded: PlayerTakes) -> Project:
    if recorded == project.takes.get(player_id):
        return project
    return replace(project, takes={**project.takes, player_id: recorded})


def _changed(project: Project, player_id: str, take_id: str, **fields: Any) -> Project:
    recorded = recorded_with(project, player_id, take_id)
    takes = tuple(msgspec.structs.replace(take, **fields) if take.id == take_id else take for take in recorded.takes)
    return _with(project, player_id, msgspec.structs.replace(recorded, takes=takes))


def _replaced(
    project: Project,
    player_id: str,
    requested: Sequence[Note],
    curves: Sequence[ControllerCurve],
    start_tick: int,
    end_tick: int,
) -> Project:
    """Replace the notes of the player's part from ``start_tick`` to ``end_tick`` by those ``requested``, and its
    controllers by ``curves``.
    """
    part = project.part(project.player(player_id))
    outside = [note for note in part.notes if not start_tick <= note.onset_tick < end_tick]
    # A note moved out of the span by hand already exists.
    known = {note.id for note in outside} | _others(project, part.id)
    inside = [note for note in requested if note.id not in known]
    notes = _fitted([note for note in outside if note.onset_tick < start_tick], inside)
    notes = _fitted(notes, [note for note in outside if note.onset_tick >= end_tick])
    return _with_part(project, part.id, notes, _spliced(part.curves, curves, start_tick, end_tick))


def _others(project: Project, part_id: str) -> set[str]:
    """Return the ids of the notes of other parts; a copied player may share ids with a take."""
    return {note.id for part in project.score.parts if part.id != part_id for note in part.notes}


def _fitted(before: list[Note], after: list[Note]) -> list[Note]:
    """Return ``before`` followed by ``after``, where notes of ``before`` end at the latest at the first onset of
    ``after``.
    """
    if not after:
        return before
    first = min(note.onset_tick for note in after)
    cut = [
        msgspec.structs.replace(note, duration_tick=first - note.onset_tick) if note.end_tick > first else note
        for note in before
    ]
    return [*cut, *after]


def _with_part(project: Project, part_id: str, notes: Iterable[Note], curves: tuple[ControllerCurve, ...]) -> Project:
    ordered = tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch)))
    parts = []
    for part in project.score.parts:
        if part.id == part_id and (part.notes != ordered or part.curves != curves):
            part = msgspec.structs.replace(part, notes=ordered, curves=curves)
        parts.append(part)
    if all(after is before for after, before in zip(parts, project.score.parts, strict=True)):
        return project
    return with_score(project, msgspec.structs.replace(project.score, parts=tuple(parts)))


def _spliced(
    before: Sequence[ControllerCurve], given: Sequence[ControllerCurve], start_tick: int, end_tick: int
) -> tuple[ControllerCurve, ...]:
    """Return the curves ``before`` with ``given`` ones inserted from ``start_tick`` to ``end_tick``; after the span the
    previous values continue.
    """
    old, new = {curve.kind: curve for curve in before}, {curve.kind: curve for curve in given}
    result = []
    for kind in (*old, *(kind for kind in new if kind not in old)):
        ticks, values = _steps(old.get(kind))
        new_ticks, new_values = _steps(new.get(kind))
        first, last = np.searchsorted(ticks, [start_tick, end_tick])
        # At both ends of a span the last value before it applies.
        from_index, to_index = np.searchsorted(new_ticks, [start_tick + 1, end_tick])
        # If no value was set before, the take's values must not affect notes before it.
        silent = [(0, 0.0)] if not len(ticks) and start_tick > 0 else []
        goes_on = [(end_tick, _held(ticks, values, end_tick))] if end_tick < LAST_TICK else []
        spliced = (
            ([tick for tick, _ in silent], [value for _, value in silent]),
            (ticks[:first], values[:first]),
            ([start_tick], [_held(new_ticks, new_values, start_tick)]),
            (new_ticks[from_index:to_index], new_values[from_index:to_index]),
            ([tick for tick, _ in goes_on], [value for _, value in goes_on]),
            (ticks[last:], values[last:]),
        )
        all_ticks = np.concatenate([np.asarray(part, np.int64) for part, _ in spliced])
        all_values = np.concatenate([np.asarray(part, np.float64) for _, part in spliced])
        kept = np.append(True, all_values[1:] != all_values[:-1])
        # A controller without any values is omitted.
        if all_values.any():
            result.append(ControllerCurve(kind, tuple(all_ticks[kept].tolist()), tuple(all_values[kept].tolist())))
    return tuple(result)


def _steps(curve: ControllerCurve | None) -> tuple[IntArray, FloatArray]:
    """Return ticks and values (N,) of the steps of a controller; both empty if there is no curve."""
    if curve is None:
        return np.empty(0, np.int64), np.empty(0)
    return _STEPS.step(_arrays, curve)


def _arrays(curve: ControllerCurve) -> tuple[IntArray, FloatArray]:
    return np.array(curve.ticks, np.int64), np.array(curve.values, np.float64)


def _held(ticks: IntArray, values: FloatArray, tick: int) -> float:
    """Return the value in effect at a tick; 0 before the first one."""
    index = int(np.searchsorted(ticks, tick, side="right")) - 1
    return float(values[index]) if index >= 0 else 0.0


def _recleaned(
    project: Project, player_id: str, before: dict[str, Note], after: tuple[Note, ...], span: CompSpan
) -> Project:
    """Update the notes of a take in one span of the part after its cleaning changed from ``before`` to ``after``; notes
    changed by hand stay.
    """
    part = project.part(project.player(player_id))
    here = {note.id: note for note in part.notes}
    now = {note.id: note for note in after if span.start_tick <= note.onset_tick < span.end_tick}
    was = {id: note for id, note in before.items() if span.start_tick <= note.onset_tick < span.end_tick}
    notes = dict(here)
    for id, note in was.items():
        if id in here and _is_as_given(here[id], note):
            del notes[id]
            if id in now:
                notes[id] = now[id]
    known = here.keys() | _others(project, part.id)
    notes |= {id: note for id, note in now.items() if id not in was and id not in known}
    ordered = sorted(notes.values(), key=lambda note: (note.onset_tick, note.pitch))
    breath = take_curves(project, player_id, span.take_id)
    curves = _spliced(part.curves, breath, span.start_tick, span.end_tick)
    return _with_part(project, part.id, ordered, curves)


def _is_as_given(here: Note, given: Note) -> bool:
    """Return whether a note of the part is still as it came from the take, except that it may have been shortened."""
    return here == given or (
        here.duration_tick < given.duration_tick
        and here == msgspec.structs.replace(given, duration_tick=here.duration_tick)
    )
