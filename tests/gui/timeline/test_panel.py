"""The timeline's frame: lanes, tools, empty pieces, language and theme."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import msgspec
import pytest
from PySide6.QtCore import QPoint, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QWidget
from pytestqt.qtbot import QtBot

from app.editor.design_tokens import LIGHT
from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.timeline_view import Ghosts, Tool
from app.errors import Message
from app.plan.model import Problem
from app.project.model import Project
from app.score.model import Note, Score
from app.score.tempo import TempoMap
from tests.gui.timeline.conftest import TPQ, Stage
from tests.gui.timeline.hand import Hand
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, show
from widgets.timeline.panel import TimelinePanel
from widgets.timeline.plot.plot import Background
from widgets.timeline.ruler.time_ruler import Ruler


def menu_of(panel: TimelinePanel) -> QMenu:
    found = [menu for menu in panel.findChildren(QMenu) if menu.isVisible()]
    assert len(found) == 1
    return found[0]


def choose(menu: QMenu, text: str) -> None:
    next(action for action in menu.actions() if action.text() == text).trigger()
    menu.close()
    QApplication.processEvents()


def test_all_lanes_share_one_axis_and_one_width(stage: Stage) -> None:
    widths = {lane.plot.width() for lane in stage.panel.lanes.values() if not lane.folded and lane.isVisible()}
    assert widths == {stage.panel.axis.width_px}
    stage.panel.axis.show(1.0, 2.0)
    for lane in stage.panel.lanes.values():
        seen = [lane.mouse_at(QPointF(x, 5.0)).time_s for x in (0.0, float(stage.panel.axis.width_px))]
        assert seen == pytest.approx([1.0, 2.0])


@pytest.fixture
def drawn(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Number of redraws by lane; the ruler counts as a lane."""
    result: Counter[str] = Counter()
    background, scale = Background.paint_px, Ruler._paint_scale

    def of_lane(item: Background, painter: QPainter, exposed: QRectF) -> None:
        result[item.lane.id] += 1
        background(item, painter, exposed)

    def of_ruler(ruler: Ruler, painter: QPainter) -> None:
        result["ruler"] += 1
        scale(ruler, painter)

    stage.panel.axis.show(0.5, 1.5)
    stage.session.set_playhead(1.0)
    settle()
    monkeypatch.setattr(Background, "paint_px", of_lane)
    monkeypatch.setattr(Ruler, "_paint_scale", of_ruler)
    return result


def settle() -> None:
    for _ in range(3):
        QApplication.processEvents()


def test_a_scroll_draws_every_lane_once(stage: Stage, drawn: Counter[str]) -> None:
    stage.panel.axis.pan(0.25)
    settle()
    shown = [lane.id for lane in stage.panel.lanes.values() if not lane.plot.visibleRegion().isEmpty()]
    assert len(shown) > 3
    assert drawn == dict.fromkeys([*shown, "ruler"], 1)


def test_the_playhead_passes_by_and_nothing_is_drawn_anew(stage: Stage, drawn: Counter[str]) -> None:
    head = stage.panel.playhead
    before = head.x()
    stage.session.set_playhead(1.2)
    settle()
    assert head.x() > before
    assert not drawn


def test_a_selected_note_draws_only_lanes_that_show_notes(stage: Stage, drawn: Counter[str]) -> None:
    stage.session.select(Selection(frozenset({"1:1"})))
    settle()
    assert drawn["roll"] == drawn["fingering"] == 1
    assert not {"breath", "acting", "problems", "ruler"} & set(drawn)


def test_another_colour_of_the_player_in_front_and_new_problems_are_drawn(stage: Stage, drawn: Counter[str]) -> None:
    session = stage.session
    front, behind = session.project.players
    red = (msgspec.structs.replace(front, colour="#ff0000"), behind)
    session.apply(Message("edit.player_colour", {"of": "Trumpet 1"}), replace(session.project, players=red))
    settle()
    assert {"roll", "fingering", "breath", "acting", "curves"} <= set(drawn)
    drawn.clear()
    session.set_broken({front.id: (Problem(Message("contact.hand_off", {"side": "left", "gap_mm": 9}), "1:3", 1, 2),)})
    settle()
    assert {"roll", "fingering", "breath"} <= set(drawn)


@pytest.mark.parametrize("ratio", [1.0, 1.25, 1.5, 2.0])
def test_a_picture_reaches_its_last_row_and_column_at_every_scale(stage: Stage, ratio: float) -> None:
    for height in range(20, 28):
        lane = stage.panel.lanes["problems"]
        lane.plot.resize(401, height)
        image = lane.plot._draw(QSize(round(401 * ratio) + 1, round(height * ratio) + 1), ratio).toImage()
        last = {image.pixelColor(x, image.height() - 1).name() for x in range(image.width())}
        assert lane.plot.ground().name() in last
        assert last <= {image.pixelColor(x, image.height() // 2).name() for x in range(image.width())}


def test_another_font_or_theme_is_drawn(stage: Stage, drawn: Counter[str]) -> None:
    for widget in (stage.roll, stage.panel.ruler):
        font = widget.font()
        font.setPointSizeF(font.pointSizeF() + 4.0)
        widget.setFont(font)
    settle()
    assert drawn["roll"]
    assert drawn["ruler"]
    drawn.clear()
    stage.session.set_tokens(LIGHT)
    settle()
    assert drawn["roll"] == drawn["ruler"] == 1


def test_a_lane_folds_and_unfolds_by_its_button(stage: Stage) -> None:
    lane = stage.roll
    height = lane.height()
    QTest.mouseClick(lane.fold_button, Qt.MouseButton.LeftButton)
    QApplication.processEvents()
    assert lane.folded
    assert lane.height() < height
    assert lane.header.x() == 0
    QTest.mouseClick(lane.fold_button, Qt.MouseButton.LeftButton)
    assert not lane.folded


def test_a_folded_lane_unfolds_by_a_double_click_beside_its_title(stage: Stage) -> None:
    lane = stage.roll
    lane.set_folded(True)
    QApplication.processEvents()
    place = QPoint(lane.width() - 100, lane.height() // 2)
    assert not lane.header.geometry().contains(place)
    QTest.mouseDClick(lane, Qt.MouseButton.RightButton, pos=place)
    assert lane.folded
    QTest.mouseDClick(lane, Qt.MouseButton.LeftButton, pos=place)
    assert not lane.folded


def test_a_lane_is_made_taller_by_its_lower_edge(stage: Stage) -> None:
    lane = stage.roll
    height = lane.height()
    handle = child(stage.panel, QWidget, "handle_roll")
    hand = Hand(handle)
    hand.press((50.0, 2.0))
    hand.move((50.0, 92.0))
    assert lane.height() == height + 90
    hand.release((50.0, 2.0))
    stage.panel.resize(1200, 300)
    QApplication.processEvents()
    assert lane.height() == height + 90
    hand.double_click((50.0, 2.0))
    assert lane.height() < height


def test_lanes_are_moved_and_hidden_from_their_header(stage: Stage) -> None:
    panel = stage.panel
    at = panel.stack.lanes.index(stage.roll)
    stage.roll.header.customContextMenuRequested.emit(QPoint(5, 5))
    choose(menu_of(panel), "Move Down")
    assert panel.stack.lanes.index(stage.roll) == at + 1
    stage.roll.header.customContextMenuRequested.emit(QPoint(5, 5))
    choose(menu_of(panel), "Hide")
    assert stage.roll.isHidden()
    panel.lanes_button.menu().aboutToShow.emit()
    choose(panel.lanes_button.menu(), "Notes")
    assert not stage.roll.isHidden()


def test_tools_and_the_player_in_front_are_chosen_above(stage: Stage) -> None:
    bar = stage.panel.tool_bar
    QTest.mouseClick(bar.tools[Tool.ERASE], Qt.MouseButton.LeftButton)
    assert stage.panel.tool is Tool.ERASE
    bar.player_box.setCurrentIndex(1)
    bar.player_box.activated.emit(1)
    assert stage.session.players == ("p2.1.1",)
    stage.table.actions["timeline.alone"].trigger()
    assert stage.panel.ghosts is Ghosts.ALONE
    assert bar.ghosts_button.text() == "Active Player Only"


def test_the_scroll_bar_and_the_buttons_below(stage: Stage) -> None:
    panel, axis = stage.panel, stage.panel.axis
    span = axis.span_s
    QTest.mouseClick(panel.zoom_buttons["zoom_in"], Qt.MouseButton.LeftButton)
    assert axis.span_s == pytest.approx(span / 1.5)
    QTest.mouseClick(panel.zoom_buttons["zoom_out"], Qt.MouseButton.LeftButton)
    assert axis.span_s == pytest.approx(span)
    panel.time_bar.setValue(panel.time_bar.maximum())
    assert axis.end_s == pytest.approx(axis.limits_s[1], abs=0.002)
    QTest.mouseClick(panel.zoom_buttons["fit"], Qt.MouseButton.LeftButton)
    assert axis.start_s == axis.limits_s[0]
    assert 8.0 <= axis.end_s <= 16.0
    assert panel.time_bar.value() == 0


def test_a_time_is_revealed(stage: Stage) -> None:
    axis = stage.panel.axis
    axis.show(0.0, 2.0)
    stage.session.reveal(1.0)
    assert axis.start_s == 0.0
    stage.session.reveal(30.0)
    assert axis.start_s < 30.0 < axis.end_s


def test_pointing_at_a_note_says_what_it_is(stage: Stage) -> None:
    stage.hand.move(stage.middle("1:5"))
    assert stage.panel.tool_bar.readout.text() == "A4 · 2.2.000 · velocity 80"
    stage.session.pitch_display.set(written=True, middle_c_octave=3)
    stage.hand.move(stage.middle("1:5"))
    assert stage.panel.tool_bar.readout.text().startswith("B3")
    stage.session.select(Selection(frozenset({"1:1", "1:2"})))
    stage.roll.hover(None)
    assert stage.panel.tool_bar.readout.text() == "Selected notes: 2"


def test_a_piece_without_players_and_notes_says_what_to_do(qtbot: QtBot, qt_app: QApplication) -> None:
    session = Session(Project(Score("", TPQ, TempoMap(TPQ)), ()), ImmediateTasks())
    panel = TimelinePanel(session)
    qtbot.addWidget(panel)
    panel.resize(900, 400)
    show(panel)
    assert panel.roll.hint()
    panel.set_tool(Tool.DRAW)
    hand = Hand(panel.roll.plot)
    hand.drag((100.0, 40.0), (200.0, 60.0))
    hand.double_click((150.0, 40.0))
    panel.fit()
    panel.zoom_to_selection()
    panel.grab()
    assert not session.document.done
    session.deleteLater()


def test_another_document_begins_with_the_select_tool(stage: Stage) -> None:
    stage.panel.set_tool(Tool.DRAW)
    stage.session.document.open(stage.session.project)
    assert stage.panel.tool is Tool.SELECT
    assert stage.panel.roll.plot.cursor().shape() is Qt.CursorShape.ArrowCursor
    stage.table.refresh()
    assert stage.table.actions["notes.tool_select"].isChecked()
    assert not stage.table.actions["notes.tool_draw"].isChecked()


def test_drawing_beyond_the_end_makes_room(stage: Stage) -> None:
    project = stage.session.project
    empty = tuple(msgspec.structs.replace(part, notes=()) for part in project.score.parts)
    stage.session.document.open(replace(project, score=msgspec.structs.replace(project.score, parts=empty)))
    before = stage.panel.axis.limits_s[1]
    stage.panel.set_tool(Tool.DRAW)
    stage.panel.axis.show(before - 6.0, before)
    x = stage.roll.axis.x_px(before - 1.0)
    stage.hand.drag((x, 60.0), (x + 30, 60.0))
    assert len(stage.session.project.score.parts[0].notes) == 1
    assert stage.panel.axis.limits_s[1] > before


def test_another_theme_is_taken_at_once(stage: Stage) -> None:
    before = stage.roll.plot.grab().toImage().pixelColor(3, 3)
    stage.session.set_tokens(LIGHT)
    QApplication.processEvents()
    after = stage.roll.plot.grab().toImage().pixelColor(3, 3)
    assert after.lightness() > before.lightness() + 100


@pytest.mark.parametrize(("bars", "shown"), [(2, None), (24, None), (25, 16), (400, 16)])
def test_a_short_piece_is_first_shown_whole_and_of_a_long_one_the_beginning(
    stage: Stage, bars: int, shown: int | None
) -> None:
    project = stage.session.project
    last = Note("1:99", (bars - 1) * 4 * TPQ, 4 * TPQ, 60, 80)
    part = project.score.parts[0]
    parts = (msgspec.structs.replace(part, notes=(*part.notes[:4], last)), project.score.parts[1])
    stage.session.document.open(replace(project, score=msgspec.structs.replace(project.score, parts=parts)))
    axis = stage.panel.axis
    low_s, _ = axis.limits_s
    bar_s = 2.0
    # Little more than the piece, and at least four bars.
    most_s = max(bars, 4) * bar_s + 8.0
    assert axis.start_s == low_s
    if shown is None:
        assert max(bars, 4) * bar_s <= axis.end_s <= most_s
    else:
        assert axis.end_s == pytest.approx(bar_s * shown)
    stage.panel.fit()
    assert max(bars, 4) * bar_s <= axis.end_s <= most_s
