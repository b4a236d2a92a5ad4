"""Calls from other threads on the window's thread.

A thread puts a call into a queue and wakes the window by writing a byte; it uses no Qt objects, which could be deleted
meanwhile or on the wrong thread.
"""

from __future__ import annotations

import contextlib
import socket
import threading
import weakref
from collections.abc import Callable
from queue import Empty, SimpleQueue
from typing import Final, Generic, TypeVar

from PySide6.QtCore import QCoreApplication, QObject, QSocketNotifier
from shiboken6 import isValid

T = TypeVar("T", bound=QObject)
Call = Callable[[], None]
Ask = Callable[[Call], None]
"""Function that queues a call for the window's thread, after earlier calls; may be used in any thread."""


class _Bell:
    """Wakes the window's event loop from any thread, as long as the window exists."""

    def __init__(self) -> None:
        self.near, self._far = socket.socketpair()
        self.near.setblocking(False)
        self._far.setblocking(False)
        self._lock = threading.Lock()

    def ring(self) -> None:
        with self._lock:
            # A full buffer wakes the receiver too, so the failed write is ignored.
            if self._far.fileno() >= 0:
                with contextlib.suppress(BlockingIOError):
                    self._far.send(b"\0")

    def close(self) -> None:
        with self._lock:
            self._far.close()
            self.near.close()


class Calls(QObject):
    """Runs calls on the window's thread, one in each turn of its event loop. Must be created on that thread."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        asked: SimpleQueue[Call] = SimpleQueue()
        bell = _Bell()

        def ask(call: Call) -> None:
            asked.put(call)
            bell.ring()

        self.ask: Final[Ask] = ask
        self._asked, self._bell = asked, bell
        self._notifier = QSocketNotifier(bell.near.fileno(), QSocketNotifier.Type.Read, self)
        self._notifier.activated.connect(self._make)
        weakref.finalize(self, bell.close)

    def _make(self) -> None:
        with contextlib.suppress(BlockingIOError):
            self._bell.near.recv(4096)
        try:
            call = self._asked.get_nowait()
        except Empty:
            return
        if not self._asked.empty():
            # Other calls get a turn of the event loop of their own: this one may fail, or open a dialog and wait.
            self._bell.ring()
        call()


_calls: Calls | None = None


def window_calls() -> Calls:
    """Return the program's only `Calls`, created on first use, which must be on the window's thread."""
    global _calls
    if _calls is None or not isValid(_calls):
        _calls = Calls(QCoreApplication.instance())
    return _calls


class Reporter(Generic[T]):
    """Passes reports of a thread to a listener on the window's thread, while the listener exists and waits for them."""

    def __init__(self, listener: T, is_awaited: Callable[[T], bool]) -> None:
        self._ask, self._listener, self._is_awaited = window_calls().ask, weakref.ref(listener), is_awaited

    def __call__(self, say: Callable[[T], None]) -> None:
        """Call ``say`` with the listener soon, on the window's thread."""
        listening, is_awaited = self._listener, self._is_awaited

        def call() -> None:
            listener = listening()
            if listener is not None and isValid(listener) and is_awaited(listener):
                say(listener)

        self._ask(call)
