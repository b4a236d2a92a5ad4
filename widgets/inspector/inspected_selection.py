"""The selected notes and events that the inspector shows, with their players."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from app.editor.session import Session
from app.plan.event_id import EventId
from app.plan.model import EmbouchureEvent, FingeringEvent, PlayerPlan
from app.project.edit.events import Placed, placed_events
from app.project.performers import Player
from app.score.model import Note, Part

MOST_NOTES = 500
"""Greatest number of selected notes that are examined, sufficient to find differing values."""


_OF_NOTES = frozenset({"fingering", "embouchure"})


@dataclass(frozen=True)
class SelectedNotes:
    """The selected notes of the active player, else of the first player with selected notes.

    Attributes
    ----------
    player : Player or None
        Player; None for a part without a player.
    note : Note
        First of the notes.
    notes : tuple of Note
        At most `MOST_NOTES` of the player's selected notes.
    note_ids : frozenset of str
        Ids of all selected notes, including other players'.
    """

    player: Player | None
    note: Note
    notes: tuple[Note, ...]
    note_ids: frozenset[str]

    @cached_property
    def own_ids(self) -> tuple[str, ...]:
        """Ids of the selected notes that belong to the displayed player."""
        return tuple(note.id for note in self.notes)


class NoteFinder:
    """Notes of parts by id, cached while a part is unchanged."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[tuple[Note, ...], dict[str, Note]]] = {}

    def chosen(self, part: Part, ids: frozenset[str]) -> list[Note]:
        """Return the notes of a part with given ids."""
        notes, by_id = self._known.get(part.id, ((), {}))
        if notes is not part.notes:
            by_id = {note.id: note for note in part.notes}
            self._known[part.id] = (part.notes, by_id)
        if len(ids) > len(by_id):
            return [note for note in part.notes if note.id in ids]
        return [by_id[note_id] for note_id in ids if note_id in by_id]


def selected_notes(session: Session, finder: NoteFinder) -> SelectedNotes | None:
    """Return the selected notes (see `SelectedNotes`); None if there are none."""
    project, selection = session.project, session.selection
    # A fingering or an embouchure belongs to a note.
    events = [EventId.parse(key.event_id) for key in selection.events]
    ids = selection.notes | {event.of for event in events if event.kind in _OF_NOTES}
    if not ids:
        return None
    front = [project.player(player_id) for player_id in session.players]
    owners = dict.fromkeys((*front, *project.players))
    played = {player.part_id for player in owners}
    seats: list[tuple[Player | None, Part]] = [(player, project.part(player)) for player in owners]
    seats += [(None, part) for part in project.score.parts if part.id not in played]
    for player, part in seats:
        found = finder.chosen(part, ids)
        if found:
            notes = sorted(found, key=lambda note: (note.onset_tick, -note.pitch))
            return SelectedNotes(player, notes[0], tuple(notes[:MOST_NOTES]), ids)
    return None


def selected_events(session: Session) -> tuple[PlayerPlan, tuple[Placed, ...]] | None:
    """Return the selected events of the player and kind of the earliest one, with the player's plan; None if there are
    none.
    """
    keys = session.selection.events
    if not keys:
        return None
    order = {player.id: number for number, player in enumerate(session.project.players)}
    owners = {key.player_id for key in keys}
    requested = [player_id for player_id in session.players if player_id in owners]
    requested += sorted(owners - set(requested), key=lambda player_id: order.get(player_id, 0))
    for player_id in requested:
        plan = session.plans.get(player_id)
        if plan is None:
            continue
        events = placed_events(plan, sorted(key.event_id for key in keys if key.player_id == player_id))
        if events:
            first = min(events, key=lambda event: event.start_s)
            return plan, tuple(
                sorted((event for event in events if type(event) is type(first)), key=lambda event: event.start_s)
            )
    return None


def fingering_of(plan: PlayerPlan, note_id: str) -> FingeringEvent | None:
    """Return the fingering event of a note; None for a note that is not played (a lower note of a chord)."""
    return next((event for event in plan.fingerings if event.note_id == note_id), None)


def embouchure_of(plan: PlayerPlan, note_id: str) -> EmbouchureEvent | None:
    """Return the embouchure event of a note; None for a note that is not played."""
    return next((event for event in plan.embouchures if event.note_id == note_id), None)
