"""Regenerated bars are displayed in the acting lane, can be reverted there, and are listed among the user's changes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.editor.settings import Settings
from app.errors import Message
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import AddExpression, Vary
from app.project.edit.corrections import with_corrections
from app.shell.actions import ActionTable
from app.shell.commands import edit, events, generate
from tests.gui.timeline.lane_hands import click, drag, middle, region_of, shown_panel
from tests.support.windows import child, show_in_front
from widgets.common.actions import actions
from widgets.inspector.correction_list import CorrectionList
from widgets.inspector.generated_values import Generated
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.model.regions.acting_regions import VARIED
from widgets.timeline.panel import TimelinePanel

SPAN = (3840, 7680)


@pytest.fixture
def panel(panel: TimelinePanel, session: Session, tmp_path: Path) -> Iterator[TimelinePanel]:
    table = ActionTable(
        session, Settings(tmp_path / "editor.toml"), [*edit.ACTIONS, *events.ACTIONS, *generate.ACTIONS]
    )
    table.attach("timeline", panel)
    session.select(Selection(span=SPAN))
    table.refresh()
    actions(session)["generate.bars"].trigger()
    session.select(Selection())
    show_in_front(panel)
    yield panel
    table.deleteLater()


def acting(panel: TimelinePanel) -> ActingLane:
    return child(panel, ActingLane)


def said(session: Session) -> tuple[Vary, ...]:
    assert session.player is not None
    return tuple(item for item in session.project.corrections.get(session.player.id, ()) if isinstance(item, Vary))


def test_bars_performed_anew_are_seen_where_they_are(panel: TimelinePanel, session: Session) -> None:
    lane = acting(panel)
    region = next(region for region in lane.regions if region.kind == VARIED)
    assert (region.start_tick, region.end_tick) == SPAN
    assert region.by_hand
    assert lane.groups[0][0] == VARIED
    box = lane.box(region)
    assert box.left() == pytest.approx(lane.axis.x_px(session.project.score.tempo_map.seconds(SPAN[0])))
    assert "Backspace" in lane.tip(region)


@pytest.mark.parametrize("key", [Qt.Key.Key_Backspace, Qt.Key.Key_Delete])
def test_a_key_brings_the_first_performance_back(panel: TimelinePanel, session: Session, key: Qt.Key) -> None:
    lane = acting(panel)
    assert said(session)
    click(lane, middle(lane, region_id(lane)))
    QApplication.processEvents()
    QTest.keyClick(lane.plot, key)
    assert not said(session)
    assert not [region for region in lane.regions if region.kind == VARIED]
    assert lane.groups[0][0] == "cue"
    session.document.undo()
    assert said(session)
    assert region_of(lane, region_id(lane)).by_hand


def test_it_cannot_be_dragged(panel: TimelinePanel, session: Session) -> None:
    lane, before = acting(panel), session.project
    for dx, dy in ((60.0, 0.0), (0.0, -12.0)):
        drag(lane, middle(lane, region_id(lane)), dx, dy)
    assert session.project is before


def test_the_list_of_what_was_done_by_hand_has_it(panel: TimelinePanel, session: Session, qtbot: QtBot) -> None:
    words = CorrectionList(session, Generated(session))
    qtbot.addWidget(words)
    words.resize(320, 400)
    words.show()
    line = words.list.lines.lines[0]
    assert (line.title, line.tone) == ("Regenerated", "by_hand")
    assert line.place == "2.2.000"
    words.list.opened.emit(line.key)
    assert session.selection.events == frozenset({EventKey(session.player.id, region_id(acting(panel)))})


def region_id(lane: ActingLane) -> str:
    return next(region.event_id for region in lane.regions if region.kind == VARIED)


def test_what_did_not_change_is_known_again_and_all_is_as_if_made_anew(session: Session, qtbot: QtBot) -> None:
    panel = shown_panel(session)
    qtbot.addWidget(panel)
    lane, player = acting(panel), session.player
    assert player is not None

    def smile() -> None:
        project = with_corrections(session.project, player.id, [AddExpression("x", "smile", 1920, 3840)])
        session.apply(Message("edit.add_expression", {"expression": "smile", "of": "1"}), project)

    def vary() -> None:
        project = with_corrections(session.project, player.id, [Vary("varied-1", *SPAN, 5)])
        session.apply(Message("edit.vary_everyone"), project)

    def plan() -> None:
        performance = Performance(session.project, session.performance)
        performance.prepare()
        session.set_performance(performance)

    plan()
    undo = session.document.undo
    for change in (smile, undo, vary, undo):
        change()
        plan()
        again, _ = lane.make_regions(session.performance.plan(player))
        assert {id(region) for region in again} & {id(region) for region in lane.regions if region.kind == "sway"}
        fresh = ActingLane(session, panel.axis)
        assert lane.regions == fresh.regions
        assert lane.groups == fresh.groups
        fresh.deleteLater()
