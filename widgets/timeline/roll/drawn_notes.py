"""Drawing of the piano roll: rows, up to hundreds of thousands of notes, the lasso, and advice if it is empty."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from app.arrays import AnyIntArray, FloatArray, IntArray
from widgets.common.pitch import BLACK
from widgets.timeline.model.roll.note_table import Behind, NoteTable, TimedNotes
from widgets.timeline.model.roll.shown_notes import RollModel
from widgets.timeline.plot.drawing import draw_groups, fill_rects
from widgets.timeline.plot.plot import LaneItem, LaneView

LEVELS = 4
"""Number of shades for velocity."""
GHOST_ALPHA = 70
MOST_RECTANGLES = 6000
"""Number of other players' notes above which narrow ones are drawn as points of a picture, two to four times as fast as
rectangles.
"""
NARROW_PX = 5.0
OUT_OF_SIGHT_PX = 3.0


class RollView(LaneView, Protocol):
    """Part of the roll needed by its items; a protocol, since the roll imports this module."""

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
    """Return a mixture of two colours: ``share`` 0..1 of the way from ``colour`` to ``other``."""
    a, b = QColor(colour), QColor(other)
    return QColor.fromRgbF(
        *(x + share * (y - x) for x, y in zip(a.getRgbF()[:3], b.getRgbF()[:3], strict=True))  # type: ignore[index]
    )


class Rows(LaneItem[RollView]):
    """Draws rows of black keys, lines at every C, and the range outside the active player's instrument."""

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
    """Draws the notes of all players as rectangles in the piano roll, those of the active player in front."""

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
        # Soft notes have a colour near the background, loud ones stand out.
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
        # All ghosts have one colour: many colours would hide the player in front.
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
    """Draws bars at the upper and lower edge if the active player has notes outside the visible pitches."""

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
    """Return a picture of the other players' notes: rectangles, or points for narrow ones if there are very many.

    Parameters
    ----------
    behind : Behind
        Notes of the other players; later players are drawn over earlier ones.
    ghost : QColor or None
        Colour of all notes; None for each player's own.
    ratio : float
        Screen pixels per pixel of the plot.
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
    """Draw notes that are only a few pixels wide as an image: a column for each pixel column, a row for each pitch."""
    bottom, top = lane.y_range
    low, high = int(np.floor(bottom)), int(np.ceil(top))
    pixels = np.zeros((high - low, int(np.ceil(lane.plot_rect.width()))), np.uint32)
    # Each note repeated by its width: its columns one after another.
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
    """Return a colour as Qt's 32-bit number with premultiplied alpha, which is drawn without conversion."""
    alpha = shade.alpha()
    red, green, blue = (round(part * alpha / 255) for part in (shade.red(), shade.green(), shade.blue()))
    return (alpha << 24) | (red << 16) | (green << 8) | blue


class Lasso(LaneItem[RollView]):
    """Draws the selection rectangle, and the line at which a note would be split."""

    def __init__(self, lane: RollView) -> None:
        super().__init__(lane, 20.0)
        self.rect: QRectF | None = None
        self.cut: QLineF | None = None

    def show(self, rect: QRectF | None, cut: QLineF | None = None) -> None:
        """Show the selection rectangle or the line of a split; None hides them."""
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
    """Draws advice in an empty roll."""

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        text = lane.hint()
        if text:
            painter.setFont(lane.font())
            painter.setPen(QColor(lane.session.tokens.text_dim))
            painter.drawText(lane.plot_rect, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap), text)
