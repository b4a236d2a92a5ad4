"""Base class of the rows above the lanes: the ruler and the flags."""

from __future__ import annotations

from PySide6.QtCore import QSize, Signal
from PySide6.QtGui import QColor, QFont, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.editor.design_tokens import LEAST_TEXT_PT
from app.editor.session import Session
from widgets.timeline.lane import GUTTER_PX
from widgets.timeline.plot.cached_picture import Pictured
from widgets.timeline.zoom_and_scroll import TimeAxis, wheel_turn


class Strip(Pictured):
    """A row above the lanes on their time axis.

    Signals
    -------
    sought(float)
        Request to move the playhead to this time in seconds.
    """

    sought = Signal(float)

    def __init__(self, session: Session, axis: TimeAxis, height_px: int, parent: QWidget | None) -> None:
        super().__init__(parent)
        self.session = session
        self.axis = axis
        self.setFixedHeight(height_px)
        self.setMouseTracking(True)
        font = QFont(self.font())
        if 0 < font.pointSizeF() < LEAST_TEXT_PT:
            font.setPointSizeF(LEAST_TEXT_PT)
            self.setFont(font)

    def x_px(self, tick: int) -> float:
        """Convert a tick to an x position in pixels of the strip."""
        return GUTTER_PX + self.axis.x_px(self.seconds_of(tick))

    def seconds_of(self, tick: int) -> float:
        """Convert a tick to seconds of the piece."""
        return self.session.project.score.tempo_map.seconds(float(tick))

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(800, self.height())

    def ground(self) -> QColor:
        return QColor(self.session.tokens.surface)

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.accept()
        self.axis.turn_wheel(wheel_turn(event), event.position().x() - GUTTER_PX)
