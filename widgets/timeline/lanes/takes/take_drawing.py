"""Drawing of the takes lane: the comp in a strip above, and a row for each take."""

from __future__ import annotations

from typing import Final, Protocol

import numpy as np
from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.arrays import FloatArray
from app.project.model import CompSpan
from widgets.timeline.model.takes.shown_takes import TakesModel
from widgets.timeline.model.takes.take_rows import TakeRow, owners
from widgets.timeline.plot.drawing import draw_lines, draw_rects, draw_text, shade, small_font
from widgets.timeline.plot.plot import LaneItem, LaneView

STRIP_PX: Final = 26.0
"""Height of the strip of the comp, next to the lane's title."""
MARGIN_PX: Final = 3.0
LEAST_NOTE_PX: Final = 2.0
PALE: Final = 95
"""Opacity of spans that are not used in the part."""


class TakesView(LaneView, Protocol):
    """Part of a takes lane needed for drawing; a protocol, since the lane imports this module."""

    model: TakesModel

    @property
    def rows_rect(self) -> QRectF: ...
    def row_rect(self, number: int) -> QRectF: ...
    def empty_text(self) -> str: ...


class TakesItem(LaneItem[TakesView]):
    """Draws the rows of all takes: notes, used spans, breath, and notes that cleaning omits."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        painter.setFont(small_font(lane.font()))
        if not lane.model.rows:
            self._paint_empty(painter)
            return
        painter.save()
        painter.setClipRect(exposed.intersected(lane.rows_rect))
        for number, row in enumerate(lane.model.rows):
            box = lane.row_rect(number)
            if box.intersects(exposed):
                self._paint_row(painter, row, box, exposed)
        self._paint_selected(painter)
        painter.restore()
        self._paint_strip(painter, exposed)

    def _paint_empty(self, painter: QPainter) -> None:
        lane = self.lane
        painter.setPen(QColor(lane.session.tokens.text_dim))
        box = lane.plot_rect.adjusted(14.0, 0.0, -14.0, 0.0)
        painter.drawText(box, Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextWordWrap, lane.empty_text())

    def _boxes(self, spans: tuple[CompSpan, ...], top: float, height: float) -> list[tuple[CompSpan, QRectF]]:
        """Return the rectangles of those spans of the comp that are visible on the time axis."""
        axis, clock = self.lane.axis, self.lane.session.project.score.tempo_map
        found = []
        for span in spans:
            left, right = (
                axis.x_px(clock.seconds(float(span.start_tick))),
                axis.x_px(clock.seconds(float(span.end_tick))),
            )
            left, right = max(left, -10.0), min(right, axis.width_px + 10.0)
            if right > left:
                found.append((span, QRectF(left, top, right - left, height)))
        return found

    def _paint_strip(self, painter: QPainter, exposed: QRectF) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        strip = QRectF(exposed.left(), 0.0, exposed.width(), STRIP_PX)
        painter.fillRect(strip, QColor(tokens.surface))
        painter.setPen(QPen(QColor(tokens.line), 1.0))
        painter.drawLine(strip.bottomLeft(), strip.bottomRight())
        names = {row.take_id: row.take.name for row in lane.model.rows if row.take is not None}
        for span, box in self._boxes(lane.model.shown_comp(), 3.0, STRIP_PX - 6.0):
            colour = lane.model.colour_of(span.take_id)
            inner = box.adjusted(0.5, 0.0, -0.5, 0.0)
            painter.fillRect(inner, shade(colour, 70))
            painter.fillRect(QRectF(inner.left(), inner.bottom() - 2.0, inner.width(), 2.0), QColor(colour))
            painter.setPen(QColor(tokens.text))
            shown = inner.adjusted(5.0, 0.0, -3.0, -1.0)
            draw_text(
                painter,
                QRectF(max(shown.left(), 4.0), shown.top(), shown.right() - max(shown.left(), 4.0), shown.height()),
                names.get(span.take_id, ""),
            )

    def _paint_row(self, painter: QPainter, row: TakeRow, box: QRectF, exposed: QRectF) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        colour = lane.model.colour_of(row.take_id)
        if lane.session.selection.take == row.take_id:
            painter.fillRect(QRectF(exposed.left(), box.top(), exposed.width(), box.height()), shade(tokens.accent, 22))
        taken = lane.model.shown_spans(row.take_id)
        painter.save()
        for _, span_box in self._boxes(taken, box.top(), box.height()):
            painter.fillRect(span_box, shade(colour, 46))
        painter.restore()
        if row.breath is not None:
            self._paint_breath(painter, row, box, exposed, shade(tokens.text_dim, 60))
        self._paint_notes(painter, row, box, exposed, taken, colour)
        self._paint_left_out(painter, row, box, exposed)
        painter.setPen(QPen(QColor(tokens.line), 1.0))
        bottom = round(box.bottom()) - 0.5
        painter.drawLine(QLineF(exposed.left(), bottom, exposed.right(), bottom))

    def _paint_breath(self, painter: QPainter, row: TakeRow, box: QRectF, exposed: QRectF, colour: QColor) -> None:
        assert row.breath is not None
        axis = self.lane.axis
        left, right = int(exposed.left()), int(np.ceil(exposed.right()))
        _, high = row.breath.columns(axis.seconds(left), axis.seconds(right), right - left)
        x = np.arange(left, right, dtype=np.float64) + 0.5
        shown = high > 0.0
        tops = box.bottom() - 1.0 - high * (box.height() - 2 * MARGIN_PX)
        bottoms = np.full(int(shown.sum()), box.bottom() - 1.0)
        draw_lines(painter, x[shown], tops[shown], x[shown], bottoms, QPen(colour, 1.0))

    def _paint_notes(
        self, painter: QPainter, row: TakeRow, box: QRectF, exposed: QRectF, taken: tuple[CompSpan, ...], colour: str
    ) -> None:
        axis = self.lane.axis
        shown = row.kept.between(axis.seconds(exposed.left()), axis.seconds(exposed.right()))
        left, right = axis.x_px(row.kept.start_s[shown]), axis.x_px(row.kept.end_s[shown])
        top, height = self._pitch_px(row.pitches[shown].astype(np.float64), box)
        inside = owners(taken, row.onset_ticks[shown]) >= 0
        for picked, fill in ((~inside, shade(colour, PALE)), (inside, QColor(colour))):
            heights = np.full(int(picked.sum()), height)
            draw_rects(painter, left[picked], top[picked], np.maximum(right - left - 0.5, 1.0)[picked], heights, fill)

    def _paint_left_out(self, painter: QPainter, row: TakeRow, box: QRectF, exposed: QRectF) -> None:
        """Draw the notes that cleaning leaves out of a take, hollow and struck through."""
        axis = self.lane.axis
        shown = row.left_out.between(axis.seconds(exposed.left()), axis.seconds(exposed.right()))
        if not len(shown):
            return
        left, right = axis.x_px(row.left_out.start_s[shown]), axis.x_px(row.left_out.end_s[shown])
        right = np.maximum(right, left + 3.0)
        top, height = self._pitch_px(row.left_out_pitches[shown].astype(np.float64), box)
        top, bottom = top - 1.0, top + height + 1.0
        pen = QPen(QColor(self.lane.session.tokens.warning), 1.0)
        for x0, y0, x1, y1 in (
            (left, top, right, top),
            (left, bottom, right, bottom),
            (left, top, left, bottom),
            (right, top, right, bottom),
            (left - 2.0, bottom + 2.0, right + 2.0, top - 2.0),
        ):
            draw_lines(painter, x0, y0, x1, y1, pen)

    def _pitch_px(self, pitches: FloatArray, box: QRectF) -> tuple[FloatArray, float]:
        """Return for each pitch (N,) the top of its note in the row of a take, and the height of every note,
        in pixels.
        """
        low, high = self.lane.model.pitches
        step = (box.height() - 2 * MARGIN_PX) / (high - low + 1)
        height = max(step, LEAST_NOTE_PX)
        tops: FloatArray = box.top() + MARGIN_PX + (high - pitches) * step + (step - height) / 2
        return tops, height

    def _paint_selected(self, painter: QPainter) -> None:
        """Draw the selected span in the row of its take, or the swiped range."""
        lane = self.lane
        outlined = lane.model.outlined()
        number = lane.model.number_of(outlined.take_id) if outlined is not None else None
        if outlined is None or number is None:
            return
        box = lane.row_rect(number)
        for _, place in self._boxes((outlined,), box.top(), box.height()):
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(lane.session.tokens.accent), 2.0))
            painter.drawRect(place.adjusted(1.0, 1.0, -1.0, -1.5))
