"""Markers of the piece above the ruler."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import msgspec
import pytest
from PySide6.QtCore import QEvent, QPoint
from PySide6.QtGui import QHelpEvent
from PySide6.QtWidgets import QApplication, QToolTip

from app.errors import Message
from app.project.model import Project
from app.score.model import Marker
from tests.gui.timeline.conftest import TPQ, Stage
from tests.gui.timeline.hand import CTRL, Hand, Place
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.ruler.flags import MOST_FLAG_PX, Flag, Flags

LONG = "Fugue <b>subject</b> & answer, " + 20 * "poco a poco "


def put(stage: Stage, *markers: Marker) -> Flags:
    def edit(project: Project) -> Project:
        return replace(project, score=msgspec.structs.replace(project.score, markers=markers))

    assert stage.session.attempt(Message("edit.set_tempo"), edit)
    QApplication.processEvents()
    stage.panel.flags.repaint()
    return stage.panel.flags


def flag(stage: Stage, tick: int) -> Flag:
    stage.panel.flags.repaint()
    return next(flag for flag in stage.panel.flags._flags if flag.tick == tick)


def middle(flag: Flag) -> Place:
    return flag.rect.center().x(), flag.rect.center().y()


def test_a_piece_without_markers_has_no_row_for_them(stage: Stage) -> None:
    height = stage.panel.stack.height()
    assert not stage.panel.flags.isVisible()
    flags = put(stage, Marker(0, "A"))
    assert flags.isVisible()
    assert stage.panel.stack.height() == height - flags.height()
    stage.session.document.undo()
    QApplication.processEvents()
    assert not flags.isVisible()


def test_flags_stand_at_their_places_and_none_over_another(stage: Stage) -> None:
    flags = put(
        stage,
        Marker(0, "Intro"), Marker(TPQ, LONG), Marker(3 * TPQ, "B"), Marker(3 * TPQ, "速く"),
        Marker(4 * TPQ, "C"), Marker(4 * TPQ + 6, "D"), Marker(10 * TPQ, LONG),
    )  # fmt: skip
    laid = flags._flags
    assert [(flag.tick, flag.text) for flag in laid] == [
        (0, "Intro"), (TPQ, LONG), (3 * TPQ, "B, 速く"), (4 * TPQ, "C"), (4 * TPQ + 6, "D"), (10 * TPQ, LONG),
    ]  # fmt: skip
    for one in laid:
        x = GUTTER_PX + stage.panel.axis.x_px(stage.session.project.score.tempo_map.seconds(float(one.tick)))
        assert one.rect.left() == pytest.approx(x)
        assert one.rect.width() <= MOST_FLAG_PX
    for one, following in pairwise(laid):
        assert one.rect.right() < following.rect.left()
    assert laid[0].shown == "Intro"
    assert laid[1].shown.startswith("Fugue")
    assert laid[1].shown.endswith("…")
    # Without room for its text the flag is still drawn.
    assert laid[3].shown == ""


def test_the_marker_that_holds_at_the_left_edge_stays_in_view(stage: Stage) -> None:
    put(stage, Marker(0, "Intro"), Marker(TPQ, "A"), Marker(6 * TPQ, "B"))
    stage.panel.axis.show(1.5, 3.5)
    first = flag(stage, TPQ)
    assert first.rect.left() == GUTTER_PX
    assert [flag.text for flag in stage.panel.flags._flags] == ["A", "B"]


def test_a_click_on_a_flag_sets_the_playhead_there_and_beside_it_where_it_is(stage: Stage) -> None:
    flags = put(stage, Marker(0, "Intro"), Marker(4 * TPQ, "Andante"))
    steps = list(stage.steps)
    Hand(flags).click(middle(flag(stage, 4 * TPQ)))
    assert stage.session.playhead_s == 2.0
    Hand(flags).click((GUTTER_PX + stage.panel.axis.x_px(1.25), 10.0))
    assert stage.session.playhead_s == pytest.approx(1.25)
    Hand(flags).click((GUTTER_PX / 2, 10.0))
    assert stage.session.playhead_s == pytest.approx(1.25)
    assert stage.steps == steps


def test_the_wheel_zooms_and_pans_as_on_the_ruler(stage: Stage) -> None:
    flags = put(stage, Marker(0, "Intro"))
    axis = stage.panel.axis
    span = axis.span_s
    Hand(flags).wheel((400.0, 10.0), 1, CTRL)
    assert axis.span_s < span
    start = axis.start_s
    Hand(flags).wheel((400.0, 10.0), -1)
    assert axis.start_s > start


def test_a_tooltip_tells_all_of_a_text_and_takes_none_of_it_for_markup(stage: Stage) -> None:
    flags = put(stage, Marker(4 * TPQ, LONG))
    place = QPoint(*(int(value) for value in middle(flag(stage, 4 * TPQ))))
    QApplication.sendEvent(flags, QHelpEvent(QEvent.Type.ToolTip, place, flags.mapToGlobal(place)))
    assert QToolTip.text() == flags.tip(flag(stage, 4 * TPQ))
    assert "Fugue <b>subject</b> & answer" in QToolTip.text()
    assert "Bar 2" in QToolTip.text()
    QToolTip.hideText()


def test_flags_follow_the_tempo(stage: Stage) -> None:
    put(stage, Marker(4 * TPQ, "A"))
    before = flag(stage, 4 * TPQ).rect.left()
    stage.panel.ruler._type("tempo", 0, "60")
    assert flag(stage, 4 * TPQ).rect.left() > before
