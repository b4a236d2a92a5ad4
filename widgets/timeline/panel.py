"""The timeline: a ruler over lanes that share one time axis."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget

from widgets.common.session import Session
from widgets.timeline.axis import TimeAxis
from widgets.timeline.lane import Lane
from widgets.timeline.lanes import LANES


class TimelinePanel(QWidget):
    """The timeline panel.

    Parameters
    ----------
    session : Session
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("timeline")
        self.session = session
        self.axis = TimeAxis(self)
        self.stack = QSplitter(Qt.Orientation.Vertical, self)
        self.stack.setChildrenCollapsible(False)
        self.lanes: dict[str, Lane] = {}
        for kind in LANES:
            lane = kind(session, self.axis)
            self.lanes[lane.id] = lane
            self.stack.addWidget(lane)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.stack)
