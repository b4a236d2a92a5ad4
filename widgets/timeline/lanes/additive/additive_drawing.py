"""Draws additive animation curves in their lane."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.arrays import FloatArray
from app.plan.by_hand.additive_curve import Interpolation
from widgets.common.channel_names import value_text
from widgets.timeline.model.additive.additive_curves import KeyRef, ShownCurve
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.plot.drawing import MARK_PX, draw_path, draw_text, polygon, shade, small_font
from widgets.timeline.plot.plot import LaneItem, LaneView

KEY_PX = 4.5
HANDLE_PX = 3.0
BLEND_PX = 6.0
LABEL_PX, SCALE_PX = 90.0, 48.0


class AdditiveLaneView(LaneView, Protocol):
    """Part of the additive lane needed for drawing; a protocol, since the lane imports this module."""

    curves: tuple[ShownCurve, ...]
    channel: str
    selected: frozenset[KeyRef]
    limits: tuple[float, float]
    generated: tuple[FloatArray, FloatArray] | None

    @property
    def band(self) -> PixelRect | None: ...
    @property
    def chosen_curves(self) -> frozenset[str]: ...
    def empty_text(self) -> str: ...


class CurvesItem(LaneItem[AdditiveLaneView]):
    """Draws the generated values faintly, and in front of them the additive curves with keys and handles."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane, player = self.lane, self.lane.session.player
        if player is None:
            return
        tokens = lane.session.tokens
        painter.setFont(small_font(lane.font()))
        self._paint_limits(painter, exposed)
        zero = round(lane.y_px(0.0)) + 0.5
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(QPointF(exposed.left(), zero), QPointF(exposed.right(), zero))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        if lane.generated is not None:
            self._paint_generated(painter, exposed, *lane.generated)
        colour = lane.session.colour(player)
        for shown in lane.curves:
            self._paint_curve(painter, exposed, shown, colour)
        for shown in lane.curves:
            self._paint_keys(painter, shown, colour)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        self._paint_scale(painter)
        if not lane.curves:
            painter.setPen(QColor(tokens.text_dim))
            draw_text(painter, lane.plot_rect.adjusted(LABEL_PX, 2.0, -8.0, 0.0), lane.empty_text(), _TOP_LEFT)
        if lane.band is not None:
            painter.setPen(QPen(QColor(tokens.accent), 1.0))
            painter.setBrush(shade(tokens.accent, 30))
            painter.drawRect(QRectF(lane.band.left, lane.band.top, lane.band.width, lane.band.height))

    def _paint_limits(self, painter: QPainter, exposed: QRectF) -> None:
        """Shade the part of the plot with values beyond the body's range."""
        low, high = self.lane.limits
        ground = shade(self.lane.session.tokens.line, 90)
        top, bottom = self.lane.y_px(high), self.lane.y_px(low)
        if top > 0.0:
            painter.fillRect(QRectF(exposed.left(), 0.0, exposed.width(), top), ground)
        if bottom < exposed.bottom():
            painter.fillRect(QRectF(exposed.left(), bottom, exposed.width(), exposed.bottom() - bottom), ground)

    def _paint_generated(self, painter: QPainter, exposed: QRectF, times_s: FloatArray, values: FloatArray) -> None:
        axis = self.lane.axis
        x = np.arange(np.floor(exposed.left()), np.ceil(exposed.right()) + 1.0)
        at_s = axis.seconds(0.0) + x / axis.px_per_s
        y = np.interp(at_s, times_s, values, left=np.nan, right=np.nan)
        pen = QPen(shade(self.lane.session.tokens.text_dim, 130), 1.0)
        draw_path(painter, np.stack((x, self._y(y)), axis=1), pen)

    def _paint_curve(self, painter: QPainter, exposed: QRectF, shown: ShownCurve, colour: str) -> None:
        lane, axis, curve = self.lane, self.lane.axis, shown.curve
        left = max(float(np.floor(exposed.left())), axis.x_px(shown.start_s))
        right = min(float(np.ceil(exposed.right())), axis.x_px(shown.end_s))
        if right <= left:
            return
        x = np.append(np.arange(left, right, 0.5), right)
        values = shown.values(axis.seconds(0.0) + x / axis.px_per_s)
        tone = lane.session.tokens.accent if curve.name in lane.chosen_curves else colour
        pen = QPen(shade(tone), 1.8)
        if not curve.enabled:
            pen = QPen(shade(tone, 150), 1.6, Qt.PenStyle.DotLine)
        elif curve.weight < 1.0:
            self._paint_line(painter, x, curve.weight * values, pen)
            pen = QPen(shade(tone, 170), 1.4, Qt.PenStyle.DashLine)
        self._paint_line(painter, x, values, pen)
        self._paint_beyond(painter, shown, x)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(shade(tone, 220))
        zero = lane.y_px(0.0)
        for time_s, sign in ((shown.start_s, 1.0), (shown.end_s, -1.0)):
            at = axis.x_px(time_s)
            painter.drawPolygon(
                [QPointF(at, zero - BLEND_PX), QPointF(at + sign * BLEND_PX, zero), QPointF(at, zero + BLEND_PX)]
            )
        if curve.title:
            painter.setPen(QColor(lane.session.tokens.text_dim))
            begins = max(left, SCALE_PX) + 2.0
            draw_text(painter, QRectF(begins, 1.0, right - begins, 14.0), curve.title)

    def _paint_beyond(self, painter: QPainter, shown: ShownCurve, x: FloatArray) -> None:
        """Mark spans of a curve beyond the body's range in the colour of problems, with a sign at the start."""
        lane, axis, warning = self.lane, self.lane.axis, QColor(self.lane.session.tokens.warning)
        for start_s, end_s in shown.beyond_s(lane.limits):
            left, right = axis.x_px(start_s), axis.x_px(end_s)
            here = x[(x >= left) & (x <= right)]
            if not len(here):
                continue
            values = shown.curve.weight * shown.values(axis.seconds(0.0) + here / axis.px_per_s)
            self._paint_line(painter, here, values, QPen(warning, 2.6))
            half = MARK_PX / 2.0
            at = min(max(float(self._y(values[:1])[0]), half + 1.0), lane.plot_rect.height() - half - 1.0)
            painter.setPen(QPen(warning, 1.2))
            painter.setBrush(warning)
            corners = ((0.0, -half), (half, half), (-half, half))
            painter.drawPolygon([QPointF(left + dx, at + dy) for dx, dy in corners])

    def _paint_line(self, painter: QPainter, x: FloatArray, values: FloatArray, pen: QPen) -> None:
        """Draw a curve through values (N,) at x positions (N,) in pixels; dashes continue along the whole line."""
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(polygon(np.stack((x, self._y(values)), axis=1)))

    def _paint_keys(self, painter: QPainter, shown: ShownCurve, colour: str) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        room = lane.plot_rect.adjusted(-8.0, -8.0, 8.0, 8.0)
        for at, key in enumerate(shown.curve.keys):
            place = QPointF(lane.axis.x_px(float(shown.key_s[at])), lane.y_px(key.value))
            selected = KeyRef(shown.curve.name, key.tick) in lane.selected
            if selected:
                self._paint_handles(painter, shown, at, place)
            if not room.contains(place):
                continue
            painter.setPen(QPen(QColor(tokens.accent if selected else colour), 1.6))
            painter.setBrush(QColor(tokens.accent if selected else tokens.sunken))
            _paint_key(painter, place, key.interpolation)
            if selected and len(lane.selected) == 1:
                painter.setPen(QColor(tokens.text))
                over = place.y() - 19.0 if place.y() > 22.0 else place.y() + 6.0
                left = min(place.x() + 8.0, lane.plot_rect.width() - LABEL_PX)
                draw_text(painter, QRectF(left, over, LABEL_PX, 14.0), value_text(lane.channel, key.value))

    def _paint_handles(self, painter: QPainter, shown: ShownCurve, at: int, place: QPointF) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        for _, time_s, value in shown.handles(at):
            end = QPointF(lane.axis.x_px(time_s), lane.y_px(value))
            painter.setPen(QPen(QColor(tokens.text), 1.0))
            painter.drawLine(place, end)
            painter.setBrush(QColor(tokens.text))
            painter.drawEllipse(end, HANDLE_PX, HANDLE_PX)

    def _paint_scale(self, painter: QPainter) -> None:
        """Write the values at the upper and the lower edge of the plot."""
        lane, room = self.lane, self.lane.plot_rect
        bottom, top = lane.y_range
        painter.setPen(QColor(lane.session.tokens.text_dim))
        for value, y, align in ((top, 1.0, _TOP_LEFT), (bottom, room.height() - 15.0, _BOTTOM_LEFT)):
            sign = "+" if value > 0 else ""
            draw_text(painter, QRectF(3.0, y, LABEL_PX, 14.0), sign + value_text(lane.channel, value), align)

    def _y(self, values: FloatArray) -> FloatArray:
        bottom, top = self.lane.y_range
        result: FloatArray = (top - values) / (top - bottom) * self.lane.plot_rect.height()
        return result


def _paint_key(painter: QPainter, place: QPointF, interpolation: Interpolation) -> None:
    """Draw a key as a circle, a diamond or a square, by its interpolation."""
    if interpolation == "constant":
        painter.drawRect(QRectF(place.x() - 3.8, place.y() - 3.8, 7.6, 7.6))
    elif interpolation == "linear":
        painter.drawPolygon([place + QPointF(*step) for step in ((0.0, -5.2), (5.2, 0.0), (0.0, 5.2), (-5.2, 0.0))])
    else:
        painter.drawEllipse(place, KEY_PX, KEY_PX)


_TOP_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop
_BOTTOM_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom
