"""Lookup of events in a plan by id, and of their corrections."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, Literal, NamedTuple, TypeAlias

from app.identity_cache import IdentityCache
from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.mark_corrections import SetMark, corrected_marks, mark_corrections
from app.plan.event_id import EventId
from app.plan.events_by_hand import PoseEvent, StyleEvent
from app.plan.kinds import BREATH_KINDS
from app.plan.model import BreathEvent, CueEvent, Event, ExpressionEvent, GestureEvent, PlayerPlan
from app.project.model import Project
from app.score.marks import MARK, Mark

Placed: TypeAlias = BreathEvent | CueEvent | GestureEvent | ExpressionEvent | PoseEvent | StyleEvent
"""Events with a place that the user can change."""

Origin: TypeAlias = Literal["score", "hand"]
"""Origin of a mark: the score, or the user."""
OWN: Final = "own-"
"""Prefix of the names of added events."""
_OF_NOTES: Final = ("fingering", "embouchure", "tongue", *BREATH_KINDS, "cue")
"""Kinds of events whose id ends with the id of a note."""


def corrections_of(project: Project, player_id: str, event_ids: Iterable[str]) -> tuple[Correction, ...]:
    """Return the corrections of a player that added or changed the events with the given ids."""
    requested = frozenset(event_ids)
    return tuple(item for item in project.corrections.get(player_id, ()) if item.about in requested)


def events_of(plan: PlayerPlan) -> dict[str, Event]:
    """Return all selectable events of a plan, by id."""
    groups: tuple[Sequence[Event], ...] = (
        plan.fingerings, plan.breaths, plan.embouchures, plan.cues, plan.gestures, plan.expressions, plan.poses,
        plan.styles,
    )  # fmt: skip
    return {event.id: event for group in groups for event in group}


def player_marks(project: Project, player_id: str) -> Mapping[Mark, Origin]:
    """Return a player's marks after corrections, with the origin of each. A mark whose notes no longer exist has no
    effect.
    """
    return _marks_of(project, player_id).origins


class _Marks(NamedTuple):
    origins: Mapping[Mark, Origin]
    ids: frozenset[str]


_MARKS: Final[IdentityCache[_Marks]] = IdentityCache(size=256)


def _marks_of(project: Project, player_id: str) -> _Marks:
    marks = project.part(project.player(player_id)).marks
    return _MARKS.step(_corrected, marks, project.corrections.get(player_id, ()))


def _corrected(marks: tuple[Mark, ...], corrections: tuple[Correction, ...]) -> _Marks:
    by_hand = {item.mark for item in mark_corrections(corrections) if isinstance(item, SetMark)}
    now = corrected_marks(marks, corrections)
    origins: dict[Mark, Origin] = {mark: "hand" if mark in by_hand else "score" for mark in now}
    return _Marks(origins, frozenset(mark.id for mark in now))


def is_there(project: Project, player_id: str, event_id: str) -> bool:
    """Return whether the project has the event's player, note, and, for an added event, its correction. Whether the
    generator makes the event is only known from a plan, which may lag behind.
    """
    try:
        player = project.player(player_id)
    except KeyError:
        return False
    kind, of, _ = EventId.parse(event_id)
    if kind == MARK:
        return event_id in _marks_of(project, player_id).ids
    if kind in ("pose", "additive", "vary", "style") or of.startswith(OWN):
        return bool(corrections_of(project, player_id, (event_id,)))
    return kind not in _OF_NOTES or of.startswith("@") or of in project.part(player).note_ids


def placed_events(plan: PlayerPlan, event_ids: Iterable[str]) -> list[Placed]:
    """Return the events with the given ids that have start and end, in the order of the ids."""
    requested = tuple(event_ids)
    among = frozenset(requested)
    groups: tuple[Sequence[Placed], ...] = (
        *(plan.breaths, plan.cues, plan.gestures, plan.expressions, plan.poses, plan.styles),
    )
    found = {event.id: event for group in groups for event in group if event.id in among}
    return [found[event_id] for event_id in requested if event_id in found]
