"""Names of edits for the history, which say the kind of the edited notes or events, their players and their place."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Final, Protocol

from app.editor.selection import EventKey
from app.errors import Argument, Message
from app.performance.ensemble import Performance
from app.plan.event_id import EventId
from app.plan.parameters import PARAMETERS
from app.plan.problem_lines import note_of
from app.project.edit.events import placed_events
from app.project.edit.notes import chosen_notes
from app.project.model import Project
from app.project.performers import Dancer, Player

OF_EVENTS: Final = {
    "edit.move_events": "edit.move_event",
    "edit.resize_events": "edit.resize_event",
    "edit.remove_events": "edit.remove_event",
    "edit.set_event_amounts": "edit.set_event_amount",
}
"""Name of the edit for a single event, by the name of the edit for several events."""
_ANY_KIND: Final = "event"
_MOST_NAMES: Final = 2


class PlannedPiece(Protocol):
    """The part of the session that knows the planned ticks of events, as needed for naming edits.

    Models of the timeline, which do not use Qt, have this interface too.
    """

    @property
    def project(self) -> Project: ...
    @property
    def performance(self) -> Performance: ...


def edit_of_events(session: PlannedPiece, name: str, keys: Collection[EventKey]) -> Message:
    """Return the name of an edit of some events, one of `OF_EVENTS`, with their kind, players and range."""
    kinds = {EventId.parse(key.event_id).kind for key in keys}
    kind = kinds.pop() if len(kinds) == 1 else _ANY_KIND
    ids = {key.player_id for key in keys}
    of = " · ".join(filter(None, (_named(session.project, ids), _places(session, keys))))
    said: dict[str, Argument] = {"event": kind, "of": of}
    if len(keys) == 1:
        return Message(OF_EVENTS[name], said)
    return Message(name, {**said, "count": len(keys)})


def edit_at_events(session: PlannedPiece, name: str, keys: Collection[EventKey]) -> Message:
    """Return the name of an edit of some events, with their players and range; ``name`` is the same for all kinds of
    events.
    """
    of = (_named(session.project, {key.player_id for key in keys}), _places(session, keys))
    return Message(name, {"of": " · ".join(filter(None, of))})


def edit_of_notes(
    project: Project, name: str, note_ids: Collection[str], player_ids: Collection[str] | None = None
) -> Message:
    """Return the name of an edit of some notes, with their number, players and range.

    Parameters
    ----------
    player_ids : collection of str, optional
        The intended players of a shared part; by default all players of the notes.
    """
    found = list(chosen_notes(project, note_ids))
    if player_ids is None:
        parts = {part.id for part, _ in found}
        player_ids = {player.id for player in project.players if player.part_id in parts}
    return edit_at(project, name, len(note_ids), player_ids, [note.onset_tick for _, mine in found for note in mine])


def edit_at(
    project: Project, name: str, count: int, player_ids: Collection[str], ticks: Iterable[int], **more: Argument
) -> Message:
    """Return the name of an edit of ``count`` items of some players, with the range of the given ticks.

    Parameters
    ----------
    more : Argument
        Further arguments of the message ``name``.
    """
    of = " · ".join(filter(None, (_named(project, player_ids), _range(project, ticks))))
    return Message(name, {**more, "count": count, "of": of})


def edit_of_players(project: Project, name: str, player_ids: Collection[str], **more: Argument) -> Message:
    """Return the name of an edit of some players, with the first players' names and, if there are more, their
    number.
    """
    names = [player.name for player in project.players if player.id in player_ids]
    rest = f", … ({len(names)})" if len(names) > _MOST_NAMES else ""
    return Message(name, {**more, "of": ", ".join(names[:_MOST_NAMES]) + rest})


def edit_of_parameter(project: Project, parameter: str, player_ids: Collection[str]) -> Message:
    """Return the name of a change of a parameter of some players."""
    return edit_of_players(project, "edit.parameter", player_ids, parameter=PARAMETERS[parameter].label)


def _named(project: Project, player_ids: Collection[str]) -> str:
    performers: tuple[Player | Dancer, ...] = (*project.players, *project.dancers)
    names = [one.name for one in performers if one.id in player_ids]
    return ", ".join(names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else "")


def _range(project: Project, ticks: Iterable[int]) -> str:
    known = sorted(ticks)
    return "–".join(dict.fromkeys(project.score.metre_map.label(tick) for tick in (*known[:1], *known[-1:])))


def _places(session: PlannedPiece, keys: Iterable[EventKey]) -> str:
    players = {player.id: player for player in session.project.players}
    ticks = [_tick(session, players[key.player_id], key.event_id) for key in keys if key.player_id in players]
    return _range(session.project, [tick for tick in ticks if tick is not None])


def _tick(session: PlannedPiece, player: Player, event_id: str) -> int | None:
    """Return the planned start tick of an event, or the tick of the note or place in its id if it is not planned; None
    if there is neither.
    """
    performance = session.performance
    plan = performance.plans.get(player.id) if performance.planned else None
    placed = placed_events(plan, (event_id,)) if plan is not None else ()
    if placed:
        return placed[0].start_tick
    for place in EventId.parse(event_id).places:
        if place.startswith("@") and place[1:].lstrip("-").isdecimal():
            return int(place[1:])
        # A mark over several notes names its first and last note.
        note = note_of(session.project.score, place.partition("-")[0], player.part_id)
        if note is not None:
            return note.onset_tick
    return None
