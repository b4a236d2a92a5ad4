"""Handler of unexpected exceptions: it reports them, saves unsaved work, and keeps the editor running."""

from __future__ import annotations

import os
import platform
import sys
import threading
import time
import traceback
from collections.abc import Callable
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Final

import platformdirs

from app.editor.session import Session, Severity
from app.editor.window_thread_calls import window_calls
from app.errors import AppError, Message

MOST_BYTES: Final = 1_000_000
"""A log longer than this number of bytes is started anew."""
QUIET_S: Final = 1.0
"""Least time in seconds between two reports of errors in the same place, since a panel that cannot be drawn fails at
every refresh of the screen.
"""


def log_path() -> Path:
    """Return the path of the log of unexpected exceptions."""
    return platformdirs.user_log_path("suisou", appauthor=False) / "faults.log"


class CrashHandler:
    """Receives, logs and reports every uncaught exception.

    Parameters
    ----------
    session : Session
        Session that shows a message in the status line.
    write_down : callable
        Function that saves unsaved work to a recovery file.
    clock : callable
        Function that returns the time in seconds, by which repeated exceptions are recognised.
    """

    def __init__(
        self, session: Session, write_down: Callable[[], None], log: Path, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._session = session
        self._write_down = write_down
        self._log = log
        self._clock = clock
        self._telling = False
        self._last_s = dict[object, float]()
        """Time of the last error, by its place."""
        self._ask = window_calls().ask

    def install(self) -> None:
        """Receive every uncaught exception from now on. Must be called in the window's thread."""
        sys.excepthook = self._uncaught
        threading.excepthook = self._uncaught_in_thread

    def report(self, error: BaseException) -> None:
        """Log an exception, save unsaved work and report it; an exception that repeats is handled once."""
        if self._is_repeated(error):
            return
        if isinstance(error, AppError):
            self._session.notice(error.message, Severity.ERROR)
            return
        text = "".join(traceback.format_exception(error))
        sys.stderr.write(text)
        if self._telling:
            # Reporting failed; a second attempt would fail as well.
            return
        self._telling = True
        try:
            self._note(text)
            try:
                self._write_down()
            except Exception:  # noqa: BLE001 - whatever fails here, the first fault is still to be reported
                self._note(traceback.format_exc())
            detail = f"{type(error).__name__}: {error}"
            self._session.notice(Message("program.fault", {"detail": detail, "log": str(self._log)}), Severity.ERROR)
        finally:
            self._telling = False

    def _is_repeated(self, error: BaseException) -> bool:
        """Return whether the same kind of exception occurred in the same place a moment ago."""
        trace = error.__traceback__
        while trace is not None and trace.tb_next is not None:
            trace = trace.tb_next
        place = None if trace is None else (trace.tb_frame.f_code, trace.tb_lineno)
        key = (type(error), str(error) if place is None else place)
        now_s = self._clock()
        before_s = self._last_s.get(key)
        self._last_s[key] = now_s
        return before_s is not None and now_s - before_s < QUIET_S

    def _note(self, text: str) -> None:
        head = f"{datetime.now(UTC).isoformat(timespec='seconds')} Python {platform.python_version()} {sys.platform}"
        try:
            self._log.parent.mkdir(parents=True, exist_ok=True)
            if os.path.exists(self._log) and not os.path.isfile(self._log):
                raise OSError(f"{self._log} is no file")  # opening a pipe would wait for a reader
            is_long = os.path.exists(self._log) and self._log.stat().st_size > MOST_BYTES
            with self._log.open("w" if is_long else "a", encoding="utf-8", errors="backslashreplace") as stream:
                stream.write(f"{head}\n{text}\n")
        except OSError as error:
            sys.stderr.write(f"suisou: {self._log}: {error}\n")

    def _uncaught(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if issubclass(kind, KeyboardInterrupt):
            sys.__excepthook__(kind, error, trace)
            return
        self.report(error)

    def _uncaught_in_thread(self, arguments: threading.ExceptHookArgs) -> None:
        # Reported in the window's thread, to which widgets belong.
        if arguments.exc_value is not None:
            self._ask(partial(self.report, arguments.exc_value))
