"""Objects that commands act on (selected notes and events, their players, the timeline), and conditions for enabling
commands.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable

from app.editor.session import Session
from app.editor.timeline_view import TimelineView
from app.project.performers import Player
from app.score.model import Note


def notes_by_player(session: Session) -> dict[Player, list[Note]]:
    """Return the selected notes by player, each list in the order of the score.

    Where several players share a part, its notes belong to those of them that are selected, or else to all.
    """
    project, selected = session.project, session.selection.notes
    by_part = {
        part.id: found
        for part in project.score.parts
        if selected and (found := [note for note in part.notes if note.id in selected])
    }
    owners: dict[str, list[Player]] = defaultdict(list)
    for player in project.players:
        if player.part_id in by_part:
            owners[player.part_id].append(player)
    result = {}
    for part_id, players in owners.items():
        front = [player for player in players if player.id in session.players]
        for player in front or players:
            result[player] = by_part[part_id]
    return result


def events_by_player(session: Session) -> dict[str, list[str]]:
    """Return the ids of the selected events by player."""
    result: dict[str, list[str]] = defaultdict(list)
    known = {player.id for player in session.project.players}
    for key in sorted(session.selection.events):
        if key.player_id in known:
            result[key.player_id].append(key.event_id)
    return result


def selected_ticks(session: Session) -> tuple[int, int] | None:
    """Return the selected range of ticks, else the range of the selected notes."""
    selection = session.selection
    if selection.span is not None:
        return selection.span
    notes = [note for part in session.project.score.parts for note in part.notes if note.id in selection.notes]
    if not notes:
        return None
    return min(note.onset_tick for note in notes), max(note.end_tick for note in notes)


def has_notes(session: Session) -> bool:
    """Return whether notes are selected."""
    return bool(session.selection.notes)


def has_something(session: Session) -> bool:
    """Return whether notes or events are selected."""
    return bool(session.selection.notes or session.selection.events)


def has_player(session: Session) -> bool:
    """Return whether a player is active, so that commands about players apply."""
    return session.player is not None


def has_everyone(session: Session) -> bool:
    """Return whether the piece has any players."""
    return bool(session.project.players)


def on_timeline(run: Callable[[TimelineView], None]) -> Callable[..., None]:
    """Return a command that calls a function with the shown timeline, and does nothing while none is shown."""

    def asked(session: Session, on: bool = True) -> None:
        if session.timeline_view is not None:
            run(session.timeline_view)

    return asked
