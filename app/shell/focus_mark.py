"""The line above the panel with the keyboard focus, since shortcuts differ between panels."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget
from shiboken6 import isValid

from app.editor.session import Session

LINE_PX = 2


class FocusMark(QWidget):
    """A line in the accent colour along the top of one panel.

    Parameters
    ----------
    session : Session
        Session whose theme gives the accent colour.
    window : QWidget
        Window whose top edge has the line while no panel has the focus.
    panels : mapping of str to QWidget
        Panels by the context of their shortcuts (`ActionRow.context`).
    """

    def __init__(self, session: Session, window: QWidget, panels: Mapping[str, QWidget]) -> None:
        super().__init__(window)
        self.setObjectName("focus_mark")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._session, self._window, self._panels = session, window, panels
        self._marked: QWidget | None = None
        session.theme_changed.connect(self.update)
        self.hide()

    def mark(self, context: str) -> None:
        """Move the line to the panel of a shortcut context, if there is one."""
        if not (isValid(self) and isValid(self._window)):
            # The window closes and loses the keyboard focus.
            return
        panel = self._panels.get(context)
        if self._marked is not None and isValid(self._marked):
            self._marked.removeEventFilter(self)
        self._marked = panel
        self.setParent(panel if panel is not None else self._window)
        if panel is not None:
            panel.installEventFilter(self)
            self._place(panel)
        self.setVisible(panel is not None)

    def _place(self, panel: QWidget) -> None:
        self.setGeometry(0, 0, panel.width(), LINE_PX)
        self.raise_()

    # Qt overrides

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep the line as wide as the panel."""
        if event.type() == QEvent.Type.Resize and self._marked is not None:
            self._place(self._marked)
        return False

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the line in the accent colour that marks the panel with the keyboard focus."""
        QPainter(self).fillRect(self.rect(), QColor(self._session.tokens.accent))
