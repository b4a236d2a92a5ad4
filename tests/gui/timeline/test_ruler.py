"""The ruler by mouse and keys."""

from __future__ import annotations

import random

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu

from app.editor.selection import Selection
from app.score.metre_map import Metre
from app.score.model import Score
from app.score.tempo import TempoChange, TempoMap
from tests.gui.timeline.conftest import TPQ, Stage
from tests.gui.timeline.hand import ALT, CTRL, SHIFT, Hand, Place
from tests.support.windows import child
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.model.ruler.ruler_marks import clock, lay_marks
from widgets.timeline.ruler.time_ruler import MARKS_PX, Ruler
from widgets.timeline.zoom_and_scroll import TimeAxis

BAR = 4 * TPQ


def ruler_of(stage: Stage) -> Ruler:
    return stage.panel.ruler


def place(stage: Stage, tick: float, y: float = MARKS_PX + 8) -> Place:
    seconds = stage.session.project.score.tempo_map.seconds(float(tick))
    return GUTTER_PX + stage.panel.axis.x_px(seconds), y


def on_mark(stage: Stage, kind: str, tick: int) -> Place:
    stage.panel.ruler.repaint()
    mark = next(mark for mark in ruler_of(stage)._marks if (mark.kind, mark.tick) == (kind, tick))
    return (mark.box.left + mark.box.right) / 2, (mark.box.top + mark.box.bottom) / 2


def type_into(stage: Stage, text: str, key: Qt.Key = Qt.Key.Key_Return) -> None:
    editor = child(stage.panel.ruler, QLineEdit, "mark_editor")
    assert editor.isVisible()
    editor.selectAll()
    QTest.keyClicks(editor, text)
    QTest.keyClick(editor, key)
    assert not editor.isVisible()


def choose(menu: QMenu, text: str) -> None:
    next(action for action in menu.actions() if action.text() == text).trigger()
    QApplication.processEvents()


def test_a_metre_of_a_bar_that_begins_out_of_sight_is_typed_in_sight(stage: Stage) -> None:
    clock = stage.session.project.score.tempo_map
    stage.panel.axis.show(clock.seconds(BAR + 2.0 * TPQ), clock.seconds(3.0 * BAR))
    ruler = ruler_of(stage)
    ruler.edit_mark("metre", BAR)
    editor = child(ruler, QLineEdit, "mark_editor")
    assert editor.visibleRegion().boundingRect() == editor.rect()
    type_into(stage, "3/4")
    assert stage.session.project.score.metre_map.metres[-1].tick == BAR


def test_a_click_seeks(stage: Stage) -> None:
    sought: list[float] = []
    stage.panel.sought.connect(sought.append)
    Hand(ruler_of(stage)).click(place(stage, 3 * TPQ))
    assert sought == [pytest.approx(1.5, abs=0.02)]
    assert stage.session.playhead_s == sought[0]
    assert stage.session.selection.span is None


def test_a_drag_with_shift_selects_a_range_on_the_grid(stage: Stage) -> None:
    hand = Hand(ruler_of(stage))
    before_s = stage.session.playhead_s
    hand.drag(place(stage, 2.02 * TPQ), place(stage, 4.9 * TPQ), SHIFT)
    assert stage.session.selection.span == (2 * TPQ, 5 * TPQ)
    hand.drag(place(stage, 6 * TPQ), place(stage, 4.03 * TPQ), SHIFT | ALT)
    assert stage.session.playhead_s == before_s
    span = stage.session.selection.span
    assert span[0] != 4 * TPQ
    assert abs(span[0] - 4.03 * TPQ) < 4
    hand.click(place(stage, 6 * TPQ))
    assert stage.session.selection.span is None


def test_the_playhead_is_scrubbed(stage: Stage) -> None:
    stage.session.set_playhead(1.0)
    Hand(ruler_of(stage)).drag(place(stage, 2 * TPQ + 2, 42), place(stage, 5 * TPQ, 42))
    assert stage.session.playhead_s == pytest.approx(2.5, abs=0.01)
    assert stage.session.selection.span is None


def test_a_drag_anywhere_on_the_ruler_scrubs(stage: Stage) -> None:
    stage.session.select(Selection(frozenset({"1:1"})))
    hand, seen = Hand(ruler_of(stage)), list[float]()
    stage.session.playhead_changed.connect(seen.append)
    for y in (8.0, MARKS_PX + 8.0):
        hand.drag(place(stage, 3 * TPQ, y), place(stage, 6 * TPQ, y))
        # At the press, half way and at the end.
        assert seen == pytest.approx([1.5, 2.25, 3.0], abs=0.02)
        seen.clear()
    assert stage.session.selection == Selection(frozenset({"1:1"}))
    # Past the edge the timeline scrolls, and the playhead stays in the piece.
    hand.drag(place(stage, 2 * TPQ), (-3000.0, MARKS_PX + 8.0))
    assert stage.session.playhead_s == stage.panel.axis.limits_s[0]


def test_escape_takes_a_scrub_back(stage: Stage) -> None:
    stage.session.set_playhead(0.75)
    hand = Hand(ruler_of(stage))
    hand.press(place(stage, 3 * TPQ))
    hand.move(place(stage, 5 * TPQ))
    QTest.keyClick(ruler_of(stage), Qt.Key.Key_Escape)
    assert stage.session.playhead_s == 0.75


def test_edges_of_the_loop_are_dragged(stage: Stage) -> None:
    stage.session.set_loop((1.0, 2.0))
    hand = Hand(ruler_of(stage))
    hand.drag(place(stage, 4 * TPQ - 3), place(stage, 6.03 * TPQ))
    assert stage.session.loop_s == (1.0, 3.0)
    hand.drag(place(stage, 2 * TPQ + 3), place(stage, 3 * TPQ))
    assert stage.session.loop_s == (1.5, 3.0)
    hand.drag(place(stage, 3 * TPQ), place(stage, 8 * TPQ))
    assert stage.session.loop_s[0] < 3.0


def test_edges_of_the_punch_range_are_dragged(stage: Stage) -> None:
    recording = stage.session.recording
    hand = Hand(ruler_of(stage))
    recording.set(punch=True, punch_ticks=(2 * TPQ, 4 * TPQ))
    stage.session.set_loop((1.0, 2.0))
    # Both ranges have an edge here: the bar of the loop is above that of the punch range.
    hand.drag(place(stage, 4 * TPQ - 2, 32), place(stage, 6.03 * TPQ, 32))
    assert recording.punch_ticks == (2 * TPQ, 6 * TPQ)
    assert stage.session.loop_s == (1.0, 2.0)
    hand.drag(place(stage, 4 * TPQ - 2, 24), place(stage, 5 * TPQ, 24))
    assert stage.session.loop_s == (1.0, 2.5)
    # An edge does not pass the other, and Escape takes a drag back.
    hand.drag(place(stage, 6 * TPQ), place(stage, 1 * TPQ))
    assert recording.punch_ticks[1] > recording.punch_ticks[0]
    before = recording.punch_ticks
    hand.press(place(stage, 2 * TPQ, 32))
    hand.move(place(stage, 1.5 * TPQ, 32))
    hand.move(place(stage, 1 * TPQ, 32))
    assert recording.punch_ticks[0] == TPQ
    QTest.keyClick(ruler_of(stage), Qt.Key.Key_Escape)
    assert recording.punch_ticks == before
    hand.release(place(stage, 1 * TPQ, 32))
    recording.set(punch=False)
    hand.drag(place(stage, 2 * TPQ, 32), place(stage, 3 * TPQ, 32))
    assert recording.punch_ticks == before


def test_a_running_take_is_seen_from_its_beginning_to_the_playhead(stage: Stage) -> None:
    ruler, recording = ruler_of(stage), stage.session.recording
    stage.session.set_playhead(1.0)

    def shown(tick: float) -> QColor:
        x, y = place(stage, tick, 30)
        return ruler.grab().toImage().pixelColor(round(x * ruler.devicePixelRatioF()), round(y))

    plain = shown(1.5 * TPQ), shown(2.5 * TPQ)
    recording.set(running=True, start_s=0.5, counted_from_s=-1.5, passes=1)
    assert shown(1.5 * TPQ).red() > plain[0].red() + 20
    assert shown(2.5 * TPQ) == plain[1]
    stage.session.set_playhead(1.5)
    assert shown(2.5 * TPQ).red() > plain[1].red() + 20
    recording.set(running=False)
    assert shown(1.5 * TPQ) == plain[0]


def test_a_double_click_fits(stage: Stage) -> None:
    Hand(ruler_of(stage)).double_click(place(stage, 3 * TPQ))
    axis = stage.panel.axis
    assert axis.start_s == axis.limits_s[0]
    assert 8.0 <= axis.end_s <= 16.0


def test_wheels_scroll_and_zoom(stage: Stage) -> None:
    axis = stage.panel.axis
    start, at = axis.start_s, axis.seconds(300 - GUTTER_PX)
    hand = Hand(ruler_of(stage))
    hand.wheel((300.0, 30.0), 2, CTRL)
    assert axis.seconds(300 - GUTTER_PX) == pytest.approx(at)
    assert axis.start_s > start
    start = axis.start_s
    hand.wheel((300.0, 30.0), -1)
    assert axis.start_s > start


def test_a_tempo_is_typed(stage: Stage) -> None:
    Hand(ruler_of(stage)).double_click(on_mark(stage, "tempo", 0))
    type_into(stage, "96")
    assert stage.session.project.score.tempo_map.bpm == ((0, pytest.approx(96.0)),)
    assert stage.steps == ["edit.set_tempo"]
    Hand(ruler_of(stage)).double_click(on_mark(stage, "tempo", 0))
    type_into(stage, "50", Qt.Key.Key_Escape)
    assert stage.steps == ["edit.set_tempo"]


def test_an_impossible_tempo_is_refused_in_words(stage: Stage) -> None:
    said: list[str] = []
    stage.session.noticed.connect(lambda message, severity: said.append(message.id))
    Hand(ruler_of(stage)).double_click(on_mark(stage, "tempo", 0))
    type_into(stage, "fast")
    assert said == ["tempo.outside"]
    assert stage.steps == []


def test_a_tempo_is_added_dragged_and_removed(stage: Stage) -> None:
    ruler = ruler_of(stage)
    choose(ruler.context_menu(QPointF(*place(stage, 4.02 * TPQ))), "Add Tempo Here")
    type_into(stage, "90")
    tempo = stage.session.project.score.tempo_map
    assert tempo.bpm == ((0, pytest.approx(120.0)), (BAR, pytest.approx(90.0)))
    start = on_mark(stage, "tempo", BAR)
    hand = Hand(ruler)
    hand.press(start)
    hand.move((place(stage, 5 * TPQ)[0], start[1]))
    hand.move((place(stage, 6 * TPQ)[0], start[1]))
    hand.release((place(stage, 6 * TPQ)[0], start[1]))
    moved = [tick for tick, _ in stage.session.project.score.tempo_map.bpm]
    assert len(moved) == 2
    assert moved[1] > BAR
    assert moved[1] % (TPQ // 4) == 0
    assert stage.steps == ["edit.set_tempo", "edit.move_tempo"]
    x, y = on_mark(stage, "tempo", moved[1])
    choose(ruler.context_menu(QPointF(x, y)), "Remove Tempo")
    assert len(stage.session.project.score.tempo_map.bpm) == 1


def test_a_dragged_tempo_comes_back_with_escape(stage: Stage) -> None:
    ruler = ruler_of(stage)
    choose(ruler.context_menu(QPointF(*place(stage, 4 * TPQ))), "Add Tempo Here")
    type_into(stage, "90")
    before = stage.session.project
    start = on_mark(stage, "tempo", BAR)
    hand = Hand(ruler)
    hand.press(start)
    hand.move((start[0] + 90, start[1]))
    assert stage.session.project is not before
    QTest.keyClick(ruler, Qt.Key.Key_Escape)
    hand.release((start[0] + 90, start[1]))
    assert stage.session.project is before
    assert stage.steps == ["edit.set_tempo"]


def test_a_metre_is_added_at_a_bar_and_removed(stage: Stage) -> None:
    ruler = ruler_of(stage)
    choose(ruler.context_menu(QPointF(*place(stage, 6 * TPQ))), "Add Time Signature at This Bar")
    type_into(stage, "3/4")
    metres = [(metre.tick, metre.numerator) for metre in stage.session.project.score.metres]
    assert metres == [(0, 4), (BAR, 3)]
    x, y = on_mark(stage, "metre", BAR)
    choose(ruler.context_menu(QPointF(x, y)), "Remove Time Signature")
    assert len(stage.session.project.score.metres) == 1


def test_a_bar_is_selected_from_the_menu(stage: Stage) -> None:
    choose(ruler_of(stage).context_menu(QPointF(*place(stage, 6 * TPQ))), "Select Bar")
    assert stage.session.selection.span == (BAR, 2 * BAR)


def test_the_unit_is_chosen_on_the_ruler(stage: Stage) -> None:
    ruler = ruler_of(stage)
    menu = ruler.unit_button.menu()
    for index, display in enumerate(("bars", "seconds", "frames")):
        menu.actions()[index].trigger()
        assert stage.session.time_display == display
        assert ruler.unit_button.text() == menu.actions()[index].text()


@pytest.mark.parametrize(
    ("seconds", "decimals", "text"),
    [(0.0, 0, "0:00"), (-1.5, 1, "-0:01.5"), (59.996, 2, "1:00.00"), (3725.0, 0, "1:02:05"), (-0.001, 1, "0:00.0")],
)
def test_clock(seconds: float, decimals: int, text: str) -> None:
    assert clock(seconds, decimals) == text


def with_metre(stage: Stage, bar: int, text: str = "3/4") -> Ruler:
    ruler = ruler_of(stage)
    choose(ruler.context_menu(QPointF(*place(stage, bar * BAR + 10))), "Add Time Signature at This Bar")
    type_into(stage, text)
    return ruler


def metres(stage: Stage) -> list[tuple[int, int, int]]:
    return [(metre.tick, metre.numerator, metre.denominator) for metre in stage.session.project.score.metres]


def test_a_metre_is_dragged_from_bar_to_bar(stage: Stage) -> None:
    ruler = with_metre(stage, 1)
    before = stage.session.project
    x, y = on_mark(stage, "metre", BAR)
    hand = Hand(ruler)
    hand.press((x, y))
    hand.move((place(stage, 1.4 * BAR)[0], y))
    hand.move((place(stage, 2.2 * BAR)[0], y))
    hand.release((place(stage, 2.2 * BAR)[0], y))
    assert metres(stage) == [(0, 4, 4), (2 * BAR, 3, 4)]
    assert stage.steps == ["edit.set_metre", "edit.move_metre"]
    stage.session.document.undo()
    assert stage.session.project is before


def test_escape_brings_a_dragged_metre_back(stage: Stage) -> None:
    ruler = with_metre(stage, 1)
    before = stage.session.project
    x, y = on_mark(stage, "metre", BAR)
    hand = Hand(ruler)
    hand.press((x, y))
    hand.move((place(stage, 2.2 * BAR)[0], y))
    assert stage.session.project is not before
    QTest.keyClick(ruler, Qt.Key.Key_Escape)
    assert stage.session.project is before
    hand.release((place(stage, 2.2 * BAR)[0], y))
    assert stage.steps == ["edit.set_metre"]


def test_the_first_metre_and_tempo_stay_and_that_is_said(stage: Stage) -> None:
    said: list[str] = []
    stage.session.noticed.connect(lambda message, severity: said.append(message.id))
    before = stage.session.project
    for kind in ("metre", "tempo"):
        x, y = on_mark(stage, kind, 0)
        Hand(ruler_of(stage)).drag((x, y), (place(stage, 2 * BAR)[0], y))
        QTest.keyClick(ruler_of(stage), Qt.Key.Key_Delete)
    assert stage.session.project is before
    assert set(said) == {"tempo.first_stays"}


def test_delete_removes_the_mark_that_was_clicked_and_nothing_else(stage: Stage) -> None:
    """Selected notes stay, although Delete removes them elsewhere."""
    ruler = with_metre(stage, 2)
    stage.session.select(Selection(frozenset({"1:0"})))
    Hand(ruler).click(on_mark(stage, "metre", 2 * BAR))
    ruler.setFocus()
    QTest.keyClick(ruler, Qt.Key.Key_Delete)
    assert metres(stage) == [(0, 4, 4)]
    assert stage.steps == ["edit.set_metre", "edit.remove_metre"]
    assert len(stage.session.project.score.parts[0].notes) == 8
    stage.session.document.undo()
    assert metres(stage) == [(0, 4, 4), (2 * BAR, 3, 4)]


def test_enter_and_a_double_click_edit_a_metre(stage: Stage) -> None:
    ruler = with_metre(stage, 2)
    Hand(ruler).double_click(on_mark(stage, "metre", 2 * BAR))
    type_into(stage, "5/8")
    assert metres(stage)[-1] == (2 * BAR, 5, 8)
    Hand(ruler).click(on_mark(stage, "metre", 2 * BAR))
    QTest.keyClick(ruler, Qt.Key.Key_Return)
    type_into(stage, "2/4")
    assert metres(stage)[-1] == (2 * BAR, 2, 4)


def slow_marks(score: Score, axis: TimeAxis, metrics: QFontMetricsF) -> list[tuple[str, int, str, float]]:
    """Kind, tick, text and left edge of a ruler's marks from 100 to 700 pixels, found by examining every one."""
    found = [(metre.tick, 0, "metre", f"{metre.numerator}/{metre.denominator}") for metre in score.metres]
    found += [(tick, 1, "tempo", f"♩={bpm:.4g}") for tick, bpm in score.tempo_map.bpm]
    laid = [(100.0 + axis.x_px(score.tempo_map.seconds(float(tick))), tick, kind, text)
            for tick, _, kind, text in sorted(found)]  # fmt: skip
    inside = [mark for mark in laid if 100.0 <= mark[0] <= 700.0]
    marks: list[tuple[str, int, str, float]] = []
    free_px = 100.0
    for kind in ("metre", "tempo"):
        for _, tick, _, text in [mark for mark in laid if mark[0] < 100.0 and mark[2] == kind][-1:]:
            width = metrics.horizontalAdvance(text) + 12.0
            if free_px + width <= (inside[0][0] if inside else 700.0):
                marks.append((kind, tick, text, free_px))
                free_px += width + 2.0
    for x, tick, kind, text in inside:
        if x >= free_px - 1 or (marks and marks[-1][1] == tick):
            marks.append((kind, tick, text, max(x, free_px)))
            free_px = max(x, free_px) + metrics.horizontalAdvance(text) + 14.0
    return marks


@pytest.mark.parametrize("seed", range(20))
def test_marks_stand_where_the_slow_way_puts_them(qt_app: QApplication, seed: int) -> None:
    made = random.Random(seed)
    ticks = sorted({0, *made.sample(range(1, 40 * BAR), 60)})
    metres = tuple(Metre(tick, made.randint(2, 7), 4) for tick in ticks if tick == 0 or made.random() < 0.5)
    changes = [TempoChange(tick, made.randint(300_000, 900_000)) for tick in ticks if tick == 0 or made.random() < 0.5]
    score = Score("", TPQ, TempoMap.of_changes(TPQ, changes), metres)
    axis, metrics = TimeAxis(), QFontMetricsF(QFont())
    axis.set_limits(-1.0, 100.0, (-1.0, 100.0))
    axis.set_width(600)
    axis.show(made.uniform(-1.0, 30.0), made.uniform(31.0, 90.0))
    marks = lay_marks(score, axis, metrics, 100.0, 700.0, 20.0)
    assert marks
    laid = [(mark.kind, mark.tick, mark.text, pytest.approx(mark.box.left)) for mark in marks]
    assert laid == slow_marks(score, axis, metrics)
