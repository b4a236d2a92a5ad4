"""A combo box that can represent several objects with different values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon, QStandardItemModel, QWheelEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from widgets.common.numbers import MIXED
from widgets.common.plain import ComboBox


@dataclass(frozen=True)
class Option:
    """An option: id, text and optional icon, and the reason why it cannot be chosen (empty if it can)."""

    id: str
    text: str
    icon: QIcon | None = None
    reason: str = ""


class Combo(ComboBox):
    """Combo box of options by id. Shows a dash for different values; the mouse wheel works only with keyboard focus.

    Signals
    -------
    chosen(str)
        The user chose the option of this id.
    """

    chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._options: tuple[Option, ...] = ()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        # As wide as the available room, not as the longest name.
        self.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(6)
        self.setMinimumHeight(LEAST_TARGET_PX + 1)
        self.setPlaceholderText(MIXED)
        self.activated.connect(self._activated)

    def set_options(self, options: Sequence[Option]) -> None:
        """Set the options; the current one stays if it is among them."""
        if tuple(options) == self._options:
            return
        shown = self.shown
        self._options = tuple(options)
        self.blockSignals(True)
        self.clear()
        for option in self._options:
            if option.icon is not None:
                self.addItem(option.icon, option.text, option.id)
            else:
                self.addItem(option.text, option.id)
            if option.reason:
                self._bar(self.count() - 1, option.reason)
        self.blockSignals(False)
        self.show_option(shown)

    def _bar(self, index: int, reason: str) -> None:
        model = self.model()
        if isinstance(model, QStandardItemModel):
            model.item(index).setEnabled(False)
        self.setItemData(index, reason, Qt.ItemDataRole.ToolTipRole)

    @property
    def shown(self) -> str | None:
        """Return the id of the current option; None for different values."""
        value = self.currentData()
        return value if isinstance(value, str) else None

    def show_option(self, option_id: str | None) -> None:
        """Set the current option without a signal; None shows the dash."""
        self.blockSignals(True)
        self.setCurrentIndex(-1 if option_id is None else self.findData(option_id))
        self.blockSignals(False)

    def _activated(self, index: int) -> None:
        if 0 <= index < len(self._options):
            self.chosen.emit(self._options[index].id)

    # Qt overrides

    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()

    def minimumSizeHint(self) -> QSize:
        return QSize(60, super().minimumSizeHint().height())
