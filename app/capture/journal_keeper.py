"""Thread of the recorder that writes the journal, and continues in another folder if the disk is full."""

from __future__ import annotations

import contextlib
import errno
import os
import time
from queue import Empty, SimpleQueue
from typing import Any, Final

from app.capture.journal import JournalWriter, is_whole
from app.capture.protocol import (
    EventsSaved,
    Leave,
    Moved,
    NewsQueue,
    NotStarted,
    RecordingFinished,
    RequestRefused,
    StartRecording,
    Stop,
    Sync,
)
from app.errors import FileError, Message

_TO_DISK_S: Final = 0.25
_NO_ROOM: Final = frozenset({errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)})
"""Error numbers of a full disk."""


class JournalKeeper:
    """Writes the items of a queue: commands `StartRecording`, `Sync`, `Stop` and `Leave`, received messages, marks;
    None ends journal and thread.
    """

    def __init__(self, queue: SimpleQueue[Any], news: NewsQueue) -> None:
        self._queue, self._news = queue, news
        self._writer: JournalWriter | None = None
        self._elsewhere = b""
        self._is_away = False
        self._failed = False
        self._to_disk_at_s = 0.0

    def run(self) -> None:
        """Write items until None or `Leave`."""
        while True:
            with contextlib.suppress(Empty):
                item = self._queue.get(timeout=None if self._writer is None else _TO_DISK_S)
                if not self._keep(item):
                    return
            self._write()

    def _keep(self, item: Any) -> bool:
        match item:
            case None:
                self._finish("end")
            case Leave():
                self._finish(None)
            case StartRecording():
                self._start(item)
            case Stop():
                self._finish("end")
            case Sync(ns=ns, position_s=position_s, pass_=pass_):
                if self._writer is not None:
                    self._writer.sync(ns, position_s, pass_)
            case (int(ns), bytes(message)):
                if self._writer is not None and is_whole(message):
                    self._writer.event(ns, message)
            case (str(word), int(ns)):
                self._mark(word, ns)
        return item is not None and not isinstance(item, Leave)

    def _mark(self, word: str, ns: int) -> None:
        if self._writer is not None and self._is_away != (word == "lost"):
            self._is_away = word == "lost"
            self._writer.mark(word, ns)

    def _start(self, start: StartRecording) -> None:
        self._finish("end")
        self._elsewhere = start.elsewhere
        try:
            self._writer = self._begun(start)
            self._is_away = False
            if start.resumed_ns is not None:
                self._mark("lost", start.resumed_ns)
            self._to_disk()
        except FileError as error:
            self._news.put(NotStarted(error.message))
        except OSError as error:
            self._report_failure(error)

    def _begun(self, start: StartRecording) -> JournalWriter:
        """Create the journal, in the second folder if the first disk is full."""
        try:
            return JournalWriter(os.fsdecode(start.path), start.header, resumed=start.resumed_ns is not None)
        except FileError as error:
            cause = error.__cause__
            if not (self._elsewhere and isinstance(cause, OSError) and cause.errno in _NO_ROOM):
                raise
            elsewhere, self._elsewhere = self._elsewhere, b""
            writer = JournalWriter(os.fsdecode(elsewhere), start.header)
            self._news.put(Moved(elsewhere, cause.strerror or str(cause)))
            return writer

    def _write(self) -> None:
        if self._writer is None:
            return
        try:
            self._writer.write()
            if time.perf_counter() >= self._to_disk_at_s:
                self._to_disk()
            self._failed = False
        except OSError as error:
            self._report_failure(error)

    def _to_disk(self) -> None:
        assert self._writer is not None
        if self._writer.to_disk():
            self._news.put(EventsSaved(self._writer.count))
        self._to_disk_at_s = time.perf_counter() + _TO_DISK_S

    def _finish(self, word: str | None) -> None:
        writer = self._writer
        if writer is None:
            return
        if word is not None:
            writer.mark(word, time.perf_counter_ns())
        try:
            writer.write()
        except OSError as error:
            self._move(error)
        try:
            writer.close()
        except OSError as error:
            self._refuse("capture.cut_short", writer, error)
        self._writer = None
        self._failed = False
        if word is not None:
            self._news.put(RecordingFinished(os.fsencode(writer.path), writer.count))

    def _report_failure(self, error: OSError) -> None:
        """Continue in the second folder; if that is impossible, report once that nothing can be written, and retry with
        the next items.
        """
        if self._move(error):
            return
        if not self._failed and self._writer is not None:
            self._failed = True
            self._refuse("capture.not_written", self._writer, error)

    def _move(self, error: OSError) -> bool:
        """Move the journal to the second folder, which is tried once, and return whether that succeeded."""
        elsewhere, self._elsewhere = self._elsewhere, b""
        if not elsewhere or self._writer is None:
            return False
        try:
            self._writer.move(os.fsdecode(elsewhere))
        except OSError as refusal:
            self._refuse("capture.elsewhere_refused", self._writer, refusal)
            return False
        self._news.put(Moved(elsewhere, error.strerror or str(error)))
        return True

    def _refuse(self, id: str, writer: JournalWriter, error: OSError) -> None:
        self._news.put(RequestRefused(Message(id, {"file": writer.path, "reason": error.strerror or str(error)})))
