"""Panels that can be moved, floated, tabbed and closed."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QDockWidget, QHBoxLayout, QToolButton, QWidget

from app.editor.session import Session
from app.editor.tokens import LEAST_TARGET_PX
from widgets.common.icons import icon
from widgets.common.plain import Label


class Dock(QDockWidget):
    """A panel with a quiet title bar.

    Parameters
    ----------
    name : str
        Names the panel in the layout that is remembered.
    panel : QWidget
    session : Session
    """

    def __init__(self, name: str, panel: QWidget, session: Session, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName(f"dock_{name}")
        self.setWidget(panel)
        self._session = session
        self._bar = QWidget()
        self._bar.setObjectName("dock_title")
        self._bar.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        line = QHBoxLayout(self._bar)
        line.setContentsMargins(10, 1, 3, 1)
        line.setSpacing(1)
        self._title = Label()
        self._float, self._close = QToolButton(), QToolButton()
        self._float.setObjectName("float_panel")
        self._close.setObjectName("close_panel")
        for button in (self._float, self._close):
            button.setFixedSize(LEAST_TARGET_PX, LEAST_TARGET_PX)
        self._float.clicked.connect(self._toggle_floating)
        self._close.clicked.connect(self.close)
        line.addWidget(self._title, 1)
        line.addWidget(self._float)
        line.addWidget(self._close)
        self.setTitleBarWidget(self._bar)
        session.theme_changed.connect(self._apply_theme)
        self.windowTitleChanged.connect(self._title.setText)
        self._apply_theme()
        self.retranslate()

    def _toggle_floating(self) -> None:
        self.setFloating(not self.isFloating())

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self._float.setIcon(icon("float", tokens, tokens.text_dim))
        self._close.setIcon(icon("close", tokens, tokens.text_dim))
        self._bar.setStyleSheet(
            f"#dock_title {{ background: {tokens.surface}; border-bottom: 1px solid {tokens.line}; }}"
        )
        self._title.setStyleSheet(f"color: {tokens.text_dim}; font-weight: 600;")

    def retranslate(self) -> None:
        """Set the tool tips."""
        self._float.setToolTip(self.tr("dock.float_or_dock_this_panel"))
        self._close.setToolTip(self.tr("dock.close_this_panel_view_panels"))

    def changeEvent(self, event: QEvent) -> None:
        """Another language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)
