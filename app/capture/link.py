"""The editor's side of the recorder: starts it, sends commands and collects its news. Independent of Qt."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Final, Self

import msgspec

from app.capture.journal import JournalHeader
from app.capture.protocol import (
    Back,
    Command,
    Leave,
    Lost,
    Moved,
    News,
    NotStarted,
    Open,
    Opened,
    Opening,
    RecordingFinished,
    RequestRefused,
    Restarted,
    StartRecording,
    Stop,
    Sync,
    SystemEnded,
)
from app.capture.recorder import SYSTEM_VARIABLE
from app.child import StartedChild, own_process
from app.errors import Message

_MOST_DEATHS: Final = 3
_DEATHS_WITHIN_S: Final = 10.0
_END_WITHIN_S: Final = 5.0
_OPEN_AGAIN_S: Final = 5.0
"""Seconds before a port whose opening ended the recorder is tried again."""


class RecorderLink:
    """Controls a recorder in a process of its own, which is restarted if it dies; a running journal is continued.

    Parameters
    ----------
    on_news : callable
        Called in a thread of this object when news are ready for `poll`, once until the next `poll`.
    system : str
        The only MIDI system to try, named as in `app.capture.midi_library`; empty for any.
    """

    def __init__(self, on_news: Callable[[], None] = lambda: None, *, system: str = "") -> None:
        self._on_news = on_news
        self._system = system
        self._news: deque[News] = deque()
        self._is_called = False
        self._lock = threading.Lock()
        self._child: StartedChild[News] | None = None
        self._is_leaving = False
        self._is_closed = False
        self._open: Open | None = None
        self._opening = ""
        self._refused = ""
        self._take: StartRecording | None = None
        self._is_begun = False
        self._is_stopping = False
        self._unsent: list[Sync] = []
        self._failure: Message | None = None
        self._deaths_s: list[float] = []
        self._ending: threading.Timer | None = None
        self._thread = threading.Thread(target=self._run, name="recorder link", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def port(self) -> str | None:
        """Name of the port that is or will be listened to."""
        return self._open.port if self._open is not None else None

    def open(self, port: str | None) -> None:
        """Listen to a port, now and whenever it reconnects. News: `Opened`, `RequestRefused`, `Lost`, `Back`."""
        with self._lock:
            if port == self.port:
                return
            before, self._open = self._open, None if port is None else Open(port)
            self._refused = ""
            if before is None and self._open is not None:
                self._report(self._open)
            elif self._report(Leave()):
                # The next recorder process opens the port: a port in use is closed only when its process ends.
                self._is_leaving = True
                self._end_surely()

    def start(
        self, path: str | os.PathLike[str], header: JournalHeader, elsewhere: str | os.PathLike[str] | None = None
    ) -> None:
        """Begin a journal in a new file, ending a running one first. News: `Written` or `NotStarted`.

        Parameters
        ----------
        elsewhere : path, optional
            Folder for continuing the journal if its disk is full. News: `Moved`.
        """
        with self._lock:
            if self._failure is not None:
                self._put(NotStarted(self._failure))
                return
            second = b"" if elsewhere is None else os.fsencode(Path(elsewhere).absolute())
            self._take = StartRecording(os.fsencode(Path(path).absolute()), header, elsewhere=second)
            self._is_stopping = False
            self._unsent.clear()
            self._is_begun = self._report(self._take)

    def sync(self, ns: int, position_s: float, pass_: int = 0) -> None:
        """Report the position of the piece that sounds at a moment of `time.perf_counter_ns`.

        When a loop returns, report its end in the old pass and its start in the new one for the same moment.
        """
        with self._lock:
            point = Sync(ns, position_s, pass_)
            if self._take is not None and not self._report(point):
                self._unsent.append(point)

    def stop(self) -> None:
        """Finish the journal. News: `RecordingFinished` when it is complete."""
        with self._lock:
            if self._take is not None:
                self._is_stopping = True
                self._report(Stop())

    def poll(self) -> list[News]:
        """Return the recorder's news since the last call, in order."""
        self._is_called = False
        found = []
        with contextlib.suppress(IndexError):
            while True:
                found.append(self._news.popleft())
        return found

    def close(self) -> None:
        """End the recorder after it has finished its journal."""
        with self._lock:
            self._is_closed = True
            if self._child is not None:
                self._child.hang_up()
                self._end_surely()
        self._thread.join()

    def _end_surely(self) -> None:
        """Kill a recorder that was told to end but is blocked by a MIDI driver. The lock must be held."""
        assert self._child is not None
        self._ending = threading.Timer(_END_WITHIN_S, self._child.process.kill)
        self._ending.daemon = True
        self._ending.start()

    def _report(self, command: Command) -> bool:
        """Send a command to the recorder, and return whether that succeeded; unsent commands that matter are sent to
        the next recorder. The lock must be held.
        """
        if self._child is None or self._is_leaving:
            return False
        try:
            self._child.send(command)
        except (OSError, ValueError):
            return False
        return True

    def _run(self) -> None:
        resumed_ns: int | None = None
        while True:
            try:
                child = self._started(resumed_ns)
            except OSError as error:
                self._fail(error.strerror or str(error))
                return
            if child is None:
                return
            self._read(child)
            resumed_ns = time.perf_counter_ns()
            with self._lock:
                planned = self._is_leaving or self._is_closed
                self._is_leaving = False
                self._child = None
                refused, self._opening = self._opening, ""
            status = child.ended(_END_WITHIN_S)
            if self._ending is not None:
                self._ending.cancel()
            if planned:
                continue
            if refused:
                self._refuse(refused)
            elif not self._may_restart():
                self._fail(f"status {status}")
                return
            else:
                self._put(Restarted(Message("capture.recorder_ended")))

    def _started(self, resumed_ns: int | None) -> StartedChild[News] | None:
        """Start a new recorder that continues the work of the last one, and return it; None after the link
        was closed.
        """
        with self._lock:
            if self._is_closed:
                return None
            self._child = _started(self._system)
            if self._take is not None:
                # The journal must not exist yet if no recorder has begun it.
                began_ns = resumed_ns if self._is_begun else None
                self._is_begun = (
                    self._report(msgspec.structs.replace(self._take, resumed_ns=began_ns)) or self._is_begun
                )
            if self._open is not None:
                self._report(self._open)
            for point in self._unsent:
                self._report(point)
            self._unsent.clear()
            if self._is_stopping:
                self._report(Stop())
            return self._child

    def _fail(self, detail: str) -> None:
        with self._lock:
            self._failure = Message("capture.recorder_fails", {"detail": detail})
            self._take = None
        self._put(RequestRefused(self._failure))

    def _refuse(self, port: str) -> None:
        """Report once that opening a port made the recorder's process end; the next recorder does not open this port
        for a while.
        """
        with self._lock:
            if port != self.port or self._open is None:
                return
            self._open = Open(port, self._open.is_lost, _OPEN_AGAIN_S)
            was_said, self._refused = self._refused == port, port
        if not was_said:
            self._put(RequestRefused(Message("capture.port_taken", {"port": port})))

    def _may_restart(self) -> bool:
        now_s = time.monotonic()
        self._deaths_s = [at_s for at_s in self._deaths_s if now_s - at_s < _DEATHS_WITHIN_S] + [now_s]
        return len(self._deaths_s) <= _MOST_DEATHS

    def _read(self, child: StartedChild[News]) -> None:
        with contextlib.suppress(OSError, msgspec.MsgspecError):
            while True:
                reported = child.receive()
                if isinstance(reported, SystemEnded):
                    with self._lock:
                        self._is_leaving = True
                    continue
                if isinstance(reported, Opening):
                    self._opening = reported.port
                    continue
                if isinstance(reported, Opened | Back) or _is_refusal(reported):
                    self._opening = ""
                if isinstance(reported, Moved):
                    self._take_moved(reported)
                elif isinstance(reported, RecordingFinished | NotStarted):
                    self._take_ended(reported)
                elif isinstance(reported, Lost | Opened | Back):
                    self._port_changed(reported)
                self._put(reported)

    def _port_changed(self, reported: Lost | Opened | Back) -> None:
        with self._lock:
            # Another port may have been chosen since.
            if reported.port == self.port:
                self._open = Open(reported.port, is_lost=isinstance(reported, Lost))
                self._refused = ""

    def _take_moved(self, reported: Moved) -> None:
        with self._lock:
            if self._take is not None and self._take.elsewhere == reported.path:
                self._take = msgspec.structs.replace(self._take, path=reported.path, elsewhere=b"")

    def _take_ended(self, reported: RecordingFinished | NotStarted) -> None:
        with self._lock:
            # Starting a journal while another one is written ends the other.
            if self._take is not None and (isinstance(reported, NotStarted) or reported.path == self._take.path):
                self._take = None
                self._is_stopping = False

    def _put(self, reported: News) -> None:
        self._news.append(reported)
        if not self._is_called:
            self._is_called = True
            self._on_news()


def _started(system: str) -> StartedChild[News]:
    options = own_process("app.capture.recorder")
    if system:
        options["env"][SYSTEM_VARIABLE] = system
    if sys.platform == "win32":
        # For other systems see `app.capture.recorder.take_precedence`.
        options["creationflags"] |= subprocess.HIGH_PRIORITY_CLASS
    return StartedChild(News, "app.capture.recorder", **options)


def _is_refusal(reported: News) -> bool:
    return isinstance(reported, RequestRefused) and reported.reason.id == "capture.port_refused"
