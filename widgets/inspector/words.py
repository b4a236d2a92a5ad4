"""Events and corrections in words, short enough for a list."""

from __future__ import annotations

from app.editor.translated import tr
from app.plan.by_hand.additive_curve import AdditiveCurve
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
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.event_id import EventId
from app.plan.model import (
    BreathEvent,
    CueEvent,
    EmbouchureEvent,
    Event,
    ExpressionEvent,
    GestureEvent,
    PoseEvent,
    StyleEvent,
)
from app.plan.model import FingeringEvent as Fingered
from app.project.edit.events import AMOUNTS, Placed
from app.score.model import Score
from widgets.common.channel_names import channel_name
from widgets.common.event_names import expression_name, kind_name, pose_name, style_name


def amount_field(event: Placed) -> str | None:
    """What of an event says how much of it there is."""
    field, _ = AMOUNTS.get(type(event), (None, 0.0))
    return field


def event_title(event: Event) -> str:
    """What an event is."""
    if isinstance(event, ExpressionEvent):
        return tr("inspector.expression").format(name=expression_name(event.expression))
    if isinstance(event, PoseEvent):
        return tr("inspector.pose").format(name=pose_name(event.target))
    if isinstance(event, StyleEvent):
        return tr("inspector.style").format(name=style_name(event.style))
    return kind_name(EventId.parse(event.id).kind)


def event_text(score: Score, event: Event | None) -> str:
    """Where an event is and how much of it there is: ``"12.3–12.4, 0.80"``."""
    match event:
        case None:
            return ""
        case Fingered():
            return event.label
        case EmbouchureEvent():
            return " ".join(f"{value:.2f}" for value in (event.tension, event.effort, event.air))
        case CueEvent():
            return tr("inspector.entry_beat_s").format(
                place=score.metre_map.label(event.end_tick), seconds=f"{event.beat_s:.2f}"
            )
        case BreathEvent() | GestureEvent() | ExpressionEvent() | PoseEvent() | StyleEvent():
            span = f"{score.metre_map.label(event.start_tick)}–{score.metre_map.label(event.end_tick)}"
            if isinstance(event, PoseEvent):
                angles = [f"{value:g}°".replace("-", "−") for value in (event.up_deg, event.left_deg, event.roll_deg)]
                return f"{span}, {' '.join(angles)}"
            if isinstance(event, StyleEvent):
                return f"{span}, {style_name(event.style)}"
            field = amount_field(event)
            amount = f"{getattr(event, field):.2f}".replace("-", "−") if field is not None else ""
            face = f"{expression_name(event.expression)} " if isinstance(event, ExpressionEvent) else ""
            return f"{span}, {face}{amount}"
        case _:
            return ""


def embouchure_text(correction: SetEmbouchure, event: Event) -> str:
    """The values of an embouchure that were set by hand."""
    names = {"tension": tr("inspector.tension"), "effort": tr("inspector.effort"), "air": tr("inspector.air")}
    return ", ".join(
        f"{word} {getattr(event, name):.2f}" for name, word in names.items() if getattr(correction, name) is not None
    )


def correction_title(item: Correction) -> str:
    """What was done by hand."""
    match item:
        case PinFingering():
            return tr("inspector.fingering").format(label=item.label)
        case RemoveEvent():
            return tr("inspector.removed").format(what=kind_name(EventId.parse(item.event_id).kind))
        case SetBreath():
            return kind_name(item.kind)
        case SetCue():
            return kind_name("cue")
        case SetEmbouchure():
            return tr("inspector.embouchure")
        case ChangeGesture():
            return kind_name(EventId.parse(item.event_id).kind)
        case AddGesture():
            return kind_name(item.kind)
        case ChangeExpression():
            if item.expression is not None:
                return expression_name(item.expression)
            return kind_name("expression")
        case AddExpression():
            return expression_name(item.expression)
        case Vary():
            return kind_name("vary")
        case PlayStyle():
            return tr("inspector.style").format(name=style_name(item.style))
        case AdditiveCurve():
            name = channel_name(item.channel)
            return f"{item.title} ({name})" if item.title else tr("inspector.additive_curve").format(name=name)
        case PoseCorrection():
            return tr("inspector.pose").format(name=pose_name(item.target))
