"""The drawing area of a lane, its items, and its mouse events."""

from __future__ import annotations

from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from PySide6.QtCore import QEvent, QRectF, Qt
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QFont,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPen,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.editor.session import Session
from widgets.timeline.model.lane_mouse import LaneMouse
from widgets.timeline.model.lines import Lines
from widgets.timeline.plot.cached_picture import Pictured
from widgets.timeline.plot.drawing import draw_lines
from widgets.timeline.zoom_and_scroll import TimeAxis


class LaneView(Protocol):
    """Part of a lane that its items need. A protocol, since a lane imports the modules of its items, and these cannot
    import the lane.
    """

    id: str
    session: Session
    axis: TimeAxis
    plot: Plot

    @property
    def plot_rect(self) -> QRectF: ...
    @property
    def y_range(self) -> tuple[float, float]: ...
    def y_px(self, value: float) -> float: ...
    def lines(self) -> Lines: ...
    def font(self) -> QFont: ...


class PlotOwner(Protocol):
    """Receiver of a plot's mouse and key events; a protocol, since lanes import this module."""

    session: Session

    def plot_resized(self) -> None: ...
    def pressed(self, event: QMouseEvent) -> None: ...
    def moved(self, event: QMouseEvent) -> None: ...
    def released(self, event: QMouseEvent) -> None: ...
    def double_clicked(self, event: QMouseEvent) -> None: ...
    def wheeled(self, event: QWheelEvent) -> None: ...
    def key_pressed(self, event: QKeyEvent) -> None: ...
    def claims(self, event: QKeyEvent) -> bool: ...
    def hover(self, mouse: LaneMouse | None) -> None: ...


AnyLane = TypeVar("AnyLane", bound=LaneView)


class LaneItem(Generic[AnyLane]):
    """An item drawn over the whole plot in pixels. Override `paint_px`, and draw only inside ``exposed``.

    Parameters
    ----------
    lane : LaneView
        Lane, or a more specific protocol if the item requires it.
    z : float
        Stacking order; higher values are above.
    """

    def __init__(self, lane: AnyLane, z: float = 0.0) -> None:
        self.lane = lane
        self.z = z
        lane.plot.add(self)

    def update(self) -> None:
        """Request that the lane's plot be redrawn."""
        self.lane.plot.redraw()

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        """Draw the item in pixels of the plot; use ``lane.axis.x_px`` and ``lane.y_px`` to convert times and values."""
        raise NotImplementedError


class Background(LaneItem[LaneView]):
    """Draws lines of bars, beats and the grid, and shades the loop and the selected span."""

    def __init__(self, lane: LaneView) -> None:
        super().__init__(lane, -100.0)

    def paint_px(self, painter: QPainter, exposed: QRectF) -> None:
        lane = self.lane
        tokens, axis, session = lane.session.tokens, lane.axis, lane.session
        span = session.selection.span
        if span is not None:
            tempo = session.project.score.tempo_map
            self._shade(painter, exposed, tempo.seconds(float(span[0])), tempo.seconds(float(span[1])), tokens.accent)
        if session.loop_s is not None:
            self._shade(painter, exposed, *session.loop_s, tokens.good)
        lines = lane.lines()
        for seconds, colour, alpha in (
            (lines.step_s, tokens.line, 110),
            (lines.beat_s, tokens.line, 255),
            (lines.bar_s, tokens.line_strong, 255),
        ):
            shade = QColor(colour)
            shade.setAlpha(alpha)
            x = axis.x_px(seconds)
            # Half pixels give sharp lines.
            x = np.floor(x[(x >= exposed.left() - 1) & (x <= exposed.right() + 1)]) + 0.5
            top, bottom = np.full(len(x), exposed.top()), np.full(len(x), exposed.bottom())
            draw_lines(painter, x, top, x, bottom, QPen(shade, 1.0))

    def _shade(self, painter: QPainter, exposed: QRectF, start_s: float, end_s: float, colour: str) -> None:
        axis = self.lane.axis
        left, right = axis.x_px(start_s), axis.x_px(end_s)
        shade = QColor(colour)
        shade.setAlpha(34)
        painter.fillRect(QRectF(left, exposed.top(), right - left, exposed.height()) & exposed, shade)


class Plot(Pictured):
    """The drawing area of a lane, which receives its mouse and key events.

    Not a QGraphicsView, since the views of several scenes are updated one after another, which repainted all lanes each
    time.
    """

    def __init__(self, lane: PlotOwner, parent: QWidget) -> None:
        super().__init__(parent)
        self._lane = lane
        self._items: list[LaneItem[Any]] = []
        self.setMinimumSize(40, 0)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)

    def add(self, item: LaneItem[Any]) -> None:
        """Add an item that the plot draws, ordered by the items' ``z``."""
        self._items.append(item)
        self._items.sort(key=lambda each: each.z)
        self.redraw()

    def ground(self) -> QColor:
        return QColor(self._lane.session.tokens.sunken)

    def draw(self, painter: QPainter, room: QRectF) -> None:
        for item in self._items:
            painter.save()
            item.paint_px(painter, room)
            painter.restore()

    # Qt overrides

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride and self._lane.claims(event):
            event.accept()
            return True
        return super().event(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._lane.plot_resized()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._lane.pressed(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self._lane.moved(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._lane.released(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._lane.double_clicked(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        self._lane.wheeled(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        self._lane.key_pressed(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        event.ignore()

    def leaveEvent(self, event: QEvent) -> None:
        self._lane.hover(None)
