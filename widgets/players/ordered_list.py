"""Base of the lists of players and dancers, whose rows the user can reorder."""

from __future__ import annotations

from typing import Final, TypeAlias

from PySide6.QtCore import (
    QEvent,
    QItemSelectionModel,
    QModelIndex,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QRectF,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QHelpEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QListView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QToolTip,
    QWidget,
)

from app.editor.session import Session
from widgets.common.icons import icon

ID_ROLE: Final = Qt.ItemDataRole.UserRole + 1
"""Item role of a row's id (str)."""
AnyIndex: TypeAlias = QModelIndex | QPersistentModelIndex
_BAR_PX = 5


class OrderedList(QListView):
    """A list in which a drag or Alt with the arrows reorders, and F2 or a double click renames.

    Its model provides an id for each row as `ID_ROLE`.

    Signals
    -------
    moved(object, int)
        The user moved the rows with these ids (tuple of str) before the row that had this index.
    """

    moved = Signal(object, int)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._press: QPoint | None = None
        self._pressed_number = -1
        self._drop_row: int | None = None
        self.setEditTriggers(QAbstractItemView.EditTrigger.EditKeyPressed | QAbstractItemView.EditTrigger.DoubleClicked)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setUniformItemSizes(True)
        self.setMouseTracking(True)

    def rename_current(self) -> None:
        """Open the field for the name of the current row."""
        if self.currentIndex().isValid():
            self.setFocus(Qt.FocusReason.OtherFocusReason)
            self.scrollTo(self.currentIndex())
            self.edit(self.currentIndex())

    def _count(self) -> int:
        return self.model().rowCount()

    def _box(self, number: int) -> QRect:
        return self.visualRect(self.model().index(number, 0))

    def _selected_numbers(self) -> list[int]:
        """Return the indices of the rows moved by a drag or Alt with an arrow."""
        return sorted(index.row() for index in self.selectionModel().selectedIndexes())

    def _move(self, before: int) -> None:
        numbers = self._selected_numbers()
        ids = tuple(str(self.model().index(number, 0).data(ID_ROLE)) for number in numbers)
        if ids:
            self.moved.emit(ids, before)

    def _shift(self, step: int) -> None:
        numbers = self._selected_numbers()
        if not numbers:
            return
        target = numbers[0] - 1 if step < 0 else numbers[-1] + 2
        if 0 <= target <= self._count():
            self._move(target)

    def _drop_row_at(self, y: int) -> int:
        rows = range(self._count())
        return next((number for number in rows if y < self._box(number).center().y()), self._count())

    def _edge_px(self, number: int) -> int:
        """Return the y position in pixels of the upper edge of a row; the lower edge of the last visible row if the row
        is hidden or does not exist.
        """
        if number < self._count() and self._box(number).isValid():
            return self._box(number).top()
        above = (self._box(row).bottom() for row in range(number - 1, -1, -1) if self._box(row).isValid())
        return next(above, 0)

    def _let_go(self) -> None:
        self._press, self._pressed_number = None, -1

    # Qt overrides

    def mousePressEvent(self, event: QMouseEvent) -> None:
        position = event.position().toPoint()
        self._let_go()
        index = self.indexAt(position)
        if event.button() == Qt.MouseButton.LeftButton and index.isValid():
            self._press = position
            plain = event.modifiers() == Qt.KeyboardModifier.NoModifier
            if plain and self.selectionModel().isSelected(index) and len(self._selected_numbers()) > 1:
                # Possibly the start of a drag of all selected rows: the release shows whether it was a click.
                self._pressed_number = index.row()
                return
        elif event.button() == Qt.MouseButton.RightButton:
            if index.isValid() and not self.selectionModel().isSelected(index):
                self.selectionModel().setCurrentIndex(index, QItemSelectionModel.SelectionFlag.ClearAndSelect)
            return
        super().mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._press is None or not event.buttons() & Qt.MouseButton.LeftButton:
            super().mouseMoveEvent(event)
            return
        position = event.position().toPoint()
        far = (position - self._press).manhattanLength() >= QApplication.startDragDistance()
        if self._drop_row is not None or (far and self._count() > 1):
            self._drop_row = self._drop_row_at(position.y())
            self.viewport().update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        target, self._drop_row = self._drop_row, None
        pressed, was_pressed = self._pressed_number, self._press is not None
        self._let_go()
        self.viewport().update()
        if target is not None:
            self._move(target)
        elif was_pressed and pressed >= 0:
            flags = QItemSelectionModel.SelectionFlag
            self.selectionModel().setCurrentIndex(self.model().index(pressed, 0), flags.ClearAndSelect)
        else:
            super().mouseReleaseEvent(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        index = self.indexAt(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and index.isValid():
            # Qt does not treat it as a click on the row if the press changed the selection.
            self.edit(index)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._drop_row is not None:
            self._drop_row = None
            self._let_go()
            self.viewport().update()
        elif event.modifiers() == Qt.KeyboardModifier.AltModifier and event.key() in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._shift(-1 if event.key() == Qt.Key.Key_Up else 1)
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self._drop_row is None:
            return
        painter = QPainter(self.viewport())
        painter.fillRect(
            QRect(0, self._edge_px(self._drop_row) - 1, self.viewport().width(), 3), QColor(self._session.tokens.accent)
        )


class RowDelegate(QStyledItemDelegate):
    """Draws the common parts of rows: colour, selection, number of problems, focus frame."""

    def __init__(self, session: Session, view: OrderedList) -> None:
        super().__init__(view)
        self._session, self._view = session, view

    def paint_ground(
        self, painter: QPainter, option: QStyleOptionViewItem, colour: str, opacity: float, inset_px: int
    ) -> None:
        """Paint the background of a row.

        Parameters
        ----------
        colour : str
            Colour of the bar at the left.
        opacity : float
            Opacity of the accent colour in selected rows.
        inset_px : int
            Space above and below the bar.
        """
        tokens, box = self._session.tokens, option.rect
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if option.state & QStyle.StateFlag.State_Selected:
            fill = QColor(tokens.accent)
            fill.setAlphaF(opacity)
            painter.fillRect(box, fill)
        elif option.state & QStyle.StateFlag.State_MouseOver:
            painter.fillRect(box, QColor(tokens.raised))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(colour))
        bar = QRectF(box.left() + 4, box.top() + inset_px, _BAR_PX, box.height() - 2 * inset_px)
        painter.drawRoundedRect(bar, 2, 2)

    def paint_problems(self, painter: QPainter, room: QRect, count: int, font: QFont) -> int:
        """Draw a mark with the number of problems at the right end of ``room``, and return the right end of the
        remaining space in pixels.
        """
        if not count:
            return room.right()
        tokens, text = self._session.tokens, str(count)
        width = round(QFontMetricsF(font).horizontalAdvance(text)) + 20
        spot = QRect(room.right() - width, room.top(), width, room.height())
        icon("problem", tokens, tokens.warning).paint(painter, QRect(spot.left(), spot.center().y() - 7, 16, 16))
        painter.setFont(font)
        painter.setPen(QColor(tokens.warning))
        painter.drawText(spot, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, text)
        return spot.left() - 6

    def paint_frame(self, painter: QPainter, box: QRect, is_front: bool) -> None:
        """Draw the line below a row, and a frame around a row with the keyboard focus; ``is_front`` marks the active
        one.
        """
        tokens = self._session.tokens
        painter.setPen(QColor(tokens.line))
        painter.drawLine(box.bottomLeft(), box.bottomRight())
        if is_front and self._view.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(tokens.accent), 1.5))
            painter.drawRoundedRect(QRectF(box).adjusted(1, 1, -1, -1.5), 3, 3)

    def tip(self, index: AnyIndex, box: QRect, at: QPoint) -> str:
        """Return the tool tip for a point in a row with a rectangle."""
        raise NotImplementedError

    def helpEvent(
        self, event: QHelpEvent, view: QAbstractItemView, option: QStyleOptionViewItem, index: AnyIndex
    ) -> bool:
        if event.type() != QEvent.Type.ToolTip or not index.isValid():
            return False
        QToolTip.showText(event.globalPos(), self.tip(index, option.rect, event.pos()), view)
        return True
