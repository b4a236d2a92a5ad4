"""Adding events by command or mouse: everything added in one step is selected afterwards."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import TypeAlias

from app.editor.edit_names import edit_at
from app.editor.selection import EventKey, Selection
from app.editor.session import Session, Severity
from app.errors import AppError, Message
from app.plan.kinds import GESTURE_KINDS, GestureKind
from app.plan.model import PlayerPlan
from app.plan.music.written_dynamics import holding_row
from app.project.edit import breaths_and_cues
from app.project.edit import events as edit
from app.project.edit.corrections import Edited
from app.project.edit.marks import next_dynamic_tick, player_marks, toggle_marks
from app.project.model import Project
from app.score.marks import MARK
from app.score.model import Note

Addition: TypeAlias = tuple[PlayerPlan, int, Callable[[Project], Edited]]
"""A player's plan, the tick of the position, and the edit that adds an event there."""
Places: TypeAlias = Iterable[tuple[PlayerPlan, int]]
"""A player's plan, and the tick of an event."""
Spans: TypeAlias = Iterable[tuple[PlayerPlan, int, int]]
"""A player's plan, and the ticks of an event."""


STYLE_BARS = 2
"""Length in bars of a new style region."""


def add_breaths(session: Session, places: Places) -> None:
    """Add a breath before the first note at or after each of the given ticks."""
    _add(
        session,
        "edit.add_breath",
        [(plan, tick, partial(breaths_and_cues.add_breath, plan=plan, tick=tick)) for plan, tick in places],
    )


def toggle_mark(session: Session, notes: Mapping[str, Sequence[Note]], kind: str, text: str = "") -> None:
    """Write a mark over the given notes of each player, or remove it if all of them have it; if that is impossible, say
    why in the status line.
    """
    try:
        marked = toggle_marks(session.project, notes, kind, text)
    except AppError as error:
        session.notice(error.message, Severity.WARNING)
        return
    id = "edit.add_mark" if marked.added else "edit.remove_mark"
    done = session.apply(Message(id, {"mark": text or f"{MARK}.{kind}"}), marked.project)
    if done and marked.added:
        tell_reach(session, [(player_id, own[0].onset_tick) for player_id, own in notes.items() if own], text)


def tell_reach(session: Session, places: Iterable[tuple[str, int]], text: str) -> None:
    """Report in the status line the place up to which a written dynamic holds.

    Parameters
    ----------
    places : iterable of (str, int)
        Player id and tick at which the dynamic was written; of several, the latest end is reported.
    text : str
        Text of the dynamic, such as ``mf``.
    """
    project, ends = session.project, []
    for player_id, tick in places:
        there = player_marks(project, player_id)
        for mark in there:
            if (mark.kind, mark.tick, mark.text) == ("dynamic", tick, text) and holding_row(mark) is not None:
                ends.append(mark.end_tick or next_dynamic_tick(there, mark))
    known = [tick for tick in ends if tick is not None]
    if len(known) < len(ends):
        session.notice(Message("mark.holds_to_the_end", {"mark": text}))
    elif known:
        session.notice(Message("mark.holds_up_to", {"mark": text, "place": project.metre_map.label(max(known))}))


def add_cues(session: Session, places: Places) -> None:
    """Add a cue to the first entry of notes at or after each of the given ticks."""
    _add(
        session,
        "edit.add_cue",
        [(plan, tick, partial(breaths_and_cues.add_cue, plan=plan, tick=tick)) for plan, tick in places],
    )


def add_gestures(session: Session, kind: GestureKind, spans: Spans) -> None:
    """Add a gesture of a kind over each span of a player, as one undoable step."""
    amount = 0.5 if GESTURE_KINDS[kind].signed else 1.0
    add = partial(edit.add_gesture, kind=kind, amount=amount)
    made = [
        (plan, start, partial(add, player_id=plan.player_id, start_tick=start, end_tick=end))
        for plan, start, end in spans
    ]
    _add(session, "edit.add_gesture", made, gesture=kind)


def add_named_gestures(session: Session, name: str, spans: Spans) -> None:
    """Add the gesture of this name at the start of each span, in its usual length."""
    clock = session.project.score.tempo_map
    length_s = session.performance.metadata.gestures.items[name].length_s
    add = partial(edit.add_gesture, kind="named", amount=1.0, gesture=name)
    made = [
        (plan, start, partial(add, player_id=plan.player_id, start_tick=start, end_tick=end))
        for plan, start, _ in spans
        for end in [round(clock.ticks(clock.seconds(float(start)) + length_s))]
    ]
    _add(session, "edit.add_gesture", made, gesture=name)


def add_expressions(session: Session, name: str, spans: Spans) -> None:
    """Add an expression of full strength, with its own fades, over each span."""
    face = session.performance.expressions[name]
    add = partial(edit.add_expression, expression=name, fade_in_s=face.fade_in_s, fade_out_s=face.fade_out_s)
    made = [
        (plan, start, partial(add, player_id=plan.player_id, start_tick=start, end_tick=end))
        for plan, start, end in spans
    ]
    _add(session, "edit.add_expression", made, expression=name)


def add_styles(session: Session, style: str, spans: Spans) -> None:
    """Add spans in which players play in a style, as one undoable step."""
    add = partial(edit.add_style, style=style)
    made = [
        (plan, start, partial(add, player_id=plan.player_id, start_tick=start, end_tick=end))
        for plan, start, end in spans
    ]
    _add(session, "edit.add_style", made, style=style)


def change_styles(session: Session, style: str) -> None:
    """Change the style of the selected style spans."""
    plans, selected = session.plans, session.selection.events

    def edited(project: Project) -> Project:
        for player_id in sorted({key.player_id for key in selected} & set(plans)):
            ids = [key.event_id for key in selected if key.player_id == player_id]
            project = edit.set_style(project, plans[player_id], ids, style)
        return project

    session.attempt(Message("edit.set_style", {"style": style}), edited)


def bars_of(session: Session, player_ids: Iterable[str], tick: float) -> list[tuple[PlayerPlan, int, int]]:
    """Return a range in which to add something for each player, as the player's plan with the first and last tick.

    It is the selected range if that contains ``tick``, else the bar at ``tick`` and the next one. Players without a
    plan are left out.
    """
    metres, span = session.project.metre_map, session.selection.span
    if span is None or not span[0] <= tick < span[1]:
        at = max(round(tick), 0)
        bar_ticks = metres.bar_ticks_at(at)
        start = int(metres.bars(at - bar_ticks, at + 1)[-1])
        span = (start, start + STYLE_BARS * bar_ticks)
    return [(plan, *span) for player_id in player_ids if (plan := session.plans.get(player_id)) is not None]


def _add(session: Session, id: str, additions: Sequence[Addition], **added: str) -> None:
    keys: set[EventKey] = set()

    def whole(project: Project) -> Project:
        for plan, _, add in additions:
            project, event_ids = add(project)
            keys.update(EventKey(plan.player_id, event_id) for event_id in event_ids)
        return project

    before = session.project
    players, ticks = {plan.player_id for plan, _, _ in additions}, [tick for _, tick, _ in additions]
    name = edit_at(before, id, len(additions), players, ticks, **added)
    if additions and session.attempt(name, whole):
        session.select(Selection(events=frozenset(keys)))
        if session.project is before and keys:
            session.notice(Message("edit.is_there"))
