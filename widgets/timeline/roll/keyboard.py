"""The keys at the left of the piano roll, with their names."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QEvent, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent, QPen, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from widgets.common.pitch import BLACK

KEYBOARD_PX = 50


class Keyed(Protocol):
    """Part of the roll that the keyboard needs; a protocol, since the roll imports this module."""

    session: Session

    @property
    def header(self) -> QWidget: ...
    @property
    def row_px(self) -> float: ...
    @property
    def y_range(self) -> tuple[float, float]: ...
    def y_px(self, value: float) -> float: ...
    def value_at(self, y_px: float) -> float: ...
    def pitch_text(self, pitch: int) -> str: ...
    def pitch_tip(self, pitch: int) -> str: ...
    def select_pitch(self, pitch: int, add: bool) -> None: ...
    def scroll_pitch(self, notches: float) -> None: ...


class Keyboard(QWidget):
    """Piano keyboard at the rows of the roll. A click selects all notes of a pitch in the active player's part; with
    Shift or Ctrl in addition.
    """

    def __init__(self, roll: Keyed) -> None:
        super().__init__(roll.header)
        self.setObjectName("keyboard")
        self._roll = roll
        self._hovered: int | None = None
        self._pressed: int | None = None
        self.setMouseTracking(True)

    def show_pitch(self, pitch: int | None) -> None:
        """Highlight the key of the row under the mouse."""
        if pitch != self._hovered:
            self._hovered = pitch
            self.update()

    def _pitch(self, event: QMouseEvent) -> int:
        return int(self._roll.value_at(event.position().y()) // 1)

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        roll = self._roll
        tokens = roll.session.tokens
        dark = tokens.name == "dark"
        white, black = (tokens.text, tokens.raised) if dark else (tokens.raised, tokens.text)
        painter = QPainter(self)
        width, height = float(self.width()), roll.row_px
        painter.fillRect(self.rect(), QColor("#b9bec8" if dark else white))
        bottom, top = roll.y_range
        first, last = int(bottom // 1), int(-(-top // 1))
        metrics = QFontMetricsF(self.font())
        every = height >= metrics.height() * 0.86
        for pitch in range(first, last):
            y = roll.y_px(pitch + 1)
            is_black = pitch % 12 in BLACK
            rect = QRectF(0.0, y, width, height)
            if is_black:
                painter.fillRect(QRectF(0.0, y, width * 0.55, height), QColor("#2a2d33" if dark else "#3b414b"))
            elif pitch % 12 in (0, 5) or every:
                painter.setPen(QPen(QColor("#8b919c" if dark else tokens.line_strong), 1.0))
                painter.drawLine(rect.bottomLeft(), rect.bottomRight())
            if pitch == self._hovered:
                light = QColor(tokens.accent)
                light.setAlpha(150)
                painter.fillRect(rect, light)
            if pitch % 12 == 0 or every or pitch == self._hovered:
                self._name(painter, metrics, pitch, rect, is_black and pitch != self._hovered and every, black)
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(self.width() - 1, 0, self.width() - 1, self.height())

    def _name(
        self, painter: QPainter, metrics: QFontMetricsF, pitch: int, rect: QRectF, on_black: bool, _ink: str
    ) -> None:
        text = self._roll.pitch_text(pitch)
        painter.setPen(QColor("#15181d"))
        if on_black:
            painter.setPen(QColor("#e3e5e9"))
            rect = rect.adjusted(0.0, 0.0, -rect.width() * 0.42, 0.0)
        # The name of a low row is taller than the row and may overlap its neighbours.
        spare = max(metrics.height() - rect.height(), 0.0) / 2
        place = rect.adjusted(2.0, -spare, -3.0, spare)
        painter.drawText(place, int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter), text)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            add = bool(event.modifiers() & (Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier))
            self._pressed = self._pitch(event)
            self._roll.select_pitch(self._pressed, add)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        pitch = self._pitch(event)
        self.show_pitch(pitch)
        self.setToolTip(self._roll.pitch_tip(pitch))
        if event.buttons() & Qt.MouseButton.LeftButton and pitch != self._pressed:
            self._pressed = pitch
            self._roll.select_pitch(pitch, True)

    def leaveEvent(self, event: QEvent) -> None:
        self.show_pitch(None)

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.accept()
        notches = event.angleDelta().y() / 120.0
        self._roll.scroll_pitch(notches)
