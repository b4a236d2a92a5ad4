"""Adapts the ends of slurs and other marks when notes are deleted, split or joined, both for marks of the score and for
those set by hand.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import TypeAlias

import msgspec

from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.mark_corrections import OfMark
from app.project.edit.marks import AFTER
from app.project.model import Project
from app.score.marks import MARK_KINDS, Mark
from app.score.model import Part

Ends: TypeAlias = Callable[[str, str, str], tuple[str, str]]
"""Function from a mark's kind and its two ends (note ids) to new ends."""


def drawn_in(project: Project, gone: Collection[str]) -> Project:
    """Shorten slurs to the nearest remaining notes when notes are deleted; slurs that would keep only one note are not
    changed.
    """

    lost = frozenset(gone)

    def ends_of(part: Part) -> Ends:
        place = {note.id: index for index, note in enumerate(part.notes)}
        kept = [index for index, note in enumerate(part.notes) if note.id not in lost]

        def ends(kind: str, first: str, last: str) -> tuple[str, str]:
            if not _spans(kind) or first not in place or last not in place or lost.isdisjoint((first, last)):
                return first, last
            within = [index for index in kept if place[first] <= index <= place[last]]
            return (part.notes[within[0]].id, part.notes[within[-1]].id) if len(within) > 1 else (first, last)

        return ends

    return _anchored(project, lost, ends_of)


def carried_on(project: Project, seconds: Mapping[str, str]) -> Project:
    """Move ends of slurs, and breath marks, from one note to another; ``seconds`` has the new note's id by the old
    one's.
    """

    def ends(kind: str, first: str, last: str) -> tuple[str, str]:
        if kind in AFTER:
            return seconds.get(first, first), last
        end = seconds.get(last, last)
        # If the mark has a single note, both ends move.
        return (first, end) if _spans(kind) and end != first else (first, last)

    return _anchored(project, seconds.keys(), lambda part: ends)


def _spans(kind: str) -> bool:
    return MARK_KINDS[kind].anchor == "notes"


def _anchored(project: Project, note_ids: Collection[str], ends_of: Callable[[Part], Ends]) -> Project:
    """Attach the marks at the given notes, in score and corrections, to other notes: ``ends_of`` returns for a part the
    function that replaces a mark's first and last note.
    """
    parts, corrections = [], dict(project.corrections)
    for part in project.score.parts:
        players = [player.id for player in project.players if player.part_id == part.id]
        said = any(isinstance(item, OfMark) for id in players for item in corrections.get(id, ()))
        if (said or part.marks) and not part.note_ids.isdisjoint(note_ids):
            ends = ends_of(part)
            marks = tuple(_of_score(mark, ends) for mark in part.marks)
            part = part if marks == part.marks else msgspec.structs.replace(part, marks=marks)
            for id in players:
                if id in corrections:
                    corrections[id] = tuple(_by_hand(item, ends) for item in corrections[id])
        parts.append(part)
    if corrections == project.corrections and tuple(parts) == project.score.parts:
        return project
    return replace(project, score=msgspec.structs.replace(project.score, parts=tuple(parts)), corrections=corrections)


def _of_score(mark: Mark, ends: Ends) -> Mark:
    first, last = ends(mark.kind, mark.note_id, mark.last_note_id)
    return msgspec.structs.replace(mark, note_id=first, last_note_id=last)


def _by_hand(item: Correction, ends: Ends) -> Correction:
    if not isinstance(item, OfMark) or item.note_id is None:
        return item
    first, last = ends(item.kind, item.note_id, item.last_note_id or "")
    return msgspec.structs.replace(item, note_id=first, last_note_id=last or None)
