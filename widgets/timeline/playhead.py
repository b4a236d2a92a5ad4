"""The playhead of the timeline: its line over all lanes, and turning of the page during playback."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from widgets.timeline.lane_header import GUTTER_PX
from widgets.timeline.zoom_and_scroll import TimeAxis

PAGE_AT = 0.94
"""Position of the playhead as a share of the width at which the page is turned; see `PAGE_TO`."""
PAGE_TO = 0.06
"""Position of the playhead as a share of the width after the page was turned."""


class Playhead(QWidget):
    """A thin line over all lanes; its movement redraws only the uncovered strip.

    Parameters
    ----------
    lanes : QWidget
        Widget with the lanes, which has the same height.
    """

    def __init__(self, session: Session, axis: TimeAxis, lanes: QWidget, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("playhead")
        self._session, self._axis, self._lanes = session, axis, lanes
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def place(self) -> None:
        """Move the line to the playhead of the session; hide it if that is not visible."""
        x = self._axis.x_px(self._session.playhead_s)
        inside = 0 <= x <= self._axis.width_px
        self.setVisible(inside)
        if inside:
            self.setGeometry(int(GUTTER_PX + x), self._lanes.y(), 1, self._lanes.height())
            self.raise_()

    def turn_page(self, playhead_s: float) -> bool:
        """Scroll to the next page if the playhead is near the right edge or not visible; return whether it scrolled."""
        axis = self._axis
        if 0 <= (playhead_s - axis.start_s) / axis.span_s <= PAGE_AT:
            return False
        start_s = playhead_s - PAGE_TO * axis.span_s
        axis.show(start_s, start_s + axis.span_s)
        return True

    # Qt overrides

    def paintEvent(self, event: QPaintEvent) -> None:
        QPainter(self).fillRect(event.rect(), QColor(self._session.tokens.accent))
