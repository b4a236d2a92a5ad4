"""Gallery of the basic motions of a choreography."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from PySide6.QtCore import (
    QAbstractListModel,
    QItemSelectionModel,
    QModelIndex,
    QPersistentModelIndex,
    QRectF,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen
from PySide6.QtWidgets import QAbstractItemView, QListView, QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from app.editor.design_tokens import LEAST_TEXT_PT
from app.editor.session import Session
from widgets.common.choreography.figures import draw_figures, placed

if TYPE_CHECKING:
    from app.choreography.overview import BasicMotion

AnyIndex = QModelIndex | QPersistentModelIndex

FIGURE_PX: Final = 92
CARD_PX: Final = 228
_GAP_PX: Final = 8
_EDGE_PX: Final = 9
_STATE: Final = Qt.ItemDataRole.UserRole


class MotionModel(QAbstractListModel):
    """Qt model of basic motions as rows.

    Attributes
    ----------
    used : mapping of int to int
        Number of times that the dancer dances each basic motion in the piece.
    sources : int
        Number of motion files from which the choreography was learned.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.motions: Sequence[BasicMotion] = ()
        self.used: Mapping[int, int] = {}
        self.sources = 0

    def show_motions(self, motions: Sequence[BasicMotion], used: Mapping[int, int], sources: int) -> None:
        """Replace the displayed basic motions; ``used`` counts how often each is danced, ``sources`` is the number of
        motion files.
        """
        self.beginResetModel()
        self.motions, self.used, self.sources = motions, used, sources
        self.endResetModel()

    def segments_text(self, state: int) -> str:
        """Return number and mean length of the segments of a basic motion as text."""
        motion = self.motions[state]
        return self.tr("motion_model.segments_summary").format(count=motion.segments, seconds=motion.mean_s)

    def sources_text(self, state: int) -> str:
        """Return the number of motion files that contain a basic motion as text."""
        return self.tr("motion_model.sources_of").format(count=len(self.motions[state].sources), all=self.sources)

    def used_text(self, state: int) -> str:
        """Return the number of times that a basic motion is danced in the piece as text."""
        count = self.used.get(state, 0)
        return self.tr("motion_model.danced").format(count=count) if count else self.tr("motion_model.not_danced")

    # Qt overrides

    def rowCount(self, parent: AnyIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self.motions)

    def data(self, index: AnyIndex, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        if not index.isValid():
            return None
        state = index.row()
        if role == Qt.ItemDataRole.DisplayRole:
            return str(state + 1)
        if role == Qt.ItemDataRole.AccessibleTextRole:
            name = self.tr("motion_model.basic_motion").format(number=state + 1)
            return ", ".join((name, self.segments_text(state), self.sources_text(state), self.used_text(state)))
        return state if role == _STATE else None


class MotionGallery(QListView):
    """Cards that fill the width; the arrow keys select.

    Signals
    -------
    selected(int)
        Another basic motion was selected.
    """

    selected = Signal(int)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.rows = MotionModel(self)
        self._delegate = _CardDelegate(session, self)
        self.setModel(self.rows)
        self.setItemDelegate(self._delegate)
        self.setViewMode(QListView.ViewMode.IconMode)
        self.setResizeMode(QListView.ResizeMode.Adjust)
        self.setMovement(QListView.Movement.Static)
        self.setUniformItemSizes(True)
        self.setSpacing(_GAP_PX // 2)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setMouseTracking(True)
        self.selectionModel().currentChanged.connect(lambda index: self.selected.emit(index.row()))

    def show_motions(
        self, motions: Sequence[BasicMotion], used: Mapping[int, int], sources: int, colour: str, mirrored: bool
    ) -> None:
        """Show basic motions in a dancer's colour, mirrored if the dancer is, keeping the selection; see
        `MotionModel.show_motions`.
        """
        before = max(self.currentIndex().row(), 0)
        self._delegate.colour, self._delegate.mirrored = colour, mirrored
        self.rows.show_motions(motions, used, sources)
        if motions:
            index = self.rows.index(min(before, len(motions) - 1))
            self.selectionModel().setCurrentIndex(index, QItemSelectionModel.SelectionFlag.ClearAndSelect)


class _CardDelegate(QStyledItemDelegate):
    """Draws a card: number, times danced, three poses, segments and sources."""

    def __init__(self, session: Session, view: MotionGallery) -> None:
        super().__init__(view)
        self._session = session
        self._view = view
        self.colour = ""
        self.mirrored = False

    def _small_font(self) -> QFont:
        font = QFont(self._view.font())
        font.setPointSizeF(max(font.pointSizeF() - 0.5, LEAST_TEXT_PT))
        return font

    def _line_px(self) -> float:
        return QFontMetricsF(self._view.font()).height()

    # Qt overrides

    def sizeHint(self, option: QStyleOptionViewItem, index: AnyIndex) -> QSize:
        rows = self._view.rows
        small = QFontMetricsF(self._small_font())
        texts = [text(state) for state in range(len(rows.motions)) for text in (rows.segments_text, rows.sources_text)]
        wide = max((small.horizontalAdvance(text) for text in texts), default=0.0) + 2 * _EDGE_PX
        lines = self._line_px() + 2 * small.height()
        return QSize(max(CARD_PX, round(wide)), round(lines) + FIGURE_PX + 2 * _EDGE_PX + 8)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        state = int(index.data(_STATE))
        tokens, rows = self._session.tokens, self._view.rows
        motion, count = rows.motions[state], rows.used.get(state, 0)
        chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        box = QRectF(option.rect).adjusted(2, 2, -2, -2)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        edge = QColor(tokens.accent if chosen else tokens.line)
        painter.setPen(QPen(edge, 2.0 if chosen and self._view.hasFocus() else 1.0))
        painter.setBrush(QColor(tokens.raised))
        painter.drawRoundedRect(box, 5, 5)
        room = box.adjusted(_EDGE_PX, _EDGE_PX - 2, -_EDGE_PX, -_EDGE_PX + 2)
        self._paint_texts(painter, room, state, count)
        drawn = motion.poses * ((-1.0, 1.0) if self.mirrored else (1.0, 1.0))
        floor_px = room.top() + self._line_px() + FIGURE_PX
        middles = room.left() + room.width() * np.array([1.0, 3.0, 5.0]) / 6.0
        painter.setPen(QPen(QColor(tokens.line_strong), 1.0))
        painter.drawLine(round(room.left()), round(floor_px + 3), round(room.right()), round(floor_px + 3))
        pixels = placed(drawn, middles, floor_px, FIGURE_PX)
        # The pose at the accent is the one danced on the beat.
        draw_figures(painter, pixels[[0, 2]], QColor(tokens.text_dim), 1.6, FIGURE_PX)
        draw_figures(painter, pixels[[1]], QColor(self.colour or tokens.text), 2.2, FIGURE_PX)
        painter.restore()

    def _paint_texts(self, painter: QPainter, room: QRectF, state: int, count: int) -> None:
        tokens, rows = self._session.tokens, self._view.rows
        small, bold = self._small_font(), QFont(self._view.font())
        bold.setBold(True)
        top = QRectF(room.left(), room.top(), room.width(), self._line_px())
        painter.setFont(bold)
        painter.setPen(QColor(tokens.text))
        painter.drawText(top, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, str(state + 1))
        painter.setFont(bold if count else small)
        painter.setPen(QColor(tokens.accent if count else tokens.text_dim))
        painter.drawText(top, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, rows.used_text(state))
        painter.setFont(small)
        high = QFontMetricsF(small).height()
        for number, text in enumerate((rows.sources_text(state), rows.segments_text(state))):
            painter.setPen(QColor(tokens.text_dim if number == 0 else tokens.text))
            line = QRectF(room.left(), room.bottom() - (number + 1) * high, room.width(), high)
            painter.drawText(line, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, text)
