"""A widget that is drawn once and shown often."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QWidget


class Pictured(QWidget):
    """What is drawn is kept as a picture, so that the playhead passing by draws nothing anew.

    Override `draw`, and call `redraw` when something that it draws is another.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._picture: QPixmap | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def draw(self, painter: QPainter, room: QRectF) -> None:
        """Draw all of it, the ground too."""
        raise NotImplementedError

    def redraw(self, *_changes: object) -> None:
        """Something that is drawn is other now."""
        self._picture = None
        self.update()

    def _drawn(self) -> QPixmap:
        ratio = self.devicePixelRatioF()
        size = (QSizeF(self.size()) * ratio).toSize()
        if self._picture is None or self._picture.size() != size or self._picture.devicePixelRatio() != ratio:
            self._picture = self._draw(size, ratio)
        return self._picture

    def _draw(self, size: QSize, ratio: float) -> QPixmap:
        picture = QPixmap(size)
        picture.setDevicePixelRatio(ratio)
        painter, room = QPainter(picture), QRectF(self.rect())
        # Clipped to what there is, Qt draws lines and shapes that are not opaque ten times as fast.
        painter.setClipRect(room)
        self.draw(painter, room)
        painter.end()
        return picture

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        QPainter(self).drawPixmap(0, 0, self._drawn())

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        # Fonts and words are drawn too.
        self.redraw()
