"""Slow work beside the window: in threads, with progress, stopped on request, its errors told."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from PySide6.QtCore import QObject, Qt, Signal

from app.errors import AppError, Cancelled, Message
from widgets.common.tasks import Progress, StopWanted

T = TypeVar("T")


@dataclass(eq=False)
class Task:
    """Work under way.

    Attributes
    ----------
    name : Message
        What is being done.
    share : float
        0..1 of it that is done, as the worker says.
    """

    name: Message
    key: str | None
    done: Callable[[Any], None]
    failed: Callable[[AppError], None] | None
    share: float = 0.0
    stop: threading.Event = field(default_factory=threading.Event)
    thread: threading.Thread | None = None


class ThreadTasks(QObject):
    """The editor's task runner; implements `widgets.common.tasks.Tasks`.

    Signals
    -------
    changed()
        Work began or ended.
    failed(AppError)
        Work without a ``failed`` of its own met an error that a person can act on.
    unexpected(BaseException)
        Work met a fault of the program.
    """

    changed = Signal()
    failed = Signal(object)
    unexpected = Signal(object)
    _ended = Signal(object, object, object)

    def __init__(self) -> None:
        super().__init__()
        self._running: list[Task] = []
        self._ended.connect(self._end, Qt.ConnectionType.QueuedConnection)

    @property
    def running(self) -> tuple[Task, ...]:
        """Work that nobody stopped, oldest first."""
        return tuple(task for task in self._running if not task.stop.is_set())

    def run(
        self,
        name: Message,
        work: Callable[[Progress, StopWanted], T],
        done: Callable[[T], None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
    ) -> None:
        """Start work: see `Tasks.run`."""
        if key is not None:
            for other in self._running:
                if other.key == key:
                    other.stop.set()
        task = Task(name, key, done, failed)
        thread = threading.Thread(target=self._work, args=(task, work), name=f"task {name.id}", daemon=True)
        task.thread = thread
        self._running.append(task)
        thread.start()
        self.changed.emit()

    def cancel(self, task: Task) -> None:
        """Ask work to stop; it is no longer shown, and its result is dropped."""
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

    def _work(self, task: Task, work: Callable[[Progress, StopWanted], object]) -> None:
        """In the thread."""

        def progress(share: float) -> None:
            task.share = min(max(share, 0.0), 1.0)

        result: object = None
        error: BaseException | None = None
        try:
            result = work(progress, task.stop.is_set)
        except BaseException as problem:  # noqa: BLE001 - told in the window's thread
            error = problem
        try:
            self._ended.emit(task, result, error)
        except RuntimeError:
            # The window has gone meanwhile: nobody is left to tell.
            return

    def _end(self, task: Task, result: object, error: BaseException | None) -> None:
        """In the window's thread."""
        if task in self._running:
            self._running.remove(task)
        try:
            if task.stop.is_set() or isinstance(error, Cancelled):
                return
            if error is None:
                task.done(result)
            elif not isinstance(error, AppError):
                self.unexpected.emit(error)
            elif task.failed is not None:
                task.failed(error)
            else:
                self.failed.emit(error)
        finally:
            self.changed.emit()
