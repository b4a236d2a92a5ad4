"""The button at the left of the ruler for its unit."""

from __future__ import annotations

from typing import Final, get_args

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolButton, QWidget

from app.editor.session import Session, TimeDisplay
from widgets.common.controls import Retranslated
from widgets.common.icons import icon

_UNITS: Final[dict[TimeDisplay, str]] = {unit: f"unit_button.{unit}" for unit in get_args(TimeDisplay)}


class UnitButton(Retranslated, QToolButton):
    """Button that chooses the unit of the ruler: bars, seconds or frames."""

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
            action = self.texted(menu.addAction(""), text=_UNITS[display])
            action.setCheckable(True)
            action.setData(display)
            group.addAction(action)
            self._units[display] = action
        group.triggered.connect(lambda action: session.set_time_display(action.data()))
        self.setMenu(menu)
        session.time_display_changed.connect(self._show_unit)
        session.theme_changed.connect(self._show_icon)
        self.texted(self, tip="unit_button.tip")
        self._show_unit()
        self._show_icon()

    def retranslate(self) -> None:
        self._show_unit()

    def _show_unit(self) -> None:
        action = self._units[self._session.time_display]
        action.setChecked(True)
        self.setText(action.text())

    def _show_icon(self) -> None:
        self.setIcon(icon("clock", self._session.tokens))
