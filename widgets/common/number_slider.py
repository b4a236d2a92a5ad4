"""The number control of the editor: a slim slider with name, value and unit."""

from __future__ import annotations

import math

from PySide6.QtCore import SIGNAL, QEvent, QObject, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QFocusEvent,
    QGuiApplication,
    QKeyEvent,
    QKeySequence,
    QMouseEvent,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QLineEdit, QMenu, QSizePolicy, QWidget

from app.editor.session import Session, Severity
from app.errors import Message
from widgets.common.clicks import on_click
from widgets.common.controls import named
from widgets.common.number_display import NumberDisplay
from widgets.common.numbers import number_from

DRAG_PX = 3
"""A press that moves less than this number of pixels is a click."""
FREE_DRAG_PX = 4
"""Pixels of a drag per step if there is no range to fill."""
WHEEL_REST_MS = 600
"""Milliseconds between notches of the wheel below which they form one edit."""
FINE = 0.1
MOST_SHOWN = 24
"""Greatest number of characters of invalid text that are quoted."""
_STEP_KEYS = {
    Qt.Key.Key_Up: 1.0,
    Qt.Key.Key_Right: 1.0,
    Qt.Key.Key_Down: -1.0,
    Qt.Key.Key_Left: -1.0,
    Qt.Key.Key_PageUp: 10.0,
    Qt.Key.Key_PageDown: -10.0,
}
_TYPE_KEYS = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_F2)
_RESET_KEYS = (Qt.Key.Key_Backspace, Qt.Key.Key_Delete)
_STARTS = tuple("0123456789.-+(")
"""Characters that may begin a number."""


class NumberSlider(NumberDisplay):
    """A number control for dragging, typing (also ``1/3``), stepping by keys and wheel, copying, pasting, and resetting
    by a double click.

    Drag to change (Shift: fine), click to type, double-click or Backspace to reset, Escape to cancel. The wheel works
    only with keyboard focus, so that scrolling a panel changes nothing.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.
    minimum, maximum : float
        The smallest and largest value.
    default : float
        Value after a reset.
    step : float
        Step of keys and wheel, and of a drag without ``slides``.
    slides : bool
        Whether the range is short enough for a filled slider; else a drag changes the value by steps.
    resets : bool
        Whether there is a default; without one a double click starts typing.
    fills : (float, float), optional
        Part of the range that fills the control and that a drag can reach; other values can be typed. None for the
        whole range.

    Signals
    -------
    changed(float, object)
        The user set a value. The object is a token shared by all values of one drag; None for a single change.
    reset(float)
        The user resets to the default; emitted instead of `changed` if a slot is connected that removes the stored
        value.
    released()
        A drag or a turn of the wheel has ended.
    """

    changed = Signal(float, object)
    reset = Signal(float)
    released = Signal()

    def __init__(
        self,
        session: Session,
        minimum: float = 0.0,
        maximum: float = 1.0,
        *,
        default: float = 0.0,
        step: float = 0.01,
        decimals: int = 2,
        slides: bool = True,
        fills: tuple[float, float] | None = None,
        resets: bool = True,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(session, fills or (minimum, maximum), default, decimals, slides, resets, parent)
        self._minimum, self._maximum = minimum, maximum
        self._step, self._fills = step, fills
        self._token: object | None = None
        self._press: QPointF | None = None
        self._press_value, self._press_mixed = 0.0, False
        self._drag_x, self._drag_value = 0.0, 0.0
        self._field: QLineEdit | None = None
        self._wheel_rest = QTimer(self, singleShot=True, interval=WHEEL_REST_MS)
        self._wheel_rest.timeout.connect(self._end)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.SizeHorCursor)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def set_range(self, minimum: float, maximum: float) -> None:
        """Allow only values from ``minimum`` to ``maximum``."""
        self._minimum, self._maximum = minimum, maximum
        self._ends = self._fills or (minimum, maximum)
        self.update()

    def set_step(self, step: float) -> None:
        """Set the step of keys and wheel, and of a drag if the control is not a filled slider."""
        self._step = step

    # Editing

    def copy(self) -> None:
        """Copy the number to the clipboard."""
        QGuiApplication.clipboard().setText(self.value_text().replace("−", "-"))

    def paste(self) -> None:
        """Set the number on the clipboard, if it is valid."""
        self._take(QGuiApplication.clipboard().text())

    def reset_value(self) -> None:
        """Reset to the default; start typing if there is none."""
        if not self._resets:
            self.type_value()
        elif self.receivers(SIGNAL("reset(double)")) > 0:
            self.reset.emit(self._default)
        else:
            self._request(self._default, None)

    def type_value(self, text: str | None = None) -> None:
        """Open the field to type in, with the value selected, or beginning with ``text``."""
        if not self.isEnabled():
            return
        field = named(QLineEdit(self), "number_field")
        field.setFrame(False)
        field.setAlignment(Qt.AlignmentFlag.AlignRight)
        field.setTextMargins(4, 0, 4, 0)
        tokens = self._session.tokens
        field.setStyleSheet(
            f"QLineEdit {{ background: {tokens.sunken}; color: {tokens.text}; border: 1px solid {tokens.accent};"
            f" border-radius: 4px; padding: 0; margin: 0; min-height: 0;"
            f" selection-background-color: {tokens.accent}; selection-color: {tokens.accent_text}; }}"
        )
        field.setGeometry(self.rect())
        field.setText(self.value_text().replace("−", "-") if text is None else text)
        if self._mixed and text is None:
            field.clear()
        field.installEventFilter(self)
        self._field = field
        field.show()
        field.setFocus(Qt.FocusReason.OtherFocusReason)
        if text is None:
            field.selectAll()

    def _take(self, text: str) -> None:
        value = self._reads(text) if self._reads is not None else number_from(text, self._unit)
        if value is not None:
            self._request(value, None)
        else:
            said = Message("value.not_understood", {"text": text.strip()[:MOST_SHOWN], "value": self.value_text()})
            self._session.notice(said, Severity.WARNING)

    def _request(self, value: float, token: object | None) -> None:
        kept = self._kept(value)
        if self._press is not None and kept == self._kept(self._press_value) and not self._press_mixed:
            # A drag back to its start leaves no change, however precise the value was.
            kept = self._press_value
        if not self._mixed and kept in (self._value, self._kept(self._value)):
            return
        self._value, self._mixed = kept, False
        self.update()
        self.changed.emit(kept, token)

    def _step_by(self, count: float, modifiers: Qt.KeyboardModifier) -> None:
        fine = FINE if modifiers & Qt.KeyboardModifier.ShiftModifier else 1.0
        self._token = self._token or object()
        self._request(self._value + count * max(self._step * fine, 10.0**-self._decimals), self._token)

    def _kept(self, value: float) -> float:
        """Return a value limited to the range and rounded to the displayed decimals."""
        return min(max(round(value, self._decimals), self._minimum), self._maximum) + 0.0

    def _end(self) -> None:
        self._wheel_rest.stop()
        if self._after_drag is not None:
            (self._value, self._mixed), self._after_drag = self._after_drag, None
            self.update()
        if self._token is not None:
            self._token = None
            self.released.emit()

    def _close_field(self, commit: bool, focus: bool = True) -> None:
        field, self._field = self._field, None
        if field is None:
            return
        field.removeEventFilter(self)
        text = field.text()
        field.hide()
        field.deleteLater()
        if focus:
            self.setFocus(Qt.FocusReason.OtherFocusReason)
        if commit and text.strip():
            self._take(text)
        self.update()

    def _cancel_drag(self) -> None:
        if self._dragging:
            self._dragging, self._after_drag = False, None
            # Restores the value of each object, including objects without a value of their own, which no single value
            # could express.
            if self._token is not None and self._session.document.cancel_gesture(self._token):
                self._value, self._mixed = self._press_value, self._press_mixed
                self.update()
            else:
                self._request(self._press_value, self._token)
        self._press = None
        self._end()

    def _menu_entries(self) -> QMenu:
        menu = named(QMenu(self), "number_menu")
        for text, slot in (
            (self.tr("number_slider.type_value"), lambda: self.type_value()),
            (self.tr("number_slider.copy_value"), self.copy),
            (self.tr("number_slider.paste_value"), self.paste),
        ):
            on_click(menu.addAction(text), slot)
        if self._resets:
            on_click(menu.addAction(self.tr("number_slider.reset")), self.reset_value)
        return menu

    # Qt overrides

    def resizeEvent(self, event: QResizeEvent) -> None:
        if self._field is not None:
            self._field.setGeometry(self.rect())
        super().resizeEvent(event)

    def event(self, event: QEvent) -> bool:
        # Typed digits must not reach the window's shortcuts, which choose fingerings.
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self._takes(event):
            event.accept()
            return True
        return super().event(event)

    def _takes(self, event: QKeyEvent) -> bool:
        if event.matches(QKeySequence.StandardKey.Copy) or event.matches(QKeySequence.StandardKey.Paste):
            return True
        if event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier):
            return False
        key = Qt.Key(event.key())
        special = key in _STEP_KEYS or key in _TYPE_KEYS or key in _RESET_KEYS
        escape = key == Qt.Key.Key_Escape and self._press is not None
        return special or escape or key in (Qt.Key.Key_Home, Qt.Key.Key_End) or event.text() in _STARTS

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if key == Qt.Key.Key_Escape and self._press is not None:
            self._cancel_drag()
        elif event.matches(QKeySequence.StandardKey.Copy):
            self.copy()
        elif event.matches(QKeySequence.StandardKey.Paste):
            self.paste()
        elif not self._takes(event):
            super().keyPressEvent(event)
        elif key in _STEP_KEYS:
            self._step_by(_STEP_KEYS[key], event.modifiers())
        elif key in _TYPE_KEYS:
            self.type_value()
        elif key in _RESET_KEYS:
            self.reset_value()
        elif key in (Qt.Key.Key_Home, Qt.Key.Key_End):
            if self._slides:
                self._request(self._minimum if key == Qt.Key.Key_Home else self._maximum, None)
        else:
            self.type_value(event.text())

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if Qt.Key(event.key()) in _STEP_KEYS and not event.isAutoRepeat() and self._press is None:
            self._end()
        else:
            super().keyReleaseEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            event.ignore()
            return
        self._end()
        self._press = event.position()
        self._press_value, self._press_mixed = self._value, self._mixed
        self._drag_x, self._drag_value = event.position().x(), self._value
        self._dragging = False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._press is None:
            return
        x = event.position().x()
        if not self._dragging:
            if abs(x - self._press.x()) < DRAG_PX:
                return
            self._dragging, self._token = True, object()
        # At the position of the press the value is exactly the initial one.
        way = x - self._press.x()
        x = self._press.x() + math.copysign(max(abs(way) - DRAG_PX, 0.0), way)
        low, high = self._ends
        per_px = (high - low) / max(self.width(), 1) if self._slides else self._step / FREE_DRAG_PX
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            per_px *= FINE
        # The sum is unrounded and limited, so that slow drags accumulate and a drag beyond a limit reverses at once.
        moved = self._drag_value + (x - self._drag_x) * per_px
        self._drag_value = min(max(moved, min(low, self._press_value)), max(high, self._press_value))
        self._drag_x = x
        self._request(self._drag_value, self._token)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton or self._press is None:
            return
        dragged = self._dragging
        self._press, self._dragging = None, False
        self.update()
        self._end()
        if not dragged and self.rect().contains(event.position().toPoint()):
            self.type_value()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._close_field(commit=False)
        self._press = None
        self.reset_value()

    def wheelEvent(self, event: QWheelEvent) -> None:
        if not self.hasFocus() or self._press is not None:
            event.ignore()
            return
        notches = (event.angleDelta().y() or event.angleDelta().x()) / 120.0
        self._wheel_rest.start()
        self._step_by(notches, event.modifiers())
        event.accept()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if self._press is None:
            menu = self._menu_entries()
            menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
            menu.popup(event.globalPos())

    def focusOutEvent(self, event: QFocusEvent) -> None:
        if self._press is None:
            self._end()
        super().focusOutEvent(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is not self._field:
            return super().eventFilter(watched, event)
        if event.type() == QEvent.Type.MouseButtonDblClick:
            self._close_field(commit=False)
            self.reset_value()
            return True
        if event.type() == QEvent.Type.FocusOut:
            if isinstance(event, QFocusEvent) and event.reason() != Qt.FocusReason.PopupFocusReason:
                self._close_field(commit=True, focus=False)
            return False
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            return self._field_key(Qt.Key(event.key()), event)
        return False

    def _field_key(self, key: Qt.Key, event: QKeyEvent) -> bool:
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._close_field(commit=True)
        elif key == Qt.Key.Key_Escape:
            self._close_field(commit=False)
        elif key in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab):
            self._close_field(commit=True)
            self.focusNextPrevChild(key == Qt.Key.Key_Tab)
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._close_field(commit=True)
            self.keyPressEvent(event)
        else:
            return False
        return True
