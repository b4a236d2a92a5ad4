"""The list of players: a model of the project's, and how a row is drawn and taken hold of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import (
    QAbstractListModel,
    QItemSelection,
    QItemSelectionModel,
    QModelIndex,
    QPoint,
    QRect,
    QRectF,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QMouseEvent, QPainter, QPen
from PySide6.QtWidgets import QAbstractItemView, QLineEdit, QStyleOptionViewItem, QWidget

from app.editor.session import Session
from app.project.performers import Player
from widgets.common.controls import named
from widgets.common.icons import icon
from widgets.players.ordered_list import ID_ROLE, AnyIndex, OrderedList, RowDelegate

ROW_PX = 40
BUTTON_PX = 26
_ROW = Qt.ItemDataRole.UserRole


@dataclass(frozen=True)
class PlayerRow:
    """Contents of a player's row.

    Attributes
    ----------
    instrument : str
        In the language of the editor.
    problems : int
        How many the plan has; 0 while there is no plan.
    leads : bool
        Whether the player gives the ensemble's entries.
    unseen : str
        Why the player cannot be seen or exported; empty: nothing is known against it.
    """

    player: Player
    colour: str
    instrument: str
    problems: int = 0
    leads: bool = False
    unseen: str = ""


class PlayerModel(QAbstractListModel):
    """The players as rows.

    Signals
    -------
    renamed(str, str)
        The user typed another name for the player of this id.
    """

    renamed = Signal(str, str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._rows: tuple[PlayerRow, ...] = ()

    @property
    def rows(self) -> tuple[PlayerRow, ...]:
        """The rows, from the top."""
        return self._rows

    def show_rows(self, rows: tuple[PlayerRow, ...]) -> None:
        """Show these."""
        if [row.player.id for row in rows] != [row.player.id for row in self._rows]:
            self.beginResetModel()
            self._rows = rows
            self.endResetModel()
            return
        before, self._rows = self._rows, rows
        for number, (old, new) in enumerate(zip(before, rows, strict=True)):
            if old != new:
                self.dataChanged.emit(self.index(number), self.index(number))

    def number(self, player_id: str) -> int | None:
        """The row of a player."""
        return next((number for number, row in enumerate(self._rows) if row.player.id == player_id), None)

    # Qt's own names

    def rowCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self._rows)

    def data(self, index: AnyIndex, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        row = self._rows[index.row()]
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return row.player.name
        if role == Qt.ItemDataRole.AccessibleDescriptionRole:
            return row.instrument
        if role == ID_ROLE:
            return row.player.id
        return row if role == _ROW else None

    def setData(self, index: AnyIndex, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        if role != Qt.ItemDataRole.EditRole or not isinstance(value, str):
            return False
        player = self._rows[index.row()].player
        if value.strip() and value != player.name:
            self.renamed.emit(player.id, value)
        return True

    def flags(self, index: AnyIndex) -> Qt.ItemFlag:
        return Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsEditable


class _RowDelegate(RowDelegate):
    """Draws a row: colour, name, instrument, leader's crown, problems, record arm, mute and solo."""

    def buttons(self, row: QRect) -> tuple[QRect, QRect]:
        """Places of the buttons mute and solo."""
        top = row.center().y() - BUTTON_PX // 2 + 1
        solo = QRect(row.right() - BUTTON_PX - 3, top, BUTTON_PX, BUTTON_PX)
        return solo.translated(-BUTTON_PX - 2, 0), solo

    def arm_button(self, row: QRect) -> QRect:
        """Rectangle of the record-arm mark; empty while there is no device to record from."""
        if not self._session.recording.port:
            return QRect()
        return self.buttons(row)[0].translated(-BUTTON_PX - 2, 0)

    # Qt's own names

    def sizeHint(self, option: QStyleOptionViewItem, index: AnyIndex) -> QSize:
        lines = QFontMetricsF(self._view.font()).height() + QFontMetricsF(self._small_font()).height()
        return QSize(120, max(ROW_PX, round(lines) + 7))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        row: PlayerRow = index.data(_ROW)
        tokens, box = self._session.tokens, option.rect
        in_front = self._session.players[:1] == (row.player.id,)
        painter.save()
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
        # Dim text would be lost upon the selection.
        dim = tokens.text if in_front else tokens.text_dim
        painter.setPen(QColor(tokens.warning if row.unseen else dim))
        lower = QRect(room.left(), room.top() + half, right - room.left(), room.height() - half)
        text = self.tr("row_delegate.cannot_be_seen") if row.unseen else row.instrument
        text = QFontMetricsF(small).elidedText(text, Qt.TextElideMode.ElideRight, lower.width())
        painter.drawText(lower, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, text)

    def _paint_arm(self, painter: QPainter, box: QRect, player_id: str, in_front: bool) -> None:
        """Full: always recorded; a red ring: recorded while in front; a dim one: not recorded."""
        tokens, armed = self._session.tokens, self._session.recording.armed
        is_next = armed == player_id or (not armed and in_front)
        painter.setPen(QPen(QColor(tokens.error if is_next else tokens.line_strong), 1.5))
        painter.setBrush(QColor(tokens.error) if armed == player_id else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(QRectF(box).center(), 5.5, 5.5)

    def _paint_button(self, painter: QPainter, box: QRect, letter: str, on: bool, colour: str) -> None:
        tokens = self._session.tokens
        painter.setBrush(QColor(colour) if on else Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(colour if on else tokens.line_strong), 1.0))
        painter.drawRoundedRect(QRectF(box).adjusted(2.5, 2.5, -2.5, -2.5), 3, 3)
        painter.setFont(self._small_font())
        painter.setPen(QColor(tokens.sunken if on else tokens.text_dim))
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
        row: PlayerRow = index.data(_ROW)
        mute, solo = self.buttons(box)
        if mute.contains(at):
            return self.tr("row_delegate.mute_silent_but_still")
        if solo.contains(at):
            return self.tr("row_delegate.solo_only_these_sound")
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


class PlayerList(OrderedList):
    """The players: click, Ctrl and Shift select; drag or Alt with the arrows reorders; F2 or a double click renames.

    Signals
    -------
    mute_clicked(str), solo_clicked(str), arm_clicked(str)
        The button of this player.
    chosen(object)
        The user selected these ids (tuple of str), the first in front.
    """

    mute_clicked = Signal(str)
    solo_clicked = Signal(str)
    arm_clicked = Signal(str)
    chosen = Signal(object)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(session, parent)
        self.rows = PlayerModel(self)
        self._delegate = _RowDelegate(session, self)
        self._showing = False
        self._searched = ""
        self.setModel(self.rows)
        self.setItemDelegate(self._delegate)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.selectionModel().selectionChanged.connect(self._selected)
        session.recording.changed.connect(self.viewport().update)

    def height_of_rows(self) -> int:
        """Height of the list without scrolling, pixels."""
        return max(self.sizeHintForRow(0), 0) * self.rows.rowCount() + 2 * self.frameWidth()

    def show_rows(self, rows: tuple[PlayerRow, ...]) -> None:
        """Show these players, and which of them are selected."""
        self._showing = True
        self.rows.show_rows(rows)
        self._showing = False
        self._hide_rows()
        self.show_selection()

    def search(self, text: str) -> None:
        """Show only the players whose name or instrument contains a text, in upper or lower case."""
        self._searched = text.strip().casefold()
        self._hide_rows()

    @property
    def found(self) -> tuple[str, ...]:
        """Ids of the players that the search shows."""
        return tuple(
            row.player.id
            for row in self.rows.rows
            if self._searched in row.player.name.casefold() or self._searched in row.instrument.casefold()
        )

    def _hide_rows(self) -> None:
        found = set(self.found)
        for number, row in enumerate(self.rows.rows):
            self.setRowHidden(number, row.player.id not in found)

    def show_selection(self) -> None:
        """Show whom the session has selected."""
        numbers = [self.rows.number(player_id) for player_id in self._session.players]
        requested = [number for number in numbers if number is not None]
        self._showing = True
        selection = QItemSelection()
        for number in requested:
            selection.select(self.rows.index(number), self.rows.index(number))
        model = self.selectionModel()
        flags = QItemSelectionModel.SelectionFlag
        if requested and self.currentIndex().row() != requested[0]:
            model.setCurrentIndex(self.rows.index(requested[0]), flags.NoUpdate)
        model.select(selection, flags.ClearAndSelect)
        self._showing = False
        self.viewport().update()

    def _selected(self) -> None:
        if self._showing:
            return
        rows = self.rows.rows
        numbers = sorted(index.row() for index in self.selectionModel().selectedIndexes())
        current = self.currentIndex().row()
        if current in numbers:
            numbers.remove(current)
            numbers.insert(0, current)
        self.chosen.emit(tuple(rows[number].player.id for number in numbers))

    def _button_at(self, position: QPoint) -> tuple[Signal | None, str]:
        index = self.indexAt(position)
        if not index.isValid():
            return None, ""
        mute, solo = self._delegate.buttons(self.visualRect(index))
        player_id = self.rows.rows[index.row()].player.id
        if mute.contains(position):
            return self.mute_clicked, player_id  # type: ignore[return-value]
        if self._delegate.arm_button(self.visualRect(index)).contains(position):
            return self.arm_clicked, player_id  # type: ignore[return-value]
        return (self.solo_clicked, player_id) if solo.contains(position) else (None, "")  # type: ignore[return-value]

    # Qt's own names

    def mousePressEvent(self, event: QMouseEvent) -> None:
        signal, player_id = self._button_at(event.position().toPoint())
        if signal is not None and event.button() == Qt.MouseButton.LeftButton:
            self._let_go()
            signal.emit(player_id)  # type: ignore[attr-defined]
            return
        super().mousePressEvent(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if self._button_at(event.position().toPoint())[0] is not None:
            self.mousePressEvent(event)
        else:
            super().mouseDoubleClickEvent(event)
