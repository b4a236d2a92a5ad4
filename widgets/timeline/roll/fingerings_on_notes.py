"""Fingerings on the notes of a roll, with marks of pinned fingerings and of problems."""

from __future__ import annotations

from itertools import repeat

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF, QStaticText

from app.arrays import IntArray
from app.plan.model import FingeringEvent, PlayerPlan
from instrument_maps.fingering_label import says_words
from instrument_maps.key_chart import key_chart
from instrument_maps.library import all_maps
from widgets.timeline.model.roll.note_table import NoteTable
from widgets.timeline.plot.plot import LaneItem
from widgets.timeline.roll.drawn_notes import RollView, mixed

LABEL_GAP_PX = 5.0
INSIDE_PX = 15.0
"""Height in pixels of a row from which a label is inside its note."""


class Labels(LaneItem[RollView]):
    """Draws fingerings on the active player's notes, with marks of pinned fingerings and of problems."""

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 10.0)
        self._texts: dict[str, tuple[QStaticText, float]] = {}
        self._signs: dict[str, str] = {}
        """Fingerings as they are written on notes, by label."""
        self._plan: PlayerPlan | None = None
        self._table: NoteTable | None = None
        self._fingered: IntArray = np.empty(0, np.int64)
        self._events: tuple[FingeringEvent, ...] = ()
        self._note_ids: list[str] = []
        self._said: IntArray = np.empty(0, np.int64)
        """Numbers of the events, as the notes are ordered that they finger."""

    def forget_fonts(self) -> None:
        """Discard sizes measured in the former font."""
        self._texts.clear()

    def _know(self, table: NoteTable, plan: PlayerPlan | None) -> None:
        """Look up the fingering event of each note of the table in a plan; cached for the same table and plan."""
        if table is self._table and plan is self._plan:
            return
        if plan is not self._plan:
            self._signs = {}
            self._events = plan.fingerings if plan is not None else ()
            self._note_ids = [event.note_id for event in self._events]
        self._table, self._plan = table, plan
        # While notes are dragged, each movement of the mouse changes the table.
        found = map(table.index.get, self._note_ids, repeat(-1))
        places = np.fromiter(found, np.int64, len(self._note_ids))
        order = np.argsort(places, kind="stable")
        order = order[np.searchsorted(places[order], 0) :]
        self._fingered = places[order]
        self._said = order

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        front = lane.model.front()
        if front is None:
            return
        table, colour = front
        self._know(table, lane.session.plan)
        wider = exposed.adjusted(-60.0, 0.0, 4.0, 0.0)
        rows = lane.visible(table, wider)
        self._paint_problems(painter, table, rows)
        self._paint_fingerings(painter, table, wider, colour)

    def _paint_problems(self, painter: QPainter, table: NoteTable, rows: IntArray) -> None:
        lane = self.lane
        problems = lane.model.warned(table)
        found = [place for place in rows.tolist() if place in problems] if problems else []
        if not found:
            return
        left, top, width, height = lane.boxes(table, np.array(found, np.int64))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(lane.session.tokens.warning))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for x, y, w, h in zip(left.tolist(), top.tolist(), width.tolist(), height.tolist(), strict=True):
            painter.drawRect(QRectF(x, y + h - 2.0, max(w, 6.0), 2.0))
            painter.drawPolygon(QPolygonF([QPointF(x, y), QPointF(x + 5.0, y - 8.0), QPointF(x + 10.0, y)]))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _paint_fingerings(self, painter: QPainter, table: NoteTable, exposed: QRectF, colour: str) -> None:
        lane = self.lane
        visible = table.visible(lane.axis.seconds(exposed.left()), lane.axis.seconds(exposed.right()))
        first, last = np.searchsorted(self._fingered, (visible.start, visible.stop)).tolist()
        row_px = lane.row_px
        if first == last or (last - first) * 8.0 > lane.axis.width_px or row_px < 5.0:
            return
        tokens = lane.session.tokens
        painter.setFont(lane.font())
        line_px = QFontMetricsF(lane.font()).height()
        inside = row_px >= max(INSIDE_PX, line_px - 2.0)
        rows = self._fingered[first:last]
        left, top, width, _ = lane.boxes(table, rows)
        # Room of a label: until the next note if it is below, its own note if it is inside.
        following = np.append(left[1:], np.inf) - left
        room = width if inside else following
        on_note = QColor("#10151b" if mixed(colour, "#000000", 0.0).lightnessF() > 0.45 else "#ffffff")
        plain, pinned = QPen(on_note if inside else QColor(tokens.text_dim)), QPen(QColor(tokens.by_hand))
        veil = QColor(tokens.sunken)
        veil.setAlpha(190)
        flags = lane.model.selected(table)
        events = [self._events[number] for number in self._said[first:last].tolist()]
        for place, event, x, y, free in zip(
            rows.tolist(), events, left.tolist(), top.tolist(), room.tolist(), strict=True
        ):
            text, text_px = self._text(self._in_signs(event))
            if event.corrected:
                self._mark(painter, x, y, row_px)
            if text_px + LABEL_GAP_PX > free:
                continue
            if inside:
                painter.setPen(QPen(QColor("#10151b")) if flags is not None and flags[place] else plain)
                painter.drawStaticText(QPointF(x + 4.0, y + (row_px - 1.0 - line_px) / 2), text)
            else:
                below = y + row_px - 1.0
                painter.fillRect(QRectF(x, below, text_px + 2.0, line_px - 2.0), veil)
                painter.setPen(pinned if event.corrected else plain)
                painter.drawStaticText(QPointF(x + 1.0, below - 1.0), text)

    def _mark(self, painter: QPainter, x: float, y: float, row_px: float) -> None:
        """Draw the mark of a pinned fingering: a vertical bar at the note's start."""
        painter.fillRect(QRectF(x, y - 1.0, 3.0, row_px + 1.0), QColor(self.lane.session.tokens.by_hand))

    def _in_signs(self, event: FingeringEvent) -> str:
        """Return a fingering as one line of text: chart signs for keys and holes, the usual label for valves and
        slides.
        """
        if event.label not in self._signs:
            session = self.lane.session
            instrument = all_maps().get(session.player.instrument_id) if session.player is not None else None
            charted = instrument is not None and says_words(instrument.controls)
            self._signs[event.label] = (
                key_chart(instrument).in_signs(event.controls) if instrument and charted else event.label
            )
        return self._signs[event.label]

    def _text(self, label: str) -> tuple[QStaticText, float]:
        known = self._texts.get(label)
        if known is None:
            text = QStaticText(label)
            text.setTextFormat(Qt.TextFormat.PlainText)
            text.prepare(font=self.lane.font())
            known = self._texts[label] = (text, QFontMetricsF(self.lane.font()).horizontalAdvance(label))
        return known
