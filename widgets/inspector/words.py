"""Short descriptions of events and corrections for lists."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from app.editor.translated import tr
from app.plan.by_hand.corrections import Correction
from app.plan.event_id import EventId
from app.plan.events_by_hand import PoseEvent, StyleEvent
from app.plan.model import BreathEvent, CueEvent, EmbouchureEvent, Event, ExpressionEvent, GestureEvent
from app.plan.model import FingeringEvent as Fingered
from app.project.edit.events import AMOUNTS, Placed
from app.score.marks import Mark
from app.score.model import Part, Score
from instrument_maps.fingering_words import fingering_words
from instrument_maps.library import all_maps
from widgets.common.channel_names import channel_name
from widgets.common.event_names import expression_name, kind_name, mark_name, pose_name, style_name
from widgets.common.instrument_name import language


def amount_field(event: Placed) -> str | None:
    """Return the name of the field that holds an event's amount; None if it has none."""
    field, _ = AMOUNTS.get(type(event), (None, 0.0))
    return field


def event_title(event: Event) -> str:
    """Return the title of an event for the inspector, such as the kind or the expression's name."""
    if isinstance(event, ExpressionEvent):
        return tr("inspector.expression").format(name=expression_name(event.expression))
    if isinstance(event, PoseEvent):
        return tr("inspector.pose").format(name=pose_name(event.target))
    if isinstance(event, StyleEvent):
        return tr("inspector.style").format(name=style_name(event.style))
    return kind_name(EventId.parse(event.id).kind)


def fingering_text(label: str, instrument_id: str) -> str:
    """Return a fingering in words; the label if the instrument is not installed."""
    instrument = all_maps().get(instrument_id)
    return label if instrument is None else fingering_words(instrument, label, language())


def event_text(score: Score, event: Event | None, instrument_id: str, correction: Correction | None = None) -> str:
    """Return the place and amount of an event as text, such as ``"12.3–12.4, 0.80"``; for an embouchure, the corrected
    values.
    """
    match event:
        case None:
            return ""
        case Fingered():
            return fingering_text(event.label, instrument_id)
        case EmbouchureEvent():
            if correction is None:
                return " ".join(f"{value:.2f}" for value in (event.tension, event.effort, event.air))
            names = {"tension": tr("inspector.tension"), "effort": tr("inspector.effort"), "air": tr("inspector.air")}
            return ", ".join(
                f"{word} {getattr(event, name):.2f}"
                for name, word in names.items()
                if getattr(correction, name) is not None
            )
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


_NAMES: Final[Mapping[str, Callable[[str], str]]] = {
    "event": kind_name,
    "expression": expression_name,
    "pose": pose_name,
    "style": style_name,
    "channel": channel_name,
    "mark": mark_name,
}
_TITLES: Final = {
    "pin_fingering": "inspector.fingering",
    "remove": "inspector.removed",
    "remove_mark": "inspector.removed",
    "play_style": "inspector.style",
    "additive": "inspector.additive_curve",
    "pose": "inspector.pose",
}


def mark_text(score: Score, part: Part, mark: Mark) -> str:
    """Return the text of a mark and its end, such as ``"mf"`` or ``"to 13.1"``."""
    ends = [note.onset_tick for note in part.notes if note.id == mark.last_note_id] if mark.last_note_id else []
    end_tick = ends[0] if ends else mark.end_tick
    until = tr("inspector.mark_until").format(end=score.metre_map.label(end_tick)) if end_tick else ""
    return " ".join(filter(None, (mark.text, until)))


def correction_title(item: Correction, instrument_id: str) -> str:
    """Return the title of a manual correction for a player of an instrument."""
    kind, name = item.named
    shown = fingering_text(name, instrument_id) if kind == "fingering" else _NAMES[kind](name)
    if item.title:
        return f"{item.title} ({shown})"
    return tr(_TITLES[item.tag]).format(name=shown) if item.tag in _TITLES else shown
