"""Fingering charts of keys and holes along their lane: a chart at each note, with key names if there is space; bars for
the holes at notes too short for a chart.
"""

from __future__ import annotations

from math import ceil
from typing import NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPixmap

from app.arrays import BoolArray, FloatArray
from app.plan.model import FingeringEvent
from instrument_maps.fingering_words import pressed_names
from instrument_maps.key_chart import HOLE, KeyChart, key_chart
from instrument_maps.model import InstrumentMap
from widgets.common.fingering_picture import ChartColours, ChartPlace, chart_sides, draw_chart
from widgets.common.instrument_name import language
from widgets.timeline.plot.drawing import draw_mark, draw_rects, shade, small_font
from widgets.timeline.plot.plot import LaneView

LEAST_PX, USUAL_PX, PREFERRED_PX = 52, 80, 116
"""Heights in pixels of a lane with charts: least, easily readable, and preferred."""
MOST_HOLE_PX = 18.0
MARGIN_PX = 3.0
THUMB_PX = 13.0
"""Width in pixels left of the column in every chart for the thumb's holes, so that columns are aligned."""
SQUEEZE = 0.6
MOST_PICTURES = 1024
BAR_SHARE = 0.55
"""Height of a bar, of the distance between two holes."""


class ShownFingerings(NamedTuple):
    """Visible fingerings: their events, and for each (N,) the left and right edge in pixels and whether it is
    selected.
    """

    events: list[FingeringEvent]
    left: FloatArray
    width: FloatArray
    chosen: BoolArray


class _Picture(NamedTuple):
    """A drawn fingering chart: its pixels, its extent left of the column's middle, and its width."""

    pixels: QPixmap
    left_px: float
    width_px: float


class FingeringCharts:
    """Draws the charts of an instrument; each picture is made once."""

    def __init__(self, lane: LaneView, instrument: InstrumentMap) -> None:
        self._lane, self._instrument = lane, instrument
        self.chart: KeyChart = key_chart(instrument)
        self._pictures: dict[tuple[str, str, float], _Picture] = {}
        self._drawn_for: tuple[object, ...] = ()
        self._words: dict[tuple[str, str], tuple[list[str], list[str]]] = {}

    # Positions

    @property
    def hole_px(self) -> float:
        """Distance of holes in pixels."""
        room = self._lane.plot_rect.height() - 2 * MARGIN_PX
        return min(max(room, 1.0) / (self.chart.bottom - self.chart.top), MOST_HOLE_PX)

    @property
    def tight_px(self) -> float:
        """The width of the narrowest chart."""
        return HOLE * self.hole_px + 8.0

    def y_px(self, y: float) -> float:
        """Pixels from the top of the lane to a height of the chart."""
        return MARGIN_PX + (y - self.chart.top) * self.hole_px

    def rows(self) -> list[tuple[str, float]]:
        """Return the signs of the holes in the chart's column, each with its height in pixels."""
        return [(key.control.label if not key.sign else key.sign, self.y_px(key.y)) for key in self.chart.column]

    # Drawing

    def paint(
        self, painter: QPainter, exposed: QRectF, shown: ShownFingerings, pressed: FloatArray, colour: str
    ) -> None:
        """Draw the visible fingerings.

        Parameters
        ----------
        pressed : array (K, N)
            How far each of the K holes of the column is closed in each fingering, 0..1.
        colour : str
            The player's colour.
        """
        self._forget_old()
        narrow = shown.width < self.tight_px
        self._paint_bars(painter, exposed, shown, pressed, narrow, colour)
        wide = np.flatnonzero(~narrow)
        for index, x, room in zip(wide.tolist(), shown.left[wide].tolist(), shown.width[wide].tolist(), strict=True):
            self._paint_event(painter, shown.events[index], x, room, bool(shown.chosen[index]), colour)
        for index in np.flatnonzero(narrow).tolist():
            if shown.events[index].corrected:
                draw_mark(painter, self._lane.session.tokens, float(shown.left[index]), 0.0)

    def _forget_old(self) -> None:
        """Discard cached pictures made for another theme, height or screen."""
        now = (self._lane.session.tokens, self.hole_px, self._lane.plot.devicePixelRatioF())
        if now != self._drawn_for or len(self._pictures) > MOST_PICTURES:
            self._drawn_for = now
            self._pictures.clear()

    def _paint_bars(
        self,
        painter: QPainter,
        exposed: QRectF,
        shown: ShownFingerings,
        pressed: FloatArray,
        narrow: BoolArray,
        colour: str,
    ) -> None:
        if not narrow.any():
            return
        tokens, tall = self._lane.session.tokens, BAR_SHARE * self.hole_px
        for key, value in zip(self.chart.column, pressed, strict=True):
            for picked, token in ((~shown.chosen, colour), (shown.chosen, tokens.accent)):
                down = narrow & picked & (value > 0.0)
                size = np.maximum(value[down] * tall, 2.0)
                top = self.y_px(key.y) + tall / 2.0 - size
                draw_rects(painter, shown.left[down], top, shown.width[down], size, shade(token, 200))

    def _paint_event(
        self, painter: QPainter, event: FingeringEvent, x: float, room: float, chosen: bool, colour: str
    ) -> None:
        tokens = self._lane.session.tokens
        # Anything but the first choice is emphasised, since users look for it.
        strong = event.corrected or event.rank > 1
        shown = tokens.accent if chosen else tokens.text if strong else colour
        picture = self._picture(event, shown, SQUEEZE)
        middle = x + 1.0 + max(THUMB_PX, picture.left_px)
        if middle - picture.left_px + picture.width_px > x + room:
            middle = x + 1.0 + picture.left_px
        if picture.width_px + 1.0 > room:
            picture = self._picture(event, shown, 0.0)
            middle = x + max((room - picture.width_px) / 2.0, 0.0) + picture.left_px
        painter.drawPixmap(QPointF(middle - picture.left_px, MARGIN_PX), picture.pixels)
        if event.corrected:
            draw_mark(painter, tokens, x, 0.0)
        right = middle - picture.left_px + picture.width_px + 4.0
        self._paint_names(painter, event, QRectF(right, 0.0, x + room - right, self._lane.plot_rect.height()))

    def _paint_names(self, painter: QPainter, event: FingeringEvent, box: QRectF) -> None:
        """Draw the names of keys beside the column, else their signs, from the top; nothing if these do not fit."""
        metrics = QFontMetricsF(painter.font())
        line_px = metrics.height()
        for words in self._words_of(event):
            if words and max(map(metrics.horizontalAdvance, words)) <= box.width():
                painter.setPen(QPen(QColor(self._lane.session.tokens.text_dim)))
                top = (box.height() - len(words) * line_px) / 2.0
                for number, word in enumerate(words):
                    line = QRectF(box.left(), top + number * line_px, box.width(), line_px)
                    painter.drawText(line, Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextDontClip, word)
                return

    def _words_of(self, event: FingeringEvent) -> tuple[list[str], list[str]]:
        """Return the names and the signs of the pressed keys that are not part of the chart's fixed column."""
        known = (event.label, language())
        if known not in self._words:
            beside = [key for key in self.chart.keys if event.controls.get(key.control.name, 0.0) > 0.0]
            beside = [key for key in beside if not key.is_always_shown]
            values = {key.control.name: event.controls[key.control.name] for key in beside}
            names = pressed_names(self._instrument, values, known[1]) if values else []
            self._words[known] = (names, [key.sign for key in beside])
        return self._words[known]

    def _picture(self, event: FingeringEvent, colour: str, squeeze: float) -> _Picture:
        key = (event.label, colour, squeeze)
        if key not in self._pictures:
            self._pictures[key] = self._drawn(event, colour, squeeze)
        return self._pictures[key]

    def _drawn(self, event: FingeringEvent, colour: str, squeeze: float) -> _Picture:
        hole_px, ratio = self.hole_px, self._lane.plot.devicePixelRatioF()
        bare = ChartPlace(0.0, 0.0, hole_px, squeeze)
        left, right = (side + 1.0 for side in chart_sides(self.chart, bare, event.controls))
        tall = (self.chart.bottom - self.chart.top) * hole_px
        pixels = QPixmap(ceil((left + right) * ratio), ceil((tall + 1.0) * ratio))
        pixels.setDevicePixelRatio(ratio)
        pixels.fill(Qt.GlobalColor.transparent)
        nothing = QColor(Qt.GlobalColor.transparent)
        line = QColor(self._lane.session.tokens.text_dim)
        painter = QPainter(pixels)
        painter.setFont(small_font(self._lane.font()))
        place = ChartPlace(left, -self.chart.top * hole_px, hole_px, squeeze)
        draw_chart(
            painter, self.chart, event.controls, place, ChartColours(QColor(colour), line, nothing, nothing, nothing),
            whole=False,
        )  # fmt: skip
        painter.end()
        return _Picture(pixels, left, left + right)
