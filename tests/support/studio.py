"""The editor with a wind controller whose messages a test provides."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.shell.app import Program
from tests.support.recorder import Clock, SpokenFor


class Studio:
    """A program whose clock advances while the test waits."""

    def __init__(self, program: Program, folder: Path, clock: Clock) -> None:
        self.program, self.folder, self.clock = program, folder, clock
        self.session = program.session
        self.links: list[SpokenFor] = []

    @property
    def link(self) -> SpokenFor:
        return self.links[-1]

    def wait(self, until: Callable[[], bool], most_s: float = 60.0) -> None:
        end = time.monotonic() + most_s
        while not until():
            assert time.monotonic() < end
            QApplication.processEvents()
            time.sleep(0.001)
            self.clock.ns += 10_000_000

    def press(self, key: Qt.Key) -> None:
        window = self.program.window
        window.activateWindow()
        assert QTest.qWaitForWindowActive(window, 10_000)
        QTest.keyClick(window.palette_field, key, Qt.KeyboardModifier.ControlModifier)

    def blow(self, pitch: int, at_s: float, length_s: float = 0.1) -> None:
        """Play a note when the performance reaches it."""
        playback = self.session.playback
        assert playback is not None
        # Not the playhead, which is updated when the machine has time: after a loop it may be out of date.
        self.wait(lambda: playback.position_s() >= at_s)
        self.link.play(bytes((0xB0, 2, 100)))
        self.link.play(bytes((0x90, pitch, 90)))
        # The playhead moves in steps: one that has passed the end at once would give a note without length.
        end_ns = self.clock.ns + round(length_s * 1e9)
        self.wait(lambda: self.clock.ns >= end_ns)
        self.link.play(bytes((0x80, pitch, 0)))
        self.link.play(bytes((0xB0, 2, 0)))
