"""A line with the generated value, the user's value, and a button to revert."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QToolButton, QWidget

from app.editor.session import Session
from widgets.common.clicks import on_click
from widgets.common.controls import named, wrapped
from widgets.common.icons import icon
from widgets.common.layouts import in_row
from widgets.common.plain import Label


class ByHandLine(QWidget):
    """Line with the generated value, the user's value and a button that restores the generated one: ``generated 0 ·
    yours 2·3 ⟲``.

    It is hidden if the user changed nothing.

    Signals
    -------
    reverted()
        The user requests the generated value.
    """

    reverted = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._generated: str | None = None
        self._yours = ""
        self._text = wrapped(Label())
        self._button = named(QToolButton(), "revert")
        on_click(self._button, self.reverted.emit)
        in_row((self._text, 1), (self._button, 0, Qt.AlignmentFlag.AlignTop), of=self, margins=(10, 2, 0, 2), spacing=4)
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()
        self._retranslate()
        self.hide()

    def show_values(self, generated: str | None, yours: str) -> None:
        """Show both values. ``generated`` is None while it is computed, and empty if there is no generated value."""
        self._generated, self._yours = generated, yours
        self._retranslate()
        self.show()

    def text(self) -> str:
        """Return the displayed text."""
        return self._text.text()

    def _retranslate(self) -> None:
        if self._generated is None:
            text = self.tr("by_hand_line.yours").format(yours=self._yours)
        elif not self._generated:
            text = self.tr("by_hand_line.added")
        else:
            text = self.tr("by_hand_line.generated_yours").format(generated=self._generated, yours=self._yours)
        self._text.setText(text)
        self._button.setToolTip(self.tr("by_hand_line.revert_tip"))

    def _apply_theme(self) -> None:
        self._button.setIcon(icon("reset", self._session.tokens, self._session.tokens.by_hand))
        self.update()

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(0, 3, 3, self.height() - 6, QColor(self._session.tokens.by_hand))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self._retranslate()
        super().changeEvent(event)
