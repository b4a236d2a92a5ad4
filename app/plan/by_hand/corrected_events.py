"""Applies an animator's corrections to events, and finds corrections whose anchor no longer exists."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TypeVar

import msgspec

from app.errors import Message
from app.plan.by_hand.corrections import (
    BY_HAND,
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    SetEmbouchure,
)
from app.plan.model import BreathEvent, CueEvent, EmbouchureEvent, ExpressionEvent, GestureEvent, Planned, Problem
from app.score.tempo import TempoMap

E = TypeVar("E", BreathEvent, CueEvent, GestureEvent, ExpressionEvent)
Span = TypeVar("Span", GestureEvent, ExpressionEvent)


def sound_corrections(
    corrections: tuple[Correction, ...], expressions: Collection[str], at_s: float
) -> Planned[Correction]:
    """Keep the corrections that can be applied, and report a problem for each other one: a span that ends before it
    begins, or an unknown expression.

    Parameters
    ----------
    expressions : collection of str
        Names of the available expressions.
    at_s : float
        Time at which the problems are shown.
    """
    sound: list[Correction] = []
    problems = []
    for item in corrections:
        if isinstance(item, ChangeExpression | AddExpression) and item.expression not in (None, *expressions):
            message = Message(
                "correction.unknown_expression", {"name": str(item.expression), "known": ", ".join(expressions)}
            )
        elif item.is_empty:
            message = Message("correction.empty_span", {"kind": item.tag, "anchor": item.subject})
        else:
            sound.append(item)
            continue
        problems.append(Problem(message, None, at_s, at_s))
    return Planned(tuple(sound), tuple(problems))


def removed_ids(corrections: tuple[Correction, ...]) -> frozenset[str]:
    """Collect the ids of generated events that corrections remove or move to another note."""
    return frozenset(item.left_out for item in corrections if item.left_out is not None)


def without_removed(events: tuple[E, ...], removed: frozenset[str]) -> tuple[E, ...]:
    """Return the events whose ids are not in ``removed``."""
    return tuple(event for event in events if event.id not in removed) if removed else events


def correct_embouchures(
    events: tuple[EmbouchureEvent, ...], corrections: tuple[Correction, ...]
) -> tuple[EmbouchureEvent, ...]:
    """Apply corrections to the embouchures of notes: values set by hand replace the generated ones."""
    by_note = {item.note_id: item for item in corrections if isinstance(item, SetEmbouchure)}
    if not by_note:
        return events
    return tuple(
        msgspec.structs.replace(
            event,
            tension=event.tension if item.tension is None else item.tension,
            effort=event.effort if item.effort is None else item.effort,
            air=event.air if item.air is None else item.air,
            reason=BY_HAND,
            planned=(event.tension, event.effort, event.air),
        )
        if (item := by_note.get(event.note_id)) is not None
        else event
        for event in events
    )


def correct_gestures(
    events: tuple[GestureEvent, ...], corrections: tuple[Correction, ...], clock: TempoMap
) -> tuple[GestureEvent, ...]:
    """Apply corrections to generated gestures: drop removed ones, change others, and add the animator's own; ordered by
    start.
    """
    added = [item.event(clock) for item in corrections if isinstance(item, AddGesture)]
    changes = {item.event_id: item for item in corrections if isinstance(item, ChangeGesture)}
    return _corrected_spans(events, corrections, changes, added, clock)


def correct_expressions(
    events: tuple[ExpressionEvent, ...], corrections: tuple[Correction, ...], clock: TempoMap
) -> tuple[ExpressionEvent, ...]:
    """Apply corrections to generated expressions: drop removed ones, change others, and add the animator's own; ordered
    by start.
    """
    added = [item.event(clock) for item in corrections if isinstance(item, AddExpression)]
    changes = {item.event_id: item for item in corrections if isinstance(item, ChangeExpression)}
    return _corrected_spans(events, corrections, changes, added, clock)


def _corrected_spans(
    events: tuple[Span, ...],
    corrections: tuple[Correction, ...],
    changes: Mapping[str, ChangeGesture | ChangeExpression],
    added: Sequence[Span],
    clock: TempoMap,
) -> tuple[Span, ...]:
    removed = removed_ids(corrections)
    kept: list[Span] = [event for event in events if event.id not in removed]
    if not changes and not added:
        return tuple(kept)
    result = [_changed(event, changes.get(event.id), clock) for event in kept]
    result.extend(added)
    result.sort(key=lambda event: event.start_s)
    return tuple(result)


def _changed(event: Span, change: ChangeGesture | ChangeExpression | None, clock: TempoMap) -> Span:
    """Apply a correction to an event: values of the correction that are not None replace those of the event."""
    if change is None:
        return event
    start = event.start_tick if change.start_tick is None else change.start_tick
    end = event.end_tick if change.end_tick is None else change.end_tick
    if start >= end:
        # Only one end was set, and the generated other end has since moved past it: a correction wins.
        start, end = (start, start + 1) if change.end_tick is None else (end - 1, end)
    said = {name: value for name, value in msgspec.structs.asdict(change).items() if value is not None}
    said |= {"start_tick": start, "end_tick": end}
    del said["event_id"]
    return msgspec.structs.replace(
        event,
        start_s=event.start_s if start == event.start_tick else clock.seconds(float(start)),
        end_s=event.end_s if end == event.end_tick else clock.seconds(float(end)),
        reason=BY_HAND,
        corrected=True,
        **said,
    )


def orphans(
    corrections: tuple[Correction, ...], note_ids: frozenset[str], event_ids: frozenset[str], at_s: float
) -> tuple[Problem, ...]:
    """A problem for every correction whose note or event no longer exists.

    Parameters
    ----------
    note_ids, event_ids : frozenset of str
        The notes of the line, and every event the generator made before removals.
    at_s : float
        Time at which the problems are shown, the start of the performance, since their own place is lost.
    """
    return tuple(
        Problem(Message("correction.orphaned", {"kind": item.tag, "anchor": item.subject}), None, at_s, at_s)
        for item in corrections
        if item.is_lost(note_ids, event_ids)
    )
