"""A number field with an automatic value."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QDoubleSpinBox, QWidget

from widgets.common.clicks import on_switch
from widgets.common.layouts import in_row

TEXT_MARGIN_PX = 6
"""Left margin of the text in pixels as in other fields, since the style sheet does not affect spin boxes."""


class AutomaticNumber(QWidget):
    """A check box "Automatic" and a number field that is enabled while it is unchecked.

    Signals
    -------
    changed()
        The user chose another value.

    Parameters
    ----------
    name : str
        Object name of the number field; that of the check box ends in ``_automatic``.
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
        """Return the typed number; None if it is automatic."""
        return None if self.check.isChecked() else self.number.value()

    def set_range(self, least: float, most: float) -> None:
        """Set the range of the numbers that the user can enter; `show_value` may show others."""
        self._range = least, most

    def show_value(self, value: float | None, found: float | None) -> None:
        """Display a value, or the automatic one ``found`` if it is None, without emitting a signal."""
        self.number.blockSignals(True)
        self.check.setChecked(value is None)
        self.number.setEnabled(value is not None)
        shown = found if value is None else value
        least, most = self._range
        self.number.setRange(min(least, least if shown is None else shown), max(most, most if shown is None else shown))
        if shown is not None:
            self.number.setValue(shown)
        # An unknown value is not shown as a number.
        self.number.lineEdit().setVisible(shown is not None)
        self.number.blockSignals(False)

    def _toggled(self, automatic: bool) -> None:
        self.number.setEnabled(not automatic)
        self.number.lineEdit().setVisible(True)
        self.changed.emit()
        if not automatic:
            self.number.setFocus()
            self.number.selectAll()
