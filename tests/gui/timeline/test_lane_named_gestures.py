"""Gestures defined in tables: added from the menu, moved, resized, deleted and undone, compared with the project."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QMenu

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import AddGesture, ChangeGesture, RemoveEvent
from app.plan.model import GestureEvent
from app.project.edit import events as edit
from app.project.edit.players import set_parameters
from app.shell.commands.events import delete
from metadata.library import GESTURES
from tests.gui.timeline.lane_hands import click, drag, front_plan, middle, region_of
from tests.support.windows import child
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.panel import TimelinePanel

NAME = Message("edit.set_event_amount", {"count": 1})


@pytest.fixture
def lane(panel: TimelinePanel) -> ActingLane:
    return child(panel, ActingLane)


def said(session: Session) -> tuple[object, ...]:
    return session.project.corrections.get(session.player.id, ())


def add_shrug(lane: ActingLane) -> None:
    """Add a shrug with the right button, at a free place of the lane."""
    menu = lane.context_menu(lane.mouse_at(QPointF(600.0, 60.0)))
    menus = [action.menu() for action in menu.actions()]
    entries = {entry.text(): entry for one in menus if isinstance(one, QMenu) for entry in one.actions()}
    assert {gesture.title.en for gesture in GESTURES.now().items.values()} <= set(entries)
    entries["Shrug"].trigger()


def gestures(session: Session) -> list[GestureEvent]:
    return [event for event in front_plan(session).gestures if event.kind == "named"]


def added_gestures(session: Session) -> list[GestureEvent]:
    return [event for event in gestures(session) if ":rule:" not in event.id]


def test_one_is_added_moved_sized_and_deleted_and_every_step_is_undone(lane: ActingLane, session: Session) -> None:
    add_shrug(lane)
    [added] = said(session)
    assert isinstance(added, AddGesture)
    assert (added.kind, added.gesture, added.amount) == ("named", "shrug", 1.0)
    [event] = added_gestures(session)
    assert event.gesture is not None
    assert event.end_s - event.start_s == pytest.approx(GESTURES.now().items["shrug"].length_s, abs=0.01)
    region = region_of(lane, event.id)
    assert (region.label, region.by_hand, region.signed) == ("Shrug", True, False)
    assert session.selection.events == {EventKey(session.players[0], event.id)}

    drag(lane, middle(lane, event.id), dx=90)
    [moved] = added_gestures(session)
    assert moved.start_s > event.start_s + 1.0
    assert moved.end_tick - moved.start_tick == event.end_tick - event.start_tick
    drag(lane, middle(lane, event.id), dy=8)
    [smaller] = added_gestures(session)
    assert 0.0 < smaller.amount < 1.0

    click(lane, middle(lane, event.id))
    delete(session)
    assert not added_gestures(session)
    assert not said(session), "what was added is forgotten"
    for _ in range(4):
        session.document.undo()
    assert not session.document.done
    assert not added_gestures(session)


def test_what_a_rule_made_is_changed_and_removed_and_stays_so_for_another_seed(
    lane: ActingLane, session: Session
) -> None:
    player = session.players[0]
    session.attempt(NAME, lambda project: set_parameters(project, (player,), style="soloist"))
    first, second = gestures(session)[:2]
    assert first.id.startswith("named:rule:soloist_climax:")
    assert region_of(lane, first.id).label == "Lean in"
    session.attempt(NAME, lambda project: edit.set_amounts(project, front_plan(session), {first.id: 0.25}))
    session.select(Selection(events=frozenset({EventKey(player, second.id)})))
    delete(session)
    assert [type(item) for item in said(session)] == [ChangeGesture, RemoveEvent]
    session.attempt(NAME, lambda project: set_parameters(project, (player,), seed=99))
    left = {event.id: event for event in gestures(session)}
    assert left[first.id].amount == 0.25
    assert left[first.id].corrected
    assert second.id not in left
    assert not front_plan(session).problems or all(
        problem.message.id != "correction.orphaned" for problem in front_plan(session).problems
    )
