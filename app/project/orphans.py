"""Corrections whose note no longer exists: they are kept without effect until attached to another note or removed."""

from __future__ import annotations

from dataclasses import dataclass

from app.errors import UsageError
from app.plan.by_hand.corrections import Correction
from app.project.anchors import moved_correction, notes_of
from app.project.edit.corrections import take_back, with_corrections
from app.project.model import Project


@dataclass(frozen=True)
class Orphan:
    """A correction whose note no longer exists, with its player."""

    player_id: str
    correction: Correction


def orphaned(project: Project) -> tuple[Orphan, ...]:
    """Return every correction that belongs to a note which its player does not have or no longer has."""
    found = []
    for player in project.players:
        corrections = project.corrections.get(player.id, ())
        if not corrections:
            continue
        played = {note.id for note in project.part(player).notes}
        for correction in corrections:
            if not played.issuperset(notes_of(correction)):
                found.append(Orphan(player.id, correction))
    return tuple(found)


def reattached(project: Project, player_id: str, correction: Correction, note_id: str) -> Project:
    """Attach a correction to another note of its player, keeping lengths relative to the note; it replaces one of the
    same kind there. For a slur, the missing end is attached; if both are missing, the first one.
    """
    anchors = notes_of(correction)
    if not anchors:
        raise UsageError("reimport.no_note", kind=correction.tag)
    played = {note.id for note in project.part(project.player(player_id)).notes}
    if note_id not in played:
        raise UsageError("reimport.not_played", note=note_id)
    former = next((note for note in anchors if note not in played), anchors[0])
    if former == note_id:
        return project
    without = take_back(project, player_id, [correction])
    return with_corrections(without, player_id, [moved_correction(correction, {former: note_id})])
