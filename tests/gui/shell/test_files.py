"""Autosaves of the editor without a window: location, reports and times."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.files import Files
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.errors import Message
from app.formats import atomic
from app.project import autosave as autosave_module
from app.project.autosave import Autosave, autosave_path
from app.project.edit.piece import new_piece, set_title
from app.project.model import Project
from app.project.recording import AudioTrack
from app.project.recovery import Recoverable, load_work, recoverable
from app.project.running_editors import Presence
from app.project.storage import encode_autosave, load, save
from tests.gui.shell.conftest import Answers
from tests.support.tasks import ImmediateTasks


class Desk:
    """File operations of an editor, a project with a file, and a clock."""

    def __init__(self, folder: Path, settings: Settings, now: Callable[[], float]) -> None:
        self.document = folder / "work" / "piece.suisou"
        self.recovery = folder / "recovery"
        self.session = Session(new_piece(), ImmediateTasks())
        self.answers = Answers()
        self.answers.path = self.document
        self.autosave = Autosave(Presence(self.recovery))
        self.files = Files(self.session, settings, self.answers, self.autosave)
        self.reported: list[Message] = []
        self.session.noticed.connect(lambda message, severity: self.reported.append(message))
        self._now = now

    def edit(self, title: str) -> None:
        self.session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, title))

    def crash(self) -> None:
        """End like a killed process: the system releases the lock, and no file is touched."""
        self.autosave.presence._stream.close()
        self.files._timer.stop()
        self.files.autosave = None

    def found(self) -> tuple[Recoverable, ...]:
        result: list[tuple[Recoverable, ...]] = []
        self.files.find_recoverable(result.append)
        return result[-1]


class Clock:
    """The clock of the autosaves."""

    def __init__(self) -> None:
        self.now_s = 1000.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    result = Clock()
    monkeypatch.setattr("app.editor.files.time.monotonic", result)
    return result


Sit = Callable[[], Desk]


@pytest.fixture
def sit(qapp: QApplication, tmp_path: Path, settings: Settings, clock: Clock) -> Iterator[Sit]:
    desks: list[Desk] = []

    def begin() -> Desk:
        desks.append(Desk(tmp_path, settings, clock))
        return desks[-1]

    yield begin
    for desk in desks:
        desk.files.end()
        desk.session.deleteLater()


@pytest.fixture
def desk(sit: Sit) -> Desk:
    result = sit()
    result.document.parent.mkdir()
    result.files.begin()
    result.files.save()
    return result


@pytest.fixture
def refusing(monkeypatch: pytest.MonkeyPatch) -> dict[Path, int]:
    """Make folders refuse writing, as for a user without permission."""
    result: dict[Path, int] = {}
    new_partial = atomic._new_partial

    def asked(folder: Path) -> tuple[Path, BinaryIO]:
        if folder in result:
            raise OSError(result[folder], os.strerror(result[folder]))
        return new_partial(folder)

    monkeypatch.setattr(atomic, "_new_partial", asked)
    return result


def pass_time(desk: Desk, clock: Clock) -> None:
    clock.now_s += 4.0
    desk.files.tick()


@pytest.mark.parametrize("gone", [False, True])
def test_work_that_its_folder_refuses_is_offered_again(
    desk: Desk, sit: Sit, clock: Clock, refusing: dict[Path, int], gone: bool
) -> None:
    if gone:
        shutil.rmtree(desk.document.parent)
    else:
        refusing[desk.document.parent] = errno.EROFS
    for number in range(5):
        desk.edit(f"Precious {number}")
        pass_time(desk, clock)
    # Reported only once.
    assert [message.id for message in desk.reported] == ["autosave.elsewhere"]
    assert desk.files.risk is None
    desk.crash()
    second = sit()
    found: list[Recoverable] = []
    second.files.found.connect(found.append)
    if gone:
        found.extend(second.found())
    else:
        second.files.open(desk.document)
    (item,) = found
    second.files.recover(item)
    assert second.session.project.score.title == "Precious 4"
    assert second.files.path == desk.document
    assert not second.files.is_saved


def test_autosaves_return_to_their_usual_place(desk: Desk, clock: Clock, refusing: dict[Path, int]) -> None:
    refusing[desk.document.parent] = errno.ENOSPC
    desk.edit("Precious")
    pass_time(desk, clock)
    assert not autosave_path(desk.document).exists()
    refusing.clear()
    desk.edit("More precious")
    pass_time(desk, clock)
    assert load(autosave_path(desk.document)).score.title == "More precious"
    assert not desk.autosave.presence.own_path.exists()
    desk.files.save()
    assert not autosave_path(desk.document).exists()


def test_the_risk_is_reported_once_and_over_when_a_place_takes_the_work(
    desk: Desk, clock: Clock, refusing: dict[Path, int]
) -> None:
    refusing |= {desk.document.parent: errno.EROFS, desk.recovery: errno.ENOSPC}
    for number in range(3):
        desk.edit(f"Precious {number}")
        pass_time(desk, clock)
    assert [message.id for message in desk.reported] == ["autosave.refused"]
    assert desk.files.risk == desk.reported[0]
    # A failed write is repeated without another edit.
    del refusing[desk.recovery]
    pass_time(desk, clock)
    assert desk.files.risk is None
    assert load(desk.autosave.presence.own_path).score.title == "Precious 2"


def test_saving_notices_what_others_wrote_whatever_the_clock_says(desk: Desk) -> None:
    overtaken: list[Path] = []
    desk.files.overtaken.connect(lambda path, then: overtaken.append(path))
    desk.edit("Mine")
    desk.files.save()
    stat = desk.document.stat()
    # Same size and same time stamp as before.
    save(set_title(desk.session.project, "Else"), desk.document)
    os.utime(desk.document, ns=(stat.st_atime_ns, stat.st_mtime_ns))
    assert desk.document.stat().st_size == stat.st_size
    desk.edit("Mine again")
    desk.files.save()
    assert overtaken == [desk.document]
    assert load(desk.document).score.title == "Else"
    # A file that was only touched leads to no question.
    desk.files.save_over()
    os.utime(desk.document, (1.0, 1.0))
    desk.edit("Once more")
    desk.files.save()
    assert load(desk.document).score.title == "Once more"


def test_what_is_undone_to_the_saved_state_is_no_unsaved_work(desk: Desk, clock: Clock) -> None:
    desk.edit("Never mind")
    pass_time(desk, clock)
    assert autosave_path(desk.document).exists()
    desk.session.document.undo()
    assert not autosave_path(desk.document).exists()
    pass_time(desk, clock)
    assert not autosave_path(desk.document).exists()


def test_a_crash_costs_five_seconds_of_work_at_most(desk: Desk, clock: Clock) -> None:
    """The timer fires a second earlier, and no drag delays it."""
    timer = desk.files._timer
    assert not timer.isActive()
    desk.edit("First")
    assert timer.interval() == 4000
    clock.now_s += 3.0
    desk.edit("Second")
    assert timer.interval() == 4000
    assert timer.isSingleShot()
    clock.now_s += 1.0
    desk.files.tick()
    assert load(autosave_path(desk.document)).score.title == "Second"
    assert not timer.isActive()


def test_autosaves_are_made_beside_the_window(
    desk: Desk, clock: Clock, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot
) -> None:
    threads: list[int] = []

    def noted(*arguments: Any) -> bytes:
        threads.append(threading.get_ident())
        return encode_autosave(*arguments)

    monkeypatch.setattr(autosave_module, "encode_autosave", noted)
    tasks = ThreadTasks()
    desk.session.tasks = tasks
    desk.edit("Precious")
    pass_time(desk, clock)
    qtbot.waitUntil(lambda: tasks.is_idle)
    assert autosave_path(desk.document).exists()
    assert threads
    assert threading.get_ident() not in threads


EDITING = """
import sys, time
from pathlib import Path
from PySide6.QtCore import QCoreApplication, QTimer
from app.errors import Message
from app.project.autosave import Autosave
from app.project.edit.piece import new_piece, set_title
from app.project.model import Project
from app.project.running_editors import Presence
from app.editor.files import Files
from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.editor.session import Session
folder = Path(sys.argv[1])
application = QCoreApplication(["suisou"])
session = Session(new_piece(), ThreadTasks())
files = Files(session, Settings(folder / "editor.ini"), None, Autosave(Presence(folder / "recovery"), 0.4))
files.begin()
begun_s = time.monotonic()
def edit():
    title = str(time.monotonic() - begun_s)
    session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, title))
    print(title, flush=True)
timer = QTimer(interval=10)
timer.timeout.connect(edit)
timer.start()
application.exec()
"""


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
def test_an_editor_that_is_killed_loses_no_more_than_the_delay(tmp_path: Path) -> None:
    """During continuous edits, with a delay of 0.4 s to shorten the test."""
    process = subprocess.Popen(
        [sys.executable, "-c", EDITING, str(tmp_path)],
        cwd=Path(__file__).parents[3],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    done_s = 0.0
    with process.stdout as stdout:
        for line in stdout:
            done_s = float(line)
            if done_s > 1.2:
                process.kill()
    process.wait()
    (item,) = recoverable(tmp_path / "recovery")
    project, _ = load_work(item)
    # A second for the machine, as the editor's own delay has.
    assert done_s - float(project.score.title) < 0.4 + 1.0


def broken(project: Project) -> Project:
    """A recording at a time that a file cannot contain, which no edit produces."""
    return replace(project, audio=AudioTrack("/music/a.wav", float("nan")))


def test_what_cannot_be_saved_is_named_and_the_rest_is_autosaved(
    desk: Desk, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[Message] = []
    desk.files.unsaveable.connect(said.append)
    desk.edit("One")
    with monkeypatch.context() as unchecked:
        unchecked.setattr("app.project.undoable_document.require_sound", lambda *projects: None)
        assert desk.session.attempt(Message("edit.set_audio"), broken)
    for title in ("Two", "Three"):
        desk.edit(title)
        clock.now_s += 5.0
        desk.files.tick()
        assert load(autosave_path(desk.document)).score.title == title
    # Once, and no more until something else is the matter.
    assert [message.id for message in said] == ["autosave.without"]
    assert said[0].arguments["place"] == "audio.offset_s"
    assert desk.files.risk is None
    desk.files.save()
    assert [message.id for message in said[1:]] == ["project.cannot_save"]
    assert desk.files.can_leave_out
    desk.files.leave_out()
    desk.files.save()
    assert desk.files.is_saved
    assert load(desk.document).score.title == "Three"


def test_an_edit_that_could_not_be_saved_is_refused_with_its_reason(desk: Desk) -> None:
    project = desk.session.project
    assert not desk.session.attempt(Message("edit.set_audio"), broken)
    assert desk.session.project is project
    assert desk.reported[-1].id == "project.not_storable"
