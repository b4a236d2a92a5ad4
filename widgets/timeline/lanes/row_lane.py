"""Base class of lanes with rows of equal height that scroll."""

from __future__ import annotations

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from widgets.timeline.lane import Lane, LaneMouse
from widgets.timeline.zoom_and_scroll import TimeAxis


class RowLane(Lane):
    """A lane of rows; the wheel or a drag with the middle button scrolls.

    Attributes
    ----------
    row_limits_px : (int, int)
        Class attribute: least and greatest height of a row.
    strip_px : float
        Class attribute: height of the fixed strip above the rows.
    """

    row_limits_px = (24, 72)
    strip_px = 0.0

    def __init__(self, session: Session, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(session, axis, parent)
        self._scrolled_px = 0.0

    def count_rows(self) -> int:
        """Return the number of rows."""
        raise NotImplementedError

    def rows_scrolled(self) -> None:
        """Update after the rows were scrolled."""

    @property
    def rows_rect(self) -> QRectF:
        """Return the rectangle of the rows in pixels of the plot."""
        return self.plot_rect.adjusted(0.0, self.strip_px, 0.0, 0.0)

    @property
    def row_px(self) -> float:
        """Height of a row in pixels."""
        least, most = self.row_limits_px
        return min(max(self.rows_rect.height() / max(self.count_rows(), 1), least), most)

    def row_rect(self, number: int) -> QRectF:
        """Return the rectangle of the row ``number`` in pixels of the plot, scrolled."""
        top = self.strip_px - self._scrolled_px + number * self.row_px
        return QRectF(0.0, top, self.plot_rect.width(), self.row_px)

    def row_number_at(self, y_px: float) -> int | None:
        """Return the index of the row at a height in pixels; None if there is none."""
        number = int((y_px - self.strip_px + self._scrolled_px) // self.row_px)
        return number if y_px >= self.strip_px and 0 <= number < self.count_rows() else None

    def _scroll_to(self, top_px: float) -> None:
        most = max(self.count_rows() * self.row_px - self.rows_rect.height(), 0.0)
        kept = min(max(top_px, 0.0), most)
        if kept != self._scrolled_px:
            self._scrolled_px = kept
            self.rows_scrolled()
            self.update_items()

    def wheel(self, mouse: LaneMouse, steps: float) -> bool:
        """Scroll the rows; return False if all of them are visible."""
        if self.count_rows() * self.row_px <= self.rows_rect.height() + 0.5:
            return False
        self._scroll_to(self._scrolled_px - steps * self.row_px)
        return True

    def pan_y(self, by_px: float) -> None:
        self._scroll_to(self._scrolled_px - by_px)
