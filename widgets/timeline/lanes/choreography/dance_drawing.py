"""Drawing of dances: each basic motion as a block with its number and a small figure at its accent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from app.arrays import IntArray
from app.project.performers import Dancer
from widgets.common.choreography.figures import draw_figures, placed
from widgets.timeline.lanes.choreography.dragged_step import MoveStep
from widgets.timeline.plot.drawing import draw_lines, draw_mark, draw_rects, draw_text, shade, small_font
from widgets.timeline.plot.plot import LaneItem, LaneView

if TYPE_CHECKING:
    from app.choreography.performed.dance_steps import DanceSteps

LEAST_NUMBER_PX, LEAST_FIGURE_PX = 12.0, 20.0
"""A narrower block has no number, and no figure."""
_BAR_PX = 3.0


class DancesView(LaneView, Protocol):
    """Part of a dance lane needed for drawing; a protocol, since the lane imports this module."""

    dances: dict[str, DanceSteps]
    moving: MoveStep | None

    @property
    def dancers(self) -> tuple[Dancer, ...]: ...
    @property
    def selected_step(self) -> tuple[str, int] | None: ...
    def row_rect(self, number: int) -> QRectF: ...
    def empty_text(self) -> str: ...
    def reason(self, dance: DanceSteps) -> str: ...


class DancesItem(LaneItem[DancesView]):
    """Draws the rows of dances in a lane, one for each dancer."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane, tokens = self.lane, self.lane.session.tokens
        painter.setFont(small_font(lane.font()))
        text = lane.empty_text()
        if text:
            painter.setPen(QColor(tokens.text_dim))
            painter.drawText(
                lane.plot_rect.adjusted(12, 2, -12, -2),
                int(Qt.AlignmentFlag.AlignVCenter) | int(Qt.TextFlag.TextWordWrap),
                text,
            )
            return
        for number, dancer in enumerate(lane.dancers):
            box = lane.row_rect(number)
            dance = lane.dances.get(dancer.id)
            if dance is None or not box.intersects(lane.plot_rect):
                continue
            painter.setPen(QPen(QColor(tokens.line), 1.0))
            painter.drawLine(box.bottomLeft(), box.bottomRight())
            reason = lane.reason(dance)
            if reason:
                painter.setPen(QColor(tokens.warning if dance.error is not None else tokens.text_dim))
                draw_text(painter, box.adjusted(12, 0, -12, 0), reason)
                continue
            self._paint_row(painter, box.adjusted(0, 2, 0, -2), dance, lane.session.colour(dancer))
            if lane.moving is not None and lane.moving.dancer_id == dancer.id and lane.moving.tick is not None:
                self._paint_move(painter, box.adjusted(0, 2, 0, -2), dance, lane.moving.number, lane.moving.tick)

    def _paint_row(self, painter: QPainter, box: QRectF, dance: DanceSteps, colour: str) -> None:
        lane, axis = self.lane, self.lane.axis
        first = int(np.searchsorted(dance.end_s, axis.start_s, side="right"))
        stop = int(np.searchsorted(dance.start_s, axis.end_s, side="left"))
        if first >= stop:
            return
        here = np.arange(first, stop)
        left, right = axis.x_px(dance.start_s[here]), axis.x_px(dance.end_s[here])
        width = np.maximum(right - left - 1.0, 1.0)
        count = len(here)
        draw_rects(painter, left, np.full(count, box.top()), width, np.full(count, box.height()), shade(colour, 55))
        self._paint_accents(painter, box, dance, here, colour)
        chosen = lane.selected_step
        selected = chosen[1] if chosen is not None and chosen[0] == dance.dancer.id else None
        wide = width >= LEAST_NUMBER_PX
        if (width >= LEAST_FIGURE_PX).any() and box.height() >= 20.0:
            self._paint_figures(painter, box, dance, here[width >= LEAST_FIGURE_PX], colour)
        for at in np.flatnonzero(wide).tolist():
            block = QRectF(float(left[at]), box.top(), float(width[at]), box.height())
            painter.setPen(QColor(lane.session.tokens.text))
            draw_text(
                painter,
                block.adjusted(_BAR_PX, 0.0, -1.0, 0.0),
                str(dance.steps[first + at].state + 1),
                Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop,
            )
        self._paint_marks(painter, box, dance, here, selected)

    def _paint_move(self, painter: QPainter, box: QRectF, dance: DanceSteps, number: int, tick: int) -> None:
        """Draw a dragged step of a dance at its new place, with a line at its accent; ``tick`` is the accent's new
        place."""
        lane, step = self.lane, dance.steps[number]
        accent_s = lane.session.project.score.tempo_map.seconds(float(tick))
        by_s = accent_s - step.accent_s
        left, right, accent = (lane.axis.x_px(at_s) for at_s in (step.start_s + by_s, step.end_s + by_s, accent_s))
        painter.setBrush(QColor(shade(lane.session.tokens.accent, 60)))
        painter.setPen(QPen(QColor(lane.session.tokens.accent), 1.6, Qt.PenStyle.DashLine))
        painter.drawRect(QRectF(left, box.top(), max(right - left - 1.0, 2.0), box.height()))
        painter.setPen(QPen(QColor(lane.session.tokens.accent), 2.0))
        painter.drawLine(QPointF(accent, box.top()), QPointF(accent, box.bottom()))

    def _paint_accents(self, painter: QPainter, box: QRectF, dance: DanceSteps, here: IntArray, colour: str) -> None:
        """Draw a short line at the accent of each visible step of a dance; ``here`` are the steps' indices."""
        accents = self.lane.axis.x_px(np.array([dance.steps[at].accent_s for at in here.tolist()]))
        bottom = np.full(len(here), box.bottom())
        draw_lines(painter, accents, bottom - 5.0, accents, bottom, QPen(QColor(colour), 2.0))

    def _paint_figures(self, painter: QPainter, box: QRectF, dance: DanceSteps, here: IntArray, colour: str) -> None:
        from app.choreography.performed.dance_steps import figures

        assert dance.choreographer is not None
        axis, height = self.lane.axis, box.height() - 4.0
        drawn = figures(dance.choreographer)[[dance.steps[at].segment for at in here.tolist()]]
        middles = axis.x_px((dance.start_s[here] + dance.end_s[here]) / 2.0) + 4.0
        if dance.dancer.mirrored:
            drawn = drawn * (-1.0, 1.0)
        draw_figures(painter, placed(drawn, middles, box.bottom() - 2.0, height), QColor(colour), 1.5, height)

    def _paint_marks(
        self, painter: QPainter, box: QRectF, dance: DanceSteps, here: IntArray, selected: int | None
    ) -> None:
        tokens, axis = self.lane.session.tokens, self.lane.axis
        for at in here.tolist():
            left, right = axis.x_px(float(dance.start_s[at])), axis.x_px(float(dance.end_s[at]))
            if dance.pinned[at]:
                draw_mark(painter, tokens, max(right - 8.0, left), box.top() + 1.0)
            elif dance.barred(at):
                draw_mark(painter, tokens, max(right - 8.0, left), box.top() + 1.0, removed=True)
            if at == selected:
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.setPen(QPen(QColor(tokens.accent), 1.6))
                painter.drawRect(QRectF(left, box.top(), max(right - left - 1.0, 2.0), box.height()))
