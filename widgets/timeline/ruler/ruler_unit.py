"""The button at the left of the ruler: what it counts."""

from __future__ import annotations

from typing import get_args

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolButton, QWidget

from app.editor.session import Session, TimeDisplay
from widgets.common.icons import icon


class UnitButton(QToolButton):
    """Bars, seconds or frames."""

    def __init__(self, session: Session, parent: QWidget) -> None:
        super().__init__(parent)
        self._session = session
        self.setObjectName("time_display")
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.setAutoRaise(True)
        self._units: dict[TimeDisplay, QAction] = {}
        menu = QMenu(self)
        group = QActionGroup(menu)
        for display in get_args(TimeDisplay):
            action = menu.addAction("")
            action.setCheckable(True)
            action.setData(display)
            group.addAction(action)
            self._units[display] = action
        group.triggered.connect(lambda action: session.set_time_display(action.data()))
        self.setMenu(menu)
        session.time_display_changed.connect(self._show_unit)
        session.theme_changed.connect(self._show_icon)
        self.retranslate()
        self._show_icon()

    def retranslate(self) -> None:
        """Set every text anew."""
        texts: dict[TimeDisplay, str] = {
            "bars": self.tr("unit_button.bars"),
            "seconds": self.tr("unit_button.seconds"),
            "frames": self.tr("unit_button.frames"),
        }
        for display, action in self._units.items():
            action.setText(texts[display])
        self.setToolTip(self.tr("unit_button.what_ruler_counts"))
        self._show_unit()

    def _show_unit(self) -> None:
        action = self._units[self._session.time_display]
        action.setChecked(True)
        self.setText(action.text())

    def _show_icon(self) -> None:
        self.setIcon(icon("clock", self._session.tokens))
