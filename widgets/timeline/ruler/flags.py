"""The markers of the piece as flags above the ruler: rehearsal letters, sections, cues. Hidden if there are none."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QHelpEvent, QMouseEvent, QPainter, QPen
from PySide6.QtWidgets import QToolTip, QWidget

from app.editor.session import Session
from app.score.model import Score
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.ruler.strip import Strip
from widgets.timeline.zoom_and_scroll import TimeAxis

FLAGS_PX = 18
LEAST_FLAG_PX = 32.0
"""Least width in pixels of a flag with a text."""
MOST_FLAG_PX = 220.0
BARE_FLAG_PX = 5.0
AIR_PX = 5.0
"""Margin in pixels on either side of a text."""


@dataclass(frozen=True)
class Flag:
    """Flag above the ruler for the markers at one tick; ``shown`` is the text, shortened to fit."""

    tick: int
    text: str
    shown: str
    rect: QRectF


def lay_flags(score: Score, axis: TimeAxis, metrics: QFontMetricsF, left_px: float, right_px: float) -> list[Flag]:
    """Return the flags without overlaps. The flag in effect at the left edge stays visible.

    Parameters
    ----------
    axis : TimeAxis
        Time axis whose pixels count from ``left_px``.
    left_px, right_px : float
        Visible range in pixels.
    """
    named = [
        (tick, ", ".join(marker.text for marker in here))
        for tick, here in groupby(score.markers, lambda marker: marker.tick)
    ]
    ticks = np.array([tick for tick, _ in named], np.float64)
    places = left_px + axis.x_px(score.tempo_map.seconds(ticks))
    first, last = np.searchsorted(places, (left_px, right_px)).tolist()
    flags: list[Flag] = []
    for index in range(max(first - 1, 0), last):
        tick, text = named[index]
        x = max(float(places[index]), left_px)
        end = float(places[index + 1]) if index + 1 < len(named) else right_px
        room = min(end - x - 1.0, MOST_FLAG_PX)
        width = metrics.horizontalAdvance(text) + 2 * AIR_PX
        if room >= min(width, LEAST_FLAG_PX):
            shown = metrics.elidedText(text, Qt.TextElideMode.ElideRight, room - 2 * AIR_PX) if width > room else text
            flags.append(Flag(tick, text, shown, QRectF(x, 1.0, min(width, room), FLAGS_PX - 3.0)))
        elif index >= first and room > 0.0:
            flags.append(Flag(tick, text, "", QRectF(x, 1.0, min(room, BARE_FLAG_PX), FLAGS_PX - 3.0)))
    return flags


class Flags(Strip):
    """The row of flags; a click on a flag or between flags moves the playhead."""

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, FLAGS_PX, parent)
        self.setObjectName("flags")
        self._flags: list[Flag] = []
        axis.changed.connect(self.redraw)
        session.changed.connect(self._piece_set)
        session.theme_changed.connect(self.redraw)
        self._piece_set()

    def _piece_set(self, *_changes: object) -> None:
        self.setVisible(bool(self.session.project.score.markers))
        self.redraw()

    def _flag_at(self, place: QPointF) -> Flag | None:
        return next((flag for flag in reversed(self._flags) if flag.rect.contains(place)), None)

    # Qt overrides

    def draw(self, painter: QPainter, room: QRectF) -> None:
        tokens, score = self.session.tokens, self.session.project.score
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self.font())
        painter.setClipRect(room.adjusted(GUTTER_PX, 0.0, 0.0, 0.0))
        self._flags = lay_flags(score, self.axis, QFontMetricsF(self.font()), GUTTER_PX, float(self.width()))
        for flag in self._flags:
            x = self.x_px(flag.tick)
            # A mark that began before the left edge is dimmed.
            colour = QColor(tokens.text_dim if x < GUTTER_PX else tokens.text)
            shade = QColor(tokens.text_dim)
            shade.setAlpha(150 if not flag.shown else 50)
            painter.fillRect(flag.rect, shade)
            if x >= GUTTER_PX:
                painter.setPen(QPen(QColor(tokens.text_dim), 1.0))
                painter.drawLine(QPointF(int(x) + 0.5, 1.0), QPointF(int(x) + 0.5, room.bottom()))
            painter.setPen(colour)
            painter.drawText(flag.rect, int(Qt.AlignmentFlag.AlignCenter), flag.shown)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and event.position().x() >= GUTTER_PX:
            flag = self._flag_at(event.position())
            between_s = self.axis.seconds(event.position().x() - GUTTER_PX)
            self.sought.emit(between_s if flag is None else self.seconds_of(flag.tick))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        over = self._flag_at(event.position()) is not None
        self.setCursor(Qt.CursorShape.PointingHandCursor if over else Qt.CursorShape.ArrowCursor)

    def tip(self, flag: Flag) -> str:
        """Return the complete text of a flag, and its bar."""
        bar = self.session.project.score.metre_map.bar_of_tick(flag.tick)
        where = self.tr("flags.bar").format(bar=bar)
        return f"{flag.text}\n{where}"

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip:
            assert isinstance(event, QHelpEvent)
            flag = self._flag_at(QPointF(event.pos()))
            if flag is None:
                QToolTip.hideText()
            else:
                QToolTip.showText(event.globalPos(), self.tip(flag), self, flag.rect.toAlignedRect())
            return True
        return super().event(event)
