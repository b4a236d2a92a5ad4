"""The selection as an immutable value."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import msgspec

from app.plan.event_id import EventId
from app.plan.model import PlayerPlan
from app.project.edit.events import events_of, is_there
from app.project.edit.placed_takes import BEFORE
from app.project.model import Project
from app.score.marks import MARK

UNPLANNED: Final = ("vary", "additive", MARK)
"""Kinds of selectable events that are not part of plans."""


class EventKey(msgspec.Struct, frozen=True, order=True):
    """Key of an event in a player's plan: the player's id and the event's id."""

    player_id: str
    event_id: str


class Selection(msgspec.Struct, frozen=True):
    """The selected notes, events and players.

    Attributes
    ----------
    notes : frozenset of str
        Ids of the selected notes, unique in the score.
    span : (int, int) or None
        The selected range of time: its first tick and the tick after its last one.
    take : str or None
        Id of the selected take of the active player; empty for the notes from before the first take, None if none is
        selected.
    """

    notes: frozenset[str] = frozenset()
    events: frozenset[EventKey] = frozenset()
    span: tuple[int, int] | None = None
    take: str | None = None

    def __bool__(self) -> bool:
        return bool(self.notes or self.events or self.span or self.take is not None)

    def within(self, project: Project) -> Selection:
        """Return the part of the selection that exists in ``project``; ``self`` if all of it does."""
        notes = self.notes
        if notes:
            notes = frozenset().union(*(notes & part.note_ids for part in project.score.parts))
        events = frozenset(key for key in self.events if is_there(project, key.player_id, key.event_id))
        take = self.take
        if take not in (None, BEFORE) and all(
            take != recorded.id for played in project.takes.values() for recorded in played.takes
        ):
            take = None
        kept = Selection(notes, events, self.span, take)
        return self if kept == self else kept

    def planned(self, plans: Mapping[str, PlayerPlan]) -> Selection:
        """Return the part of the selection that exists in the players' plans; ``self`` if all of it does."""
        known = {
            player_id: events_of(plans[player_id])
            for player_id in {key.player_id for key in self.events} & plans.keys()
        }
        events = frozenset(
            key
            for key in self.events
            if key.event_id in known.get(key.player_id, ()) or EventId.parse(key.event_id).kind in UNPLANNED
        )
        return self if events == self.events else msgspec.structs.replace(self, events=events)
