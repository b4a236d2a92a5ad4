"""List of dancers with one selected, which the user can reorder."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QItemSelectionModel, QModelIndex, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import QAbstractItemView, QLineEdit, QStyle, QStyleOptionViewItem, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.project.performers import Dancer
from widgets.common.controls import named
from widgets.players.ordered_list import ID_ROLE, AnyIndex, OrderedList, RowDelegate

_COLOUR, _PROBLEMS = ID_ROLE + 1, ID_ROLE + 2


class DancerList(OrderedList):
    """List of dancers: a click or the arrows select; drag or Alt with the arrows reorders; F2 or a double click
    renames.

    Signals
    -------
    chosen(str)
        The user selected this dancer.
    renamed(str, str)
        The user typed another name for the dancer of this id.
    """

    chosen = Signal(str)
    renamed = Signal(str, str)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(session, parent)
        self.rows = QStandardItemModel(self)
        self._showing = False
        self.setModel(self.rows)
        self.setItemDelegate(_RowDelegate(session, self))
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.rows.itemChanged.connect(self._edited)
        self.selectionModel().currentChanged.connect(self._selected)

    def show_dancers(self, dancers: Sequence[Dancer], selected: Dancer | None) -> None:
        """Show dancers as rows with one selected."""
        self._showing = True
        shown = [str(self.rows.item(row).data(ID_ROLE)) for row in range(self.rows.rowCount())]
        if shown != [dancer.id for dancer in dancers]:
            self.rows.clear()
            for dancer in dancers:
                item = QStandardItem()
                item.setData(dancer.id, ID_ROLE)
                item.setDropEnabled(False)
                self.rows.appendRow(item)
        for row, dancer in enumerate(dancers):
            item = self.rows.item(row)
            values = {
                Qt.ItemDataRole.EditRole: dancer.name,
                _COLOUR: self._session.colour(dancer),
                _PROBLEMS: len(self._session.problems(dancer.id)),
            }
            for role, value in values.items():
                if item.data(role) != value:
                    item.setData(value, role)
            if selected is not None and dancer.id == selected.id:
                flags = QItemSelectionModel.SelectionFlag.ClearAndSelect
                self.selectionModel().setCurrentIndex(item.index(), flags)
        self._showing = False
        self.viewport().update()

    def _edited(self, item: QStandardItem) -> None:
        if not self._showing:
            dancer_id, name = str(item.data(ID_ROLE)), item.text()
            if name != self._session.project.dancer(dancer_id).name:
                self.renamed.emit(dancer_id, name)

    def _selected(self, index: QModelIndex) -> None:
        if not self._showing and index.isValid():
            self.chosen.emit(str(index.data(ID_ROLE)))


class _RowDelegate(RowDelegate):
    """Draws a row: colour, name and number of problems."""

    def tip(self, index: AnyIndex, box: QRect, at: QPoint) -> str:
        count = int(index.data(_PROBLEMS) or 0)
        problems = [self.tr("row_delegate.problems").format(count=count)] if count else []
        return "\n".join([str(index.data()), *problems])

    # Qt overrides

    def sizeHint(self, option: QStyleOptionViewItem, index: AnyIndex) -> QSize:
        return QSize(120, max(LEAST_TARGET_PX, round(QFontMetricsF(self._view.font()).height()) + 8))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        tokens, box = self._session.tokens, option.rect
        selected = bool(option.state & QStyle.StateFlag.State_Selected)
        painter.save()
        self.paint_ground(painter, option, str(index.data(_COLOUR)), 0.28, 4)
        room = box.adjusted(16, 0, -6, 0)
        room.setRight(self.paint_problems(painter, room, int(index.data(_PROBLEMS) or 0), self._view.font()))
        font = QFont(self._view.font())
        font.setBold(selected)
        painter.setFont(font)
        painter.setPen(QColor(tokens.text))
        name = QFontMetricsF(font).elidedText(str(index.data()), Qt.TextElideMode.ElideRight, room.width())
        painter.drawText(room, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, name)
        self.paint_frame(painter, box, selected)
        painter.restore()

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: AnyIndex) -> QWidget:
        return named(QLineEdit(parent), "dancer_name")

    def updateEditorGeometry(self, editor: QWidget, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        editor.setGeometry(option.rect.adjusted(13, 1, -2, -2))
