"""Texts of the status line: they cause no repaint of the players, and are not listed twice in a row."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QFrame, QLabel, QProgressBar, QPushButton, QToolButton
from pytestqt.qtbot import QtBot

from app.editor.session import Severity
from app.editor.tasks import ThreadTasks
from app.errors import Message, Progress, StopRequested
from app.shell.app import Program
from app.shell.status import StatusLine
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Start
from tests.support.windows import child
from widgets.common.text import sentence


class Painted(QObject):
    """Counts how often a widget is painted."""

    count = 0

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - a name of Qt
        self.count += event.type() == QEvent.Type.Paint
        return False


def test_the_bar_of_motion_waits_for_the_next_picture(program: Program, qtbot: QtBot) -> None:
    status = program.window.status
    bar = child(status, QProgressBar, "motion_ready")
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


def test_what_is_said_again_and_again_is_listed_once(program: Program) -> None:
    status, session = program.window.status, program.session
    for _ in range(5):
        session.notice(Message("tempo.first_stays"), Severity.WARNING)
    session.notice(Message("problems.none"))
    session.notice(Message("tempo.first_stays"), Severity.WARNING)
    QTest.mouseClick(child(status, QPushButton, "notice"), Qt.MouseButton.LeftButton)
    listed = child(program.window, QFrame, "notices")
    reported = [label.text() for label in listed.findChildren(QLabel) if label.text()]
    again, said = sentence(Message("tempo.first_stays")), sentence(Message("problems.none"))
    assert [text for text in reported if text in (again, said)] == [again, said, again]
    listed.hide()


def test_the_list_of_notices_stays_while_it_is_read(program: Program) -> None:
    status = program.window.status
    program.session.notice(Message("problems.none"))
    notice, listed = status.findChild(QPushButton, "notice"), program.window.findChild(QFrame, "notices")
    assert notice is not None
    assert listed is not None
    QTest.mouseClick(notice, Qt.MouseButton.LeftButton)
    status._fade.timeout.emit()
    assert listed.isVisible()
    assert status.notice_text
    listed.hide()
    status._fade.timeout.emit()
    assert not status.notice_text


def test_a_path_in_a_notice_can_be_copied_and_its_folder_shown(
    program: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[Path] = []
    monkeypatch.setattr("app.shell.notices.show_folder", shown.append)
    file = tmp_path / "film.mp4"
    file.touch()
    status, session = program.window.status, program.session
    session.notice(Message("problems.none"))
    session.notice(Message("export.done", {"count": 3, "folder": str(tmp_path)}))
    session.notice(Message("video.done", {"file": str(file)}))
    session.notice(Message("video.done", {"file": "/nowhere/film.mp4"}))
    listed = child(program.window, QFrame, "notices")
    notice = child(status, QPushButton, "notice")
    for number in range(2):
        QTest.mouseClick(notice, Qt.MouseButton.LeftButton)
        buttons = [button for button in listed.findChildren(QToolButton, "folder") if button.isVisible()]
        assert [button.toolTip() for button in buttons] == ["Show in Folder"] * 2
        QTest.mouseClick(buttons[number], Qt.MouseButton.LeftButton)
        assert not listed.isVisible()
    assert shown == [tmp_path, tmp_path]
    QTest.mouseClick(notice, Qt.MouseButton.LeftButton)
    (text,) = (label for label in listed.findChildren(QLabel) if label.isVisible() and str(file) in label.text())
    QTest.mouseDClick(text, Qt.MouseButton.LeftButton)
    assert text.hasSelectedText()
    listed.hide()


def test_a_notice_about_a_piece_goes_when_another_is_opened(start: Start) -> None:
    program = start()
    status, files = program.window.status, program.editor.files
    program.session.notice(Message("tempo.first_stays"), Severity.WARNING)
    files.open(QUARTET, ask=False)
    assert status.notice_text, "of the program, before there was a piece"
    files.open(QUARTET, ask=False)
    assert not status.notice_text


def test_much_work_at_once_leaves_room_for_its_names(program: Program, qtbot: QtBot) -> None:
    tasks, go_on = ThreadTasks(), threading.Event()
    line = StatusLine(program.session, program.editor.files, tasks, program.window)

    def work(progress: Progress, stop_requested: StopRequested) -> None:
        go_on.wait(60.0)

    def reported() -> list[str]:
        rows = [button.parentWidget() for button in line.findChildren(QAbstractButton, "stop_task")]
        return [label.text() for row in rows for label in row.findChildren(QLabel)]

    try:
        for number in range(6):
            tasks.run(Message("work.metadata"), work, lambda nothing: None, key=f"kind {number}")
        for name in ("work.instruments", "work.save", "work.portraits"):
            tasks.run(Message(name), work, lambda nothing: None)
        qtbot.waitUntil(lambda: len(reported()) >= 3)
        assert reported() == ["Reading your styles and expressions…", "Reading your instruments…", "Saving…"]
    finally:
        go_on.set()
        qtbot.waitUntil(lambda: tasks.is_idle)
    qtbot.waitUntil(lambda: not reported())


@pytest.mark.parametrize("said", [Message("capture.port_taken", {"port": "Aerophone"}), Message("capture.no_system")])
@pytest.mark.parametrize(
    ("change", "goes"),
    [
        ({"port": "", "connection": "none"}, True),
        ({"connection": "open"}, True),
        ({"connection": "lost"}, False),
    ],
)
def test_a_warning_about_a_device_goes_with_the_choice_of_it(
    program: Program, change: dict[str, str], goes: bool, said: Message
) -> None:
    status, session = program.window.status, program.session
    session.recording.set(port="Aerophone", connection="refused")
    session.notice(said, Severity.ERROR)
    assert status.notice_text
    session.recording.set(**change)
    assert (status.notice_text == "") is goes


def test_that_none_is_chosen_goes_with_the_first_choice_of_a_device(program: Program) -> None:
    status, session = program.window.status, program.session
    session.notice(Message("record.no_device"), Severity.WARNING)
    session.recording.set(ports=("Aerophone",))
    assert status.notice_text
    session.recording.set(port="Aerophone", connection="open")
    assert not status.notice_text


def test_a_warning_about_a_device_goes_with_the_choice_of_another_one(program: Program) -> None:
    status, session = program.window.status, program.session
    session.recording.set(port="Aerophone", connection="refused")
    session.notice(Message("capture.port_taken", {"port": "Aerophone"}), Severity.ERROR)
    session.recording.set(port="EWI USB", connection="refused")
    assert not status.notice_text
    # A problem of all devices names no single device.
    session.notice(Message("capture.no_system"), Severity.ERROR)
    session.recording.set(port="Aerophone", connection="refused")
    assert status.notice_text
