"""A widget that is drawn once into a cached image, from which it is repainted."""

from __future__ import annotations

from math import ceil

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QWidget


class Pictured(QWidget):
    """Widget drawn into a cached image, so that the moving playhead does not redraw it.

    Override `draw`, and call `redraw` when its inputs have changed.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._picture: QPixmap | None = None
        self._ratio = 1.0
        """Pixels of the picture in one of the widget's."""
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def ground(self) -> QColor:
        """Return the background colour; every subclass implements this."""
        raise NotImplementedError

    def draw(self, painter: QPainter, room: QRectF) -> None:
        """Draw everything except the background into ``room``; every subclass implements this."""
        raise NotImplementedError

    def redraw(self, *_changes: object) -> None:
        """Discard the cached picture, since its inputs have changed."""
        self._picture = None
        self.update()

    def _drawn(self) -> QPixmap:
        ratio = self.devicePixelRatioF()
        # At a scale of 125 % a widget may begin between two pixels and extend into one more.
        size = QSize(ceil(self.width() * ratio) + 1, ceil(self.height() * ratio) + 1)
        if self._picture is None or self._picture.size() != size or self._ratio != ratio:
            self._picture, self._ratio = self._draw(size, ratio), ratio
        return self._picture

    def _draw(self, size: QSize, ratio: float) -> QPixmap:
        picture = QPixmap(size)
        picture.fill(self.ground())
        painter = QPainter(picture)
        painter.scale(ratio, ratio)
        # Clipped to the picture, Qt draws lines and translucent shapes ten times as fast.
        painter.setClipRect(QRectF(QPointF(), QSizeF(size) / ratio))
        self.draw(painter, QRectF(self.rect()))
        painter.end()
        return picture

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        painter, picture = QPainter(self), self._drawn()
        # Pixel by pixel: if it scaled to the same size, Qt would read beyond the last row.
        painter.scale(1.0 / self._ratio, 1.0 / self._ratio)
        painter.drawPixmap(0, 0, picture)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        # Fonts and texts are parts of the picture.
        self.redraw()
