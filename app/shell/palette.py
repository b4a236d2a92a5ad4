"""The command palette: a search field for all commands, in either language."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QPoint, QRect, QSize, Qt
from PySide6.QtGui import QColor, QKeyEvent, QKeySequence, QPainter, QPalette, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import (
    QApplication,
    QFrame,
    QLineEdit,
    QListView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QWidget,
)

from app.editor.session import Session
from app.shell.action import without_dots
from app.shell.actions import ActionTable, sequences
from app.shell.fuzzy import fitness
from app.shell.language import TEXTS
from widgets.common.controls import Caption, Retranslated, named
from widgets.common.layouts import in_column

WIDTH_PX, ROW_PX, MOST_ROWS = 560, 30, 14
_ID = int(Qt.ItemDataRole.UserRole)
_PLACE, _KEYS = _ID + 1, _ID + 2


class Palette(Retranslated, QFrame):
    """A search field with a list of matching commands, which closes itself."""

    def __init__(self, session: Session, table: ActionTable, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("palette")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._session, self._table = session, table
        self._ran: list[str] = []
        self.field = self.texted(
            named(QLineEdit(), "palette_field"),
            placeholder="palette.search_field",
            name="palette.search_commands",
        )
        self.field.setClearButtonEnabled(True)
        self.field.textChanged.connect(self._search)
        self.field.installEventFilter(self)
        self.model = QStandardItemModel(self)
        self.list = self.texted(named(QListView(), "palette_list"), name="palette.commands")
        self.list.setModel(self.model)
        self.list.setItemDelegate(_Row(session, self.list))
        self.list.setEditTriggers(QListView.EditTrigger.NoEditTriggers)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setFrameShape(QFrame.Shape.NoFrame)
        self.list.setMouseTracking(True)
        self.list.clicked.connect(self._run)
        self.nothing = named(Caption("palette.no_match"), "palette_nothing")
        self.nothing.setFixedHeight(ROW_PX)
        self.nothing.setIndent(8)
        in_column(self.field, self.list, self.nothing, of=self, margins=6, spacing=6)

    def open_at(self, corner: QPoint) -> None:
        """Open with the top right corner at a point of the screen."""
        self._table.refresh()
        self.field.clear()
        self._search("")
        self.move(corner - QPoint(self.width(), 0))
        self.show()
        self.field.setFocus(Qt.FocusReason.PopupFocusReason)

    def found(self) -> list[str]:
        """Return the ids of the listed commands, the best match first."""
        return [str(self.model.item(row).data(_ID)) for row in range(self.model.rowCount())]

    def _search(self, query: str) -> None:
        self.model.clear()
        for action_id in self._best(query):
            action = self._table.actions[action_id]
            item = QStandardItem(without_dots(action.text()))
            item.setData(action_id, _ID)
            item.setData(self._table.rows[action_id].place, _PLACE)
            native = QKeySequence.SequenceFormat.NativeText
            keys = sequences(self._table.keys(action_id))
            item.setData(keys[0].toString(native) if keys else "", _KEYS)
            item.setIcon(action.icon())
            item.setEnabled(action.isEnabled())
            self.model.appendRow(item)
        rows = min(self.model.rowCount(), MOST_ROWS)
        self.list.setFixedHeight(rows * ROW_PX + 4)
        self.list.setVisible(rows > 0)
        self.nothing.setVisible(rows == 0)
        self.nothing.setStyleSheet(f"color: {self._session.tokens.text_dim};")
        self.setFixedWidth(WIDTH_PX)
        self.adjustSize()
        if self.model.rowCount():
            self.list.setCurrentIndex(self.model.index(0, 0))

    def _best(self, query: str) -> list[str]:
        """Return the ids of matching commands: available ones first, then unavailable ones, then matches of scattered
        letters; the recently used commands for an empty query.
        """
        scored: list[tuple[bool, bool, float, int, str]] = []
        whole = 2.0 * len("".join(query.split())) - 1.0
        for order, (action_id, row) in enumerate(self._table.rows.items()):
            if action_id == "application.palette":
                continue
            action = self._table.actions[action_id]
            if not query.strip():
                recent = self._ran.index(action_id) if action_id in self._ran else len(self._ran)
                scored.append((False, not action.isEnabled(), float(recent), order, action_id))
                continue
            menu, english = row.menu.replace("/", " "), without_dots(TEXTS[f"action.{action_id}"][0])
            names = (without_dots(action.text()), english, f"{row.place} {action.text()}", menu)
            values = [fitness(query, name) for name in (*names[:3], f"{menu} {english}")]
            fits = [value - 0.5 * (place > 1) for place, value in enumerate(values) if value is not None]
            if fits:
                scored.append((max(fits) < whole, not action.isEnabled(), -max(fits), order, action_id))
        return [action_id for *_, action_id in sorted(scored)]

    def _run(self, index: QModelIndex | QPersistentModelIndex) -> None:
        action_id = index.data(_ID)
        action = self._table.actions.get(action_id)
        if action is None or not action.isEnabled():
            return
        self.hide()
        self._ran = [action_id, *(other for other in self._ran if other != action_id)]
        action.trigger()

    def _step(self, rows: int) -> None:
        count = self.model.rowCount()
        if count:
            self.list.setCurrentIndex(self.model.index((self.list.currentIndex().row() + rows) % count, 0))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle keys of the field that move in the list."""
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            steps = {
                Qt.Key.Key_Down: 1,
                Qt.Key.Key_Up: -1,
                Qt.Key.Key_PageDown: MOST_ROWS - 1,
                Qt.Key.Key_PageUp: 1 - MOST_ROWS,
            }
            key = Qt.Key(event.key())
            if key in steps:
                self._step(steps[key])
                return True
            if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self._run(self.list.currentIndex())
                return True
        return super().eventFilter(watched, event)


class _Row(QStyledItemDelegate):
    """Draws one row of the command palette: icon, text, menu and shortcut of a command."""

    def __init__(self, session: Session, parent: QWidget) -> None:
        super().__init__(parent)
        self._session = session

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        """Draw one command of the palette: title, menu and shortcut, dimmed if it is not available."""
        tokens = self._session.tokens
        style: Any = option
        chosen = bool(style.state & QStyle.StateFlag.State_Selected)
        enabled = bool(style.state & QStyle.StateFlag.State_Enabled)
        area: QRect = style.rect
        painter.save()
        if chosen:
            painter.fillRect(area, QColor(tokens.accent if enabled else tokens.line))
        group = QPalette.ColorGroup.Normal if enabled else QPalette.ColorGroup.Disabled
        role = QPalette.ColorRole.HighlightedText if chosen and enabled else QPalette.ColorRole.Text
        colour = QApplication.palette().color(group, role)
        dim = QColor(colour) if chosen and enabled else QColor(tokens.text_dim)
        drawing = index.data(Qt.ItemDataRole.DecorationRole)
        if drawing is not None:
            drawing.paint(painter, QRect(area.left() + 8, area.center().y() - 7, 16, 16))
        area = area.adjusted(34, 0, -10, 0)
        middle = Qt.AlignmentFlag.AlignVCenter
        keys, place, text = index.data(_KEYS), index.data(_PLACE), index.data(Qt.ItemDataRole.DisplayRole)
        metrics = painter.fontMetrics()
        painter.setPen(colour)
        painter.drawText(area, middle | Qt.AlignmentFlag.AlignRight, keys)
        area.setRight(area.right() - metrics.horizontalAdvance(keys) - 14)
        shown = metrics.elidedText(text, Qt.TextElideMode.ElideRight, area.width())
        painter.drawText(area, middle, shown)
        area.setLeft(area.left() + metrics.horizontalAdvance(shown) + 10)
        painter.setPen(dim)
        painter.drawText(area, middle, metrics.elidedText(place, Qt.TextElideMode.ElideRight, max(area.width(), 0)))
        painter.restore()

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        """Return the size of a row, the same for all."""
        return QSize(WIDTH_PX - 20, ROW_PX)
