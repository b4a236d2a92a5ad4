"""A menu of choices that opens at the mouse pointer."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QMainWindow, QMenu

from widgets.common.controls import named


def choice_menu() -> QMenu:
    """Return a menu of the editor's window that is deleted when it closes."""
    windows = (window for window in QApplication.topLevelWidgets() if isinstance(window, QMainWindow))
    # Not a child of the command palette, which is about to close.
    menu = named(QMenu(next(windows, QApplication.activeWindow())), "choice")
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return menu
