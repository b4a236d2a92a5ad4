"""Drawing of the piano roll: rows, notes by the hundred thousand, what stands on them, and the lasso."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import repeat
from typing import Protocol

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QImage, QPainter, QPen, QPolygonF, QStaticText

from app.arrays import AnyIntArray, FloatArray, IntArray
from app.plan.model import FingeringEvent, PlayerPlan
from instrument_maps.fingering_label import says_words
from instrument_maps.key_chart import key_chart
from instrument_maps.library import all_maps
from widgets.common.pitch import BLACK
from widgets.timeline.model.roll.note_table import Behind, NoteTable, TimedNotes
from widgets.timeline.model.roll.shown_notes import RollModel
from widgets.timeline.plot.drawing import draw_groups, fill_rects
from widgets.timeline.plot.plot import LaneItem, LaneView

LEVELS = 4
"""Shades of velocity."""
GHOST_ALPHA = 70
MOST_RECTANGLES = 6000
"""More notes behind than this, and the narrow ones become points of a picture: two to four times as fast."""
NARROW_PX = 5.0
LABEL_GAP_PX = 5.0
OUT_OF_SIGHT_PX = 3.0
INSIDE_PX = 15.0
"""In rows at least so high a label stands inside its note."""


class RollView(LaneView, Protocol):
    """Part of the roll that its items draw; a protocol for the reason of `LaneView`."""

    model: RollModel

    @property
    def ghosted(self) -> bool: ...
    @property
    def playable(self) -> tuple[int, int] | None: ...
    @property
    def row_px(self) -> float: ...
    def visible(self, table: TimedNotes, exposed: QRectF) -> IntArray: ...
    def boxes(self, table: TimedNotes, rows: IntArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]: ...
    def hint(self) -> str: ...


def mixed(colour: str, other: str, share: float) -> QColor:
    """A colour, ``share`` 0..1 of the way to another."""
    a, b = QColor(colour), QColor(other)
    return QColor.fromRgbF(
        *(x + share * (y - x) for x, y in zip(a.getRgbF()[:3], b.getRgbF()[:3], strict=True))  # type: ignore[index]
    )


class Rows(LaneItem[RollView]):
    """Rows of black keys, lines at every C, and where the instrument in front cannot go."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        tokens = lane.session.tokens
        bottom, top = lane.y_range
        height = lane.row_px
        black = QColor("#000000" if tokens.name == "dark" else tokens.line)
        black.setAlpha(60 if tokens.name == "dark" else 90)
        octave = QPen(QColor(tokens.line), 1.0)
        for pitch in range(int(np.floor(bottom)), int(np.ceil(top))):
            y = lane.y_px(pitch + 1)
            if pitch % 12 in BLACK:
                painter.fillRect(QRectF(exposed.left(), y, exposed.width(), height), black)
            if pitch % 12 == 0 or height >= 14:
                painter.setPen(octave)
                line = round(lane.y_px(pitch)) - 0.5
                painter.drawLine(QLineF(exposed.left(), line, exposed.right(), line))
        playable = lane.playable
        if playable is not None:
            shade = QColor(tokens.error)
            shade.setAlpha(26)
            low, high = playable
            above, below = lane.y_px(high + 1), lane.y_px(low)
            painter.fillRect(QRectF(exposed.left(), 0, exposed.width(), above) & exposed, shade)
            rest = lane.plot_rect.height() - below
            painter.fillRect(QRectF(exposed.left(), below, exposed.width(), rest) & exposed, shade)


class Notes(LaneItem[RollView]):
    """All players' notes as rectangles."""

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 0.0)
        self._behind: tuple[object, Behind, QImage] | None = None
        """The other players' notes as they were drawn last, and what that depends on: a selection, an edit in front or
        the playhead passing by leave them as they are."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        painter.setPen(Qt.PenStyle.NoPen)
        self._show_behind(painter, exposed)
        front = lane.model.front()
        if front is None:
            return
        table, colour = front
        rows = lane.visible(table, exposed)
        # Soft notes lie nearer to the ground, loud ones stand out.
        ground = lane.session.tokens.sunken
        level = np.clip(table.velocity[rows] * LEVELS // 128, 0, LEVELS - 1)
        for number in range(LEVELS):
            shade = mixed(colour, ground, 0.55 * (LEVELS - 1 - number) / (LEVELS - 1))
            self._draw(painter, table, rows[level == number], shade)
        self._draw_selected(painter, table, exposed, colour)

    def _show_behind(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        behind = lane.model.ghosts()
        if not behind.tables:
            return
        # Ghosts of one colour: many players in many colours would hide the one in front.
        ghost = _shade(lane.session.tokens.text_dim, GHOST_ALPHA) if lane.ghosted else None
        ratio = lane.plot.devicePixelRatioF()
        key = (lane.axis.start_s, lane.axis.end_s, lane.y_range, lane.plot_rect.size().toTuple(), ratio, ghost)
        if self._behind is None or self._behind[0] != key or not self._behind[1].looks_like(behind):
            self._behind = (key, behind, picture_behind(lane, behind, ghost, ratio))
        painter.drawImage(QPointF(0.0, 0.0), self._behind[2])
        if lane.model.selects_behind:
            for table, colour in zip(behind.tables, behind.colours, strict=True):
                self._draw_selected(painter, table, exposed, colour)

    def _draw_selected(self, painter: QPainter, table: NoteTable, exposed: QRectF, colour: str) -> None:
        lane = self.lane
        flags = lane.model.selected(table)
        if flags is None:
            return
        rows = lane.visible(table, exposed)
        rows = rows[flags[rows]]
        tokens = lane.session.tokens
        fill = mixed(colour, "#ffffff" if tokens.name == "dark" else "#000000", 0.55 if tokens.name == "dark" else 0.35)
        if len(rows) < 4000:
            painter.setPen(QPen(QColor(tokens.text), 1.0))
        self._draw(painter, table, rows, fill)
        painter.setPen(Qt.PenStyle.NoPen)

    def _draw(self, painter: QPainter, table: NoteTable, rows: IntArray, shade: QColor) -> None:
        if not len(rows):
            return
        fill_rects(painter, *self.lane.boxes(table, rows), shade)


class OutOfSight(LaneItem[RollView]):
    """Bars at the upper and lower edge: there are notes of the player in front above or below what is seen."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        front = lane.model.front()
        if front is None:
            return
        table, colour = front
        found = table.visible(lane.axis.seconds(exposed.left()), lane.axis.seconds(exposed.right()))
        pitch, (bottom, top) = table.pitch[found], lane.y_range
        for hidden, y in ((pitch >= top, 0.0), (pitch + 1 <= bottom, lane.plot_rect.height() - OUT_OF_SIGHT_PX)):
            rows = np.flatnonzero(hidden) + found.start
            if len(rows):
                left, _, width, _ = lane.boxes(table, rows)
                height = np.full(len(rows), OUT_OF_SIGHT_PX)
                fill_rects(painter, left, np.full(len(rows), y), width, height, QColor(colour))


def _shade(colour: str, alpha: int) -> QColor:
    shade = QColor(colour)
    shade.setAlpha(alpha)
    return shade


def picture_behind(lane: RollView, behind: Behind, ghost: QColor | None, ratio: float) -> QImage:
    """The other players' notes: as rectangles, or where there are very many, the narrow ones as points.

    Parameters
    ----------
    behind : Behind
        Later players lie over those before.
    ghost : QColor or None
        Colour of all of them; None: each player's own.
    ratio : float
        Pixels of the screen in one of the plot's.
    """
    room = lane.plot_rect
    image = QImage(
        int(np.ceil(room.width() * ratio)), int(np.ceil(room.height() * ratio)),
        QImage.Format.Format_ARGB32_Premultiplied,
    )  # fmt: skip
    image.setDevicePixelRatio(ratio)
    image.fill(Qt.GlobalColor.transparent)
    notes = behind.notes
    rows = lane.visible(notes, room)
    rows = rows[np.argsort(notes.owner[rows], kind="stable")]
    owner = notes.owner[rows]
    left, top, width, height = boxes = lane.boxes(notes, rows)
    shades = [QColor(colour) if ghost is None else ghost for colour in behind.colours]
    painter = QPainter(image)
    # See `Pictured`.
    painter.setClipRect(room)
    if len(rows) > MOST_RECTANGLES:
        narrow = width <= NARROW_PX
        _draw_points(painter, lane, left[narrow], notes.pitch[rows[narrow]], width[narrow], owner[narrow], shades)
        owner, boxes = owner[~narrow], (left[~narrow], top[~narrow], width[~narrow], height[~narrow])
    draw_groups(painter, boxes, owner, shades)
    painter.end()
    return image


def _draw_points(
    painter: QPainter,
    lane: RollView,
    left: FloatArray,
    pitch: FloatArray,
    width: FloatArray,
    owner: AnyIntArray,
    shades: Sequence[QColor],
) -> None:
    """Notes of a few pixels' width, drawn as pixels: a column for each of the plot's, a row for each pitch."""
    bottom, top = lane.y_range
    low, high = int(np.floor(bottom)), int(np.ceil(top))
    pixels = np.zeros((high - low, int(np.ceil(lane.plot_rect.width()))), np.uint32)
    # Every note as often as it is wide: its columns, one after another.
    counts = width.astype(np.int64)
    note = np.repeat(np.arange(len(counts)), counts)
    x = left.astype(np.int64)[note] + np.arange(len(note)) - np.repeat(np.cumsum(counts) - counts, counts)
    inside = (x >= 0) & (x < pixels.shape[1])
    note, x = note[inside], x[inside]
    y = (high - 1 - pitch).astype(np.int64)
    values = np.array([_premultiplied(shade) for shade in shades], np.uint32)
    pixels[y[note], x] = values[owner[note]]
    rows, columns = pixels.shape
    image = QImage(pixels.data, columns, rows, 4 * columns, QImage.Format.Format_ARGB32_Premultiplied)
    painter.drawImage(QRectF(0.0, lane.y_px(high), columns, rows * lane.row_px), image)


def _premultiplied(shade: QColor) -> int:
    """Premultiply a colour as Qt stores it, so that it draws without a conversion."""
    alpha = shade.alpha()
    red, green, blue = (round(part * alpha / 255) for part in (shade.red(), shade.green(), shade.blue()))
    return (alpha << 24) | (red << 16) | (green << 8) | blue


class Labels(LaneItem[RollView]):
    """Fingerings on the notes of the player in front, marks of what was pinned by hand, and of problems."""

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
        """The font is another one."""
        self._texts.clear()

    def _know(self, table: NoteTable, plan: PlayerPlan | None) -> None:
        """Sort a plan's fingerings to the notes they belong to, once for each pair."""
        if table is self._table and plan is self._plan:
            return
        if plan is not self._plan:
            self._signs = {}
            self._events = plan.fingerings if plan is not None else ()
            self._note_ids = [event.note_id for event in self._events]
        self._table, self._plan = table, plan
        # While notes are dragged, the table is another with every move of the mouse.
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
        # What a label may take: to the next note's beginning where it hangs below, its own note where it is inside.
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
        """The solid mark of what the user decided: a bar at the note's beginning."""
        painter.fillRect(QRectF(x, y - 1.0, 3.0, row_px + 1.0), QColor(self.lane.session.tokens.by_hand))

    def _in_signs(self, event: FingeringEvent) -> str:
        """A fingering in a line: keys and holes as signs of their chart, valves and places of a slide as written."""
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


class Lasso(LaneItem[RollView]):
    """The rectangle that is drawn over what shall be selected, and the line where a note would be cut."""

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 20.0)
        self.rect: QRectF | None = None
        self.cut: QLineF | None = None

    def show(self, rect: QRectF | None, cut: QLineF | None = None) -> None:
        """Draw this."""
        if (rect, cut) != (self.rect, self.cut):
            self.rect, self.cut = rect, cut
            self.update()

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        accent = QColor(self.lane.session.tokens.accent)
        painter.setPen(QPen(accent, 1.0))
        if self.rect is not None:
            fill = QColor(accent)
            fill.setAlpha(40)
            painter.setBrush(fill)
            painter.drawRect(self.rect)
        if self.cut is not None:
            painter.setPen(QPen(accent, 1.0, Qt.PenStyle.DashLine))
            painter.drawLine(self.cut)


class Hint(LaneItem[RollView]):
    """Advice in an empty roll."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        text = lane.hint()
        if text:
            painter.setFont(lane.font())
            painter.setPen(QColor(lane.session.tokens.text_dim))
            painter.drawText(lane.plot_rect, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap), text)
