"""Edits that write, delete and move marks of a part: slurs, articulations, breaths, dynamics, hairpins.

Changing a mark of the score removes it and writes a new one. In a part from MIDI a dynamic written over several notes
applies to those; over one note, and always in a part from a score, it applies until the next dynamic.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Final, NamedTuple

from app.errors import UsageError
from app.plan.by_hand.mark_corrections import (
    RemoveMark,
    SetMark,
    mark_corrections,
    remove_mark,
    set_mark,
)
from app.plan.music.written_dynamics import holding_row
from app.project.edit.corrections import take_back, with_corrections
from app.project.edit.found_events import Origin as Origin
from app.project.edit.found_events import player_marks as player_marks
from app.project.model import Project
from app.score.marks import MARK_KINDS, Mark
from app.score.model import Note

EXCLUDING: Final[tuple[frozenset[str], ...]] = (
    frozenset({"staccato", "staccatissimo", "tenuto"}),
    frozenset({"accent", "marcato"}),
    frozenset({"breath", "caesura"}),
    frozenset({"double_tongue", "triple_tongue", "flutter_tongue"}),
    frozenset({"slur", "non_legato"}),
    frozenset({"crescendo", "diminuendo"}),
)
"""Groups of kinds of which a note has at most one; adding one removes the others."""
AFTER: Final = frozenset({"breath", "caesura"})
"""Kinds that are placed after the selected note."""


class Marked(NamedTuple):
    """Result of toggling musical marks: the new project, True if marks were added (False: removed), and the number of
    marks concerned."""

    project: Project
    added: bool
    number: int


def set_marks(project: Project, player_id: str, marks: Iterable[Mark]) -> Project:
    """Write marks; each replaces one of its kind at the same place. A mark equal to one of the score that was removed
    restores it.
    """
    chosen = tuple(marks)
    read = frozenset(project.part(project.player(player_id)).marks)
    project = give_back_marks(project, player_id, chosen)
    return with_corrections(project, player_id, [set_mark(mark) for mark in chosen if mark not in read])


def remove_marks(project: Project, player_id: str, marks: Iterable[Mark]) -> Project:
    """Remove marks: those by hand are deleted, those of the score are marked as removed."""
    chosen = tuple(marks)
    project = take_back(project, player_id, [remove_mark(mark) for mark in chosen])
    left = player_marks(project, player_id)
    ids = {mark.id for mark in chosen}
    return with_corrections(project, player_id, [remove_mark(mark) for mark in left if mark.id in ids])


def replace_mark(project: Project, player_id: str, mark: Mark, changed: Mark) -> Project:
    """Replace a musical mark by a changed one, such as at another note or with another text."""
    return set_marks(remove_marks(project, player_id, [mark]), player_id, [changed])


def give_back_marks(project: Project, player_id: str, marks: Iterable[Mark]) -> Project:
    """Restore marks of the score that the user had removed."""
    return take_back(project, player_id, [remove_mark(mark) for mark in marks])


def corrections_at(project: Project, player_id: str, note_ids: Collection[str]) -> tuple[SetMark | RemoveMark, ...]:
    """Return the corrections of marks that belong to the given notes or begin at their onsets."""
    said = mark_corrections(project.corrections.get(player_id, ()))
    if not said:
        return ()
    part = project.part(project.player(player_id))
    ticks = {note.onset_tick for note in part.notes if note.id in note_ids}
    return tuple(item for item in said if item.note_id in note_ids or item.start_tick in ticks)


def toggle_marks(project: Project, notes: Mapping[str, Sequence[Note]], kind: str, text: str = "") -> Marked:
    """Write a mark over the selected notes, or remove it if all of them have it.

    A mark of notes extends from a player's first selected note to the last. A breath mark or caesura follows the last
    note, a dynamic is at the first note, and a hairpin lasts to the end of the last note.

    Parameters
    ----------
    notes : mapping of str to sequence of Note
        The selected notes by player, in order.

    Raises
    ------
    UsageError
        No player has enough selected notes for this kind of mark.
    """
    anchor = MARK_KINDS[kind].anchor
    least = 2 if anchor == "notes" else 1
    chosen = {player_id: own for player_id, own in notes.items() if len(own) >= least}
    if not chosen:
        raise UsageError("mark.one_note" if any(notes.values()) else "mark.no_notes")
    requested = {player_id: _marks_over(project, player_id, own, kind, text) for player_id, own in chosen.items()}
    there = {player_id: player_marks(project, player_id) for player_id in chosen}
    adds = any(mark not in there[player_id] for player_id, marks in requested.items() for mark in marks)
    count = 0
    for player_id, marks in requested.items():
        if not adds:
            project, count = remove_marks(project, player_id, marks), count + len(marks)
            continue
        fresh = [mark for mark in marks if mark not in there[player_id]]
        count += len(fresh)
        excluded = _excluded(there[player_id], fresh)
        project = set_marks(remove_marks(project, player_id, excluded), player_id, fresh)
    return Marked(project, adds, count)


def next_dynamic_tick(marks: Iterable[Mark], mark: Mark) -> int | None:
    """Return the tick of the next dynamic, at which one without an end stops being in force; None if there is none."""
    later = (one.tick for one in marks if one.tick > mark.tick and not one.end_tick and holding_row(one) is not None)
    return min(later, default=None)


def marks_at(marks: Collection[Mark], notes: Sequence[Note], order: Mapping[str, int]) -> list[Mark]:
    """Return the marks at the given notes, over some of them, or at ticks within them.

    Parameters
    ----------
    order : mapping of str to int
        Index of every note of the part by id.
    """
    places = sorted(order[note.id] for note in notes)
    onsets = sorted(note.onset_tick for note in notes)
    ends = {note.onset_tick: note.end_tick for note in notes}
    ids = {note.id for note in notes}

    def is_at(mark: Mark) -> bool:
        if mark.note_id:
            if MARK_KINDS[mark.kind].anchor != "notes":
                return mark.note_id in ids
            first, last = order.get(mark.note_id), order.get(mark.last_note_id)
            return first is not None and last is not None and _any_within(places, first, last)
        before = bisect_right(onsets, mark.tick) - 1
        sounds = before >= 0 and mark.tick < ends[onsets[before]]
        return sounds or _any_within(onsets, mark.tick, mark.end_tick - 1)

    return [mark for mark in marks if is_at(mark)]


def _any_within(ordered: Sequence[int], first: int, last: int) -> bool:
    at = bisect_left(ordered, first)
    return at < len(ordered) and ordered[at] <= last


def _marks_over(project: Project, player_id: str, notes: Sequence[Note], kind: str, text: str) -> list[Mark]:
    """Return the marks of a kind to be written over selected notes of one player."""
    anchor = MARK_KINDS[kind].anchor
    first, last = notes[0], max(notes, key=lambda note: note.end_tick)
    if anchor == "notes":
        return [Mark(kind, first.id, notes[-1].id, text=text)]
    if kind in AFTER:
        return [Mark(kind, notes[-1].id)]
    if anchor == "note":
        return [Mark(kind, note.id, text=text) for note in notes]
    holds = anchor == "span" or (len(notes) > 1 and project.part(project.player(player_id)).source == "sound")
    return [Mark(kind, tick=first.onset_tick, end_tick=last.end_tick if holds else 0, text=text)]


def _excluded(there: Collection[Mark], fresh: Sequence[Mark]) -> list[Mark]:
    """Return the marks among ``there`` that cannot be combined with new ones."""
    others: dict[str, frozenset[str]] = {kind: kinds - {kind} for kinds in EXCLUDING for kind in kinds}
    places = {(other, *_place(mark)) for mark in fresh for other in others.get(mark.kind, ())}
    return [mark for mark in there if (mark.kind, *_place(mark)) in places]


def _place(mark: Mark) -> tuple[str, str, int]:
    return mark.note_id, mark.last_note_id, mark.tick
