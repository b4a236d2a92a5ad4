"""Windows of tests, shown: a window is neither drawn nor in front before the display says so."""

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
"""Between two looks whether something has come to be: more often takes much of the processor that it needs itself."""


def child(parent: QObject, kind: type[W], *name: str) -> W:
    """The part of this kind, and of this object name if one is given, which must be there."""
    found = parent.findChild(kind, *name)
    assert found is not None, (kind, *name)
    return found


def show(window: QWidget) -> None:
    """Show a window and wait until it can be seen."""
    window.show()
    assert QTest.qWaitForWindowExposed(window, PATIENCE_MS)


def show_in_front(window: QWidget) -> None:
    """Show a window and wait until it has the keyboard."""
    window.show()
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, PATIENCE_MS)


def pause(milliseconds: int) -> None:
    """Let the application work for some time; it sleeps where there is nothing to do, while vispy makes `QTest.qWait` a
    loop that never does."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def wait_until(condition: Callable[[], bool]) -> bool:
    """Let the application work until a condition holds; whether it came to hold."""
    end_s = time.monotonic() + PATIENCE_MS / 1000
    while not (holds := condition()) and time.monotonic() < end_s:
        pause(LOOK_AGAIN_MS)
    return holds


def draw_coarsely(canvas: Canvas, event: object) -> None:
    """In place of `Canvas.on_draw`, where no one looks at the players: a quarter of the pixels."""
    canvas._draw(*(int(size_px) // 2 for size_px in canvas.physical_size))
