"""Draws cues, facial expressions, poses and gestures in the acting lane."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from app.arrays import FloatArray
from widgets.timeline.model.regions.acting_regions import BASE
from widgets.timeline.model.regions.shown_event import Region
from widgets.timeline.model.regions.shown_regions import HANDLE_PX
from widgets.timeline.plot.drawing import draw_columns, draw_path, draw_text, polygon, shade
from widgets.timeline.plot.plot import LaneView

LEAST_SHAPE_PX = 6.0
"""Width in pixels below which an event is drawn as a bar, since its fades are invisible."""


class ActingView(LaneView, Protocol):
    """Part of the acting lane needed for drawing; a protocol, since the lane imports this module."""

    def fade_handles(self, region: Region, box: QRectF) -> tuple[tuple[str, QPointF], ...]: ...


class ActingPainter:
    """Draws cues, expressions, poses and gestures in their rectangles of the acting lane."""

    def __init__(self, lane: ActingView) -> None:
        self._lane = lane

    def paint_sway(self, painter: QPainter, x0: FloatArray, x1: FloatArray, y: FloatArray, colour: QColor) -> None:
        """Draw sway as a wave that is flat where the direction changes."""
        if not len(x0):
            return
        if len(x0) > self._lane.plot_rect.width() / 3:
            draw_columns(painter, self._lane.plot_rect, x0, x1, y, None, colour)
            return
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        before = np.concatenate((y[:1], y[:-1]))
        steps = 1 if np.median(x1 - x0) < 6.0 else 10
        share = np.arange(1, steps + 1) / steps
        eased = 0.5 - 0.5 * np.cos(np.pi * share) if steps > 1 else share
        x = (x0[:, None] + (x1 - x0)[:, None] * share).ravel()
        points = np.stack((x, (before[:, None] + (y - before)[:, None] * eased).ravel()), axis=1)
        draw_path(painter, points, QPen(colour, 1.2))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def paint_cue(self, painter: QPainter, region: Region, box: QRectF, colour: str, room_px: float) -> None:
        """Draw a cue as a triangle with the tip on the beat, and its name if there is space."""
        tokens = self._lane.session.tokens
        peak = min(max(self._lane.axis.x_px(region.peak_s), box.left()), box.right())
        outline = [(box.left(), box.bottom()), (peak, box.top() + 2.0), (box.right(), box.bottom())]
        painter.setPen(QPen(QColor(colour), 1.4, Qt.PenStyle.DotLine if region.guest else Qt.PenStyle.SolidLine))
        painter.setBrush(Qt.BrushStyle.NoBrush if region.guest else QColor(shade(colour, 90)))
        painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in outline]))
        painter.drawLine(QPointF(box.right(), box.top()), QPointF(box.right(), box.bottom()))
        if box.width() < LEAST_SHAPE_PX:
            return
        painter.setPen(QColor(tokens.text_dim if region.guest else tokens.text))
        draw_text(painter, QRectF(box.right() + 4.0, box.top(), min(room_px, 130.0), box.height()), region.label)

    def paint_varied(self, painter: QPainter, region: Region, box: QRectF, colour: str, selected: bool) -> None:
        """Draw an event as a trapezoid with its strength as height and its fades as slopes."""
        painter.setPen(QPen(QColor(colour), 1.6 if selected else 1.0))
        painter.setBrush(shade(colour, 110 if selected else 60))
        painter.drawRoundedRect(box.adjusted(0.5, 0.5, -0.5, -0.5), 2.0, 2.0)
        painter.setPen(QColor(self._lane.session.tokens.text))
        inside = QRectF(QPointF(max(box.left(), 0.0), box.top()), box.bottomRight())
        draw_text(painter, inside.adjusted(10.0, 0.0, -4.0, 0.0), region.label)

    def paint_bar(self, painter: QPainter, region: Region, box: QRectF, colour: str, selected: bool) -> None:
        """Draw an event as a bar up or down from the middle of the row, by its amount."""
        middle = box.center().y()
        end = middle - region.amount * (box.height() / 2 - 1.0)
        bar = QRectF(QPointF(box.left(), min(middle, end)), QPointF(box.right() - 1.0, max(middle, end)))
        painter.setPen(QPen(QColor(colour), 1.0))
        painter.setBrush(shade(colour, 60 if region.kind == "sway" else 120))
        painter.drawRect(bar)
        if selected:
            painter.setPen(QPen(QColor(colour), 1.0, Qt.PenStyle.DotLine))
            painter.setBrush(shade(colour, 26))
            painter.drawRect(box.adjusted(0.5, 0.5, -0.5, -0.5))
        if box.width() > 46.0:
            painter.setPen(QColor(self._lane.session.tokens.text))
            draw_text(painter, box.adjusted(10.0, 0.0, -2.0, 0.0), f"{region.amount:+.2f}".replace("-", "−"))

    def paint_span(self, painter: QPainter, region: Region, box: QRectF, colour: str, selected: bool) -> None:
        """Draw an event as a trapezoid as high as its amount, with its fades as slopes."""
        tokens, scale = self._lane.session.tokens, self._lane.axis.px_per_s
        if box.width() < LEAST_SHAPE_PX:
            top = box.bottom() - max(box.height() * abs(region.amount), 3.0)
            painter.fillRect(QRectF(QPointF(box.left(), top), box.bottomRight()), shade(colour, 140))
            return
        if region.event_id == BASE:
            painter.fillRect(box.adjusted(0.0, 1.0, 0.0, 0.0), shade(colour, 190 if selected else 60))
            return
        left, right = box.left(), box.right()
        if region.fades_outside:
            left, right = left - region.fade_in_s * scale, right + region.fade_out_s * scale
        fade_in = min(region.fade_in_s * scale, right - left)
        fade_out = min(region.fade_out_s * scale, right - left - fade_in)
        top = box.bottom() - max(box.height() * abs(region.amount), 3.0)
        corners = np.array(
            [(left, box.bottom()), (left + fade_in, top), (right - fade_out, top), (right, box.bottom())]
        )
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(shade(colour, 34))
        painter.drawRoundedRect(box, 3.0, 3.0)
        painter.setPen(QPen(QColor(colour), 1.6 if selected else 1.0))
        painter.setBrush(shade(colour, 130 if selected or region.by_hand else 85))
        painter.drawPolygon(polygon(corners))
        if selected and region.fades:
            painter.setBrush(QColor(tokens.surface))
            for _, handle in self._lane.fade_handles(region, box):
                painter.drawEllipse(handle, HANDLE_PX - 1.0, HANDLE_PX - 1.0)
        painter.setPen(QColor(tokens.text))
        number = "" if region.steady or region.amount >= 1.0 else f" {region.amount:.2f}".replace("-", "−")
        indent = 10.0 if region.by_hand else 5.0
        # The name of a region that begins before the left edge stays visible.
        inside = QRectF(QPointF(max(box.left(), 0.0), box.top()), box.bottomRight())
        draw_text(painter, inside.adjusted(indent, 0.0, -4.0, 0.0), region.label + number)
