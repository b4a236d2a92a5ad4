"""A question that can wait, over the panels: something was found, and there are two or three answers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QToolButton, QWidget

from widgets.common.icons import icon, pixmap
from widgets.common.session import Session
from widgets.common.tokens import LEAST_TARGET_PX

Texts = Callable[[], tuple[str, tuple[str, ...]]]
"""The question and the answers in the language of the editor."""


class Banner(QFrame):
    """One question at a time.

    Parameters
    ----------
    session : Session
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("banner")
        self._session = session
        self._texts: Texts | None = None
        self._buttons: list[QPushButton] = []
        self._line = QHBoxLayout(self)
        self._line.setContentsMargins(12, 5, 6, 5)
        self._mark, self._text = QLabel(), QLabel()
        self._text.setObjectName("banner_text")
        self._text.setWordWrap(True)
        self._close = QToolButton()
        self._close.setObjectName("banner_close")
        self._close.setFixedSize(LEAST_TARGET_PX, LEAST_TARGET_PX)
        self._close.clicked.connect(self.hide)
        self._line.addWidget(self._mark)
        self._line.addWidget(self._text, 1)
        self._line.addWidget(self._close)
        self.hide()
        session.theme_changed.connect(self.retranslate)

    def ask(self, texts: Texts, answers: tuple[Callable[[], None], ...]) -> None:
        """Ask; whatever is answered, the banner goes."""
        for button in self._buttons:
            self._line.removeWidget(button)
            button.hide()
            button.deleteLater()
        self._buttons = []
        self._texts = texts
        for place, answer in enumerate(answers):
            button = QPushButton()
            button.setObjectName(f"banner_answer_{place}")
            button.clicked.connect(partial(self._answered, answer))
            self._line.insertWidget(2 + place, button)
            self._buttons.append(button)
        self.retranslate()
        self.show()

    def _answered(self, answer: Callable[[], None]) -> None:
        self.hide()
        answer()

    def retranslate(self) -> None:
        """Set the texts and the colours."""
        tokens = self._session.tokens
        self.setStyleSheet(f"#banner {{ background: {tokens.raised}; border-bottom: 1px solid {tokens.warning}; }}")
        self._mark.setPixmap(pixmap("warning", 18, tokens.warning, self.devicePixelRatioF()))
        self._close.setIcon(icon("close", tokens))
        self._close.setToolTip(self.tr("Not now"))
        if self._texts is not None:
            text, answers = self._texts()
            self._text.setText(text)
            for button, answer in zip(self._buttons, answers, strict=True):
                button.setText(answer)
