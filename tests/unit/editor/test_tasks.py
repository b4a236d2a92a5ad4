"""Background tasks in threads: results, errors, cancelling, keys."""

from __future__ import annotations

import gc
import threading

import pytest
from PySide6.QtCore import QObject, QThread
from pytestqt.qtbot import QtBot
from shiboken6 import delete

from app.editor.tasks import ThreadTasks
from app.errors import AppError, Cancelled, Message

NAME = Message("work.open")


@pytest.fixture
def tasks(qtbot: QtBot) -> ThreadTasks:
    return ThreadTasks()


def test_work_is_done_elsewhere_and_reported_here(tasks: ThreadTasks, qtbot: QtBot) -> None:
    threads: list[object] = []
    here = threading.get_ident()

    def work(progress: object, stop_requested: object) -> int:
        threads.append(threading.get_ident())
        return 7

    def done(result: int) -> None:
        threads.extend((threading.get_ident(), result))

    tasks.run(NAME, work, done)
    assert len(tasks.running) == 1
    qtbot.waitUntil(lambda: not tasks.running)
    assert threads[0] != here
    assert threads[1:] == [here, 7]


def test_work_that_makes_files_is_named_while_it_does(tasks: ThreadTasks, qtbot: QtBot) -> None:
    go_on = threading.Event()

    def work(progress: object, stop_requested: object) -> None:
        go_on.wait(5)

    writing = Message("work.export")
    tasks.run(NAME, work, lambda nothing: None)
    assert tasks.writing == ()
    tasks.run(writing, work, lambda nothing: None, writes=True)
    assert tasks.writing == (writing,)
    tasks.cancel(tasks.running[-1])
    assert tasks.writing == ()
    go_on.set()
    qtbot.waitUntil(lambda: tasks.is_idle)


def test_progress_is_kept_within_its_bounds(tasks: ThreadTasks, qtbot: QtBot) -> None:
    reported, go_on = threading.Event(), threading.Event()

    def work(progress, stop_requested) -> None:  # type: ignore[no-untyped-def]
        progress(0.5)
        reported.set()
        go_on.wait(5)
        progress(7.0)

    tasks.run(NAME, work, lambda nothing: None)
    assert reported.wait(5)
    task = tasks.running[0]
    assert task.share == 0.5
    go_on.set()
    qtbot.waitUntil(lambda: not tasks.running)
    assert task.share == 1.0


def test_a_cancelled_work_is_asked_to_stop_and_its_result_dropped(tasks: ThreadTasks, qtbot: QtBot) -> None:
    results: list[object] = []
    ended = threading.Event()

    def work(progress, stop_requested) -> str:  # type: ignore[no-untyped-def]
        while not stop_requested():
            QThread.msleep(1)
        ended.set()
        return "late"

    tasks.run(NAME, work, results.append, results.append)
    tasks.cancel(tasks.running[0])
    assert tasks.running == ()
    assert ended.wait(5)
    qtbot.wait(30)
    assert results == []


def test_the_same_key_takes_the_place(tasks: ThreadTasks, qtbot: QtBot) -> None:
    results: list[object] = []

    def slow(progress, stop_requested) -> str:  # type: ignore[no-untyped-def]
        while not stop_requested():
            QThread.msleep(1)
        return "slow"

    tasks.run(NAME, slow, results.append, key="plan")
    tasks.run(NAME, lambda progress, stop_requested: "fast", results.append, key="plan")
    qtbot.waitUntil(lambda: results == ["fast"])
    qtbot.wait(30)
    assert results == ["fast"]


def test_errors_go_where_they_belong(tasks: ThreadTasks, qtbot: QtBot) -> None:
    own: list[AppError] = []
    reported: list[AppError] = []
    faults: list[BaseException] = []
    tasks.failed.connect(reported.append)
    tasks.unexpected.connect(faults.append)

    def raising(error: BaseException):  # type: ignore[no-untyped-def]
        def work(progress: object, stop_requested: object) -> None:
            raise error

        return work

    def done(nothing: object) -> None:
        pytest.fail("there is no result")

    tasks.run(NAME, raising(AppError("midi.empty", file="a")), done, own.append)
    tasks.run(NAME, raising(AppError("midi.empty", file="b")), done)
    tasks.run(NAME, raising(Cancelled("work.stopped")), done, own.append)
    tasks.run(NAME, raising(KeyError(5)), done, own.append)
    qtbot.waitUntil(lambda: not tasks.running)
    assert [error.message.arguments["file"] for error in own] == ["a"]
    assert [error.message.arguments["file"] for error in reported] == ["b"]
    assert [type(error) for error in faults] == [KeyError]


def test_ending_waits_for_the_workers(tasks: ThreadTasks, qtbot: QtBot) -> None:
    def work(progress, stop_requested) -> None:  # type: ignore[no-untyped-def]
        while not stop_requested():
            QThread.msleep(1)

    tasks.run(NAME, work, lambda nothing: None)
    thread = tasks.running[0].thread
    assert thread is not None
    tasks.cancel_all(2.0)
    assert not thread.is_alive()


def test_what_the_work_knew_dies_in_the_window_s_thread_alone(qtbot: QtBot) -> None:
    """Objects held by a task are freed in the window's thread, regardless of who drops the task and how late the thread
    ends.
    """
    died: list[int] = []

    class SettingBinding:
        def __del__(self) -> None:
            died.append(threading.get_ident())

    def begin(end: threading.Event, outcome: Exception | None) -> None:
        held, tasks = SettingBinding(), ThreadTasks()
        tasks.destroyed.connect(lambda: died.append(threading.get_ident()))

        def work(progress: object, stop_requested: object) -> SettingBinding:
            end.wait(5)
            if outcome is not None:
                raise outcome
            return held

        tasks.run(NAME, work, lambda result, held=held: None)

    ends = [threading.Event() for _ in range(20)]
    for number, end in enumerate(ends):
        begin(end, (None, KeyError(number), Cancelled("work.stopped"))[number % 3])
    for end in ends:
        end.set()

    def all_died() -> bool:
        gc.collect()
        return len(died) == 2 * len(ends)

    qtbot.waitUntil(all_died)
    assert set(died) == {threading.get_ident()}


def test_a_closed_owner_gets_no_reports(tasks: ThreadTasks, qtbot: QtBot) -> None:
    faults: list[BaseException] = []
    tasks.unexpected.connect(faults.append)

    class Panel(QObject):
        def take(self, result: object) -> None:
            faults.append(AssertionError("reported"))

        def ended(self) -> None:
            faults.append(AssertionError("reported"))

    panel, end = Panel(), threading.Event()
    tasks.run(NAME, lambda progress, stop_requested: end.wait(5), panel.take, ended=panel.ended)
    delete(panel)
    end.set()
    qtbot.waitUntil(lambda: not tasks.running)
    assert faults == []


@pytest.mark.parametrize("outcome", [None, AppError("midi.empty", file="a"), Cancelled("work.stopped"), KeyError(1)])
def test_the_end_is_reported_first_whatever_it_was(
    tasks: ThreadTasks, qtbot: QtBot, outcome: BaseException | None
) -> None:
    reported: list[str] = []
    tasks.unexpected.connect(lambda fault: reported.append("fault"))

    def work(progress: object, stop_requested: object) -> None:
        if outcome is not None:
            raise outcome

    tasks.run(
        NAME,
        work,
        lambda nothing: reported.append("done"),
        lambda error: reported.append("failed"),
        None,
        lambda: reported.append("ended"),
    )
    qtbot.waitUntil(lambda: not tasks.running)
    expected = {type(None): ["done"], AppError: ["failed"], Cancelled: [], KeyError: ["fault"]}[type(outcome)]
    assert reported == ["ended", *expected]
