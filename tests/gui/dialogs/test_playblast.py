"""The playblast dialog writes pictures in order, and a complete film or none."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QDoubleSpinBox, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.tasks import ThreadTasks
from app.errors import AppError, Message
from app.project.camera_bookmarks import View
from tests.gui.conftest import quartet_project
from tests.gui.timeline.hand import SHIFT, Hand
from tests.support.windows import child, pause
from widgets.dialogs.playblast import PlayblastDialog
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.ruler.time_ruler import MARKS_PX, Ruler
from widgets.timeline.zoom_and_scroll import TimeAxis


@pytest.fixture
def threaded(qt_app: object) -> Iterator[Session]:
    tasks = ThreadTasks()
    session = Session(quartet_project(), tasks)
    session.set_loop((2.0, 2.5))
    yield session
    tasks.cancel_all(5.0)
    session.deleteLater()


def film(session: Session, path: Path, times: list[float], fails_at_s: float = 1e9) -> PlayblastDialog:
    def shoot(
        width: int, height: int, span_s: tuple[float, float], view: View | None, marked: bool
    ) -> Callable[[float], np.ndarray]:
        assert not marked

        def draw(time_s: float) -> np.ndarray:
            assert span_s[0] <= time_s < span_s[1]
            if time_s > fails_at_s:
                raise AppError("picture.no_gl", reason="of the test")
            times.append(time_s)
            return np.zeros((height, width, 4), np.uint8)

        return draw

    def sound(start_s: float, end_s: float, rate: int) -> np.ndarray:
        return np.zeros((round((end_s - start_s) * rate), 2), np.float32)

    dialog = PlayblastDialog(session, shoot, sound, path)
    dialog.show()
    return dialog


def press(dialog: PlayblastDialog, name: str) -> None:
    QTest.mouseClick(dialog.findChild(QPushButton, name), Qt.MouseButton.LeftButton)


def test_the_loop_becomes_a_film(threaded: Session, qtbot: QtBot, tmp_path: Path) -> None:
    times: list[float] = []
    path = tmp_path / "film.mp4"
    dialog = film(threaded, path, times)
    with qtbot.waitSignal(dialog.filmed):
        press(dialog, "playblast_start")
    assert path.read_bytes()[4:8] == b"ftyp"
    assert len(times) in (15, 16)
    assert np.allclose(np.diff(times), 1 / 30)
    assert times[0] == pytest.approx(2.0, abs=1 / 30)
    state = child(dialog, QLabel, "playblast_state")
    assert "film.mp4" in state.text()


def test_cancelled_it_leaves_nothing(threaded: Session, qtbot: QtBot, tmp_path: Path) -> None:
    threaded.set_loop((2.0, 40.0))
    dialog = film(threaded, tmp_path / "film.mp4", [])
    press(dialog, "playblast_start")
    pause(50)
    # The window asks before it closes meanwhile.
    assert threaded.tasks.writing == (Message("work.playblast"),)
    press(dialog, "playblast_close")
    qtbot.waitUntil(child(dialog, QPushButton, "playblast_start").isEnabled)
    qtbot.waitUntil(lambda: list(tmp_path.iterdir()) == [])


def test_a_picture_that_cannot_be_drawn_ends_it_and_is_reported(
    threaded: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    dialog = film(threaded, tmp_path / "film.mp4", [], fails_at_s=2.2)
    press(dialog, "playblast_start")
    button, state = dialog.findChild(QPushButton, "playblast_start"), dialog.findChild(QLabel, "playblast_state")
    assert state is not None
    qtbot.waitUntil(button.isEnabled)
    assert "of the test" in state.text()
    assert list(tmp_path.iterdir()) == []


def test_the_range_made_last_is_offered_and_chosen(threaded: Session, tmp_path: Path) -> None:
    threaded.set_loop(None)
    dialog = film(threaded, tmp_path / "film.mp4", [])
    ranges = child(dialog, QComboBox, "playblast_range")
    assert ranges.currentText() == "Whole piece"
    QTest.keyClick(ranges, Qt.Key.Key_Down)
    assert ranges.currentText() == "Whole piece"
    # Shift and a drag on the ruler, beside the open dialog.
    axis = TimeAxis()
    axis.show(0.0, 20.0)
    ruler = Ruler(threaded, axis)
    ruler.resize(1200, ruler.height())
    ruler.show()
    clock, hand = threaded.project.score.tempo_map, Hand(ruler)
    places = [(GUTTER_PX + axis.x_px(time_s), MARKS_PX + 8.0) for time_s in (4.0, 9.0)]
    hand.drag(places[0], places[1], SHIFT)
    assert threaded.selection.span is not None
    assert ranges.currentText() == "Selection"
    start_s, end_s = (clock.seconds(float(tick)) for tick in threaded.selection.span)
    span = dialog._requested_span()
    assert (span.first_frame_s, span.end_s) == pytest.approx((start_s, end_s), abs=1 / 30)
    lead_in = child(dialog, QDoubleSpinBox, "playblast_lead_in")
    assert (lead_in.isVisible(), lead_in.value()) == (True, 0.0)
    lead_in.setValue(1.0)
    start_tick = threaded.selection.span[0]
    led_s = clock.seconds(float(start_tick - threaded.project.metre_map.felt_ticks_at(start_tick)))
    led = dialog._requested_span()
    assert led_s < start_s
    assert (led.first_frame_s, led.end_s) == pytest.approx((led_s, end_s), abs=1 / 30)
    lead_in.setValue(0.0)
    again = film(threaded, tmp_path / "film.mp4", [])
    assert child(again, QComboBox, "playblast_range").currentText() == "Selection"
    threaded.set_loop((2.0, 2.5))
    assert ranges.currentText() == "Loop"
    assert lead_in.isVisible()
    # A choice stays until another range is created.
    QTest.keyClick(ranges, Qt.Key.Key_Up)
    assert ranges.currentText() == "Whole piece"
    assert dialog._requested_span().count > 1000
    assert not lead_in.isVisible()
    hand.click(places[0])
    assert ranges.currentText() == "Whole piece"
    threaded.set_loop((2.0, 3.0))
    assert ranges.currentText() == "Loop"
    threaded.set_loop(None)
    assert ranges.currentText() == "Whole piece"
