"""Names of edits of events, which say of what kind these are, whose, and where; and of edits of players."""

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
from app.project.model import Project
from app.project.performers import Player

OF_EVENTS: Final = {
    "edit.move_events": "edit.move_event",
    "edit.resize_events": "edit.resize_event",
    "edit.remove_events": "edit.remove_event",
    "edit.set_event_amounts": "edit.set_event_amount",
}
"""Names of edits of a single event by those of several."""
_ANY_KIND: Final = "event"
_MOST_NAMES: Final = 2


class PlannedPiece(Protocol):
    """Part of the session that says where events are."""

    @property
    def project(self) -> Project: ...
    @property
    def performance(self) -> Performance: ...


def edit_of_events(session: PlannedPiece, name: str, keys: Collection[EventKey]) -> Message:
    """Return the name of an edit of some events, one of `OF_EVENTS`: their kind, their players, from where to where."""
    kinds = {EventId.parse(key.event_id).kind for key in keys}
    kind = kinds.pop() if len(kinds) == 1 else _ANY_KIND
    of = " · ".join(filter(None, (_players(session, keys), _places(session, keys))))
    said: dict[str, Argument] = {"event": kind, "of": of}
    if len(keys) == 1:
        return Message(OF_EVENTS[name], said)
    return Message(name, {**said, "count": len(keys)})


def edit_of_players(project: Project, name: str, player_ids: Collection[str], **more: Argument) -> Message:
    """Return the name of an edit of some players, which names the first ones, and counts more than these."""
    names = [player.name for player in project.players if player.id in player_ids]
    rest = f", … ({len(names)})" if len(names) > _MOST_NAMES else ""
    return Message(name, {**more, "of": ", ".join(names[:_MOST_NAMES]) + rest})


def edit_of_parameter(project: Project, parameter: str, player_ids: Collection[str]) -> Message:
    """Return the name of a change of a parameter of some players."""
    return edit_of_players(project, "edit.parameter", player_ids, parameter=PARAMETERS[parameter].label)


def _players(session: PlannedPiece, keys: Iterable[EventKey]) -> str:
    ids = {key.player_id for key in keys}
    names = [player.name for player in session.project.players if player.id in ids]
    return ", ".join(names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else "")


def _places(session: PlannedPiece, keys: Iterable[EventKey]) -> str:
    players = {player.id: player for player in session.project.players}
    ticks = {_tick(session, players[key.player_id], key.event_id) for key in keys if key.player_id in players}
    known = sorted(tick for tick in ticks if tick is not None)
    labels = dict.fromkeys(session.project.score.metre_map.label(tick) for tick in (*known[:1], *known[-1:]))
    return "–".join(labels)


def _tick(session: PlannedPiece, player: Player, event_id: str) -> int | None:
    """The tick at which an event begins as planned, else that of the note or the tick that its id names."""
    performance = session.performance
    plan = performance.plans.get(player.id) if performance.planned else None
    placed = placed_events(plan, (event_id,)) if plan is not None else ()
    if placed:
        return placed[0].start_tick
    for place in EventId.parse(event_id).places:
        if place.startswith("@") and place[1:].lstrip("-").isdecimal():
            return int(place[1:])
        # A mark over several notes names the first and the last one.
        note = note_of(session.project.score, place.partition("-")[0], player.part_id)
        if note is not None:
            return note.onset_tick
    return None
