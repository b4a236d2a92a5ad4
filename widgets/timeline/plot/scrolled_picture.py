"""A cached picture larger than the visible range, so that short scrolling in time needs no redraw."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QImage, QPainter

from widgets.timeline.plot.plot import LaneView

BESIDE = 0.5
"""Share of the visible width drawn in addition at either side."""


class ScrolledPicture:
    """Image of the contents of a lane, reused while only time is scrolled."""

    def __init__(self, lane: LaneView) -> None:
        self._lane = lane
        self._look: object = None
        self._span_s = (0.0, 0.0)
        self._image: QImage | None = None

    def draw(self, painter: QPainter, look: object, paint: Callable[[QPainter, float, float], None]) -> None:
        """Draw the visible range.

        Parameters
        ----------
        look : object
            All inputs of the drawing other than the zoom and the plot's size, compared for equality.
        paint : callable
            Draws the contents between two times (seconds) into the plot's pixels.
        """
        lane, axis = self._lane, self._lane.axis
        ratio, room = lane.plot.devicePixelRatioF(), lane.plot_rect
        look = (look, ratio, axis.px_per_s, room.width(), room.height())
        scrolled = look == self._look
        if not scrolled or not self._span_s[0] <= axis.start_s <= axis.end_s <= self._span_s[1]:
            # A plot being scrolled will be scrolled further; one being zoomed has another picture at the next step.
            more_s = (axis.end_s - axis.start_s) * BESIDE if scrolled else 0.0
            self._look, self._span_s = look, (axis.start_s - more_s, axis.end_s + more_s)
            self._image = self._made(paint, ratio)
        if self._image is not None:
            painter.drawImage(QPointF(round(axis.x_px(self._span_s[0])), 0.0), self._image)

    def _made(self, paint: Callable[[QPainter, float, float], None], ratio: float) -> QImage:
        axis, height = self._lane.axis, self._lane.plot_rect.height()
        left, right = (axis.x_px(seconds) for seconds in self._span_s)
        image = QImage(
            ceil((right - left) * ratio), ceil(height * ratio), QImage.Format.Format_ARGB32_Premultiplied
        )  # fmt: skip
        image.setDevicePixelRatio(ratio)
        image.fill(Qt.GlobalColor.transparent)
        painter = QPainter(image)
        painter.translate(-left, 0.0)
        # See `Pictured`.
        painter.setClipRect(QRectF(left, 0.0, right - left, height))
        paint(painter, *self._span_s)
        painter.end()
        return image
