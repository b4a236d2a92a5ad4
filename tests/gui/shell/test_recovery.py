"""Unsaved work is autosaved, offered after a crash, and restored or discarded; errors are reported."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from app.editor.session import Severity
from app.errors import Message
from app.project.autosave import DELAY_S
from app.project.edit.piece import set_title
from app.project.recovery import Recoverable
from app.project.running_editors import Presence
from app.project.storage import load, save
from app.shell.app import Program
from app.shell.crash_handler import CrashHandler
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers, Start, trigger
from tests.support.windows import child


def edit(program: Program, title: str) -> None:
    program.session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, title))


def crash(program: Program) -> None:
    """End like a killed process: no file is touched, and the system releases the lock."""
    autosave = program.editor.files.autosave
    autosave.presence._stream.close()
    program.editor.files._timer.stop()
    program.editor.files.autosave = None
    program.window.hide()


def offered(program: Program) -> tuple[Recoverable, ...]:
    """Unsaved work left by closed or crashed editors."""
    found: list[tuple[Recoverable, ...]] = []
    program.editor.files.find_recoverable(found.append)
    return found[-1]


def later(program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    """Advance the clock until unsaved work is autosaved."""
    import time

    now = time.monotonic()
    with monkeypatch.context() as patch:
        patch.setattr("app.editor.files.time.monotonic", lambda: now + DELAY_S + 1.0)
        program.editor.files.tick()


def click(program: Program, name: str, qtbot: QtBot) -> None:
    qtbot.mouseClick(child(program.window, QPushButton, name), Qt.MouseButton.LeftButton)


def test_a_piece_that_was_never_saved_is_offered_on_the_start_page(
    start: Start, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    edit(first, "Precious")
    later(first, monkeypatch)
    assert "autosaved" in first.window.status._saved.text()
    crash(first)
    second = start()
    click(second, "recover", qtbot)
    assert second.session.project.score.title == "Precious"
    assert second.window.isWindowModified()
    assert second.editor.files.path is None


def test_unsaved_work_on_a_file_is_offered_when_it_is_opened(
    start: Start, answers: Answers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    path = answers.path = tmp_path / "piece.suisou"
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    trigger(first, "file.save")
    edit(first, "Precious")
    later(first, monkeypatch)
    crash(first)
    second = start()
    second.editor.files.open(path)
    assert second.session.project.score.title != "Precious"
    assert second.window.banner.isVisible()
    click(second, "banner_answer_0", qtbot)
    assert second.session.project.score.title == "Precious"
    assert second.editor.files.path == path
    assert second.window.isWindowModified()


@pytest.mark.parametrize("same", [True, False])
def test_work_that_was_never_saved_is_offered_over_the_piece_that_the_editor_starts_with(
    same: bool, start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False, at_start=True)
    assert not first.window.banner.isVisible()
    edit(first, "Precious")
    later(first, monkeypatch)
    crash(first)
    other = tmp_path / "other.mid"
    shutil.copyfile(QUARTET, other)
    second = start()
    # Later it is offered over its own piece; over any other the start page has offered it already.
    second.editor.files.open(other, ask=False)
    assert not second.window.banner.isVisible()
    second.editor.files.open(QUARTET if same else other, ask=False, at_start=not same)
    banner = second.window.banner
    assert banner.isVisible()
    assert "Unsaved changes found: Precious" in banner._text.text()
    second.editor.speak("ja")
    QApplication.processEvents()
    assert "未保存の変更が見つかりました: Precious" in banner._text.text()
    click(second, "banner_answer_0", qtbot)
    assert second.session.project.score.title == "Precious"
    assert second.editor.files.path is None
    assert second.window.isWindowModified()
    assert not banner.isVisible()


def test_work_that_was_never_saved_is_offered_over_a_project_that_the_editor_starts_with(
    start: Start, answers: Answers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    path = answers.path = tmp_path / "piece.suisou"
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    trigger(first, "file.save")
    first.editor.files.open(QUARTET, ask=False)
    edit(first, "Precious")
    later(first, monkeypatch)
    crash(first)
    second = start()
    second.editor.files.open(path, at_start=True)
    click(second, "banner_answer_1", qtbot)
    assert offered(second) == ()
    assert second.editor.files.path == path


def test_work_that_is_thrown_away_is_not_offered_again(
    start: Start, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    edit(first, "Worthless")
    later(first, monkeypatch)
    crash(first)
    second = start()
    click(second, "discard", qtbot)
    assert offered(second) == ()
    qtbot.waitUntil(lambda: second.window.findChild(QPushButton, "recover") is None)


def test_an_orderly_end_leaves_nothing_to_recover(
    start: Start, monkeypatch: pytest.MonkeyPatch, answers: Answers
) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    edit(first, "Given up")
    later(first, monkeypatch)
    answers.answer = "discard"
    trigger(first, "file.close")
    first.window.close()
    assert offered(start()) == ()


def test_work_that_was_to_be_discarded_is_kept_until_another_file_is_open(
    start: Start, monkeypatch: pytest.MonkeyPatch, answers: Answers, tmp_path: Path
) -> None:
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    edit(first, "Still here")
    later(first, monkeypatch)
    (tmp_path / "broken.mid").write_bytes(b"no music")
    answers.answer = "discard"
    first.editor.files.open(tmp_path / "broken.mid", ask=False)
    crash(first)
    assert len(offered(start())) == 1


@pytest.mark.at_fault
def test_a_fault_is_reported_noted_down_and_the_work_written(
    program: Program, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    log = tmp_path / "log" / "faults.log"
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    faults = CrashHandler(program.session, program.editor.files.write_now, log)
    edit(program, "Precious")
    try:
        raise KeyError("a bug")
    except KeyError as error:
        faults.report(error)
    assert "KeyError: 'a bug'" in log.read_text(encoding="utf-8")
    assert "KeyError" in program.window.status.notice_text
    assert str(log) in program.window.status.notice_text
    autosave = program.editor.files.autosave
    assert Path(autosave.presence.note.autosave).is_file()
    capsys.readouterr()


@pytest.mark.at_fault
def test_a_fault_of_saving_does_not_hide_the_first(
    program: Program, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> None:
        raise OSError("the disk is full")

    faults = CrashHandler(program.session, fail, tmp_path / "faults.log")
    faults.report(KeyError("first"))
    text = (tmp_path / "faults.log").read_text(encoding="utf-8")
    assert "first" in text
    assert "the disk is full" in text
    assert "first" in program.window.status.notice_text
    capsys.readouterr()


def test_notices_unfold_and_go(program: Program, qtbot: QtBot) -> None:
    status = program.window.status
    program.session.notice(Message("midi.empty", {"file": "/a/very/long/path.mid"}), Severity.ERROR)
    assert status.notice_text == "/a/very/long/path.mid is empty; choose another file"
    click(program, "notice", qtbot)
    details = status._details
    qtbot.waitUntil(details.isVisible)
    details.hide()
    status.dismiss()
    assert status.notice_text == ""


def test_what_the_window_says_of_work_that_no_place_takes(
    start: Start, answers: Answers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    answers.path = document = tmp_path / "work" / "piece.suisou"
    document.parent.mkdir()
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    trigger(first, "file.save")
    button = child(first.window.status, QPushButton, "unsaved_at_risk")
    assert button.isHidden()
    shutil.rmtree(document.parent)
    edit(first, "Precious")
    with monkeypatch.context() as patch:
        patch.setattr(Presence, "own_path", tmp_path / "nowhere" / "x.suisou")
        later(first, monkeypatch)
        assert button.isVisible()
        for code, words in (("ja", "フォルダー"), ("en", "in another folder now")):
            first.editor.speak(code)
            QApplication.processEvents()
            assert words in button.toolTip()
        answers.path = tmp_path / "elsewhere.suisou"
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert load(answers.path).score.title == "Precious"
    assert button.isHidden()


def test_work_on_a_file_that_has_changed_since_does_not_replace_it_unasked(
    start: Start, answers: Answers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    answers.path = document = tmp_path / "piece.suisou"
    first = start()
    first.editor.files.open(QUARTET, ask=False)
    trigger(first, "file.save")
    edit(first, "Precious")
    later(first, monkeypatch)
    crash(first)
    save(set_title(load(document), "Of another user"), document)
    os.utime(document, (1.0, 1.0))
    second = start()
    assert any("file has changed since" in label.text() for label in second.window.start_page.findChildren(QLabel))
    second.editor.files.open(document)
    banner = second.window.banner
    assert "file has changed since" in banner._text.text()
    banner._buttons[0].click()
    trigger(second, "file.save")
    assert load(document).score.title == "Of another user"
    banner._buttons[1].click()
    assert load(document).score.title == "Precious"
