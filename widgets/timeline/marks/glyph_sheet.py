"""Drawing of placed marks: glyphs as cached images, slurs as outlines."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import ceil, floor, hypot
from typing import Final, NamedTuple, TypeAlias

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QImage, QPainter, QPainterPath

from app.editor.design_tokens import Tokens
from widgets.timeline.marks.glyphs import glyph_path, wave_path
from widgets.timeline.model.marks.mark_looks import LOOKS
from widgets.timeline.model.marks.placed_marks import STEEPNESS, PlacedMarks
from widgets.timeline.plot.drawing import shade

HAND_PX: Final = 4.0
"""Side in pixels of the square that indicates the user's marks."""
END_DOT_PX = 3.0
SLUR_PX = (0.8, 2.4)
"""Thickness in pixels of a slur at its ends and in its middle."""
CALM = 205
"""Opacity of marks from the score."""

Pictured: TypeAlias = tuple[QImage, int, int]
"""A picture, and the position of its upper left corner."""


class MarkColours(NamedTuple):
    """Colours in which marks are drawn, with a different one for selected or dragged marks.

    Attributes
    ----------
    selected : frozenset of int
        Indices of the selected marks.
    held : int or None
        Index of the slur whose end can be dragged.
    """

    tokens: Tokens
    selected: frozenset[int]
    held: int | None

    def of(self, number: int) -> QColor:
        """Return the colour of the mark with an index: the accent colour if it is selected."""
        return QColor(self.tokens.accent) if number in self.selected else shade(self.tokens.text, CALM)


def paint_marks(painter: QPainter, placed: PlacedMarks, colours: MarkColours, font: QFont) -> None:
    """Draw musical marks at their computed positions: slurs, glyphs, texts, and squares at marks that the user set."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setPen(Qt.PenStyle.NoPen)
    _paint_arcs(painter, placed, colours)
    _paint_glyphs(painter, placed, colours)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    _paint_texts(painter, placed, colours, font)
    _paint_hands(painter, placed, QColor(colours.tokens.by_hand))


def _paint_glyphs(painter: QPainter, placed: PlacedMarks, colours: MarkColours) -> None:
    marks, unit = placed.table.of_player.marks, round(placed.unit_px, 1)
    ratio = painter.device().devicePixelRatioF()
    shades = {chosen: colours.of(number) for chosen, number in ((False, -1), *((True, n) for n in colours.selected))}
    values = {chosen: shade.rgba() for chosen, shade in shades.items()}
    columns = (column.tolist() for column in placed.glyphs)
    for number, x, y, x_end, y_end in zip(*columns, strict=True):
        mark = marks[number]
        look, chosen = LOOKS[mark.kind], number in colours.selected
        if look.is_text:
            continue
        if look.place == "next":
            painter.setBrush(shades[chosen])
            painter.drawPath(_thick([(x, y), (x_end, y_end)]))
            continue
        picture, left, top = _glyph(mark.kind, unit, mark.text, values[chosen], ratio)
        painter.drawImage(QPointF(round(x) + left, round(y) + top), picture)
        if mark.kind == "trill" and x_end - x > 4 * unit:
            painter.setBrush(shades[chosen])
            painter.drawPath(wave_path(x + 1.6 * unit, x_end, y - unit, unit))


@lru_cache(maxsize=512)
def _glyph(kind: str, unit_px: float, text: str, rgba: int, ratio: float) -> Pictured:
    return pictured(glyph_path(kind, unit_px, text), rgba, ratio)


def pictured(path: QPainterPath, rgba: int, ratio: float) -> Pictured:
    """Return a filled outline as a picture, which is drawn faster, with its upper left corner."""
    box = path.boundingRect()
    left, top = floor(box.left()) - 1, floor(box.top()) - 1
    width, height = ceil(box.right()) + 1 - left, ceil(box.bottom()) + 1 - top
    picture = QImage(ceil(width * ratio), ceil(height * ratio), QImage.Format.Format_ARGB32_Premultiplied)
    picture.setDevicePixelRatio(ratio)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor.fromRgba(rgba))
    painter.drawPath(path.translated(-left, -top))
    painter.end()
    return picture, left, top


def _paint_arcs(painter: QPainter, placed: PlacedMarks, colours: MarkColours) -> None:
    columns = (column.tolist() for column in placed.arcs)
    for number, x0, y0, x1, y1, lift, is_bracket in zip(*columns, strict=True):
        painter.setBrush(colours.of(number))
        painter.drawPath((_bracket if is_bracket else _slur)(x0, y0, x1, y1, lift))
        if number in colours.selected or number == colours.held:
            for x, y in ((x0, y0), (x1, y1)):
                painter.drawEllipse(QPointF(x, y), END_DOT_PX, END_DOT_PX)


def _paint_texts(painter: QPainter, placed: PlacedMarks, colours: MarkColours, font: QFont) -> None:
    marks = placed.table.of_player.marks
    painter.setFont(font)
    metrics = QFontMetricsF(font)
    for number, x, y in zip(*(column.tolist() for column in placed.glyphs[:3]), strict=True):
        mark = marks[number]
        if LOOKS[mark.kind].is_text:
            painter.setPen(colours.of(number))
            left = x - metrics.horizontalAdvance(mark.text) / 2
            painter.drawText(QPointF(left, y - metrics.descent()), mark.text)


def _paint_hands(painter: QPainter, placed: PlacedMarks, colour: QColor) -> None:
    """Draw a small square at each mark that the user set by hand."""
    by_hand, arcs = placed.table.of_player.by_hand, placed.arcs
    if not by_hand.any():
        return
    for place in by_hand[placed.glyphs.mark].nonzero()[0].tolist():
        box = placed.box_of_glyph(place)
        painter.fillRect(QRectF(round(box.left) - HAND_PX - 1.0, round(box.top), HAND_PX, HAND_PX), colour)
    for place in by_hand[arcs.mark].nonzero()[0].tolist():
        x0, y0, x1, y1, lift = (float(column[place]) for column in arcs[1:6])
        middle = (y0 + y1) / 2 - lift
        top = middle - HAND_PX - 2.0 if lift >= 0 else middle + 2.0
        painter.fillRect(QRectF(round((x0 + x1 - HAND_PX) / 2), round(top), HAND_PX, HAND_PX), colour)


def _path() -> QPainterPath:
    path = QPainterPath()
    path.setFillRule(Qt.FillRule.WindingFill)
    return path


def _slur(x0: float, y0: float, x1: float, y1: float, lift: float) -> QPainterPath:
    """Return the outline of a slur: thin at its ends, thicker in the middle."""
    path = _path()
    width, rise = x1 - x0, (y1 - y0) * STEEPNESS
    thin, thick = SLUR_PX
    # A control point at 4/3 of the height raises the middle by 1.
    up = lift * 4 / 3
    # Keeps the thickness where the curve is steep.
    more = (thick - thin) * 2 / 3 * min(hypot(1.0, (y1 - y0) / max(width, 1.0)), 3.0)
    left, right = x0 + width * STEEPNESS, x1 - width * STEEPNESS
    path.moveTo(x0, y0 - thin / 2)
    path.cubicTo(left, y0 + rise - up - more, right, y1 - rise - up - more, x1, y1 - thin / 2)
    path.lineTo(x1, y1 + thin / 2)
    path.cubicTo(right, y1 - rise - up + more, left, y0 + rise - up + more, x0, y0 + thin / 2)
    path.closeSubpath()
    return path


def _thick(points: list[tuple[float, float]], half: float = 0.7) -> QPainterPath:
    """Return the outline of a line through points (x, y), ``half`` pixels wide to both sides."""
    path = _path()
    for (x0, y0), (x1, y1) in pairwise(points):
        length = max(hypot(x1 - x0, y1 - y0), 1e-6)
        dx, dy = -(y1 - y0) / length * half, (x1 - x0) / length * half
        path.moveTo(x0 + dx, y0 + dy)
        path.lineTo(x1 + dx, y1 + dy)
        path.lineTo(x1 - dx, y1 - dy)
        path.lineTo(x0 - dx, y0 - dy)
        path.closeSubpath()
    return path


def _bracket(x0: float, y0: float, x1: float, y1: float, lift: float) -> QPainterPath:
    """Return a dashed line over notes that are tongued one by one, with a hook at each end; ``lift`` is its height
    above the notes in pixels, negative if below."""
    hook = 4.0 if lift >= 0 else -4.0
    path = _thick([(x0, y0 - lift + hook), (x0, y0 - lift)])
    count = max(int((x1 - x0) // 7), 1)
    for number in range(count):
        shares = number / count, (number + 0.6) / count
        path.addPath(_thick([(x0 + (x1 - x0) * s, y0 + (y1 - y0) * s - lift) for s in shares]))
    path.addPath(_thick([(x1, y1 - lift), (x1, y1 - lift + hook)]))
    return path
