"""The playblast dialog: pictures come in order, the film is whole or not there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.editor.tasks import ThreadTasks
from app.errors import AppError
from app.project.cameras import View
from tests.gui.conftest import quartet_project
from tests.support.windows import child, pause
from widgets.dialogs.playblast import PlayblastDialog


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
    QTest.keyClick(child(dialog, QComboBox, "playblast_range"), Qt.Key.Key_Down)
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
