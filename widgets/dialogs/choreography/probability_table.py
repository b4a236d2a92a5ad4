"""Table of probabilities as shades and numbers, with figures of basic motions or names as headings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from app.arrays import FloatArray
from app.editor.design_tokens import LEAST_TARGET_PX, LEAST_TEXT_PT, Tokens
from app.editor.session import Session
from widgets.common.choreography.figures import draw_figures, placed

AnyIndex = QModelIndex | QPersistentModelIndex

FIGURE_PX: Final = 38
COLUMN_PX: Final = 42
_LEAST_SHOWN: Final = 0.005
"""Probabilities below this are not shown, since they round to 0 %."""
_LEAST_SHADE, _MOST_SHADE = 0.06, 0.95


@dataclass(frozen=True, eq=False)
class Side:
    """Headings of the rows or columns.

    Attributes
    ----------
    names : tuple of str
        Numbers of basic motions, or names.
    marked : frozenset of int
        Indices that occur in the piece.
    notes : mapping of int to str
        Short texts beside names.
    figures : (N, 21, 2) float64, optional
        Stick figures of the basic motions, drawn instead of numbers.
    """

    names: tuple[str, ...]
    marked: frozenset[int]
    notes: Mapping[int, str]
    figures: FloatArray | None = None


_NONE: Final = Side((), frozenset(), {})


class _TableModel(QAbstractTableModel):
    """Qt model of a table (R, C) of probabilities, with headings of R rows and C columns."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.values: FloatArray = np.zeros((0, 0))
        self.rows, self.columns = _NONE, _NONE
        self.sentence: Callable[[int, int], str] = lambda row, column: ""

    def show_table(self, values: FloatArray, rows: Side, columns: Side, sentence: Callable[[int, int], str]) -> None:
        self.beginResetModel()
        self.values, self.rows, self.columns, self.sentence = values, rows, columns, sentence
        self.endResetModel()

    # Qt overrides

    def rowCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else self.values.shape[0]

    def columnCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else self.values.shape[1]

    def data(self, index: AnyIndex, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        if not index.isValid():
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            value = float(self.values[index.row(), index.column()])
            return f"{100.0 * value:.0f}" if value >= _LEAST_SHOWN else "·"
        if role in (Qt.ItemDataRole.ToolTipRole, Qt.ItemDataRole.AccessibleTextRole):
            return self.sentence(index.row(), index.column())
        return None

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        side = self.columns if orientation == Qt.Orientation.Horizontal else self.rows
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.AccessibleTextRole):
            return side.names[section]
        if role == Qt.ItemDataRole.ToolTipRole:
            return " · ".join(filter(None, (side.names[section], side.notes.get(section, ""))))
        return None


class ProbabilityTable(QTableView):
    """Table of probabilities as shades with percentages; the arrow keys select cells.

    Signals
    -------
    pointed(str)
        Sentence about the current cell; empty if there is none.
    """

    pointed = Signal(str)

    def __init__(self, session: Session, row_px: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.table = _TableModel(self)
        self.setModel(self.table)
        self.setItemDelegate(_CellDelegate(session, self))
        for header in (
            _Header(Qt.Orientation.Horizontal, session, self),
            _Header(Qt.Orientation.Vertical, session, self),
        ):
            if header.orientation() == Qt.Orientation.Horizontal:
                self.setHorizontalHeader(header)
                header.setMinimumSectionSize(COLUMN_PX)
            else:
                self.setVerticalHeader(header)
                header.setMinimumSectionSize(max(row_px, LEAST_TARGET_PX))
            header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.setShowGrid(False)
        self.setCornerButtonEnabled(False)
        self.setTabKeyNavigation(False)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setMouseTracking(True)
        self.selectionModel().currentChanged.connect(self._point)

    def show_table(self, values: FloatArray, rows: Side, columns: Side, sentence: Callable[[int, int], str]) -> None:
        """Show probabilities (R, C) of R rows and C columns keeping the current cell; ``sentence`` returns a text about
        a cell.
        """
        before = self.currentIndex()
        row, column = max(before.row(), 0), max(before.column(), 0)
        self.table.show_table(values, rows, columns, sentence)
        for header in (self.horizontalHeader(), self.verticalHeader()):
            assert isinstance(header, _Header)
            header.measure()
        if values.size:
            self.setCurrentIndex(self.table.index(min(row, values.shape[0] - 1), min(column, values.shape[1] - 1)))
        self._point(self.currentIndex())

    def _point(self, index: QModelIndex) -> None:
        self.pointed.emit(self.table.sentence(index.row(), index.column()) if index.isValid() else "")
        # Repaint the marks of its row and column in the headers.
        self.horizontalHeader().viewport().update()
        self.verticalHeader().viewport().update()


def _mixed(below: str, above: str, share: float) -> QColor:
    """Return the colour that results from painting ``above`` with the opacity ``share`` on ``below``."""
    one, other = QColor(below), QColor(above)
    red, green, blue = (
        below + (above - below) * share
        for below, above in ((one.redF(), other.redF()), (one.greenF(), other.greenF()), (one.blueF(), other.blueF()))
    )
    return QColor.fromRgbF(red, green, blue)


def _legible(tokens: Tokens, ground: QColor) -> QColor:
    """Return the theme's text colour that contrasts more with a ground."""
    candidates = [QColor(tokens.text), QColor(tokens.accent_text)]
    return max(candidates, key=lambda colour: _contrast(colour, ground))


def _contrast(one: QColor, other: QColor) -> float:
    """Return the contrast ratio of two colours as defined in WCAG 2.1, 1..21."""
    light, dark = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def _luminance(colour: QColor) -> float:
    """Return the relative luminance of a colour, 0..1, as defined in WCAG 2.1."""
    parts = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
        for part in (colour.redF(), colour.greenF(), colour.blueF())
    ]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


class _CellDelegate(QStyledItemDelegate):
    """Draws the cell of a probability; the higher it is, the more the colour differs from the background."""

    def __init__(self, session: Session, view: ProbabilityTable) -> None:
        super().__init__(view)
        self._session = session
        self._view = view

    # Qt overrides

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        tokens, values = self._session.tokens, self._view.table.values
        value, most = float(values[index.row(), index.column()]), float(values.max())
        box = QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5)
        seen = value >= _LEAST_SHOWN
        # Square roots distinguish rare transitions from impossible ones.
        share = _LEAST_SHADE + (_MOST_SHADE - _LEAST_SHADE) * (value / most) ** 0.5 if seen else 0.0
        ground = _mixed(tokens.sunken, tokens.accent, share)
        painter.save()
        painter.fillRect(box, ground)
        painter.setFont(self._view.font())
        painter.setPen(_legible(tokens, ground) if seen else QColor(tokens.text_dim))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, str(index.data()))
        if option.state & QStyle.StateFlag.State_Selected:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(QColor(tokens.text), 2.0 if self._view.hasFocus() else 1.0))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(box.adjusted(1, 1, -1, -1))
        painter.restore()


class _Header(QHeaderView):
    """Draws headings: stick figures with numbers, or names; marks those that occur in the piece."""

    def __init__(self, orientation: Qt.Orientation, session: Session, view: ProbabilityTable) -> None:
        super().__init__(orientation, view)
        self._session = session
        self._view = view
        self.setSectionsClickable(False)
        self.setHighlightSections(False)

    def measure(self) -> None:
        """Set the size that the headings need."""
        size = self.sizeHint()
        if self.orientation() == Qt.Orientation.Vertical:
            self.setFixedWidth(size.width())
        else:
            self.setFixedHeight(size.height())

    @property
    def _side(self) -> Side:
        table = self._view.table
        return table.columns if self.orientation() == Qt.Orientation.Horizontal else table.rows

    def _fonts(self) -> tuple[QFont, QFont]:
        """Return the fonts for names of motions (bold) and for the notes below them (small)."""
        bold, small = QFont(self._view.font()), QFont(self._view.font())
        bold.setBold(True)
        small.setPointSizeF(max(small.pointSizeF() - 0.5, LEAST_TEXT_PT))
        return bold, small

    def _notes_px(self) -> float:
        _, small = self._fonts()
        return max((QFontMetricsF(small).horizontalAdvance(note) for note in self._side.notes.values()), default=0.0)

    # Qt overrides

    def sizeHint(self) -> QSize:
        bold, small = (QFontMetricsF(font) for font in self._fonts())
        side = self._side
        if self.orientation() == Qt.Orientation.Horizontal:
            return QSize(0, round(FIGURE_PX + bold.height() + (small.height() if side.notes else 0.0)) + 10)
        names_px = max((bold.horizontalAdvance(name) for name in side.names), default=0.0)
        texts_px = max(names_px, self._notes_px()) if side.figures is not None else names_px
        return QSize(round(texts_px) + (FIGURE_PX + 6 if side.figures is not None else 14) + 14, 0)

    def paintSection(self, painter: QPainter, rect: QRect, section: int) -> None:
        tokens, side = self._session.tokens, self._side
        across = self.orientation() == Qt.Orientation.Horizontal
        current = self._view.currentIndex()
        here = (current.column() if across else current.row()) == section
        marked = section in side.marked
        bold, small = self._fonts()
        painter.save()
        painter.fillRect(rect, QColor(tokens.raised if here else tokens.surface))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box, name = QRectF(rect), side.names[section]
        colour = QColor(tokens.accent if marked else tokens.text_dim)
        if side.figures is None:
            if marked:
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(colour)
                painter.drawEllipse(QRectF(box.left() + 6, box.center().y() - 3, 6, 6))
            painter.setFont(bold if marked else self._view.font())
            painter.setPen(QColor(tokens.text if marked else tokens.text_dim))
            right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
            painter.drawText(box.adjusted(14, 0, -8, 0), right, name)
            painter.restore()
            return
        note = side.notes.get(section, "")
        high, note_high = QFontMetricsF(bold).height(), QFontMetricsF(small).height()
        if across:
            middle, floor_px = box.center().x(), box.top() + FIGURE_PX + 2
            first = QRectF(box.left(), floor_px + 4, box.width(), high)
            align = Qt.AlignmentFlag.AlignCenter
        else:
            middle, floor_px = box.left() + FIGURE_PX / 2 + 4, box.center().y() + FIGURE_PX / 2 - 3
            top = box.center().y() - (high + (note_high if note else 0.0)) / 2
            first = QRectF(box.left() + FIGURE_PX + 8, top, box.width() - FIGURE_PX - 12, high)
            align = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        pixels = placed(side.figures[[section]], np.array([middle]), floor_px, FIGURE_PX)
        draw_figures(painter, pixels, colour, 1.5, FIGURE_PX)
        painter.setFont(bold)
        painter.setPen(QColor(tokens.text if marked else tokens.text_dim))
        painter.drawText(first, align, name)
        if note:
            painter.setFont(small)
            painter.setPen(QColor(tokens.accent))
            painter.drawText(QRectF(first.left(), first.bottom(), first.width(), note_high), align, note)
        painter.restore()
