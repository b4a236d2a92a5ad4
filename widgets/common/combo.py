"""A list to choose one of, that stands for several things too."""

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
    """Something to choose: what it is, its text, perhaps a picture; with a reason why not, it cannot be chosen."""

    id: str
    text: str
    icon: QIcon | None = None
    reason: str = ""


class Combo(ComboBox):
    """Options by id. Shows a dash where several things differ; the wheel works only where the keyboard is.

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
        # As wide as there is room, not as the longest name.
        self.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(6)
        self.setMinimumHeight(LEAST_TARGET_PX + 1)
        self.setPlaceholderText(MIXED)
        self.activated.connect(self._activated)

    def set_options(self, options: Sequence[Option]) -> None:
        """Offer these; the one that was shown stays, where it is still there."""
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
        """Id of the option shown; None where several differ."""
        value = self.currentData()
        return value if isinstance(value, str) else None

    def show_option(self, option_id: str | None) -> None:
        """Show an option without a signal; None shows the dash."""
        self.blockSignals(True)
        self.setCurrentIndex(-1 if option_id is None else self.findData(option_id))
        self.blockSignals(False)

    def _activated(self, index: int) -> None:
        if 0 <= index < len(self._options):
            self.chosen.emit(self._options[index].id)

    # Qt's own names

    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()

    def minimumSizeHint(self) -> QSize:
        return QSize(60, super().minimumSizeHint().height())
