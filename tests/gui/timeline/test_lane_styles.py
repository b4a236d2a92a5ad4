"""Regions of a style in the acting lane: placed, moved, resized, changed and deleted by mouse and keys."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.editor.additions import bars_of
from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.settings import Settings
from app.plan.by_hand.corrections import PlayStyle
from app.shell.actions import ActionTable
from app.shell.commands import edit, events
from tests.gui.timeline.conftest import TPQ, Stage
from tests.gui.timeline.lane_hands import click, drag, middle, planned, region_of
from tests.support.windows import child, show_in_front
from widgets.common.actions import actions
from widgets.timeline.lanes.acting.acting_lane import ActingLane
from widgets.timeline.model.regions.acting_regions import STYLE
from widgets.timeline.panel import TimelinePanel

SPAN = (3840, 7680)


@pytest.fixture
def panel(panel: TimelinePanel, session: Session, tmp_path: Path) -> Iterator[TimelinePanel]:
    table = ActionTable(session, Settings(tmp_path / "editor.toml"), [*edit.ACTIONS, *events.ACTIONS])
    table.attach("timeline", panel)
    show_in_front(panel)
    yield panel
    table.deleteLater()


def acting(panel: TimelinePanel) -> ActingLane:
    return child(panel, ActingLane)


def said(session: Session, player: int = 0) -> list[PlayStyle]:
    id = session.project.players[player].id
    return [item for item in session.project.corrections.get(id, ()) if isinstance(item, PlayStyle)]


def choose(panel: TimelinePanel, menu_name: str, style: str, tick: int, y_px: float = 5.0) -> None:
    """Choose from the menu of the lane at a place."""
    lane = acting(panel)
    x_px = lane.axis.x_px(panel.session.project.score.tempo_map.seconds(float(tick)))
    menu = lane.context_menu(lane.mouse_at(QPointF(x_px, y_px)))
    assert menu is not None
    styles = child(menu, QMenu, menu_name)
    next(entry for entry in styles.actions() if entry.objectName() == f"style_{style}").trigger()
    menu.close()


@pytest.fixture
def placed(panel: TimelinePanel, session: Session) -> TimelinePanel:
    session.select(Selection(span=SPAN))
    choose(panel, "style_here", "soloist", SPAN[0] + 10)
    return panel


def test_it_is_placed_over_the_selected_range_and_shown_with_its_name(placed: TimelinePanel, session: Session) -> None:
    (item,) = said(session)
    assert (item.style, item.start_tick, item.end_tick) == ("soloist", *SPAN)
    lane = acting(placed)
    region = region_of(lane, "style:own-1")
    assert (region.kind, region.label, region.by_hand) == (STYLE, "Soloist", True)
    assert lane.groups[0][0] == STYLE
    assert lane.row_names()[0][0] == "Style"
    assert not said(session, 1)
    session.document.undo()
    assert not said(session)
    assert lane.groups[0][0] != STYLE


def test_without_a_range_it_takes_two_bars_and_everyone_may_have_it(panel: TimelinePanel, session: Session) -> None:
    choose(panel, "style_of_all_here", "reserved", 4000)
    bar = session.project.metre_map.bar_ticks_at(4000)
    for player in range(len(session.project.players)):
        (item,) = said(session, player)
        assert (item.style, item.end_tick - item.start_tick) == ("reserved", 2 * bar)
        assert item.start_tick <= 4000 < item.end_tick
    session.document.undo()
    assert not session.project.corrections


def test_it_is_moved_resized_and_its_edge_is_dragged(placed: TimelinePanel, session: Session) -> None:
    lane = acting(placed)
    per_beat = lane.box(region_of(lane, "style:own-1")).width() / ((SPAN[1] - SPAN[0]) / 480)
    drag(lane, middle(lane, "style:own-1"), dx=2 * per_beat)
    (item,) = said(session)
    assert (item.start_tick, item.end_tick) == (SPAN[0] + 960, SPAN[1] + 960)
    box = lane.box(region_of(lane, "style:own-1"))
    drag(lane, QPointF(box.right() - 2.0, box.center().y()), dx=per_beat)
    (item,) = said(session)
    assert (item.start_tick, item.end_tick) == (SPAN[0] + 960, SPAN[1] + 1440)
    click(lane, middle(lane, "style:own-1"))
    region = region_of(lane, "style:own-1")
    handle = dict(lane.fade_handles(region, lane.box(region)))["fade_in"]
    drag(lane, handle, dx=per_beat)
    (longer,) = said(session)
    assert longer.fade_in_ticks > item.fade_in_ticks + 400
    session.document.undo()
    session.document.undo()
    session.document.undo()
    assert (said(session)[0].start_tick, said(session)[0].end_tick) == SPAN


def test_escape_takes_a_drag_back_and_delete_the_region(placed: TimelinePanel, session: Session) -> None:
    lane = acting(placed)
    drag(lane, middle(lane, "style:own-1"), dx=120.0, release=False)
    lane.plot.setFocus()
    QTest.keyClick(lane.plot, Qt.Key.Key_Escape)
    assert (said(session)[0].start_tick, said(session)[0].end_tick) == SPAN
    click(lane, middle(lane, "style:own-1"))
    actions(session)["edit.delete"].trigger()
    assert not said(session)


def test_another_style_from_the_menu_and_by_key(placed: TimelinePanel, session: Session) -> None:
    lane = acting(placed)
    at = middle(lane, "style:own-1")
    click(lane, at)
    choose(placed, "another_style", "jazz", (SPAN[0] + SPAN[1]) // 2, at.y())
    assert [item.style for item in said(session)] == ["jazz"]
    session.select(Selection())
    session.set_playhead(20.0)
    actions(session)["events.style"].trigger()
    menu = next(one for one in QApplication.topLevelWidgets() if isinstance(one, QMenu) and one.isVisible())
    next(entry for entry in menu.actions() if entry.objectName() == "style_student").trigger()
    menu.close()
    assert [item.style for item in said(session)] == ["jazz", "student"]


def test_a_style_lasts_for_the_range_only_where_it_is_set_within_it(stage: Stage) -> None:
    planned(stage.session)
    (player, *_) = stage.session.plans
    stage.session.select(Selection(span=(0, 2 * TPQ)))
    for tick, span in (
        (0, (0, 2 * TPQ)),
        (2 * TPQ - 1, (0, 2 * TPQ)),
        (2 * TPQ, (0, 8 * TPQ)),
        (5 * TPQ, (4 * TPQ, 12 * TPQ)),
    ):
        ((_, *found),) = bars_of(stage.session, [player], tick)
        assert tuple(found) == span
