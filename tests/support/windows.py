"""Display of windows in tests; the display draws and activates windows with a delay."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

from PySide6.QtCore import QEventLoop, QObject, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from widgets.viewport.canvas import Canvas

PATIENCE_MS = 180_000
W = TypeVar("W", bound=QObject)
LOOK_AGAIN_MS = 10
"""Milliseconds between two checks of a condition; more frequent ones take too much of the processor."""


def child(parent: QObject, kind: type[W], *name: str) -> W:
    """Child of a type, and of an object name if given, which must exist."""
    found = parent.findChild(kind, *name)
    assert found is not None, (kind, *name)
    return found


def show(window: QWidget) -> None:
    """Show a window and wait until it is visible."""
    window.show()
    assert QTest.qWaitForWindowExposed(window, PATIENCE_MS)


def show_in_front(window: QWidget) -> None:
    """Show a window and wait until it has the keyboard focus."""
    window.show()
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, PATIENCE_MS)


def pause(milliseconds: int) -> None:
    """Process events for some time, sleeping while there are none; `QTest.qWait` would keep the processor busy because
    of vispy.
    """
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def wait_until(condition: Callable[[], bool]) -> bool:
    """Process events until a condition holds or the time is over; return whether it holds."""
    end_s = time.monotonic() + PATIENCE_MS / 1000
    while not (holds := condition()) and time.monotonic() < end_s:
        pause(LOOK_AGAIN_MS)
    return holds


def draw_coarsely(canvas: Canvas, event: object) -> None:
    """Replacement for `Canvas.on_draw` with a quarter of the pixels, for tests that do not examine the players."""
    canvas._draw(*(int(size_px) // 2 for size_px in canvas.physical_size))
