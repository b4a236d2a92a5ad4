"""Mouse events with any button and modifier, sent to a widget."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QWidget

NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
CTRL = Qt.KeyboardModifier.ControlModifier
ALT = Qt.KeyboardModifier.AltModifier
LEFT = Qt.MouseButton.LeftButton
MIDDLE = Qt.MouseButton.MiddleButton
Place = tuple[float, float]


class Hand:
    """Mouse over one widget; positions are in its pixels."""

    def __init__(self, widget: QWidget) -> None:
        self._widget = widget
        self._held = Qt.MouseButton.NoButton

    def _send(self, kind: QEvent.Type, place: Place, button: Qt.MouseButton, keys: Qt.KeyboardModifier) -> None:
        point = QPointF(*place)
        screen = QPointF(self._widget.mapToGlobal(point.toPoint()))
        QApplication.sendEvent(self._widget, QMouseEvent(kind, point, screen, button, self._held, keys))
        QApplication.processEvents()

    def press(self, place: Place, button: Qt.MouseButton = LEFT, keys: Qt.KeyboardModifier = NONE) -> None:
        self._held = button
        self._send(QEvent.Type.MouseButtonPress, place, button, keys)

    def move(self, place: Place, keys: Qt.KeyboardModifier = NONE) -> None:
        self._send(QEvent.Type.MouseMove, place, Qt.MouseButton.NoButton, keys)

    def release(self, place: Place, keys: Qt.KeyboardModifier = NONE) -> None:
        button, self._held = self._held, Qt.MouseButton.NoButton
        self._send(QEvent.Type.MouseButtonRelease, place, button, keys)

    def click(self, place: Place, keys: Qt.KeyboardModifier = NONE) -> None:
        self.press(place, keys=keys)
        self.release(place, keys)

    def double_click(self, place: Place) -> None:
        self.click(place)
        self._held = LEFT
        self._send(QEvent.Type.MouseButtonDblClick, place, LEFT, NONE)
        self.release(place)

    def drag(self, start: Place, end: Place, keys: Qt.KeyboardModifier = NONE, button: Qt.MouseButton = LEFT) -> None:
        """Press, move half way, move all the way, release."""
        self.press(start, button, keys)
        self.move(((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), keys)
        self.move(end, keys)
        self.release(end, keys)

    def wheel(self, place: Place, notches: float, keys: Qt.KeyboardModifier = NONE) -> None:
        point = QPointF(*place)
        event = QWheelEvent(
            point,
            QPointF(self._widget.mapToGlobal(point.toPoint())),
            QPoint(),
            QPoint(0, round(notches * 120)),
            Qt.MouseButton.NoButton,
            keys,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(self._widget, event)
        QApplication.processEvents()
