"""A non-modal question shown above the panels, with two or three answers."""

from __future__ import annotations

import re
from collections.abc import Callable

from PySide6.QtCore import QSize
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QFrame, QPushButton

from app.editor.session import Session
from widgets.common.clicks import on_click
from widgets.common.controls import IconButton, Retranslated, named, selectable, small, wrapped
from widgets.common.icons import pixmap
from widgets.common.layouts import STRETCH, in_row
from widgets.common.plain import Label

NARROW_PX = 560
"""Width in pixels below which the answers of a banner are below the question."""
LEAST_PX = 240
_BREAKS = re.compile(r"([_./-])")

Texts = Callable[[], tuple[str, tuple[str, ...]]]
"""Function that returns the question and the answers in the editor's language."""


class Banner(Retranslated, QFrame):
    """Bar above the panels of the window that asks one question at a time."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.setObjectName("banner")
        self._session = session
        self._texts: Texts | None = None
        self._buttons: list[QPushButton] = []
        self._line = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._line.setContentsMargins(12, 5, 6, 5)
        self._mark, self._text = Label(), selectable(wrapped(named(Label(), "banner_text")))
        close = small(IconButton(session, "close", "banner.not_now", self.hide, "banner_close"))
        self._answers = in_row(STRETCH, close)
        self._line.addLayout(in_row(self._mark, (self._text, 1)), 1)
        self._line.addLayout(self._answers)
        self.hide()
        session.theme_changed.connect(self.retranslate)

    def ask(self, texts: Texts, answers: tuple[Callable[[], None], ...]) -> None:
        """Show a question; any answer closes the banner and calls the function in ``answers`` that belongs to it."""
        for button in self._buttons:
            self._answers.removeWidget(button)
            button.hide()
            button.deleteLater()
        self._buttons = []
        self._texts = texts
        for place, answer in enumerate(answers):
            button = named(QPushButton(), f"banner_answer_{place}")
            on_click(button, self._answered, answer)
            self._answers.insertWidget(1 + place, button)
            self._buttons.append(button)
        self.retranslate()
        self.show()

    def _answered(self, answer: Callable[[], None]) -> None:
        self.hide()
        answer()

    def retranslate(self) -> None:
        """Set texts and colours again after a change of language or theme."""
        tokens = self._session.tokens
        self.setStyleSheet(f"#banner {{ background: {tokens.raised}; border-bottom: 1px solid {tokens.warning}; }}")
        self._mark.setPixmap(pixmap("warning", 18, tokens.warning, self.devicePixelRatioF()))
        if self._texts is not None:
            text, answers = self._texts()
            # File names may be broken after separators.
            self._text.setText(_BREAKS.sub("\\1\u200b", text))
            for button, answer in zip(self._buttons, answers, strict=True):
                button.setText(answer)

    # Qt overrides

    def minimumSizeHint(self) -> QSize:
        """Return a narrow minimum size, so that neighbouring panels keep their width."""
        return QSize(LEAST_PX, super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Place the answers next to the question, or below it if the banner is narrow."""
        super().resizeEvent(event)
        narrow = self.width() < NARROW_PX
        self._line.setDirection(QBoxLayout.Direction.TopToBottom if narrow else QBoxLayout.Direction.LeftToRight)
