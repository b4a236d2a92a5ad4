"""A transparent widget over the canvas for painting with Qt, hidden while there is nothing to paint."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

Paint = Callable[[QPainter, tuple[float, float]], None]


class Layer(QWidget):
    """Widget over another one that ignores the mouse.

    Parameters
    ----------
    below : QWidget
    paint : callable
        Paints over a picture of a size.
    """

    def __init__(self, below: QWidget, paint: Paint) -> None:
        super().__init__(below)
        self.setObjectName("viewport_overlay")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self._below, self._paint = below, paint
        below.installEventFilter(self)
        self.hide()

    def refresh(self, requested: bool) -> None:
        """Repaint, or hide if there is nothing to paint."""
        if requested != self.isVisibleTo(self._below):
            self.setGeometry(self._below.rect())
            self.setVisible(requested)
        if requested:
            self.update()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep the layer as large as the widget below it."""
        if event.type() == QEvent.Type.Resize:
            self.setGeometry(self._below.rect())
        return super().eventFilter(watched, event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the layer's contents over the widget below."""
        painter = QPainter(self)
        self._paint(painter, (float(self.width()), float(self.height())))
        painter.end()
