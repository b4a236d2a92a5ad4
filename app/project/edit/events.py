"""Edits of a player's events, each of which is stored as a correction.

All functions take the plan shown to the user and ids of its events. Functions that may change an event's id (a breath
dragged to another note) also return the new ids.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Final

import msgspec

from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetEmbouchure,
)
from app.plan.event_id import EventId
from app.plan.events_by_hand import PoseEvent, StyleEvent
from app.plan.kinds import GestureKind
from app.plan.model import BreathEvent, CueEvent, Event, ExpressionEvent, GestureEvent, PlayerPlan
from app.project.edit.breath_preparations import lowered_with, moved_along, preparation_with, preparations_of
from app.project.edit.breaths_and_cues import add_breath, breath_at, breath_of, cue_at, notes_of, removals_of
from app.project.edit.corrections import Edited, take_back, with_corrections
from app.project.edit.found_events import OWN as OWN
from app.project.edit.found_events import Placed as Placed
from app.project.edit.found_events import corrections_of as corrections_of
from app.project.edit.found_events import events_of as events_of
from app.project.edit.found_events import is_there as is_there
from app.project.edit.found_events import placed_events as placed_events
from app.project.edit.found_events import player_marks as player_marks
from app.project.edit.marks import corrections_at, remove_marks
from app.project.model import Project

AMOUNTS: Final[Mapping[type[Event], tuple[str, float]]] = {
    BreathEvent: ("depth", 0.0),
    GestureEvent: ("amount", -1.0),
    ExpressionEvent: ("strength", 0.0),
}
"""Field with an event's amount, and least value of the field, by type of event."""
_SPOKEN_OF: Final[Mapping[type[Event], tuple[type[Correction], ...]]] = {
    GestureEvent: (AddGesture, ChangeGesture),
    ExpressionEvent: (AddExpression, ChangeExpression),
    PoseEvent: (PoseCorrection,),
    StyleEvent: (PlayStyle,),
}
"""Corrections that refer to events, by type of event."""
_GIVEN_BACK: Final = ("fingering", "embouchure")
"""Kinds of events that are reset together with their notes."""
_KEPT: Final = 1e-4
"""Resolution to which amounts and fades are stored."""


# Change


def move(project: Project, plan: PlayerPlan, event_ids: Sequence[str], ticks: int) -> Edited:
    """Shift events in time. Breaths and cues that reach another note belong to it afterwards."""
    return _placed(project, plan, event_ids, ticks, ticks)


def resize(
    project: Project, plan: PlayerPlan, event_ids: Sequence[str], start_ticks: int = 0, end_ticks: int = 0
) -> Project:
    """Shift the starts and ends of events; each keeps at least a tick and its note. The end of a cue is the entry, so
    only its start, the preparatory beat, can be changed.
    """
    return _placed(project, plan, event_ids, start_ticks, end_ticks).project


def set_amounts(project: Project, plan: PlayerPlan, amounts: Mapping[str, float]) -> Project:
    """Set depth (breaths), amount (gestures, -1..1) or strength (expressions) of events by id; clipped to the allowed
    range.
    """
    corrections: list[Correction] = []
    for event in _current(project, plan, amounts):
        if type(event) in AMOUNTS:
            field, least = AMOUNTS[type(event)]
            corrections += _changed(project, plan, event, **{field: min(max(round(amounts[event.id], 4), least), 1.0)})
    return with_corrections(project, plan.player_id, corrections)


def set_fades(
    project: Project,
    plan: PlayerPlan,
    event_ids: Iterable[str],
    fade_in_s: float | None = None,
    fade_out_s: float | None = None,
) -> Project:
    """Set fade-in and fade-out times of expressions, poses and styles, in seconds; None leaves a value unchanged."""
    ticks = project.score.tempo_map.ticks
    corrections: list[Correction] = []
    for event in _current(project, plan, event_ids):
        fades: dict[str, float] = {}
        if isinstance(event, ExpressionEvent):
            given = {"fade_in_s": fade_in_s, "fade_out_s": fade_out_s}
            fades = {name: round(max(value, 0.0), 4) for name, value in given.items() if value is not None}
        elif isinstance(event, PoseEvent | StyleEvent):
            # Ramps of poses lie outside their span, those of styles inside.
            side = -1 if isinstance(event, PoseEvent) else 1
            if fade_in_s is not None:
                in_s = event.start_s + side * max(fade_in_s, 0.0)
                fades["fade_in_ticks"] = side * (round(ticks(in_s)) - event.start_tick)
            if fade_out_s is not None:
                out_s = event.end_s - side * max(fade_out_s, 0.0)
                fades["fade_out_ticks"] = side * (event.end_tick - round(ticks(out_s)))
        else:
            continue
        corrections += _changed(project, plan, event, **fades)
    return with_corrections(project, plan.player_id, corrections)


def set_expression(project: Project, plan: PlayerPlan, event_ids: Iterable[str], expression: str) -> Project:
    """Replace the facial expressions that the chosen expression events show."""
    return _all_changed(project, plan, event_ids, ExpressionEvent, expression=expression)


def set_style(project: Project, plan: PlayerPlan, event_ids: Iterable[str], style: str) -> Project:
    """Change the style of the chosen style spans of a player."""
    return _all_changed(project, plan, event_ids, StyleEvent, style=style)


def set_embouchure(project: Project, player_id: str, note_ids: Iterable[str], **values: float) -> Project:
    """Set ``tension``, ``effort`` or ``air`` of notes, 0..1; other values set by hand stay."""
    before = {item.note_id: item for item in project.corrections.get(player_id, ()) if isinstance(item, SetEmbouchure)}
    clipped = {name: round(min(max(value, 0.0), 1.0), 4) for name, value in values.items()}
    return with_corrections(
        project,
        player_id,
        [msgspec.structs.replace(before.get(note_id, SetEmbouchure(note_id)), **clipped) for note_id in note_ids],
    )


def pin_fingerings(project: Project, player_id: str, labels: Mapping[str, str]) -> Project:
    """Pin notes (by id) to the fingerings of these labels."""
    return with_corrections(project, player_id, [PinFingering(note_id, label) for note_id, label in labels.items()])


# Add


def toggle_preparation(project: Project, plan: PlayerPlan, note_id: str) -> Edited:
    """Remove the preparatory motion before a note's breath if there is one, else add one."""
    event_id = f"preparation:{note_id}"
    if any(event.id == event_id for event in plan.breaths):
        return Edited(remove(project, plan, (event_id,)), ())
    removed = removals_of(project, plan.player_id, event_id)
    if removed:
        return Edited(take_back(project, plan.player_id, removed), (event_id,))
    note = next((note for note in notes_of(project, plan.player_id) if note.id == note_id), None)
    return Edited(project, ()) if note is None else add_breath(project, plan, note.onset_tick, "preparation")


def add_gesture(
    project: Project,
    player_id: str,
    kind: GestureKind,
    start_tick: int,
    end_tick: int,
    amount: float = 0.5,
    gesture: str = "",
) -> Edited:
    """Add a gesture; ``gesture`` is its name if the kind is ``"named"``."""
    end_tick = max(end_tick, start_tick + 1)
    added = AddGesture(_new_name(project, player_id), kind, start_tick, end_tick, amount, gesture)
    return Edited(with_corrections(project, player_id, (added,)), (added.about,))


def add_expression(
    project: Project,
    player_id: str,
    expression: str,
    start_tick: int,
    end_tick: int,
    *,
    fade_in_s: float = 0.2,
    fade_out_s: float = 0.3,
) -> Edited:
    """Add a facial expression by hand."""
    end_tick = max(end_tick, start_tick + 1)
    name, fades = _new_name(project, player_id), (fade_in_s, fade_out_s)
    added = AddExpression(name, expression, start_tick, end_tick, 1.0, *fades)
    return Edited(with_corrections(project, player_id, (added,)), (added.about,))


def add_style(project: Project, player_id: str, style: str, start_tick: int, end_tick: int) -> Edited:
    """Add a span in another style, with fades of a felt beat or a quarter of its length."""
    end_tick = max(end_tick, start_tick + 1)
    fade = min(project.metre_map.felt_ticks_at(start_tick), (end_tick - start_tick) // 4)
    added = PlayStyle(_new_name(project, player_id), style, start_tick, end_tick, fade, fade)
    return Edited(with_corrections(project, player_id, (added,)), (added.about,))


# Remove


def remove(project: Project, plan: PlayerPlan, event_ids: Iterable[str]) -> Project:
    """Remove events and marks: added ones are deleted, generated or written ones are marked as removed."""
    player_id = plan.player_id
    note_ids = frozenset(note.id for note in notes_of(project, player_id))
    event_ids = tuple(event_ids)
    # Bars performed again and curves are not events of the plan.
    added = [item for item in corrections_of(project, player_id, event_ids) if not item.has_event]
    project = take_back(project, player_id, added) if added else project
    marks = [mark for mark in player_marks(project, player_id) if mark.id in event_ids]
    project = remove_marks(project, player_id, marks) if marks else project
    for event in _current(project, plan, event_ids):
        said = corrections_of(project, player_id, (event.id,))
        project = take_back(project, player_id, said)
        if any(item.is_added for item in said):
            continue
        former = [item.left_out for item in said if item.left_out not in (None, event.id)]
        gone = former[-1] or event.id if former else event.id
        note_id = next((place for place in EventId.parse(gone).places if place in note_ids), None)
        project = with_corrections(project, player_id, (RemoveEvent(gone, note_id),))
    return project


def give_back(project: Project, player_id: str, event_ids: Iterable[str] = (), note_ids: Iterable[str] = ()) -> Project:
    """Reset events, and fingering, embouchure and marks of notes, to their generated values. Added events are
    removed.
    """
    notes = tuple(note_ids)
    project = take_back(project, player_id, corrections_at(project, player_id, notes))
    events = tuple(event_ids)
    ids = (
        *events,
        *moved_along(project, player_id, events),
        *(f"{kind}:{note}" for kind in _GIVEN_BACK for note in notes),
    )
    return take_back(project, player_id, corrections_of(project, player_id, ids))


def forget(
    project: Project,
    player_id: str,
    kind: type[PinFingering] | type[SetEmbouchure],
    note_ids: Collection[str],
    field: str | None = None,
) -> Project:
    """Remove the pinned fingerings or embouchures of notes, so that the generated ones return; with ``field`` only one
    value of the embouchure."""
    for item in project.corrections.get(player_id, ()):
        if not isinstance(item, kind) or item.note_id not in note_ids:
            continue
        if field is not None and isinstance(item, SetEmbouchure):
            left = msgspec.structs.replace(item, **{field: None})
            if left != SetEmbouchure(item.note_id):
                project = with_corrections(project, player_id, (left,))
                continue
        project = take_back(project, player_id, (item,))
    return project


def give_back_player(project: Project, player_id: str) -> Project:
    """Reset everything of a player to the generated values."""
    return take_back(project, player_id, project.corrections.get(player_id, ()))


# Helpers


def _placed(project: Project, plan: PlayerPlan, event_ids: Sequence[str], start_ticks: int, end_ticks: int) -> Edited:
    if not start_ticks and not end_ticks:
        return Edited(project, tuple(event_ids))
    player_id = plan.player_id
    moves = start_ticks == end_ticks
    new_ids: dict[str, str] = {}
    stale: list[Correction] = []
    fresh: list[Correction] = []
    chosen = _current(project, plan, event_ids)
    preparations = preparations_of(plan)
    along = {preparations[event.id].id for event in chosen if moves and event.id in preparations}
    for event in chosen:
        start, end = event.start_tick + start_ticks, event.end_tick + end_ticks
        if start >= end:
            start, end = (end - 1, end) if start_ticks else (start, start + 1)
        made: Sequence[Correction]
        if isinstance(event, BreathEvent):
            if event.id in along:
                # It moves with its breath.
                continue
            prepared = preparations.get(event.id) if start_ticks else None
            if prepared is not None and not moves and prepared.id in event_ids:
                prepared = None
            stale += corrections_of(project, player_id, (event.id, *((prepared.id,) if prepared is not None else ())))
            placed = breath_at(project, player_id, event, start, end, moves)
            made = (placed,)
            if prepared is not None:
                taken = preparation_with(project, player_id, event, placed, prepared)
                fresh.append(taken)
                new_ids[prepared.id] = taken.about
            if start_ticks:
                fresh += lowered_with(project, player_id, event, placed)
        elif isinstance(event, CueEvent):
            stale += corrections_of(project, player_id, (event.id,))
            made = (cue_at(project, player_id, event, start, end if moves else event.end_tick),)
        else:
            ends = {}
            if start != event.start_tick:
                ends["start_tick"] = start
            if end != event.end_tick:
                ends["end_tick"] = end
            made = _changed(project, plan, event, **ends)
        fresh += made
        for item in made:
            new_ids[event.id] = item.about
    project = with_corrections(take_back(project, player_id, stale), player_id, fresh)
    return Edited(project, tuple(new_ids.get(event_id, event_id) for event_id in event_ids))


def _current(project: Project, plan: PlayerPlan, event_ids: Iterable[str]) -> list[Placed]:
    """Return the events of a plan that still exist in the project, since plans may be older than the project."""
    return placed_events(plan, [event_id for event_id in event_ids if is_there(project, plan.player_id, event_id)])


def _new_name(project: Project, player_id: str) -> str:
    """Return the first name ``own-n`` that no added event of the player has."""
    taken = {item.anchor for item in project.corrections.get(player_id, ())}
    number = 1
    while f"{OWN}{number}" in taken:
        number += 1
    return f"{OWN}{number}"


def _changed(project: Project, plan: PlayerPlan, event: Placed, **values: object) -> list[Correction]:
    """Return corrections that give an event other values, based on its existing correction if there is one; empty if a
    generated event has these values already.
    """
    said = corrections_of(project, plan.player_id, (event.id,))
    if not said and not event.corrected and all(_same(getattr(event, name), value) for name, value in values.items()):
        return []
    if isinstance(event, BreathEvent):
        return [msgspec.structs.replace(breath_of(project, plan.player_id, event), **values)]
    kinds = _SPOKEN_OF[type(event)]
    changes = [item for item in said if isinstance(item, kinds)]
    changes = changes or [kind(event.id) for kind in kinds if issubclass(kind, ChangeGesture | ChangeExpression)]
    return [msgspec.structs.replace(item, **values) for item in changes[:1]]


def _same(now: object, value: object) -> bool:
    """Return whether two values are equal at the precision of stored values."""
    return abs(now - value) < _KEPT / 2 if isinstance(now, float) and isinstance(value, float) else now == value


def _all_changed(
    project: Project, plan: PlayerPlan, event_ids: Iterable[str], kind: type[Placed], **values: object
) -> Project:
    """Set fields of the chosen events that are of one kind; other events stay."""
    chosen = [event for event in _current(project, plan, event_ids) if isinstance(event, kind)]
    return with_corrections(
        project, plan.player_id, [item for one in chosen for item in _changed(project, plan, one, **values)]
    )
