"""Drawing of holes and keys as in fingering charts of method books, in all sizes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen

from instrument_maps.key_chart import COLUMN, HOLE, PAD, ChartedKey, KeyChart, is_half

TICK_PX = 3.0
"""Width of a key in pixels if there is no more room."""
LEAST_SIGN_PX = 9.0
"""Height in pixels of a key from which its sign is drawn."""


@dataclass(frozen=True)
class ChartPlace:
    """Position and scale of a fingering chart in a drawing.

    Attributes
    ----------
    middle_px, top_px : float
        x of the middle of the column of holes, and y of the position 0 of the chart.
    hole_px : float
        Distance between neighbouring holes in pixels.
    squeeze : float
        Width of the parts beside the column relative to the scale of the height; 0 for ticks.
    """

    middle_px: float
    top_px: float
    hole_px: float
    squeeze: float = 1.0

    def box(self, key: ChartedKey) -> QRectF:
        """Return the rectangle of a key in pixels."""
        y = self.top_px + key.y * self.hole_px
        size = HOLE * self.hole_px
        if abs(key.x) < COLUMN:
            return QRectF(self.middle_px + key.x * self.hole_px - size / 2.0, y - size / 2.0, size, size)
        beside, side = size / 2.0, 1.0 if key.x > 0.0 else -1.0
        wide, tall = max(PAD[0] * self.hole_px * self.squeeze, TICK_PX), PAD[1] * self.hole_px
        if self.squeeze == 1.0:
            middle = self.middle_px + key.x * self.hole_px
        else:
            number = max(round(abs(key.x) - 1.0), 0)
            middle = self.middle_px + side * (beside + 1.5 + wide / 2.0 + number * (wide + 1.0))
        if key.is_round:
            wide = tall = size if self.squeeze == 1.0 else min(max(wide, TICK_PX), size)
        return QRectF(middle - wide / 2.0, y - tall / 2.0, wide, tall)


@dataclass(frozen=True)
class ChartColours:
    """Colours of a fingering chart: closed parts, outlines and background of open ones, and signs on both."""

    closed: QColor
    line: QColor
    ground: QColor
    on_closed: QColor
    on_ground: QColor


def chart_size(chart: KeyChart, hole_px: float) -> QSizeF:
    """Return width and height in pixels of a whole key chart, if holes are ``hole_px`` wide."""
    left, right = chart_sides(chart, ChartPlace(0.0, 0.0, hole_px))
    return QSizeF(left + right, (chart.bottom - chart.top) * hole_px)


def chart_sides(chart: KeyChart, place: ChartPlace, values: Mapping[str, float] | None = None) -> tuple[float, float]:
    """Return the extents of a chart to the left and right of the middle of its column, in pixels. With ``values``,
    those of the parts that are drawn if only pressed keys are shown.
    """
    boxes = [place.box(key) for key in chart.keys if values is None or _is_drawn(key, values)]
    return (
        max((place.middle_px - box.left() for box in boxes), default=0.0),
        max((box.right() - place.middle_px for box in boxes), default=0.0),
    )


def draw_chart(
    painter: QPainter,
    chart: KeyChart,
    values: Mapping[str, float],
    place: ChartPlace,
    colours: ChartColours,
    *,
    whole: bool = True,
) -> None:
    """Draw a fingering.

    Parameters
    ----------
    values : mapping
        Values 0..1 by control; missing controls are open.
    whole : bool
        Whether to draw keys beside the column that are not pressed.
    """
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    metrics = QFontMetricsF(painter.font())
    between = chart.between_hands
    if between is not None:
        y, half_px = place.top_px + between * place.hole_px, HOLE / 2.0 * place.hole_px
        painter.setPen(QPen(colours.line, 1.0))
        painter.drawLine(QPointF(place.middle_px - half_px, y), QPointF(place.middle_px + half_px, y))
    for key in chart.keys:
        if whole or _is_drawn(key, values):
            _draw_key(painter, key, values.get(key.control.name, 0.0), place.box(key), colours, metrics)


def _is_drawn(key: ChartedKey, values: Mapping[str, float]) -> bool:
    return key.is_always_shown or values.get(key.control.name, 0.0) > 0.0


def _draw_key(
    painter: QPainter, key: ChartedKey, value: float, box: QRectF, colours: ChartColours, metrics: QFontMetricsF
) -> None:
    half, closed = is_half(key.control, value), value > 0.0
    line_px = 1.0 if box.height() < 2 * LEAST_SIGN_PX else 1.5
    box = box.adjusted(line_px / 2, line_px / 2, -line_px / 2, -line_px / 2)
    painter.setPen(QPen(colours.closed if closed else colours.line, line_px))
    painter.setBrush(colours.closed if closed and not half else colours.ground)
    radius = box.width() / 2.0 if key.is_round else min(box.width(), box.height()) * 0.3
    painter.drawRoundedRect(box, radius, radius)
    if half:
        # The upper half of a half-covered hole is drawn open.
        painter.setBrush(colours.closed)
        painter.drawChord(box, 180 * 16, 180 * 16)
    if box.height() >= LEAST_SIGN_PX and key.sign and metrics.horizontalAdvance(key.sign) <= box.width() + 2.0:
        painter.setPen(colours.on_closed if closed and not half else colours.on_ground)
        painter.drawText(box.adjusted(-2, -4, 2, 4), Qt.AlignmentFlag.AlignCenter, key.sign)
