"""Background tasks on threads, with progress, cancellation and error reports.

A thread must not release the last reference to an object of the window, since deleting a Qt object on another thread
crashes the program. The window's thread therefore keeps the references until the thread has ended.
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
    """Interface for running work in the background, with name and progress in the status line, where the user can
    cancel it.
    """

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
        """Start work on a thread; ``done`` or ``failed`` is called on the window's thread.

        Parameters
        ----------
        name : Message
            Name of the work.
        work : callable
            Called with progress and stop_requested; it uses immutable snapshots and no widgets.
        done : callable
            Called with the result, unless cancelled.
        failed : callable, optional
            Called with an error for the user; by default the session shows it.
        key : str, optional
            New work replaces and stops running work with the same key.
        ended : callable, optional
            Called on the window's thread when the work has ended in any way, before other reports.
        writes : bool
            Whether it writes files requested by the user, so that quitting asks first.
        """
        ...

    @property
    def writing(self) -> tuple[Message, ...]:
        """Return the names of running tasks that write files the user requested, the oldest first."""
        ...


@dataclass(eq=False)
class Task:
    """Work that runs in the background.

    Attributes
    ----------
    name : Message
        Name of the work.
    share : float
        Share of the work done, 0..1.
    is_cancelled : bool
        Whether the user cancelled it; False if newer work with its key replaced it.
    writes : bool
        Whether it writes files requested by the user.
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
    """Runs the editor's background work, each on a thread of its own.

    Signals
    -------
    changed()
        Work began or ended.
    failed(AppError)
        Work that was started without ``failed`` raised an error for the user.
    cancelled(Message)
        Work of this name was cancelled by the user.
    unexpected(BaseException)
        Work raised an unexpected exception, a fault of the program.
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
        """Return the tasks that run and have not been asked to stop, the oldest first."""
        return tuple(task for task in self._running if not task.stop.is_set())

    @property
    def writing(self) -> tuple[Message, ...]:
        """Return the names of running tasks that write files the user requested, the oldest first."""
        return tuple(task.name for task in self.running if task.writes)

    @property
    def is_idle(self) -> bool:
        """Return whether no thread is running, including those of stopped tasks."""
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
        """Start ``work`` in a thread, and call ``done`` with its result in the main thread; running work with the same
        ``key`` is stopped (see `Tasks.run`)."""
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
        """Cancel a task: it is no longer shown, and its result is dropped."""
        task.is_cancelled = True
        task.stop.set()
        self.changed.emit()

    def cancel_all(self, wait_s: float = 0.0) -> None:
        """Stop all work, waiting at most this many seconds in total."""
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
    """Run a task on its thread, keep its result or error, and announce its end to the window's thread."""

    def progress(share: float) -> None:
        task.share = min(max(share, 0.0), 1.0)

    try:
        task.result = task.work(progress, task.stop.is_set)
    except BaseException as problem:  # noqa: BLE001 - reported in the window's thread
        task.error = problem
    finally:
        ask(partial(_take_back, task))


def _take_back(task: Task) -> None:
    """Report the end of a task on the window's thread, after the task's thread has finished."""
    if task.thread is not None:
        task.thread.join()
    runner = task.runner()
    if runner is not None and isValid(runner):
        runner._end(task)


def _is_there(callback: Callable[..., None]) -> bool:
    """Return whether the Qt object to which a callback belongs still exists; True for other callbacks."""
    reported = getattr(callback, "__self__", None)
    return not isinstance(reported, QObject) or isValid(reported)
