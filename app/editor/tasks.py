"""Slow work in the background: in threads, with progress, stopped on request, its errors reported.

A thread never lets go of anything last: what its work knew may be of the window, and an object of Qt that dies in a
thread not its own takes the program with it. The window's thread waits for the thread's end before it lets go.
"""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol, TypeVar

from PySide6.QtCore import QObject, Signal
from shiboken6 import isValid

from app.editor.window_thread_calls import Ask, window_calls
from app.errors import AppError, Cancelled, Message, Progress, StopRequested

T = TypeVar("T")


class Tasks(Protocol):
    """Runs work in the background; shows its name and progress in the status line, where it can be cancelled."""

    def run(
        self,
        name: Message,
        work: Callable[[Progress, StopRequested], T],
        done: Callable[[T], None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
        ended: Callable[[], None] | None = None,
        *,
        writes: bool = False,
    ) -> None:
        """Start work in a thread; ``done`` or ``failed`` follows in the window's thread.

        Parameters
        ----------
        name : Message
            What is being done.
        work : callable
            Gets progress and stop_requested; it takes snapshots of values and touches no widget.
        done : callable
            Gets the result. Not called after a cancel.
        failed : callable, optional
            Gets an error the user can act on; without it the session shows it.
        key : str, optional
            Work with a key takes the place of work with the same key, which is stopped.
        ended : callable, optional
            Called in the window's thread when the work is over, however it went and before anything else is reported.
        writes : bool
            True: it makes files that the user asked for, and the editor does not end meanwhile without a question.
        """
        ...

    @property
    def writing(self) -> tuple[Message, ...]:
        """Names of the work under way that makes files the user asked for, oldest first."""
        ...


@dataclass(eq=False)
class Task:
    """Work under way.

    Attributes
    ----------
    name : Message
        What is being done.
    share : float
        0..1 of it that is done, as the worker says.
    is_cancelled : bool
        The user does not want it any more; what is stopped by newer work of its key is not cancelled.
    writes : bool
        It makes files that the user asked for.
    """

    name: Message
    key: str | None
    work: Callable[[Progress, StopRequested], object]
    done: Callable[[Any], None]
    failed: Callable[[AppError], None] | None
    ended: Callable[[], None] | None
    runner: weakref.ref[ThreadTasks]
    writes: bool = False
    share: float = 0.0
    is_cancelled: bool = False
    stop: threading.Event = field(default_factory=threading.Event)
    thread: threading.Thread | None = None
    result: object = None
    error: BaseException | None = None


class ThreadTasks(QObject):
    """The editor's task runner.

    Signals
    -------
    changed()
        Work began or ended.
    failed(AppError)
        Work without a ``failed`` of its own met an error that the user can act on.
    cancelled(Message)
        Work of this name was cancelled by the user.
    unexpected(BaseException)
        Work met a fault of the program.
    """

    changed = Signal()
    failed = Signal(object)
    cancelled = Signal(object)
    unexpected = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._running: list[Task] = []
        self._ask = window_calls().ask

    @property
    def running(self) -> tuple[Task, ...]:
        """Work that was not stopped, oldest first."""
        return tuple(task for task in self._running if not task.stop.is_set())

    @property
    def writing(self) -> tuple[Message, ...]:
        """Names of the work under way that makes files: see `Tasks.writing`."""
        return tuple(task.name for task in self.running if task.writes)

    @property
    def is_idle(self) -> bool:
        """True if no thread works any more, stopped ones included."""
        return not self._running

    def run(
        self,
        name: Message,
        work: Callable[[Progress, StopRequested], T],
        done: Callable[[T], None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
        ended: Callable[[], None] | None = None,
        *,
        writes: bool = False,
    ) -> None:
        """Start work: see `Tasks.run`."""
        if key is not None:
            for other in self._running:
                if other.key == key:
                    other.stop.set()
        task = Task(name, key, work, done, failed, ended, weakref.ref(self), writes)
        thread = threading.Thread(target=_work, args=(task, self._ask), name=f"task {name.id}", daemon=True)
        task.thread = thread
        self._running.append(task)
        thread.start()
        self.changed.emit()

    def cancel(self, task: Task) -> None:
        """Ask work to stop; it is no longer shown, and its result is dropped."""
        task.is_cancelled = True
        task.stop.set()
        self.changed.emit()

    def cancel_all(self, wait_s: float = 0.0) -> None:
        """Ask everything to stop, and wait at most this long in all."""
        for task in self._running:
            task.stop.set()
        for task in self._running:
            if wait_s > 0.0 and task.thread is not None:
                task.thread.join(wait_s / max(len(self._running), 1))
        self.changed.emit()

    def _end(self, task: Task) -> None:
        if task in self._running:
            self._running.remove(task)
        try:
            if task.ended is not None and _is_there(task.ended):
                task.ended()
            self._report(task)
        finally:
            self.changed.emit()

    def _report(self, task: Task) -> None:
        error = task.error
        if task.is_cancelled or (isinstance(error, Cancelled) and not task.stop.is_set()):
            self.cancelled.emit(task.name)
        if task.stop.is_set() or isinstance(error, Cancelled):
            return
        if error is None:
            if _is_there(task.done):
                task.done(task.result)
        elif not isinstance(error, AppError):
            self.unexpected.emit(error)
        elif task.failed is None:
            self.failed.emit(error)
        elif _is_there(task.failed):
            task.failed(error)


def _work(task: Task, ask: Ask) -> None:
    """In the thread."""

    def progress(share: float) -> None:
        task.share = min(max(share, 0.0), 1.0)

    try:
        task.result = task.work(progress, task.stop.is_set)
    except BaseException as problem:  # noqa: BLE001 - reported in the window's thread
        task.error = problem
    finally:
        ask(partial(_take_back, task))


def _take_back(task: Task) -> None:
    """In the window's thread: the thread has nothing left to do but to end."""
    if task.thread is not None:
        task.thread.join()
    runner = task.runner()
    if runner is not None and isValid(runner):
        runner._end(task)


def _is_there(callback: Callable[..., None]) -> bool:
    """Return whether the receiver of a report is still open."""
    reported = getattr(callback, "__self__", None)
    return not isinstance(reported, QObject) or isValid(reported)
