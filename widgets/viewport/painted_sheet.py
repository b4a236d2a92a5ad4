"""A transparent widget over the canvas for painting with Qt, hidden while there is nothing to paint."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

Paint = Callable[[QPainter, tuple[float, float]], None]


class Layer(QWidget):
    """Transparent widget over another one, which ignores the mouse.

    Parameters
    ----------
    below : QWidget
        The widget below.
    paint : callable
        Paints with a painter into the given width and height.
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
        """Repaint, or hide the layer if there is nothing to paint (``requested`` False)."""
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
