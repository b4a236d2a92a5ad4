"""A recorder whose reports a test provides, and a clock that the test controls."""

from __future__ import annotations

import os
import time
from collections.abc import Callable

from app.capture.journal import JournalHeader, JournalWriter
from app.capture.link import RecorderLink
from app.capture.protocol import Events, Moved, News, Opened, Ports, RecordingFinished

EWI = "EWI5000 MIDI 1"


class Clock:
    """Clock that advances while the test waits."""

    def __init__(self) -> None:
        self.ns = 10**12

    def now_ns(self) -> int:
        return self.ns

    def now_s(self) -> float:
        return self.ns / 1e9


class RunningClock(Clock):
    """Clock of the machine."""

    def now_ns(self) -> int:
        return time.perf_counter_ns()


class SpokenFor(RecorderLink):
    """A link without a process: the test provides the recorder's reports; journals are real."""

    def __init__(self, on_news: Callable[[], None], clock: Clock) -> None:
        self.on_news, self.clock = on_news, clock
        self.reported: list[News] = [Ports((EWI,), (), "test")]
        self.requested: list[str | None] = []
        self.writer: JournalWriter | None = None
        self.elsewhere: object = None
        self.syncs: list[tuple[int, float, int]] = []
        self.closed = False

    def open(self, port: str | None) -> None:
        self.requested.append(port)
        if port == EWI:
            self.say(Opened(EWI, 0))

    def start(self, path: object, header: JournalHeader, elsewhere: object = None) -> None:
        self.writer, self.elsewhere = JournalWriter(str(path), header), elsewhere

    def move(self) -> None:
        """Fail as if the disk of the journal were full."""
        self.writer.write()
        self.writer.move(str(self.elsewhere))
        self.say(Moved(os.fsencode(str(self.elsewhere)), "No space left on device"))

    def sync(self, ns: int, position_s: float, pass_: int = 0) -> None:
        self.syncs.append((ns, position_s, pass_))
        if self.writer is not None:
            self.writer.sync(ns, position_s, pass_)

    def stop(self) -> None:
        writer, self.writer = self.writer, None
        if writer is not None:
            writer.mark("end", self.clock.now_ns())
            writer.close()
            self.say(RecordingFinished(os.fsencode(writer.path), writer.count))

    def play(self, message: bytes) -> None:
        self.play_at(self.clock.now_ns(), message)

    def play_at(self, ns: int, message: bytes) -> None:
        if self.writer is not None:
            self.writer.event(ns, message)
        self.say(Events((ns,), (message,)))

    def say(self, *reported: News) -> None:
        self.reported += reported
        self.on_news()

    def poll(self) -> list[News]:
        reported, self.reported = self.reported, []
        return reported

    def close(self) -> None:
        self.closed = True
