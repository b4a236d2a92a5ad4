"""Panels that can be moved, floated, tabbed and closed."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDockWidget, QWidget

from app.editor.session import Session
from widgets.common.controls import IconButton, named, small
from widgets.common.layouts import in_row
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
        self._session, self._title, self._bar = session, Label(), named(QWidget(), "dock_title")
        self._bar.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        float_tip, close_tip = "dock.float_or_dock_this_panel", "dock.close_this_panel_view_panels"
        buttons = (
            small(IconButton(session, "float", float_tip, self._toggle_floating, "float_panel", dim=True)),
            small(IconButton(session, "close", close_tip, self.close, "close_panel", dim=True)),
        )
        in_row((self._title, 1), *buttons, of=self._bar, margins=(10, 1, 3, 1), spacing=1)
        self.setTitleBarWidget(self._bar)
        session.theme_changed.connect(self._apply_theme)
        self.windowTitleChanged.connect(self._title.setText)
        self._apply_theme()

    def _toggle_floating(self) -> None:
        self.setFloating(not self.isFloating())

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self._bar.setStyleSheet(
            f"#dock_title {{ background: {tokens.surface}; border-bottom: 1px solid {tokens.line}; }}"
        )
        self._title.setStyleSheet(f"color: {tokens.text_dim}; font-weight: 600;")
