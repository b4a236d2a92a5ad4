"""Event filter for Space on buttons that have the keyboard focus, and for Enter in text fields."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent
from PySide6.QtWidgets import QApplication, QWidget
from shiboken6 import isValid


class KeyboardButtons(QObject):
    """Event filter: Space starts playback, but presses a button that was reached with the keyboard.

    Enter plays a bar except in a text field. (For text fields Qt gives letters precedence over shortcuts, but not
    Enter.) A clicked button keeps the focus too; Space starts playback then. Only the widget with the focus is
    filtered: a filter of the whole application would call Python a hundred times in every frame.
    """

    def __init__(self, application: QApplication, parent: QObject) -> None:
        super().__init__(parent)
        self._watched: QWidget | None = None
        self._reason: Qt.FocusReason | None = None
        """Reason for which the watched widget loses the keyboard."""
        self._reached = False
        application.focusChanged.connect(self._focus_moved)

    def _focus_moved(self, before: QWidget | None, now: QWidget | None) -> None:
        self._reached = now is not None and self._reason in _BY_KEYS
        self._reason = None
        if self._watched is not None and isValid(self._watched):
            self._watched.removeEventFilter(self)
        # If no widget has the focus, keys go to the window.
        self._watched = now if now is not None else QApplication.activeWindow()
        if self._watched is not None:
            self._watched.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Install the filter on each widget that gets the focus, and handle Space and Enter in it."""
        kind = event.type()
        if kind == QEvent.Type.FocusOut and isinstance(event, QFocusEvent):
            self._reason = event.reason()
        elif kind == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            tab = event.key() in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab)
            self._reason = Qt.FocusReason.TabFocusReason if tab else None
        elif (
            kind == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and (
                (event.key() == Qt.Key.Key_Space and self._reached and _is_pressed_by_space(watched))
                or (event.key() in _ENTER and watched.inherits("QLineEdit"))
            )
        ):
            event.accept()
        return False


_ENTER = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
_BY_KEYS = (Qt.FocusReason.TabFocusReason, Qt.FocusReason.BacktabFocusReason)


def _is_pressed_by_space(watched: QObject) -> bool:
    return watched.inherits("QAbstractButton") or watched.inherits("QComboBox")
