"""Drawing of the rows of players and section headers."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QLineEdit, QStyle, QStyleOptionViewItem, QWidget

from widgets.common.controls import named
from widgets.common.icons import icon
from widgets.players.ordered_list import AnyIndex, RowDelegate
from widgets.players.player_rows import ROW_ROLE, PlayerRow, Row, SectionRow

ROW_PX = 40
HEADER_PX = 28
BUTTON_PX = 26
ARROW_PX = 24
"""Width in pixels of the arrow that folds a section."""


class PlayerDelegate(RowDelegate):
    """Draws a player's row (colour, name, instrument, leader's crown, problems, record arm, mute and solo) or a
    section's row (arrow, name, number of players).
    """

    def buttons(self, row: QRect) -> tuple[QRect, QRect]:
        """Rectangles of the buttons for mute and solo in a player's row."""
        top = row.center().y() - BUTTON_PX // 2 + 1
        solo = QRect(row.right() - BUTTON_PX - 3, top, BUTTON_PX, BUTTON_PX)
        return solo.translated(-BUTTON_PX - 2, 0), solo

    def arm_button(self, row: QRect) -> QRect:
        """Return the rectangle of the record-arm mark; empty if there is no device."""
        if not self._session.recording.port:
            return QRect()
        return self.buttons(row)[0].translated(-BUTTON_PX - 2, 0)

    # Qt overrides

    def sizeHint(self, option: QStyleOptionViewItem, index: AnyIndex) -> QSize:
        line_px = QFontMetricsF(self._view.font()).height()
        if isinstance(index.data(ROW_ROLE), SectionRow):
            return QSize(120, max(HEADER_PX, round(line_px) + 8))
        return QSize(120, max(ROW_PX, round(line_px + QFontMetricsF(self._small_font()).height()) + 7))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        row: Row = index.data(ROW_ROLE)
        painter.save()
        if isinstance(row, SectionRow):
            self._paint_section(painter, option, row)
        else:
            self._paint_player(painter, option, row)
        painter.restore()

    def _paint_player(self, painter: QPainter, option: QStyleOptionViewItem, row: PlayerRow) -> None:
        tokens, box = self._session.tokens, option.rect
        in_front = self._session.players[:1] == (row.player.id,)
        self.paint_ground(painter, option, row.colour, 0.28 if in_front else 0.14, 5)
        mute, solo = self.buttons(box)
        self._paint_button(painter, mute, "M", row.player.muted, tokens.warning)
        self._paint_button(painter, solo, "S", row.player.soloed, tokens.good)
        arm = self.arm_button(box)
        if arm.isValid():
            self._paint_arm(painter, arm, row.player.id, in_front)
        left = (arm if arm.isValid() else mute).left()
        self._paint_texts(painter, box.adjusted(16, 3, -(box.right() - left) - 4, -3), row, in_front)
        self.paint_frame(painter, box, in_front)

    def _paint_section(self, painter: QPainter, option: QStyleOptionViewItem, section: SectionRow) -> None:
        tokens, box, chosen = self._session.tokens, option.rect, self._session.players
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(box, QColor(tokens.raised))
        front = next((row for row in section.players if chosen[:1] == (row.id,)), None)
        shown = front is not None and section.folded
        if {*section.player_ids} <= {*chosen} or shown:
            fill = QColor(tokens.accent)
            fill.setAlphaF(0.28 if front is not None else 0.14)
            painter.fillRect(box, fill)
        hovered = bool(option.state & QStyle.StateFlag.State_MouseOver)
        self._paint_arrow(painter, QPointF(box.left() + 12.0, box.center().y() + 0.5), section.folded, hovered)
        mute, solo = self.buttons(box)
        self._paint_button(painter, mute, "M", section.marked("muted"), tokens.warning)
        self._paint_button(painter, solo, "S", section.marked("soloed"), tokens.good)
        room = box.adjusted(ARROW_PX, 0, -(box.right() - mute.left()) - 6, 0)
        font, small = QFont(self._view.font()), self._small_font()
        font.setBold(True)
        if section.folded:
            room.setRight(self.paint_problems(painter, room, sum(row.problems for row in section.players), small))
        note = f"{len(section.players)}  {front.name}" if shown and front is not None else str(len(section.players))
        name = QFontMetricsF(font).elidedText(section.name, Qt.TextElideMode.ElideRight, room.width() - 24)
        left = round(QFontMetricsF(font).horizontalAdvance(name)) + 8
        painter.setFont(font)
        painter.setPen(QColor(tokens.text))
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, name)
        painter.setFont(small)
        painter.setPen(QColor(tokens.text if shown else tokens.text_dim))
        note = QFontMetricsF(small).elidedText(note, Qt.TextElideMode.ElideRight, room.width() - left)
        rest = room.adjusted(left, 0, 0, 0)
        painter.drawText(rest, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, note)
        self.paint_frame(painter, box, self._view.currentIndex().data(ROW_ROLE) is section)

    def _paint_arrow(self, painter: QPainter, middle: QPointF, folded: bool, hovered: bool) -> None:
        tokens = self._session.tokens
        painter.save()
        painter.translate(middle)
        painter.rotate(-90.0 if folded else 0.0)
        painter.setPen(QPen(QColor(tokens.text if hovered else tokens.text_dim), 1.6))
        painter.drawPolyline(QPolygonF([QPointF(-4, -2), QPointF(0, 2), QPointF(4, -2)]))
        painter.restore()

    def _paint_texts(self, painter: QPainter, room: QRect, row: PlayerRow, in_front: bool) -> None:
        tokens = self._session.tokens
        font, small = QFont(self._view.font()), self._small_font()
        font.setBold(in_front)
        right = self.paint_problems(painter, room, row.problems, small)
        name_px = right - room.left() - (20 if row.leads else 0)
        name = QFontMetricsF(font).elidedText(row.player.name, Qt.TextElideMode.ElideRight, name_px)
        half = room.height() // 2
        painter.setFont(font)
        painter.setPen(QColor(tokens.text))
        upper = QRect(room.left(), room.top(), name_px, half + 1)
        painter.drawText(upper, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, name)
        if row.leads:
            at = room.left() + round(QFontMetricsF(font).horizontalAdvance(name)) + 4
            icon("crown", tokens, tokens.by_hand).paint(painter, QRect(at, upper.center().y() - 7, 16, 16))
        painter.setFont(small)
        # Dim text would be illegible on a selected row.
        dim = tokens.text if in_front else tokens.text_dim
        painter.setPen(QColor(tokens.warning if row.unseen else dim))
        lower = QRect(room.left(), room.top() + half, right - room.left(), room.height() - half)
        text = self.tr("row_delegate.cannot_be_seen") if row.unseen else row.instrument
        text = QFontMetricsF(small).elidedText(text, Qt.TextElideMode.ElideRight, lower.width())
        painter.drawText(lower, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, text)

    def _paint_arm(self, painter: QPainter, box: QRect, player_id: str, in_front: bool) -> None:
        """Draw the record-arm mark: filled if always recorded, a red ring if recorded while active, dim if not
        recorded.
        """
        tokens, armed = self._session.tokens, self._session.recording.armed
        is_next = armed == player_id or (not armed and in_front)
        painter.setPen(QPen(QColor(tokens.error if is_next else tokens.line_strong), 1.5))
        painter.setBrush(QColor(tokens.error) if armed == player_id else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(QRectF(box).center(), 5.5, 5.5)

    def _paint_button(self, painter: QPainter, box: QRect, letter: str, on: bool | None, colour: str) -> None:
        """Draw a mute or solo button: on, off, or (None) on for some players of a section."""
        tokens = self._session.tokens
        painter.setBrush(QColor(colour) if on else Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(tokens.line_strong if on is False else colour), 1.0))
        painter.drawRoundedRect(QRectF(box).adjusted(2.5, 2.5, -2.5, -2.5), 3, 3)
        painter.setFont(self._small_font())
        painter.setPen(QColor(tokens.sunken if on else colour if on is None else tokens.text_dim))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, letter)

    def _small_font(self) -> QFont:
        font = QFont(self._view.font())
        font.setPointSizeF(max(font.pointSizeF() - 0.5, 9.0))
        return font

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: AnyIndex) -> QWidget:
        return named(QLineEdit(parent), "player_name")

    def updateEditorGeometry(self, editor: QWidget, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        box = option.rect
        count = 3 if self.arm_button(box).isValid() else 2
        editor.setGeometry(box.adjusted(13, 3, -count * (BUTTON_PX + 2) - 8, -4))

    def tip(self, index: AnyIndex, box: QRect, at: QPoint) -> str:
        row: Row = index.data(ROW_ROLE)
        mute, solo = self.buttons(box)
        if mute.contains(at):
            return self.tr("row_delegate.mute_tip")
        if solo.contains(at):
            return self.tr("row_delegate.solo_only_these_sound")
        if isinstance(row, SectionRow):
            count = self.tr("row_delegate.section_players").format(name=row.name, count=len(row.players))
            return f"{count}\n{self.tr('row_delegate.section_tip')}"
        if self.arm_button(box).contains(at):
            armed = self._session.recording.armed == row.player.id
            return self.tr("row_delegate.is_armed") if armed else self.tr("row_delegate.arm_for_recording")
        lines = [row.player.name, row.instrument]
        if row.leads:
            lines.append(self.tr("row_delegate.gives_entries"))
        if row.unseen:
            lines.append(row.unseen)
        if row.problems:
            lines.append(self.tr("row_delegate.problems").format(count=row.problems))
        return "\n".join(lines)
