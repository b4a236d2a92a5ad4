"""Commands for a player's events: adding breaths, cues, gestures and expressions, and removing manual changes."""

from __future__ import annotations

from collections import defaultdict
from typing import Final

from PySide6.QtGui import QCursor

from app.editor.additions import (
    add_breaths,
    add_cues,
    add_expressions,
    add_gestures,
    add_named_gestures,
    add_styles,
    bars_of,
    change_styles,
)
from app.editor.edit_names import edit_at_events, edit_of_events, edit_of_notes
from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.event_id import EventId
from app.plan.kinds import BEFORE_NOTES, GESTURES, GestureRow
from app.plan.model import PlayerPlan
from app.project.edit.events import (
    give_back,
    give_back_player,
    remove,
    toggle_preparation,
)
from app.project.edit.marks import corrections_at, player_marks, remove_marks
from app.project.edit.notes import erase
from app.project.model import Project
from app.shell.action import Action
from app.shell.commands.choice_menu import choice_menu
from app.shell.commands.command_targets import events_by_player, has_player, has_something, notes_by_player
from widgets.common.actions import actions
from widgets.common.clicks import on_click
from widgets.common.event_names import expression_name, gesture_name, style_name
from widgets.common.plain import verbatim

STYLE = "style"
"""First part of the ids of style regions."""
NEW_BEATS = 2
"""Length of a gesture or expression added at the playhead, in beats."""


def _playhead_tick(session: Session) -> int:
    return round(session.project.score.tempo_map.ticks(session.playhead_s))


def _places(session: Session) -> list[tuple[PlayerPlan, int]]:
    """Return the places where a command adds an event, each a player's plan and a tick: the first selected note of each
    player, else the playhead for the active player.
    """
    found = [(player.id, notes[0].onset_tick) for player, notes in notes_by_player(session).items()]
    if not found and session.player is not None:
        found = [(session.player.id, _playhead_tick(session))]
    return [(plan, tick) for player_id, tick in found if (plan := session.plans.get(player_id)) is not None]


def _spans(session: Session) -> list[tuple[PlayerPlan, int, int]]:
    """Return the ranges over which a command adds an event, each a player's plan with the first and last tick.

    They are the selected notes of each player, else the selected range, else a few beats from the playhead.
    """
    found = [
        (player.id, notes[0].onset_tick, max(note.end_tick for note in notes))
        for player, notes in notes_by_player(session).items()
    ]
    if not found and session.player is not None:
        span = session.selection.span
        if span is None:
            start = session.grid.snap(session.project.score.metre_map, _playhead_tick(session))
            span = (start, start + NEW_BEATS * session.project.metre_map.felt_ticks_at(start))
        found = [(session.player.id, *span)]
    return [(plan, start, end) for player_id, start, end in found if (plan := session.plans.get(player_id)) is not None]


# Add


def choose_gesture(session: Session) -> None:
    """Open a menu of gestures at the mouse pointer: built-in kinds, then gestures from tables."""
    menu = choice_menu()
    for action in ADDED:
        menu.addAction(actions(session)[action.id])
    menu.addSeparator()
    for name in sorted(session.performance.metadata.gestures.items, key=gesture_name):
        entry = menu.addAction(verbatim(gesture_name(name)))
        entry.setObjectName(f"gesture_{name}")
        on_click(entry, lambda name: add_named_gestures(session, name, _spans(session)), name)
    menu.popup(QCursor.pos())


def choose_expression(session: Session) -> None:
    """Open a menu of expressions at the mouse pointer: built-in ones, then the user's own."""
    menu = choice_menu()
    own = {item.name for item in session.project.expressions}
    for name in sorted(session.performance.expressions, key=lambda name: (name in own, name)):
        entry = menu.addAction(verbatim(expression_name(name)))
        entry.setObjectName(f"expression_{name}")
        on_click(entry, lambda name: add_expressions(session, name, _spans(session)), name)
    menu.popup(QCursor.pos())


def choose_style(session: Session) -> None:
    """Open a menu of styles at the mouse pointer. The chosen style replaces that of the selected regions, or else
    begins a region for the selected players in the selected range or from the playhead's bar on.
    """
    menu = choice_menu()
    regions = any(EventId.parse(key.event_id).kind == STYLE for key in session.selection.events)
    for name in sorted(session.performance.metadata.styles.items, key=style_name):
        entry = menu.addAction(verbatim(style_name(name)))
        entry.setObjectName(f"style_{name}")
        on_click(entry, _choose_style, session, name, regions)
    menu.popup(QCursor.pos())


def _choose_style(session: Session, name: str, regions: bool) -> None:
    if regions:
        change_styles(session, name)
        return
    span = session.selection.span
    tick = float(span[0]) if span is not None else float(_playhead_tick(session))
    add_styles(session, name, bars_of(session, session.players, tick))


# Remove


def delete(session: Session) -> None:
    """Delete the selected events, or else the selected notes."""
    events = events_by_player(session)
    if not events:
        notes = session.selection.notes
        name = edit_of_notes(session.project, "edit.erase_notes", notes)
        session.attempt(name, lambda project: erase(project, notes))
        return
    plans = session.plans

    def edit(project: Project) -> Project:
        for player_id, ids in events.items():
            if player_id in plans:
                project = remove(project, plans[player_id], ids)
            else:
                # Marks belong to the project and can be removed while plans are being made.
                marks = [mark for mark in player_marks(project, player_id) if mark.id in ids]
                project = remove_marks(project, player_id, marks)
        return project

    keys = [EventKey(player_id, event_id) for player_id, ids in events.items() for event_id in ids]
    if session.attempt(edit_of_events(session, "edit.remove_events", keys), edit):
        session.select(Selection())


def return_to_generated(session: Session) -> None:
    """Remove manual changes from the selected events, and from fingering, embouchure and marks of the selected
    notes.
    """
    events = events_by_player(session)
    notes = {player.id: [note.id for note in found] for player, found in notes_by_player(session).items()}

    def edit(project: Project) -> Project:
        for player_id in (*events, *(player_id for player_id in notes if player_id not in events)):
            project = give_back(project, player_id, events.get(player_id, ()), notes.get(player_id, ()))
        return project

    # Selecting a note selects its fingering.
    chosen = [*session.selection.events]
    chosen += [EventKey(player_id, str(EventId("fingering", id))) for player_id, ids in notes.items() for id in ids]
    session.attempt(edit_at_events(session, "edit.give_back", chosen), edit)


def _can_return(session: Session) -> bool:
    notes, events = session.selection.notes, session.selection.events
    if not notes and not events:
        return False
    requested = {f"{kind}:{note}" for note in notes for kind in ("fingering", "embouchure")}
    return any(
        item.about in requested or EventKey(player_id, item.about) in events
        for player_id, corrections in session.project.corrections.items()
        for item in corrections
    ) or any(
        corrections_at(session.project, player.id, {note.id for note in found})
        for player, found in notes_by_player(session).items()
    )


def revert_player(session: Session) -> None:
    """Remove all manual changes of the active player."""
    player = session.player
    if player is not None:
        session.attempt(
            Message("edit.give_back_player", {"player": player.name}),
            lambda project: give_back_player(project, player.id),
        )


# Preparations


def _breathing_notes(session: Session) -> dict[str, list[str]]:
    """Return the ids of notes, by player id, whose preparation a command changes: those of the selected breaths and
    preparations, or else the first selected note of each player.
    """
    result: dict[str, list[str]] = defaultdict(list)
    for player_id, ids in events_by_player(session).items():
        for event_id in ids:
            kind, note_id, _ = EventId.parse(event_id)
            if kind in BEFORE_NOTES and note_id not in result[player_id]:
                result[player_id].append(note_id)
    if not any(result.values()):
        for player, notes in notes_by_player(session).items():
            result[player.id] = [notes[0].id]
    return {player_id: notes for player_id, notes in result.items() if notes}


def _has_breaths(session: Session) -> bool:
    selection = session.selection
    return bool(selection.notes) or any(EventId.parse(key.event_id).kind in BEFORE_NOTES for key in selection.events)


def prepare(session: Session) -> None:
    """Turn the preparatory motion before the selected breaths on or off."""
    requested, plans = _breathing_notes(session), session.plans
    found = [
        (plans[player_id], note_id) for player_id, ids in requested.items() if player_id in plans for note_id in ids
    ]

    def edit(project: Project) -> Project:
        for plan, note_id in found:
            project = toggle_preparation(project, plan, note_id).project
        return project

    keys = [EventKey(plan.player_id, str(EventId("preparation", note_id))) for plan, note_id in found]
    session.attempt(edit_at_events(session, "edit.toggle_preparation", keys), edit)


def _added(kind: GestureRow) -> Action:
    return Action(
        f"gesture.{kind.id}",
        lambda session: add_gestures(session, kind.id, _spans(session)),
        "edit/breaths_and_acting/add_gesture",
        enabled=has_player,
    )


ADDED: Final = tuple(_added(kind) for kind in GESTURES if kind.command)
"""Commands that add a gesture, one for each kind that has a command."""
ACTIONS: tuple[Action, ...] = (
    Action("edit.delete", delete, "edit", "Delete", "timeline", has_something, icon="delete"),
    Action("events.give_back", return_to_generated, "edit", "Backspace", "timeline", _can_return, icon="reset"),
    Action(
        "events.give_back_player",
        revert_player,
        "edit",
        enabled=lambda session: session.player is not None and bool(session.project.corrections.get(session.player.id)),
    ),
    Action(
        "events.breath",
        lambda session: add_breaths(session, _places(session)),
        "edit/breaths_and_acting",
        "B",
        "timeline",
        has_player,
        icon="breath",
    ),
    Action("events.preparation", prepare, "edit/breaths_and_acting", "Shift+B", "timeline", _has_breaths),
    Action(
        "events.cue",
        lambda session: add_cues(session, _places(session)),
        "edit/breaths_and_acting",
        "C",
        "timeline",
        has_player,
        icon="cue",
    ),
    Action("events.gesture", choose_gesture, "edit/breaths_and_acting", "G", "timeline", has_player, icon="gesture"),
    Action(
        "events.expression",
        choose_expression,
        "edit/breaths_and_acting",
        "X",
        "timeline",
        has_player,
        icon="expression",
    ),
    Action("events.style", choose_style, "edit/breaths_and_acting", "Y", "timeline", has_player),
    *ADDED,
)
