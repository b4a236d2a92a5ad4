"""Comparison of two versions of a part: its changes in order, for review before the newer version is used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby
from typing import Literal, TypeAlias

import msgspec

from app.project.kept_parts import moved_part
from app.project.moved_ticks import place_map
from app.score.marks import Mark
from app.score.model import Note, Part, Score

ChangeKind: TypeAlias = Literal["added", "removed", "moved", "changed", "marks", "controllers"]
KINDS: tuple[ChangeKind, ...] = ("added", "removed", "moved", "changed", "marks", "controllers")


@dataclass(frozen=True)
class PartChange:
    """A changed note, mark or controller, or a run of notes moved by the same distance.

    Attributes
    ----------
    tick, tick_now : int
        Tick in the previous and in the new version.
    before, now : Note, Mark or None
        The changed item in each version; None if missing there. For a run, its first note.
    count : int
        Number of moved notes.
    """

    kind: ChangeKind
    tick: int
    tick_now: int
    before: Note | Mark | None = None
    now: Note | Mark | None = None
    count: int = 1


PartChanges: TypeAlias = Mapping[str, tuple[PartChange, ...]]
"""Changes of each part, by the part's id."""


def changes_by_part(before: Score, now: Score) -> PartChanges:
    """Return the changes of every part of a newer score, by part id."""
    scale = Fraction(now.ticks_per_quarter, before.ticks_per_quarter)
    former = {part.id: part for part in before.parts}
    return {part.id: part_changes(former.get(part.id), part, scale) for part in now.parts}


def part_changes(before: Part | None, now: Part | None, scale: Fraction) -> tuple[PartChange, ...]:
    """Return the changes between two versions of a part.

    Notes are matched by id. Neighbours moved by the same distance form one change, so that bars inserted before a
    thousand notes give one entry.

    Parameters
    ----------
    before, now : Part or None
        Versions; None if one is missing, so that all notes are added or removed.
    scale : Fraction
        Ticks of the new version per tick of the previous one.
    """
    was = {note.id: note for note in before.notes} if before is not None else {}
    new = {note.id: note for note in now.notes} if now is not None else {}
    stayed = [(was[id], note) for id, note in new.items() if id in was]
    pairs = [(one.onset_tick, other.onset_tick) for one, other in stayed]
    place, back = place_map(pairs, scale), place_map([pair[::-1] for pair in pairs], 1 / scale)
    found = [PartChange("added", back(note.onset_tick), note.onset_tick, None, note) for note in _only(new, was)]
    found += [PartChange("removed", note.onset_tick, place(note.onset_tick), note) for note in _only(was, new)]
    found += _moves(stayed, scale)
    found += [
        PartChange("changed", one.onset_tick, other.onset_tick, one, other)
        for one, other in stayed
        if (one.pitch, one.velocity) != (other.pitch, other.velocity)
        or max(_scaled(one.duration_tick, scale), 1) != other.duration_tick
    ]
    if before is not None and now is not None:
        moved = moved_part(msgspec.structs.replace(before, notes=()), before.id, place, scale)
        found += _marks(before, moved, now)
        if (moved.curves, moved.muted, moved.stopped) != (now.curves, now.muted, now.stopped):
            found.append(PartChange("controllers", 0, 0))
    return tuple(sorted(found, key=lambda change: (change.tick_now, KINDS.index(change.kind))))


def _only(notes: dict[str, Note], others: dict[str, Note]) -> Iterator[Note]:
    return (note for id, note in notes.items() if id not in others)


def _scaled(ticks: int, scale: Fraction) -> int:
    # Fractions are slow, and most files keep their resolution.
    return ticks if scale == 1 else round(ticks * scale)


def _moves(stayed: Sequence[tuple[Note, Note]], scale: Fraction) -> Iterator[PartChange]:
    """Yield runs of notes moved by the same distance."""
    distances = groupby(stayed, lambda pair: pair[1].onset_tick - _scaled(pair[0].onset_tick, scale))
    for distance, run in distances:
        if distance:
            (before, now), *more = run
            yield PartChange("moved", before.onset_tick, now.onset_tick, before, now, 1 + len(more))


def _marks(before: Part, moved: Part, now: Part) -> Iterator[PartChange]:
    """Yield added, removed and changed marks.

    Parameters
    ----------
    moved : Part
        The previous version with its ticks converted to those of the new one.
    """
    onsets = {note.id: note.onset_tick for note in before.notes}
    onsets_now = {note.id: note.onset_tick for note in now.notes}
    former = {mark.id: (was, mark) for was, mark in zip(before.marks, moved.marks, strict=True)}
    present = {mark.id: mark for mark in now.marks}
    for id in dict.fromkeys((*former, *present)):
        was, mark = former.get(id, (None, None))
        here = present.get(id)
        there, now_there = was or here, here or mark
        if mark == here or there is None or now_there is None:
            continue
        tick = onsets.get(there.note_id, onsets_now.get(there.note_id, there.tick))
        tick_now = onsets_now.get(now_there.note_id, onsets.get(now_there.note_id, now_there.tick))
        yield PartChange("marks", tick, tick_now, mark, here)
