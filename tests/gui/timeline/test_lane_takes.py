"""Takes by mouse and keys: swiped, selected, renamed and cleaned, compared with the project."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu
from pytestqt.qtbot import QtBot

from app.editor.selection import Selection
from app.editor.session import Session
from app.editor.settings import Settings
from app.errors import Message
from app.project.edit.placed_takes import BEFORE
from app.project.edit.takes import add_takes, set_cleaning
from app.project.snap_grid import Grid
from app.score.take import Cleaning
from app.shell.actions import ActionTable
from app.shell.commands import edit, notes, takes, timeline
from tests.gui.timeline.conftest import TPQ, scale_project
from tests.gui.timeline.lane_hands import ALT, click, double_click, drag, move_to
from tests.support.takes import PlayedNote, take_of
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child, show_in_front
from widgets.common.actions import actions
from widgets.timeline.lanes.takes.takes_lane import TakesLane
from widgets.timeline.panel import TimelinePanel

PLAYER = "p1.1.1"
EXACT = Cleaning(ghost_s=0.0, double_s=0.0, overlap_s=0.0)
GHOST: PlayedNote = (1.02, 1.05, 79, 0.04)


def played(pitch: int) -> list[PlayedNote]:
    """A note on each of the eight quarters of the scale; a quarter lasts half a second."""
    return [(0.5 * beat, 0.5 * beat + 0.45, pitch + beat, 0.7) for beat in range(8)]


@pytest.fixture
def lane(qt_app: QApplication, qtbot: QtBot, tmp_path: Path) -> Iterator[TakesLane]:
    project, _ = add_takes(
        scale_project(), PLAYER, [take_of(played(50), cleaning=EXACT), take_of(played(70), cleaning=EXACT)]
    )
    session = Session(project, ImmediateTasks())
    table = ActionTable(
        session, Settings(tmp_path / "editor.toml"), [*edit.ACTIONS, *notes.ACTIONS, *timeline.ACTIONS, *takes.ACTIONS]
    )
    panel = TimelinePanel(session)
    qtbot.addWidget(panel)
    table.attach("timeline", panel)
    panel.resize(1200, 900)
    panel.takes.set_folded(False)
    show_in_front(panel)
    panel.axis.show(-0.5, 6.0)
    session.set_grid(Grid(Fraction(1)))
    yield panel.takes
    session.timeline_view = None
    session.deleteLater()


def place(lane: TakesLane, beat: float, row: int) -> QPointF:
    seconds = lane.session.project.score.tempo_map.seconds(beat * TPQ)
    return QPointF(lane.axis.x_px(seconds), lane.row_rect(row).center().y())


def swipe(lane: TakesLane, first: float, last: float, row: int, **more: object) -> None:
    start, end = place(lane, first, row), place(lane, last, row)
    drag(lane, start, dx=end.x() - start.x(), **more)


def pitches(lane: TakesLane) -> list[int]:
    project = lane.session.project
    return [note.pitch for note in project.part(project.player(PLAYER)).notes]


def comp(lane: TakesLane) -> list[tuple[float, float, str]]:
    spans = lane.session.project.takes[PLAYER].comp
    return [(span.start_tick / TPQ, span.end_tick / TPQ, span.take_id) for span in spans]


def steps(lane: TakesLane) -> list[str]:
    return [step.name.id for step in lane.session.document.done]


def hover(lane: TakesLane, at: QPointF) -> None:
    lane.hover(lane.mouse_at(at))


SCALE = [60, 62, 64, 65, 67, 69, 71, 72]


def test_swiping_takes_a_span_from_a_take_in_one_step(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 2)
    assert comp(lane) == [(2.0, 5.0, "take:2")]
    assert pitches(lane) == [60, 62, 72, 73, 74, 69, 71, 72]
    assert steps(lane) == ["edit.comp"]
    assert lane.session.selection == Selection(span=(2 * TPQ, 5 * TPQ), take="take:2")
    swipe(lane, 4, 7, 1)
    assert comp(lane) == [(2.0, 4.0, "take:2"), (4.0, 7.0, "take:1")]
    assert pitches(lane) == [60, 62, 72, 73, 54, 55, 56, 72]
    lane.session.document.undo()
    lane.session.document.undo()
    assert pitches(lane) == SCALE


def test_a_swipe_snaps_to_the_grid_unless_alt_is_held(lane: TakesLane) -> None:
    swipe(lane, 1.8, 4.3, 1)
    assert comp(lane) == [(2.0, 4.0, "take:1")]
    lane.session.document.undo()
    swipe(lane, 1.8, 4.3, 1, modifiers=ALT)
    ((start, end, _),) = comp(lane)
    assert (start, end) == (pytest.approx(1.8, abs=0.02), pytest.approx(4.3, abs=0.02))


def test_a_swipe_backwards_and_before_the_piece_is_one_too(lane: TakesLane) -> None:
    swipe(lane, 3, -0.8, 1)
    assert comp(lane) == [(0.0, 3.0, "take:1")]


def test_the_swipe_is_shown_while_it_is_made_and_escape_ends_it(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 2, release=False)
    assert [(span.start_tick, span.end_tick) for span in lane.shown_spans("take:2")] == [(2 * TPQ, 5 * TPQ)]
    first = lane.shown_spans(BEFORE)[0]
    assert (first.start_tick, first.end_tick) == (0, 2 * TPQ)
    assert steps(lane) == []
    QTest.keyClick(lane.plot, Qt.Key.Key_Escape)
    assert lane.shown_spans("take:2") == ()
    end = place(lane, 5, 2).toPoint()
    QTest.mouseRelease(lane.plot, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, end)
    assert (steps(lane), comp(lane)) == ([], [])


def test_a_swipe_that_returns_is_none(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 2, release=False)
    start = place(lane, 2, 2).toPoint()
    move_to(lane.plot, start, Qt.KeyboardModifier.NoModifier)
    QTest.mouseRelease(lane.plot, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, start)
    assert steps(lane) == []


def test_a_double_click_on_the_head_takes_the_whole_and_before_gives_all_back(lane: TakesLane) -> None:
    head = QPoint(40, round(lane.row_rect(2).center().y() - 26))
    QTest.mouseClick(lane.heads, Qt.MouseButton.LeftButton, pos=head)
    assert lane.session.selection.take == "take:2"
    QTest.mouseDClick(lane.heads, Qt.MouseButton.LeftButton, pos=head)
    assert pitches(lane) == list(range(70, 78))
    before = QPoint(40, round(lane.row_rect(0).center().y() - 26))
    QTest.mouseDClick(lane.heads, Qt.MouseButton.LeftButton, pos=before)
    assert (pitches(lane), comp(lane)) == (SCALE, [])
    assert steps(lane) == ["edit.comp_whole", "edit.comp_before"]


def test_a_click_selects_the_span_and_the_arrows_choose_another_take_for_it(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    lane.session.select(Selection())
    click(lane, place(lane, 3.2, 1))
    assert lane.session.selection == Selection(span=(2 * TPQ, 5 * TPQ), take="take:1")
    QTest.keyClick(lane.plot, Qt.Key.Key_Down)
    assert comp(lane) == [(2.0, 5.0, "take:2")]
    assert lane.session.selection.take == "take:2"
    QTest.keyClick(lane.plot, Qt.Key.Key_Down)
    assert steps(lane) == ["edit.comp", "edit.comp"]
    QTest.keyClick(lane.plot, Qt.Key.Key_Up)
    QTest.keyClick(lane.plot, Qt.Key.Key_Up)
    assert (comp(lane), pitches(lane)) == ([], SCALE)
    assert steps(lane)[-1] == "edit.comp_before"
    QApplication.processEvents()
    QTest.keyClick(lane.plot, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert comp(lane) == [(2.0, 5.0, "take:1")]


def test_left_and_right_go_from_span_to_span(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    QTest.keyClick(lane.plot, Qt.Key.Key_Left)
    assert lane.session.selection == Selection(span=(0, 2 * TPQ), take=BEFORE)
    QTest.keyClick(lane.plot, Qt.Key.Key_Right)
    QTest.keyClick(lane.plot, Qt.Key.Key_Right)
    assert lane.session.selection.take == BEFORE
    span = lane.session.selection.span
    assert span[0] == 5 * TPQ


def test_a_take_is_renamed_where_it_stands(lane: TakesLane) -> None:
    lane.choose("take:2")
    lane.plot.setFocus()
    QApplication.processEvents()
    QTest.keyClick(lane.plot, Qt.Key.Key_F2)
    field = child(lane.heads, QLineEdit, "take_name_field")
    QTest.keyClicks(field, "Best one")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert lane.session.project.takes[PLAYER].take("take:2").name == "Best one"
    assert steps(lane) == ["edit.rename_take"]
    QTest.keyClick(lane.plot, Qt.Key.Key_F2)
    field = child(lane.heads, QLineEdit, "take_name_field")
    QTest.keyClicks(field, "x")
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert steps(lane) == ["edit.rename_take"]


def test_deleting_leaves_the_notes(lane: TakesLane) -> None:
    swipe(lane, 0, 8, 2)
    QApplication.processEvents()
    QTest.keyClick(lane.plot, Qt.Key.Key_Delete)
    assert [take.id for take in lane.session.project.takes[PLAYER].takes] == ["take:1"]
    assert pitches(lane) == list(range(70, 78))
    assert lane.session.selection == Selection()


def test_lanes_are_put_in_another_order(lane: TakesLane) -> None:
    lane.choose("take:2")
    QApplication.processEvents()
    actions(lane.session)["takes.earlier_lane"].trigger()
    assert [row.take_id for row in lane.rows] == [BEFORE, "take:2", "take:1"]
    QApplication.processEvents()
    actions(lane.session)["takes.later_lane"].trigger()
    assert [row.take_id for row in lane.rows] == [BEFORE, "take:1", "take:2"]


def edge_at(lane: TakesLane, beat: float, row: int | None = None) -> QPointF:
    """Point on an edge of the selected takes: in a row, or in the strip above."""
    at = place(lane, beat, row or 0)
    return at if row is not None else QPointF(at.x(), 12.0)


def drag_edge(lane: TakesLane, beat: float, to: float, row: int | None = None, **more: object) -> None:
    start, end = edge_at(lane, beat, row), edge_at(lane, to, row)
    drag(lane, start, dx=end.x() - start.x(), **more)


def test_an_edge_of_the_comp_is_dragged_in_one_step(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    swipe(lane, 5, 7, 2)
    drag_edge(lane, 5, 3)
    assert comp(lane) == [(2.0, 3.0, "take:1"), (3.0, 7.0, "take:2")]
    assert pitches(lane) == [60, 62, 52, 73, 74, 75, 76, 72]
    assert lane.session.selection == Selection(span=(3 * TPQ, 7 * TPQ), take="take:2")
    drag_edge(lane, 3, 6, 1)
    assert comp(lane) == [(2.0, 6.0, "take:1"), (6.0, 7.0, "take:2")]
    assert steps(lane) == ["edit.comp"] * 4
    lane.session.document.undo()
    lane.session.document.undo()
    assert comp(lane) == [(2.0, 5.0, "take:1"), (5.0, 7.0, "take:2")]


def test_an_edge_to_what_was_before_gives_it_back(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    drag_edge(lane, 2, 4)
    assert comp(lane) == [(4.0, 5.0, "take:1")]
    assert pitches(lane) == [60, 62, 64, 65, 54, 69, 71, 72]
    drag_edge(lane, 5, 7.4, modifiers=ALT)
    ((start, end, _),) = comp(lane)
    assert (start, end) == (4.0, pytest.approx(7.4, abs=0.02))
    assert steps(lane) == ["edit.comp", "edit.comp_before", "edit.comp"]


def test_an_edge_goes_no_further_than_the_next_and_leaves_no_empty_span(lane: TakesLane) -> None:
    swipe(lane, 2, 4, 1)
    swipe(lane, 4, 6, 2)
    drag_edge(lane, 4, 7)
    assert comp(lane) == [(2.0, 6.0, "take:1")]


def test_escape_ends_the_drag_of_an_edge_and_a_return_is_no_step(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    drag_edge(lane, 5, 3, release=False)
    assert [(span.start_tick, span.end_tick) for span in lane.shown_comp()] == [(2 * TPQ, 3 * TPQ)]
    QTest.keyClick(lane.plot, Qt.Key.Key_Escape)
    assert lane.shown_comp() == lane.comp
    QTest.mouseRelease(lane.plot, Qt.MouseButton.LeftButton, pos=edge_at(lane, 3).toPoint())
    drag_edge(lane, 5, 3, release=False)
    move_to(lane.plot, edge_at(lane, 5).toPoint(), Qt.KeyboardModifier.NoModifier)
    QTest.mouseRelease(lane.plot, Qt.MouseButton.LeftButton, pos=edge_at(lane, 5).toPoint())
    assert (comp(lane), steps(lane)) == ([(2.0, 5.0, "take:1")], ["edit.comp"])


def test_an_edge_shows_that_it_can_be_dragged(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    for row, beat, shape in (
        (None, 2, Qt.CursorShape.SplitHCursor),
        (1, 5, Qt.CursorShape.SplitHCursor),
        (0, 5, Qt.CursorShape.SplitHCursor),
        (2, 5, Qt.CursorShape.IBeamCursor),
        (1, 3, Qt.CursorShape.IBeamCursor),
    ):
        hover(lane, edge_at(lane, beat, row))
        assert lane.plot.cursor().shape() == shape, (row, beat)


def test_a_click_on_an_edge_selects(lane: TakesLane) -> None:
    swipe(lane, 2, 5, 1)
    lane.session.select(Selection())
    at = edge_at(lane, 5) - QPointF(2.0, 0.0)
    click(lane, at)
    assert lane.session.selection == Selection(span=(2 * TPQ, 5 * TPQ), take="take:1")
    assert steps(lane) == ["edit.comp"]


def head(lane: TakesLane, row: float) -> QPoint:
    """Point on a take's head; between two for fractional numbers."""
    return QPoint(40, round(lane.row_rect(0).top() + (row + 0.5) * lane.row_px - 26))


def drag_head(lane: TakesLane, row: int, to: float, *, release: bool = True) -> None:
    start, end = head(lane, row), head(lane, to)
    QTest.mousePress(lane.heads, Qt.MouseButton.LeftButton, pos=start)
    for step in range(1, 7):
        move_to(lane.heads, start + (end - start) * step / 6, Qt.KeyboardModifier.NoModifier)
    if release:
        QTest.mouseRelease(lane.heads, Qt.MouseButton.LeftButton, pos=end)


def test_a_head_is_dragged_to_another_place(lane: TakesLane) -> None:
    def order() -> list[str]:
        return [row.take_id for row in lane.rows]

    drag_head(lane, 2, 0.8)
    assert order() == [BEFORE, "take:2", "take:1"]
    drag_head(lane, 1, 2.9)
    assert order() == [BEFORE, "take:1", "take:2"]
    assert steps(lane) == ["edit.move_take"] * 2
    # The row before the first take stays on top; a lane that returns has not moved.
    drag_head(lane, 0, 2.9)
    drag_head(lane, 1, 1.2)
    drag_head(lane, 2, -0.4, release=False)
    assert lane.heads.dropped_before == 1
    QTest.keyClick(lane.plot, Qt.Key.Key_Escape)
    assert lane.heads.dropped_before is None
    QTest.mouseRelease(lane.heads, Qt.MouseButton.LeftButton, pos=head(lane, -0.4))
    assert (order(), steps(lane)) == ([BEFORE, "take:1", "take:2"], ["edit.move_take"] * 2)


def test_a_head_is_dragged_to_a_row_out_of_sight(lane: TakesLane) -> None:
    project, _ = add_takes(lane.session.project, PLAYER, [take_of(played(60))] * 28)
    lane.session.apply(Message("edit.record", {"count": 28}), project)
    QApplication.processEvents()
    lane.show_row("take:30")
    assert lane.row_rect(0).bottom() < 0.0
    number = lane.number_of("take:30")
    assert number == 30
    at = QPoint(40, round(lane.row_rect(number).center().y() - 26))
    QTest.mousePress(lane.heads, Qt.MouseButton.LeftButton, pos=at)
    for step in range(60):
        move_to(lane.heads, QPoint(40, -40 - step % 2), Qt.KeyboardModifier.NoModifier)
    QTest.mouseRelease(lane.heads, Qt.MouseButton.LeftButton, pos=QPoint(40, -40))
    assert lane.rows[1].take_id == "take:30"


def test_the_menu_is_of_the_row_that_was_clicked(lane: TakesLane) -> None:
    QTest.mouseClick(lane.plot, Qt.MouseButton.RightButton, pos=place(lane, 3, 2).toPoint())
    popup = QApplication.activePopupWidget()
    assert isinstance(popup, QMenu)
    names = {action.objectName() for action in popup.actions()}
    popup.close()
    assert {"takes.whole", "takes.remove", "takes.find_beats"} <= names
    assert lane.session.selection.take == "take:2"


def test_what_cleaning_leaves_out_says_why(lane: TakesLane) -> None:
    project, (id,) = add_takes(lane.session.project, PLAYER, [take_of([*played(60), GHOST])])
    lane.session.apply(Message("edit.comp_before"), project)
    row = lane.rows[-1]
    assert (row.take_id, row.faults) == (id, ("silent",))
    hover(lane, QPointF(lane.axis.x_px(1.03), lane.row_rect(3).center().y()))
    assert "too softly" in lane.plot.toolTip()
    hover(lane, QPointF(lane.axis.x_px(2.03), lane.row_rect(3).center().y()))
    assert "too softly" not in lane.plot.toolTip()
    kept = set_cleaning(lane.session.project, PLAYER, id, EXACT)
    lane.session.apply(Message("edit.clean_take", {"take": "x"}), kept)
    assert lane.rows[-1].faults == ()


def test_a_first_take_unfolds_the_lane_and_another_player_has_none(lane: TakesLane) -> None:
    lane.set_folded(True)
    project, _ = add_takes(lane.session.project, PLAYER, [take_of(played(60))])
    lane.session.apply(Message("edit.comp_before"), project)
    assert not lane.folded
    assert "(3)" in lane.title.text()
    lane.session.set_players(("p2.1.1",))
    assert lane.rows == ()
    assert "Second" in lane.empty_text()
    drag(lane, QPointF(100, 20), dx=200)
    assert steps(lane) == ["edit.comp_before"]
    lane.session.set_players((PLAYER,))
    assert len(lane.rows) == 4


def test_a_folded_lane_has_its_name_at_the_left(lane: TakesLane, qtbot: QtBot) -> None:
    width = lane.plot.width()
    lane.set_folded(True)
    qtbot.waitUntil(lambda: lane.height() < 40)
    assert lane.header.x() == 0
    lane.set_folded(False)
    qtbot.waitUntil(lambda: lane.plot.width() == width)


def test_rows_keep_their_places_when_the_tempo_changes(lane: TakesLane) -> None:
    from app.project.edit.tempo import set_tempo

    before = lane.rows[1].kept.start_s.copy()
    lane.session.apply(Message("edit.set_tempo"), set_tempo(lane.session.project, 0, 60.0))
    assert lane.rows[1].kept.start_s == pytest.approx(2 * before)
    assert lane.rows[1].breath is not None
    assert lane.rows[1].breath.time_s[0] == pytest.approx(0.0)


def test_double_clicking_a_row_is_no_swipe(lane: TakesLane) -> None:
    reported: list[str] = []
    lane.session.noticed.connect(lambda message, _: reported.append(message.id))
    double_click(lane, place(lane, 3, 1))
    assert steps(lane) == []
    assert reported == ["take.row_is_swiped"]


def test_the_part_goes_back_to_what_was_before_only_where_it_is_something_else(lane: TakesLane) -> None:
    going_back = [actions(lane.session)[id] for id in ("takes.whole", "takes.before")]

    def can_go_back() -> list[bool]:
        menu = lane.menu()
        found = [action.isEnabled() for action in going_back]
        menu.deleteLater()
        return found

    lane.choose(BEFORE)
    QApplication.processEvents()
    assert can_go_back() == [False, False]
    lane.choose("take:2")
    QApplication.processEvents()
    assert can_go_back() == [True, False]
    actions(lane.session)["takes.whole"].trigger()
    for action in going_back:
        taken = lane.session.project
        lane.choose(BEFORE)
        QApplication.processEvents()
        assert can_go_back() == [True, True]
        action.trigger()
        QApplication.processEvents()
        assert lane.session.project is not taken
        assert can_go_back() == [False, False]
        lane.session.document.undo()
        QApplication.processEvents()
