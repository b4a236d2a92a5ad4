"""A list whose rows are put in another order by hand, as the players and the dancers are."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import QItemSelectionModel, QPoint, QRect, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QAbstractItemView, QApplication, QListView, QWidget

from app.editor.session import Session

ID_ROLE: Final = Qt.ItemDataRole.UserRole + 1
"""A row's id, str."""


class OrderedList(QListView):
    """A list in which a drag or Alt with the arrows reorders, and F2 or a double click renames.

    Its model has an id of each row as `ID_ROLE`.

    Signals
    -------
    moved(object, int)
        These ids (tuple of str) go before the row that had this number.
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
        """What a drag or Alt with an arrow moves."""
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

    def _let_go(self) -> None:
        self._press, self._pressed_number = None, -1

    # Qt's own names

    def mousePressEvent(self, event: QMouseEvent) -> None:
        position = event.position().toPoint()
        self._let_go()
        index = self.indexAt(position)
        if event.button() == Qt.MouseButton.LeftButton and index.isValid():
            self._press = position
            plain = event.modifiers() == Qt.KeyboardModifier.NoModifier
            if plain and self.selectionModel().isSelected(index) and len(self._selected_numbers()) > 1:
                # Perhaps a drag of all of them: whether it was a click is known at the release.
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
            # Qt forgets that the row was pressed where the press changed the selection.
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
        last = self._drop_row >= self._count()
        box = self._box(min(self._drop_row, self._count() - 1))
        painter = QPainter(self.viewport())
        painter.fillRect(
            QRect(0, (box.bottom() if last else box.top()) - 1, self.viewport().width(), 3),
            QColor(self._session.tokens.accent),
        )
