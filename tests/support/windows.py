"""Windows of tests, shown: a window is neither drawn nor in front before the display says so."""

from __future__ import annotations

from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

PATIENCE_MS = 10_000


def show(window: QWidget) -> None:
    """Show a window and wait until it can be seen."""
    window.show()
    assert QTest.qWaitForWindowExposed(window, PATIENCE_MS)


def show_in_front(window: QWidget) -> None:
    """Show a window and wait until it has the keyboard."""
    window.show()
    window.activateWindow()
    assert QTest.qWaitForWindowActive(window, PATIENCE_MS)
