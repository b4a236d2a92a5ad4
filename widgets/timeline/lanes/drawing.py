"""Brushes, pens and many rectangles or lines at once, in the theme's colours."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from pyqtgraph.Qt.internals import PrimitiveArray
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF

from widgets.common.tokens import LEAST_TEXT_PT, Tokens

Floats = npt.NDArray[np.float64]

MARK_PX = 6.0
"""Side of the square that marks what a person made."""


def shade(colour: str, alpha: int = 255) -> QColor:
    """A token with an opacity of 0..255."""
    result = QColor(colour)
    result.setAlpha(alpha)
    return result


def small_font(base: QFont) -> QFont:
    """The smallest text that is allowed."""
    font = QFont(base)
    font.setPointSizeF(float(LEAST_TEXT_PT))
    return font


def draw_text(
    painter: QPainter,
    box: QRectF,
    text: str,
    align: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter,
) -> None:
    """A line of text, shortened where it does not fit; nothing where not even two letters would."""
    metrics = QFontMetricsF(painter.font())
    if box.width() < 14.0 or box.height() < metrics.height() - 3.0:
        return
    shown = metrics.elidedText(text, Qt.TextElideMode.ElideRight, box.width())
    if len(shown) > 1 or shown == text:
        painter.drawText(box, align | Qt.TextFlag.TextDontClip | Qt.TextFlag.TextSingleLine, shown)


def draw_mark(painter: QPainter, tokens: Tokens, x: float, y: float, removed: bool = False) -> None:
    """The small solid square of what a person made, or the cross of what a person took out; its upper left corner."""
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, removed)
    if removed:
        painter.setPen(QPen(QColor(tokens.by_hand), 1.6))
        painter.drawLine(QPointF(x, y), QPointF(x + MARK_PX, y + MARK_PX))
        painter.drawLine(QPointF(x + MARK_PX, y), QPointF(x, y + MARK_PX))
    else:
        painter.fillRect(QRectF(x, y, MARK_PX, MARK_PX), QColor(tokens.by_hand))
    painter.restore()


def draw_rects(painter: QPainter, left: Floats, top: Floats, width: Floats, height: Floats, colour: QColor) -> None:
    """Many rectangles of one colour; arrays (N,) of pixels."""
    array: Any = PrimitiveArray(QRectF, 4)
    array.resize(len(left))
    if len(left):
        table = array.ndarray()
        table[:, 0], table[:, 1], table[:, 2], table[:, 3] = left, top, width, height
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawRects(*array.drawargs())


def draw_lines(painter: QPainter, x0: Floats, y0: Floats, x1: Floats, y1: Floats, pen: QPen) -> None:
    """Many lines with one pen; arrays (N,) of pixels."""
    array: Any = PrimitiveArray(QLineF, 4)
    array.resize(len(x0))
    if len(x0):
        table = array.ndarray()
        table[:, 0], table[:, 1], table[:, 2], table[:, 3] = x0, y0, x1, y1
        painter.setPen(pen)
        painter.drawLines(*array.drawargs())


def draw_path(painter: QPainter, points: Floats, pen: QPen) -> None:
    """Joined points (N, 2) of pixels; NaN breaks the line."""
    good = np.isfinite(points[:, 1])
    edges = np.flatnonzero(np.diff(np.concatenate(([0], good.astype(np.int8), [0]))))
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for start, end in zip(edges[0::2].tolist(), edges[1::2].tolist(), strict=True):
        painter.drawPolyline(polygon(points[start:end]))


def polygon(points: Floats) -> QPolygonF:
    """Points (N, 2) as Qt has them."""
    return QPolygonF([QPointF(x, y) for x, y in points.tolist()])
