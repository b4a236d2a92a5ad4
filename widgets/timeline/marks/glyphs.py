"""Outlines of the marks at notes, in the units of `widgets.timeline.model.marks.mark_looks`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Final

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainterPath, QPainterPathStroker, QPolygonF, QTransform

from widgets.timeline.model.marks.mark_looks import LOOKS

LINE = 0.32
"""Width of a pen."""
FINE = 24.0
"""Factor by which glyphs are enlarged before Qt flattens their curves, which is exact to a quarter of a pixel."""
Point = tuple[float, float]


def _dots(count: int) -> QPainterPath:
    path = QPainterPath()
    for number in range(count):
        path.addEllipse(QPointF(number - (count - 1) / 2, -0.42), 0.42, 0.42)
    return path


def _filled(*corners: Point) -> QPainterPath:
    path = QPainterPath()
    path.addPolygon(QPolygonF([QPointF(*corner) for corner in corners]))
    path.closeSubpath()
    return path


def _lines(*lines: tuple[Point, ...], width: float = LINE) -> QPainterPath:
    """Return the outline of polylines, each given by its points; ``width`` of the pen in staff spaces."""
    path = QPainterPath()
    for line in lines:
        path.moveTo(*line[0])
        for point in line[1:]:
            path.lineTo(*point)
    return _stroked(path, width)


def _curve(start: Point, *points: Point, width: float = LINE) -> QPainterPath:
    """Return the outline of a pen stroke along joined cubic Bezier curves: ``start``, then three points for each curve;
    ``width`` in staff spaces.
    """
    path = QPainterPath(QPointF(*start))
    for at in range(0, len(points), 3):
        path.cubicTo(*(QPointF(*point) for point in points[at : at + 3]))
    return _stroked(path, width)


def _stroked(path: QPainterPath, width: float) -> QPainterPath:
    pen = QPainterPathStroker()
    pen.setWidth(width * FINE)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return _scaled(pen.createStroke(_scaled(path, FINE)), 1 / FINE)


def _scaled(path: QPainterPath, factor: float) -> QPainterPath:
    return QTransform.fromScale(factor, factor).map(path)


def _breath() -> QPainterPath:
    """Return a comma: a head with a tail to the lower left."""
    path = QPainterPath(QPointF(-0.45, -1.5))
    path.cubicTo(QPointF(-0.45, -2.05), QPointF(0.5, -2.1), QPointF(0.5, -1.3))
    path.cubicTo(QPointF(0.5, -0.7), QPointF(0.15, -0.3), QPointF(-0.35, 0.0))
    path.cubicTo(QPointF(-0.05, -0.4), QPointF(0.05, -0.7), QPointF(0.0, -0.95))
    path.cubicTo(QPointF(-0.25, -0.9), QPointF(-0.45, -1.15), QPointF(-0.45, -1.5))
    return path


def _fermata() -> QPainterPath:
    path = QPainterPath(QPointF(-1.6, 0.0))
    path.cubicTo(QPointF(-1.5, -2.5), QPointF(1.5, -2.5), QPointF(1.6, 0.0))
    path.cubicTo(QPointF(1.2, -1.85), QPointF(-1.2, -1.85), QPointF(-1.6, 0.0))
    path.addEllipse(QPointF(0.0, -0.36), 0.36, 0.36)
    return path


def _mordent() -> QPainterPath:
    """Return a zigzag with a vertical line."""
    zigzag = _lines(((-1.5, -0.4), (-0.9, -1.0), (-0.3, -0.4), (0.3, -1.0), (0.9, -0.4), (1.5, -1.0)), width=0.42)
    zigzag.addPath(_lines(((0.0, -1.4), (0.0, 0.0)), width=0.26))
    return zigzag


def _turn() -> QPainterPath:
    return _curve(
        (-1.0, -0.45), (-1.6, -0.45), (-1.5, -1.25), (-0.9, -1.25), (-0.3, -1.25), (0.3, -0.3), (0.9, -0.3),
        (1.5, -0.3), (1.6, -1.1), (1.0, -1.1), width=0.36,
    )  # fmt: skip


def _strokes(count: int) -> QPainterPath:
    """Return the outline of ``count`` strokes of a tremolo, one below the other."""
    path = QPainterPath()
    for number in range(count):
        y = -0.35 - 0.62 * number
        path.addPath(_filled((-0.9, y + 0.25), (0.9, y - 0.25), (0.9, y + 0.1), (-0.9, y + 0.6)))
    return path


def _trill() -> QPainterPath:
    """Return the outline of the letters "tr" of a trill."""
    t = _curve((-0.75, -2.1), (-1.05, -1.2), (-1.35, 0.05), (-0.75, 0.0), (-0.5, -0.02), (-0.3, -0.25), (-0.25, -0.4))
    t.addPath(_lines(((-1.25, -1.35), (-0.2, -1.45)), width=0.28))
    t.addPath(_lines(((0.15, -1.4), (0.05, -0.05))))
    t.addPath(_curve((0.1, -0.8), (0.3, -1.4), (0.7, -1.5), (1.05, -1.3)))
    return t


def _grace() -> QPainterPath:
    """Return a small eighth note with a slash."""
    note = QPainterPath()
    note.addEllipse(QPointF(-0.35, -0.4), 0.5, 0.38)
    note.addPath(_lines(((0.1, -0.45), (0.1, -2.6)), width=0.22))
    note.addPath(_curve((0.1, -2.6), (0.2, -2.0), (0.9, -1.8), (0.6, -1.1), width=0.24))
    note.addPath(_lines(((-0.7, -1.2), (0.9, -2.2)), width=0.2))
    return note


def _ring() -> QPainterPath:
    ring = QPainterPath()
    ring.addEllipse(QPointF(0.0, -0.75), 0.6, 0.6)
    return _stroked(ring, LINE)


_OUTLINES: Final[Mapping[str, Callable[[], QPainterPath]]] = {
    "staccato": lambda: _dots(1),
    "double_tongue": lambda: _dots(2),
    "triple_tongue": lambda: _dots(3),
    "staccatissimo": lambda: _filled((-0.42, -1.6), (0.42, -1.6), (0.0, 0.0)),
    "tenuto": lambda: _filled((-1.0, -0.42), (1.0, -0.42), (1.0, -0.05), (-1.0, -0.05)),
    "accent": lambda: _lines(((-1.0, -1.35), (1.0, -0.75), (-1.0, -0.15))),
    "marcato": lambda: _lines(((-0.75, -0.1), (0.0, -1.8), (0.75, -0.1)), width=0.36),
    "tremolo": lambda: _strokes(2),
    "flutter_tongue": lambda: _strokes(3),
    "grace": _grace,
    "stopped": lambda: _lines(((-0.75, -0.85), (0.75, -0.85)), ((0.0, -1.6), (0.0, -0.1))),
    "open": _ring,
    "mordent": _mordent,
    "turn": _turn,
    "trill": _trill,
    "fermata": _fermata,
    "breath": _breath,
    "caesura": lambda: _lines(((-0.85, 0.0), (0.1, -2.2)), ((-0.05, 0.0), (0.9, -2.2)), width=0.28),
    "fall": lambda: _curve((0.1, 0.0), (1.2, 0.0), (2.2, 0.7), (2.9, 2.3)),
    "doit": lambda: _curve((0.1, 0.0), (1.2, 0.0), (2.2, -0.7), (2.9, -2.3)),
    "scoop": lambda: _curve((-2.3, 1.9), (-1.9, 0.9), (-1.2, 0.1), (-0.1, 0.0)),
    "plop": lambda: _curve((-2.3, -2.3), (-1.9, -0.9), (-1.2, -0.1), (-0.1, 0.0)),
}


@lru_cache(maxsize=64)
def glyph_path(kind: str, unit_px: float, text: str = "") -> QPainterPath:
    """Return the outline of a mark of a kind around its position, or an empty path if the mark is text or a line to a
    note.
    """
    if kind == "tremolo" and text.isdecimal():
        path = _strokes(min(max(int(text), 1), 4))
    elif LOOKS[kind].is_text or LOOKS[kind].place == "next":
        return QPainterPath()
    else:
        path = _OUTLINES[kind]()
    path.setFillRule(Qt.FillRule.WindingFill)
    return _scaled(_scaled(path, FINE).simplified(), unit_px / FINE)


def wave_path(left: float, right: float, y: float, unit_px: float) -> QPainterPath:
    """Return the wavy line of a trill, centred at a height."""
    path = QPainterPath(QPointF(left, y))
    x, up, step = left, True, 0.9 * unit_px
    while x + step <= right:
        path.quadTo(QPointF(x + step / 2, y + (-0.9 if up else 0.9) * unit_px * 0.7), QPointF(x + step, y))
        x, up = x + step, not up
    return _stroked(path, LINE * unit_px)
