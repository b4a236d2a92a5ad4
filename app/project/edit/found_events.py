"""Finding events of a plan, and what the user said about them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final, TypeAlias

from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.events import PoseEvent, StyleEvent
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS
from app.plan.model import BreathEvent, CueEvent, Event, ExpressionEvent, GestureEvent, PlayerPlan
from app.project.model import Project

Placed: TypeAlias = BreathEvent | CueEvent | GestureEvent | ExpressionEvent | PoseEvent | StyleEvent
"""What has a place that the user may change."""

OWN: Final = "own-"
"""How the names of added events begin."""
_OF_NOTES: Final = ("fingering", "embouchure", "tongue", *BREATH_KINDS, "cue")
"""Kinds of events whose id ends with that of a note."""


def corrections_of(project: Project, player_id: str, event_ids: Iterable[str]) -> tuple[Correction, ...]:
    """Corrections of these events."""
    requested = frozenset(event_ids)
    return tuple(item for item in project.corrections.get(player_id, ()) if item.about in requested)


def events_of(plan: PlayerPlan) -> dict[str, Event]:
    """Every event of a plan that the user may select, by id."""
    groups: tuple[Sequence[Event], ...] = (
        plan.fingerings, plan.breaths, plan.embouchures, plan.cues, plan.gestures, plan.expressions, plan.poses,
        plan.styles,
    )  # fmt: skip
    return {event.id: event for group in groups for event in group}


def is_there(project: Project, player_id: str, event_id: str) -> bool:
    """Return whether the project has what an event is about: its player, its note, and the correction that added it.
    Whether the generator makes such an event only a plan knows, and plans lag behind the project."""
    try:
        player = project.player(player_id)
    except KeyError:
        return False
    kind, of, _ = EventId.parse(event_id)
    if kind in ("pose", "additive", "vary", "style") or of.startswith(OWN):
        return bool(corrections_of(project, player_id, (event_id,)))
    return kind not in _OF_NOTES or of.startswith("@") or of in project.part(player).note_ids


def placed_events(plan: PlayerPlan, event_ids: Iterable[str]) -> list[Placed]:
    """The events of these ids that have a place of their own, in the order of the ids."""
    requested = tuple(event_ids)
    among = frozenset(requested)
    groups: tuple[Sequence[Placed], ...] = (
        *(plan.breaths, plan.cues, plan.gestures, plan.expressions, plan.poses, plan.styles),
    )
    found = {event.id: event for group in groups for event in group if event.id in among}
    return [found[event_id] for event_id in requested if event_id in found]
