"""Drawing of texts, marks and many rectangles or lines at once, in the theme's colours."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF
from shiboken6 import wrapInstance

from app.arrays import AnyIntArray, FloatArray
from app.editor.design_tokens import LEAST_TEXT_PT, Tokens
from widgets.timeline.model.lane_mouse import PixelRect

# As an integer, because combining flags of Qt takes as long as drawing a word.
_ONE_LINE = int(Qt.TextFlag.TextDontClip) | int(Qt.TextFlag.TextSingleLine)
MARK_PX = 6.0
"""Side in pixels of the square that marks the user's changes."""


def rect(box: PixelRect) -> QRectF:
    """Convert a `PixelRect` to a `QRectF`."""
    return QRectF(box.left, box.top, box.width, box.height)


def shade(colour: str, alpha: int = 255) -> QColor:
    """Return a colour of the theme with an opacity of 0..255."""
    result = QColor(colour)
    result.setAlpha(alpha)
    return result


def small_font(base: QFont) -> QFont:
    """Return a font of the smallest allowed size."""
    font = QFont(base)
    font.setPointSizeF(float(LEAST_TEXT_PT))
    return font


def draw_text(
    painter: QPainter,
    box: QRectF,
    text: str,
    align: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter,
) -> None:
    """Draw a line of text, shortened if it does not fit; nothing if less than two letters fit."""
    metrics = QFontMetricsF(painter.font())
    if box.width() < 14.0 or box.height() < metrics.height() - 3.0:
        return
    shown = metrics.elidedText(text, Qt.TextElideMode.ElideRight, box.width())
    if len(shown) > 1 or shown == text:
        painter.drawText(box, int(align) | _ONE_LINE, shown)


def draw_mark(painter: QPainter, tokens: Tokens, x: float, y: float, removed: bool = False) -> None:
    """Draw, with its upper left corner at (x, y), the square that marks a change by the user, or a cross for a removed
    event.
    """
    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, removed)
    if removed:
        painter.setPen(QPen(QColor(tokens.by_hand), 1.6))
        painter.drawLine(QPointF(x, y), QPointF(x + MARK_PX, y + MARK_PX))
        painter.drawLine(QPointF(x + MARK_PX, y), QPointF(x, y + MARK_PX))
    else:
        painter.fillRect(QRectF(x, y, MARK_PX, MARK_PX), QColor(tokens.by_hand))
    painter.restore()


def draw_rects(
    painter: QPainter, left: FloatArray, top: FloatArray, width: FloatArray, height: FloatArray, colour: QColor
) -> None:
    """Fill many rectangles in one colour; all arrays have shape (N,) and hold pixels."""
    if len(left):
        painter.setPen(Qt.PenStyle.NoPen)
        fill_rects(painter, left, top, width, height, colour)


def fill_rects(
    painter: QPainter, left: FloatArray, top: FloatArray, width: FloatArray, height: FloatArray, colour: QColor
) -> None:
    """Fill many rectangles in one colour, outlined with the painter's pen; all arrays have shape (N,) and hold
    pixels."""
    if len(left):
        table = _side_by_side(left, top, width, height)
        painter.setBrush(colour)
        painter.drawRects(_first(table, QRectF), len(table))


def _side_by_side(*columns: FloatArray) -> FloatArray:
    """Return an array (N, 4) with four columns (N,) as rows, the memory layout of Qt's rectangles and lines
    of doubles.
    """
    table: FloatArray = np.empty((len(columns[0]), len(columns)), np.float64)
    for place, values in enumerate(columns):
        table[:, place] = values
    return table


def _first(table: FloatArray, kind: type[QRectF] | type[QLineF], row: int = 0) -> Any:
    """Return a Qt object that uses a row of a table as its memory, followed by the next rows; ``table`` must outlive
    it.
    """
    return wrapInstance(table.ctypes.data + row * table.strides[0], kind)


def draw_groups(
    painter: QPainter,
    boxes: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    group: AnyIntArray,
    colours: Sequence[QColor],
) -> None:
    """Draw many rectangles in the colours of their groups.

    Parameters
    ----------
    boxes : four arrays (N,)
        Left, top, width and height, pixels.
    group : array (N,)
        Index into ``colours`` of each rectangle, ascending.
    """
    if not len(group):
        return
    table = _side_by_side(*boxes)
    starts = np.flatnonzero(np.diff(group, prepend=-1)).tolist()
    painter.setPen(Qt.PenStyle.NoPen)
    for start, end in pairwise([*starts, len(group)]):
        painter.setBrush(colours[int(group[start])])
        painter.drawRects(_first(table, QRectF, start), end - start)


def draw_lines(painter: QPainter, x0: FloatArray, y0: FloatArray, x1: FloatArray, y1: FloatArray, pen: QPen) -> None:
    """Draw many lines from (x0, y0) to (x1, y1) with one pen; all arrays have shape (N,) and hold pixels."""
    if len(x0):
        table = _side_by_side(x0, y0, x1, y1)
        painter.setPen(pen)
        painter.drawLines(_first(table, QLineF), len(table))


def draw_path(painter: QPainter, points: FloatArray, pen: QPen) -> None:
    """Draw connected lines through points (N, 2) in pixels; a point of NaN interrupts them."""
    before, after = points[:-1], points[1:]
    both = np.isfinite(before[:, 1]) & np.isfinite(after[:, 1])
    before, after = before[both], after[both]
    draw_lines(painter, before[:, 0], before[:, 1], after[:, 0], after[:, 1], pen)


def draw_columns(
    painter: QPainter,
    room: QRectF,
    left: FloatArray,
    right: FloatArray,
    y: FloatArray,
    base: float | None,
    colour: QColor,
) -> None:
    """Draw many narrow values as one vertical line per pixel column, from the least to the greatest ``y`` there,
    including ``base`` if given.
    """
    first = int(np.floor(room.left()))
    count = int(np.ceil(room.right())) - first
    column = np.clip(np.floor((left + right) / 2.0).astype(np.int64) - first, 0, count - 1)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    top, bottom = np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)
    if base is not None:
        top, bottom = np.minimum(top, base), np.maximum(bottom, base)
    x: FloatArray = column[starts].astype(np.float64) + first + 0.5
    draw_lines(painter, x, top, x, np.maximum(bottom, top + 1.0), QPen(colour, 1.0))


def polygon(points: FloatArray) -> QPolygonF:
    """Return points (N, 2) as a polygon of Qt."""
    return QPolygonF([QPointF(x, y) for x, y in points.tolist()])
