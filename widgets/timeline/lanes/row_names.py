"""Names of a lane's rows at the right of its header."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from widgets.timeline.lane import Lane
from widgets.timeline.plot.drawing import small_font

TITLE_PX = 26.0
"""Height in pixels of the title, beside which there is little space."""


class RowNames(QWidget):
    """Labels of rows in a header; labels that would overlap others are left out.

    Parameters
    ----------
    names : callable
        Returns the texts and the vertical positions of their centres in pixels of the plot, from the top.
    """

    def __init__(self, lane: Lane, names: Callable[[], Sequence[tuple[str, float]]]) -> None:
        super().__init__(lane.header)
        self._lane = lane
        self._names = names
        self.setObjectName("row_names")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        lane.header.installEventFilter(self)
        lane.session.theme_changed.connect(self.update)
        self.setGeometry(lane.header.rect())

    # Qt overrides

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self.setGeometry(self._lane.header.rect())
        return super().eventFilter(watched, event)

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._lane.folded:
            return
        painter = QPainter(self)
        painter.setFont(small_font(self.font()))
        painter.setPen(QColor(self._lane.session.tokens.text_dim))
        height = QFontMetricsF(painter.font()).height()
        title_px = QFontMetricsF(self._lane.title.font()).horizontalAdvance(self._lane.title.text()) + 30.0
        free_from = -height
        for text, middle in self._names():
            if not 0.0 <= middle <= self.height():
                # The row is scrolled out of view.
                continue
            top = min(max(middle - height / 2, 0.0), max(self.height() - height, 0.0))
            left = title_px if top < TITLE_PX - 6.0 else 4.0
            width = self.width() - 6.0 - left
            if top < free_from - 2.0 or width < QFontMetricsF(painter.font()).horizontalAdvance(text) * 0.6:
                continue
            shown = painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, int(width))
            painter.drawText(QRectF(left, top, width, height), Qt.AlignmentFlag.AlignRight, shown)
            free_from = top + height
