"""Field in a lane for typing a number or text."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent
from PySide6.QtWidgets import QLineEdit

from app.editor.design_tokens import LEAST_TARGET_PX
from widgets.common.numbers import number_from, number_text
from widgets.timeline.lane import Lane

WIDTH_PX = 84


class NumberField(QLineEdit):
    """A field over the plot: Enter accepts, Escape or a press elsewhere cancels."""

    def __init__(self, lane: Lane) -> None:
        super().__init__(lane.plot)
        self.setObjectName("number_field")
        self._lane = lane
        self._decimals = 2
        self._unit = ""
        self._opened_with = ""
        self._take: Callable[[float], None] | None = None
        self.returnPressed.connect(self._entered)
        self.hide()

    def open(
        self, box: QRectF, value: float | None, decimals: int, take: Callable[[float], None], name: str, unit: str = ""
    ) -> None:
        """Open the field for a number at a place of the plot.

        Parameters
        ----------
        box : QRectF
            Rectangle of the object with the number.
        value : float or None
            Present number; None if several objects differ, which leaves the field empty.
        take : callable
            Called with the number, if it was changed.
        name : str
            For screen readers.
        """
        self._decimals, self._take, self._unit = decimals, take, unit
        self.setAccessibleName(name)
        self.setToolTip(name)
        self._opened_with = "" if value is None else number_text(value, decimals)
        self.setText(self._opened_with)
        height = max(self.sizeHint().height(), LEAST_TARGET_PX)
        room = self._lane.plot_rect
        left = min(max(box.left(), 0.0), max(room.width() - WIDTH_PX, 0.0))
        top = min(max(box.center().y() - height / 2, 0.0), max(room.height() - height, 0.0))
        self.setGeometry(round(left), round(top), WIDTH_PX, height)
        self.show()
        self.raise_()
        self.setFocus()
        self.selectAll()

    def close_field(self) -> None:
        """Close the field, discarding its text."""
        if self.isVisible():
            self.hide()
            self._lane.plot.setFocus()

    def _entered(self) -> None:
        if self.text() == self._opened_with:
            self.close_field()
            return
        value = number_from(self.text(), self._unit)
        if value is None:
            self.selectAll()
            return
        take = self._take
        self.close_field()
        if take is not None:
            take(value)

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self.close_field()
        else:
            super().keyPressEvent(event)
        # Unused keys must not reach the lane behind the field.
        event.accept()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        if event.reason() != Qt.FocusReason.PopupFocusReason:
            self.hide()


class TextField(NumberField):
    """A field in a lane for typing a text, as `NumberField` is for numbers."""

    def __init__(self, lane: Lane) -> None:
        super().__init__(lane)
        self.setObjectName("text_field")
        self._take_text: Callable[[str], None] | None = None

    def ask(self, box: QRectF, text: str, take: Callable[[str], None], name: str) -> None:
        """Open the field for a text at a place of the plot; ``take`` is called with the typed text, ``name`` is for
        screen readers.
        """
        self.open(box, 0.0, 0, lambda _: None, name)
        self._take_text = take
        self.setText(text)
        self.selectAll()

    def _entered(self) -> None:
        text, take = self.text(), self._take_text
        self.close_field()
        if take is not None:
            take(text)
