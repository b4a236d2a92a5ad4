"""What the status line tells while work is done costs no picture of its own."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QProgressBar
from pytestqt.qtbot import QtBot

from app.shell.app import Program


class Painted(QObject):
    """Counts how often a widget is painted."""

    count = 0

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - a name of Qt
        self.count += event.type() == QEvent.Type.Paint
        return False


def test_the_bar_of_motion_waits_for_the_next_picture(program: Program, qtbot: QtBot) -> None:
    status = program.window.status
    bar = status.findChild(QProgressBar, "motion_ready")
    assert bar is not None
    program.generator.close()
    status.set_ready(0.2)
    qtbot.waitUntil(bar.isVisible)
    qtbot.wait(50)
    painted = Painted()
    bar.installEventFilter(painted)
    status.set_ready(0.6)
    assert bar.value() == int(0.6 * bar.maximum())
    assert painted.count == 0, "the whole window would be put together for a bar"
    qtbot.waitUntil(lambda: painted.count == 1)
    status.set_ready(0.6)
    qtbot.wait(50)
    assert painted.count == 1, "nothing is new"
