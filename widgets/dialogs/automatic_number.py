"""A number that is found unless it is typed."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QDoubleSpinBox, QWidget

from widgets.common.clicks import on_switch
from widgets.common.layouts import in_row

TEXT_MARGIN_PX = 6
"""Left margin of the text, as in other fields; the style sheet does not reach the text of a spin box."""


class AutomaticNumber(QWidget):
    """A check box "Automatic", and a number that can be typed while it is not checked.

    Signals
    -------
    changed()
        The user chose another value.

    Parameters
    ----------
    name : str
        Of the number for tests and style; the check box has ``_automatic`` behind it.
    """

    changed = Signal()

    def __init__(
        self, name: str, least: float, most: float, *, step: float, decimals: int, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.check, self.number = QCheckBox(), QDoubleSpinBox()
        self.check.setObjectName(f"{name}_automatic")
        self.number.setObjectName(name)
        self.number.setDecimals(decimals)
        self._range = least, most
        self.number.setRange(least, most)
        self.number.setSingleStep(step)
        self.number.setKeyboardTracking(False)
        self.number.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self.number.lineEdit().setAcceptDrops(False)
        self.setFocusProxy(self.check)
        in_row(self.check, (self.number, 1), of=self, margins=0)
        on_switch(self.check, self._toggled)
        self.number.valueChanged.connect(lambda _: self.changed.emit())
        self.show_value(None, None)

    @property
    def value(self) -> float | None:
        """The typed number; None while it is found automatically."""
        return None if self.check.isChecked() else self.number.value()

    def set_range(self, least: float, most: float) -> None:
        """Offer only numbers within a range; `show_value` still shows a number outside of it."""
        self._range = least, most

    def show_value(self, value: float | None, found: float | None) -> None:
        """Show a value, or what was found where it is None, without a signal."""
        self.number.blockSignals(True)
        self.check.setChecked(value is None)
        self.number.setEnabled(value is not None)
        shown = found if value is None else value
        least, most = self._range
        self.number.setRange(min(least, least if shown is None else shown), max(most, most if shown is None else shown))
        if shown is not None:
            self.number.setValue(shown)
        # What is not known is not shown as a number.
        self.number.lineEdit().setVisible(shown is not None)
        self.number.blockSignals(False)

    def _toggled(self, automatic: bool) -> None:
        self.number.setEnabled(not automatic)
        self.number.lineEdit().setVisible(True)
        self.changed.emit()
        if not automatic:
            self.number.setFocus()
            self.number.selectAll()
