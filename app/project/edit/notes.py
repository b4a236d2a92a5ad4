"""Edits of notes. Ids stay with their notes, so corrections stay valid.

A new note gets the next free id ``"n:<number>"``, which differs from ids of notes from files ("track:number"); equal
edits give equal ids. Deleting a note deletes its corrections; undo restores both.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import groupby
from typing import Annotated

import msgspec

from app.errors import AppError, FileError
from app.formats.json_data import decode_json
from app.plan.by_hand.corrections import Correction
from app.plan.event_id import EventId
from app.project.anchors import notes_of
from app.project.edit.length import with_score
from app.project.edit.mark_ends import carried_on, drawn_in
from app.project.ids import new_note_ids
from app.project.limits import LAST_TICK, TICKS_PER_QUARTER
from app.project.model import Project
from app.project.snap_grid import Grid
from app.score.model import Note, Part

LOW_PITCH, HIGH_PITCH = 0, 127
LOW_VELOCITY, HIGH_VELOCITY = 1, 127


def chosen_notes(project: Project, note_ids: Collection[str]) -> Iterator[tuple[Part, list[Note]]]:
    """Yield each part that contains any of the given notes, together with these notes in order of onset."""
    requested = frozenset(note_ids)
    for part in project.score.parts:
        if not requested.isdisjoint(part.note_ids):
            yield part, [note for note in part.notes if note.id in requested]


def add_note(
    project: Project, part_id: str, onset_tick: int, duration_tick: int, pitch: int, velocity: int
) -> tuple[Project, str]:
    """Add a note to a part. Returns the project and the note's id.

    Raises
    ------
    KeyError
        There is no such part.
    """
    note = _checked(Note(next(new_note_ids(project)), onset_tick, duration_tick, pitch, velocity))
    if part_id not in {part.id for part in project.score.parts}:
        raise KeyError(part_id)
    return _edited(project, {part_id}, lambda notes: [*notes, note]), note.id


def reach_of_move(project: Project, note_ids: Collection[str], by_tick: int, by_pitch: int) -> tuple[int, int]:
    """Return the largest move (ticks, semitones) that all given notes can make together, up to (by_tick, by_pitch)."""
    notes = [note for _, mine in chosen_notes(project, note_ids) for note in mine]
    if not notes:
        return 0, 0
    pitches = [note.pitch for note in notes]
    return (
        max(by_tick, -min(note.onset_tick for note in notes)),
        min(max(by_pitch, LOW_PITCH - min(pitches)), HIGH_PITCH - max(pitches)),
    )


def move(project: Project, note_ids: Collection[str], by_tick: int, by_pitch: int) -> Project:
    """Move notes by ``by_tick`` ticks and ``by_pitch`` semitones; they keep their distances."""

    def moved(note: Note) -> Note:
        return _checked(
            msgspec.structs.replace(note, onset_tick=note.onset_tick + by_tick, pitch=note.pitch + by_pitch)
        )

    return _each(project, note_ids, moved) if by_tick or by_pitch else project


def resize(project: Project, note_ids: Collection[str], by_tick: int, *, at_start: bool = False) -> Project:
    """Move the ends of notes, or their onsets. None gets shorter than a tick or begins before the piece."""

    def resized(note: Note) -> Note:
        if at_start:
            onset = min(max(note.onset_tick + by_tick, 0), note.end_tick - 1)
            return msgspec.structs.replace(note, onset_tick=onset, duration_tick=note.end_tick - onset)
        return msgspec.structs.replace(note, duration_tick=max(note.duration_tick + by_tick, 1))

    return _each(project, note_ids, resized) if by_tick else project


def erase(project: Project, note_ids: Collection[str]) -> Project:
    """Delete notes and their corrections. A slur that ended at a deleted note ends at the nearest remaining one."""
    gone = {note.id for _, mine in chosen_notes(project, note_ids) for note in mine}
    if not gone:
        return project
    parts = {part.id for part, _ in chosen_notes(project, gone)}
    project = drawn_in(project, gone)
    project = _edited(project, parts, lambda notes: [note for note in notes if note.id not in gone])
    kept = {
        player_id: tuple(item for item in items if not (_notes_of(item) & gone))
        for player_id, items in project.corrections.items()
    }
    if all(len(kept[player_id]) == len(items) for player_id, items in project.corrections.items()):
        return project
    return replace(project, corrections={player_id: items for player_id, items in kept.items() if items})


def split(project: Project, note_ids: Collection[str], tick: int) -> tuple[Project, tuple[str, ...]]:
    """Split notes in two at a tick; the first half keeps the id. Return the project and the ids of the second
    halves.
    """
    ids = new_note_ids(project)
    seconds: dict[str, Note] = {}
    for _, mine in chosen_notes(project, note_ids):
        for note in mine:
            if note.onset_tick < tick < note.end_tick:
                seconds[note.id] = msgspec.structs.replace(
                    note, id=next(ids), onset_tick=tick, duration_tick=note.end_tick - tick
                )
    if not seconds:
        raise AppError("note.nothing_to_split")
    project = _each(
        project, seconds.keys(), lambda note: msgspec.structs.replace(note, duration_tick=tick - note.onset_tick)
    )
    project = carried_on(project, {first: second.id for first, second in seconds.items()})
    return _with_more(project, seconds), tuple(note.id for note in seconds.values())


def join(project: Project, note_ids: Collection[str]) -> Project:
    """Join selected consecutive notes of equal pitch in a part into one note, which keeps the first id."""
    longer: dict[str, int] = {}
    absorbed: dict[str, str] = {}
    requested = frozenset(note_ids)
    for part, _ in chosen_notes(project, requested):
        for joined, group in groupby(_runs(part, requested), key=lambda pair: pair[0]):
            run = [note for _, note in group]
            if joined and len(run) > 1:
                longer[run[0].id] = max(note.end_tick for note in run)
                absorbed |= dict.fromkeys((note.id for note in run[1:]), run[0].id)
    if not absorbed:
        raise AppError("note.nothing_to_join")
    return _each(
        erase(carried_on(project, absorbed), absorbed),
        longer.keys(),
        lambda note: msgspec.structs.replace(note, duration_tick=longer[note.id] - note.onset_tick),
    )


def _runs(part: Part, requested: Collection[str]) -> Iterator[tuple[int, Note]]:
    """Yield a part's notes, each after the number of its run; 0 for notes that are not in ``requested``.

    A run is a series of adjacent notes of ``requested`` at one pitch.
    """
    run = 0
    before: Note | None = None
    for note in part.notes:
        if note.id not in requested:
            before = None
            yield 0, note
            continue
        if before is None or before.pitch != note.pitch:
            run += 1
        before = note
        yield run, note


def duplicate(
    project: Project, note_ids: Collection[str], by_tick: int, by_pitch: int = 0
) -> tuple[Project, tuple[str, ...]]:
    """Copy notes within their parts, moved by ticks and semitones; return the project and the ids of the copies."""
    ids = new_note_ids(project)
    copies = {
        note.id: _checked(
            msgspec.structs.replace(
                note, id=next(ids), onset_tick=note.onset_tick + by_tick, pitch=note.pitch + by_pitch
            )
        )
        for _, mine in chosen_notes(project, note_ids)
        for note in mine
    }
    return _with_more(project, copies), tuple(note.id for note in copies.values())


def set_velocity(project: Project, note_ids: Collection[str], velocity: int) -> Project:
    """Set the MIDI velocity of the given notes."""
    return _each(project, note_ids, lambda note: _checked(msgspec.structs.replace(note, velocity=velocity)))


def change_velocity(project: Project, note_ids: Collection[str], by: int = 0, factor: float = 1.0) -> Project:
    """Multiply the velocities of the notes by a factor, then add ``by``; results are clipped to 1..127."""

    def changed(note: Note) -> Note:
        velocity = round(note.velocity * factor) + by
        return msgspec.structs.replace(note, velocity=min(max(velocity, LOW_VELOCITY), HIGH_VELOCITY))

    return _each(project, note_ids, changed)


def quantise(
    project: Project,
    note_ids: Collection[str],
    quarters: Fraction,
    strength: float = 1.0,
    *,
    onsets: bool = True,
    ends: bool = False,
) -> Project:
    """Move notes towards a grid.

    Parameters
    ----------
    quarters : Fraction
        The grid's step.
    strength : float
        Share of the way to the nearest grid line, 0..1.
    onsets, ends : bool
        Whether to move onsets, and whether to move ends. If only onsets move, lengths stay; if only ends move, at least
        a tick remains.
    """
    grid, score = Grid(quarters), project.score

    def drawn(tick: int) -> int:
        return round(tick + strength * (grid.snap(score.metre_map, tick) - tick))

    def quantised(note: Note) -> Note:
        onset = drawn(note.onset_tick) if onsets else note.onset_tick
        onset = max(onset, 0)
        end = drawn(note.end_tick) if ends else onset + note.duration_tick
        return msgspec.structs.replace(note, onset_tick=onset, duration_tick=max(end - onset, 1))

    return _each(project, note_ids, quantised)


# Clipboard


class CopiedNote(msgspec.Struct, frozen=True):
    """A note on the clipboard; its onset is relative to that of the first note there."""

    offset_tick: int
    duration_tick: int
    pitch: int
    velocity: int


class CopiedLine(msgspec.Struct, frozen=True):
    """Notes on the clipboard that come from one part."""

    part_id: str
    notes: tuple[CopiedNote, ...]


class ClipboardNotes(msgspec.Struct, frozen=True):
    """Notes on the clipboard, with the number of ticks per quarter."""

    ticks_per_quarter: Annotated[int, msgspec.Meta(ge=TICKS_PER_QUARTER[0], le=TICKS_PER_QUARTER[1])]
    lines: tuple[CopiedLine, ...]


def read_clip(data: bytes) -> ClipboardNotes | None:
    """Decode notes from the clipboard; None if the data is invalid."""
    try:
        return decode_json(data, ClipboardNotes, "")
    except FileError:
        return None


def copied(project: Project, note_ids: Collection[str]) -> ClipboardNotes:
    """Return a copy of notes for the clipboard, with onsets relative to the first one."""
    chosen = list(chosen_notes(project, note_ids))
    first = min((notes[0].onset_tick for _, notes in chosen), default=0)
    lines = tuple(
        CopiedLine(
            part.id,
            tuple(CopiedNote(note.onset_tick - first, note.duration_tick, note.pitch, note.velocity) for note in notes),
        )
        for part, notes in chosen
    )
    return ClipboardNotes(project.score.ticks_per_quarter, lines)


def paste(project: Project, part_id: str, clip: ClipboardNotes, at_tick: int) -> tuple[Project, tuple[str, ...]]:
    """Insert copied notes at a tick; returns the project and the new ids.

    Notes of a single part go to ``part_id``; notes of several parts go to their own parts, or to ``part_id`` if a part
    no longer exists.
    """
    ids = new_note_ids(project)
    scale = Fraction(project.score.ticks_per_quarter, clip.ticks_per_quarter)
    known = {part.id for part in project.score.parts}
    if part_id not in known:
        raise KeyError(part_id)
    added: dict[str, list[Note]] = {}
    for line in clip.lines:
        target = line.part_id if len(clip.lines) > 1 and line.part_id in known else part_id
        for item in line.notes:
            onset = at_tick + round(item.offset_tick * scale)
            duration = max(round(item.duration_tick * scale), 1)
            note = _checked(Note(next(ids), onset, duration, item.pitch, item.velocity))
            added.setdefault(target, []).append(note)
    for target, notes in added.items():
        project = _edited(project, {target}, lambda before, notes=notes: [*before, *notes])  # type: ignore[misc]
    return project, tuple(note.id for notes in added.values() for note in notes)


# Helpers


def _checked(note: Note) -> Note:
    if note.onset_tick < 0:
        raise AppError("note.before_start")
    if note.duration_tick < 1:
        raise AppError("note.too_short")
    if note.end_tick > LAST_TICK:
        raise AppError("note.after_all_pieces")
    if not LOW_PITCH <= note.pitch <= HIGH_PITCH:
        raise AppError("note.pitch_outside", pitch=note.pitch, low=LOW_PITCH, high=HIGH_PITCH)
    if not LOW_VELOCITY <= note.velocity <= HIGH_VELOCITY:
        raise AppError("note.velocity_outside", velocity=note.velocity, low=LOW_VELOCITY, high=HIGH_VELOCITY)
    return note


def _notes_of(item: Correction) -> set[str]:
    """Return the ids of the notes of a correction, including the note of its event, as in ``"breath:<note>"``."""
    return {item.anchor, EventId.parse(item.anchor).of, *notes_of(item)}


def _each(project: Project, note_ids: Iterable[str], edit: Callable[[Note], Note]) -> Project:
    requested = frozenset(note_ids)
    parts = {part.id for part in project.score.parts if not requested.isdisjoint(part.note_ids)}
    return _edited(project, parts, lambda notes: [edit(note) if note.id in requested else note for note in notes])


def _with_more(project: Project, beside: dict[str, Note]) -> Project:
    """Add to the project, in the same part, the new note given for each note id."""

    def more(notes: tuple[Note, ...]) -> list[Note]:
        return [*notes, *(beside[note.id] for note in notes if note.id in beside)]

    return _edited(project, {part.id for part, _ in chosen_notes(project, beside)}, more)


def _edited(project: Project, part_ids: Collection[str], edit: Callable[[tuple[Note, ...]], list[Note]]) -> Project:
    """Return the project with ``edit`` applied to the notes of the given parts, and the result sorted; `project` itself
    if nothing changes.
    """
    parts = []
    for part in project.score.parts:
        if part.id in part_ids:
            notes = edit(part.notes)
            if len(notes) != len(part.notes) or any(
                a is not b and a != b for a, b in zip(notes, part.notes, strict=True)
            ):
                notes.sort(key=lambda note: (note.onset_tick, note.pitch))
                part = msgspec.structs.replace(part, notes=tuple(notes))
        parts.append(part)
    if all(after is before for after, before in zip(parts, project.score.parts, strict=True)):
        return project
    return with_score(project, msgspec.structs.replace(project.score, parts=tuple(parts)))
