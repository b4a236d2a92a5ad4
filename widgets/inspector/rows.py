"""A list of any number of lines with title, place and detail, drawn only where visible."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QAbstractListModel, QModelIndex, QPersistentModelIndex, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import QAbstractItemView, QListView, QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from app.editor.session import Session

AnyIndex = QModelIndex | QPersistentModelIndex
_ROW = Qt.ItemDataRole.UserRole
_PAD_PX = 8


@dataclass(frozen=True)
class ListRow:
    """Contents of a line.

    Attributes
    ----------
    key : object
        Object that identifies the line, passed on by a click.
    title, place, detail : str
        Texts: the place at the right, the detail below.
    colour : str
        Colour of the bar at the left; empty for none.
    tone : str
        ``""``, ``"warning"``, ``"by_hand"``, ``"faint"`` or ``"current"``.
    """

    key: object
    title: str
    place: str = ""
    detail: str = ""
    colour: str = ""
    tone: str = ""


class LineModel(QAbstractListModel):
    """Qt model of the lines that a `LineList` displays."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.lines: tuple[ListRow, ...] = ()

    def show_lines(self, lines: Sequence[ListRow]) -> None:
        """Replace the displayed lines; selection and scrolling are reset only if the keys change."""
        new = tuple(lines)
        if new == self.lines:
            return
        if [line.key for line in new] == [line.key for line in self.lines]:
            self.lines = new
            self.dataChanged.emit(self.index(0), self.index(len(new) - 1))
            return
        self.beginResetModel()
        self.lines = new
        self.endResetModel()

    # Qt overrides

    def rowCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self.lines)

    def data(self, index: AnyIndex, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        line = self.lines[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return line.title
        if role == Qt.ItemDataRole.ToolTipRole:
            return "\n".join(text for text in (line.title, line.place, line.detail) if text)
        return line if role == _ROW else None


class _LineDelegate(QStyledItemDelegate):
    def __init__(self, session: Session, view: LineList) -> None:
        super().__init__(view)
        self._session, self._view = session, view

    def _small(self) -> QFont:
        font = QFont(self._view.font())
        font.setPointSizeF(max(font.pointSizeF() - 0.5, 9.0))
        return font

    # Qt overrides

    def sizeHint(self, option: QStyleOptionViewItem, index: AnyIndex) -> QSize:
        height = _line_px(self._view.font()) + 6
        if self._view.has_details:
            height += 2 * _line_px(self._small())
        return QSize(100, max(26, round(height)))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        line: ListRow = index.data(_ROW)
        tokens, box = self._session.tokens, option.rect
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if option.state & QStyle.StateFlag.State_Selected:
            fill = QColor(tokens.accent)
            fill.setAlphaF(0.25)
            painter.fillRect(box, fill)
        elif option.state & QStyle.StateFlag.State_MouseOver:
            painter.fillRect(box, QColor(tokens.raised))
        if line.colour:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(line.colour))
            painter.drawRoundedRect(QRectF(box.left() + 3, box.top() + 4, 4, box.height() - 8), 2, 2)
        room = box.adjusted(_PAD_PX + 4, 3, -_PAD_PX, -3)
        self._paint_texts(painter, room, line)
        painter.setPen(QColor(tokens.line))
        painter.drawLine(box.bottomLeft(), box.bottomRight())
        if option.state & QStyle.StateFlag.State_HasFocus and self._view.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(tokens.accent), 1.5))
            painter.drawRoundedRect(QRectF(box).adjusted(1, 1, -1, -1.5), 3, 3)
        painter.restore()

    def _paint_texts(self, painter: QPainter, room: QRect, line: ListRow) -> None:
        tokens = self._session.tokens
        colours = {"warning": tokens.warning, "by_hand": tokens.by_hand, "faint": tokens.text_dim}
        font, small = QFont(self._view.font()), self._small()
        font.setBold(line.tone == "current")
        first = round(_line_px(font))
        if not self._view.has_details:
            first = room.height()
        upper = QRect(room.left(), room.top(), room.width(), first)
        painter.setFont(small)
        painter.setPen(QColor(tokens.text_dim))
        painter.drawText(upper, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, line.place)
        place_px = round(QFontMetricsF(small).horizontalAdvance(line.place))
        painter.setFont(font)
        painter.setPen(QColor(colours.get(line.tone, tokens.text)))
        title_px = upper.width() - place_px - 8
        title = QFontMetricsF(font).elidedText(line.title, Qt.TextElideMode.ElideRight, title_px)
        painter.drawText(upper, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, title)
        if not line.detail:
            return
        lower = QRect(room.left(), room.top() + first, room.width(), room.height() - first)
        painter.setFont(small)
        painter.setPen(QColor(tokens.text_dim))
        flags = Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextWordWrap
        painter.drawText(lower, flags, _two_lines(QFontMetricsF(small), line.detail, lower.width()))


class LineList(QListView):
    """List of lines that are selected by arrow keys and opened by a click or Return.

    Parameters
    ----------
    has_details : bool
        Whether lines have a second and third row.

    Signals
    -------
    opened(object)
        The line of this key was clicked, or opened by Return.
    deleted()
        The user pressed Delete or Backspace.
    """

    opened = Signal(object)
    deleted = Signal()

    def __init__(self, session: Session, has_details: bool = True, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.has_details = has_details
        self.lines = LineModel(self)
        self.setModel(self.lines)
        self.setItemDelegate(_LineDelegate(session, self))
        self.setUniformItemSizes(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setMouseTracking(True)
        self.setMinimumHeight(60)
        self.clicked.connect(self._open)
        session.theme_changed.connect(self.viewport().update)

    def selected_keys(self) -> tuple[object, ...]:
        """Keys of the selected lines, from top to bottom."""
        numbers = sorted(index.row() for index in self.selectionModel().selectedIndexes())
        return tuple(self.lines.lines[number].key for number in numbers)

    def height_px(self, most_lines: int | None = None) -> int:
        """Return the height in pixels at which all lines, or a number of them, are visible."""
        count = self.lines.rowCount()
        lines_px = (count if most_lines is None else min(count, most_lines)) * self.sizeHintForRow(0)
        return max(lines_px + 2 * self.frameWidth(), self.minimumHeight())

    def _open(self, index: QModelIndex) -> None:
        if index.isValid():
            self.opened.emit(self.lines.lines[index.row()].key)

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._open(self.currentIndex())
        elif event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.deleted.emit()
        else:
            super().keyPressEvent(event)


def _line_px(font: QFont) -> float:
    """Return the height of a line in pixels that fits all scripts, since glyphs of a fallback font may be taller."""
    metrics = QFontMetricsF(font)
    return max(metrics.height(), metrics.boundingRect("漢あÁgj").height() + 1.0)


def _two_lines(metrics: QFontMetricsF, text: str, width_px: int) -> str:
    """Return the text shortened to about two lines."""
    return metrics.elidedText(text, Qt.TextElideMode.ElideRight, width_px * 1.85)
