"""Zoom and scrolling of the timeline: the common time axis of the ruler and all lanes."""

from __future__ import annotations

from typing import NamedTuple, overload

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QScrollBar, QWidget

from app.arrays import FloatArray
from app.project.snap_grid import Grid
from app.score.model import Score
from widgets.timeline.model.lines import LineCache, Lines
from widgets.timeline.model.visible_time import TimeView

ZOOM_A_NOTCH = 1.2
PAN_A_NOTCH = 0.12
"""Share of the visible range per notch of the mouse wheel."""

SCROLL_A_S = 1000
"""Steps of the scroll bar per second."""


class WheelTurn(NamedTuple):
    """A turn of the wheel, with the keys held: Ctrl zooms time, Ctrl and Shift the lane, Shift scrolls time.

    Attributes
    ----------
    notches : float
        Amount of the turn, positive away from the user.
    """

    notches: float
    sideways: bool
    with_ctrl: bool
    with_shift: bool


def wheel_turn(event: QWheelEvent) -> WheelTurn:
    """Return direction, notches and modifier keys of a turn of the mouse wheel."""
    delta, keys = event.angleDelta(), event.modifiers()
    # On some platforms Alt turns the wheel sideways.
    sideways = not delta.y() and not keys & Qt.KeyboardModifier.AltModifier
    ctrl, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
    return WheelTurn((delta.y() or delta.x()) / 120.0, sideways, bool(keys & ctrl), bool(keys & shift))


class TimeAxis(QObject):
    """The visible range of seconds and its scale in pixels: a `TimeView` with a signal for changes.

    Pixels count from the left edge of the plot area, which has the same width in every lane. Scrolling stops at the
    limits.

    Signals
    -------
    changed()
        The range, the limits or the width have changed.
    """

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._view = TimeView((0.0, 60.0), 0.0, 60.0, 800)
        self._whole_s = self._view.limits_s
        self._line_cache = LineCache()

    @property
    def start_s(self) -> float:
        """The time at the left edge in seconds."""
        return self._view.start_s

    @property
    def end_s(self) -> float:
        """The time at the right edge in seconds, excluded from the visible range."""
        return self._view.end_s

    @property
    def span_s(self) -> float:
        """Length of the visible range in seconds."""
        return self._view.span_s

    @property
    def limits_s(self) -> tuple[float, float]:
        """First and last second to which the axis can be scrolled."""
        return self._view.limits_s

    @property
    def width_px(self) -> int:
        """Width of the plot area, device-independent pixels."""
        return self._view.width_px

    @property
    def px_per_s(self) -> float:
        """Pixels per second."""
        return self._view.px_per_s

    @overload
    def x_px(self, seconds: float) -> float: ...
    @overload
    def x_px(self, seconds: FloatArray) -> FloatArray: ...
    def x_px(self, seconds: float | FloatArray) -> float | FloatArray:
        """Convert seconds to x positions in pixels; accepts a number or an array of any shape."""
        return self._view.x_px(seconds)

    def seconds(self, x_px: float) -> float:
        """Return the time in seconds at an x position of the axis."""
        return self._view.seconds(x_px)

    def lines(self, score: Score, grid: Grid) -> Lines:
        """Return the lines of bars, beats and the grid in the visible range."""
        return self._line_cache.get(score, grid, self.start_s, self.end_s, self.px_per_s)

    def set_limits(self, start_s: float, end_s: float, whole_s: tuple[float, float]) -> None:
        """Set the range that can be scrolled to, and the range of the whole piece; the visible range moves only if
        necessary.
        """
        self._whole_s = whole_s
        self._become(self._view.within(start_s, end_s))

    def set_width(self, width_px: int) -> None:
        """Set the width of the plot areas in pixels, with the same zoom, so that a wider window shows more."""
        self._become(self._view.widened(width_px))

    def show(self, start_s: float, end_s: float) -> None:
        """Show a range of seconds, within the limits of zoom and scrolling."""
        self._become(self._view.showing(start_s, end_s))

    def fit(self) -> None:
        """Zoom the time axis out to the whole piece."""
        self._become(self._view.showing(*self._whole_s))

    def zoom(self, factor: float, at_s: float) -> None:
        """Zoom by ``factor`` (above 1 shows less time) so that the time ``at_s`` keeps its position."""
        self._become(self._view.zoomed(factor, at_s))

    def pan(self, by_s: float) -> None:
        """Scroll by seconds; for a positive number later times come into view."""
        self._become(self._view.panned(by_s))

    def pan_px(self, by_px: float) -> None:
        """Scroll by dragging the contents ``by_px`` pixels to the right."""
        self.pan(-by_px / self.px_per_s)

    def turn_wheel(self, turn: WheelTurn, x_px: float) -> None:
        """Scroll in time by a turn of the wheel, or with Ctrl zoom about the position ``x_px``."""
        if turn.with_ctrl:
            self.zoom(ZOOM_A_NOTCH**turn.notches, self.seconds(x_px))
        else:
            self.pan(-turn.notches * PAN_A_NOTCH * self.span_s)

    def reveal(self, time_s: float, end_s: float | None = None) -> None:
        """Scroll to a time (or a span from it on), unless it is visible with some margin."""
        self._become(self._view.revealing(time_s, end_s))

    def _become(self, view: TimeView) -> None:
        if view != self._view:
            self._view = view
            self.changed.emit()


class TimeBar(QScrollBar):
    """Scroll bar that scrolls a time axis."""

    def __init__(self, axis: TimeAxis, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self._axis = axis
        self._showing = False
        axis.changed.connect(self._show_axis)
        self.valueChanged.connect(self._scroll)

    def _show_axis(self) -> None:
        low, high = self._axis.limits_s
        span = self._axis.span_s
        self._showing = True
        self.setRange(0, max(round((high - low - span) * SCROLL_A_S), 0))
        self.setPageStep(max(round(span * SCROLL_A_S), 1))
        self.setSingleStep(max(round(span * SCROLL_A_S / 10), 1))
        self.setValue(round((self._axis.start_s - low) * SCROLL_A_S))
        self._showing = False

    def _scroll(self, value: int) -> None:
        if not self._showing:
            start_s = self._axis.limits_s[0] + value / SCROLL_A_S
            self._axis.show(start_s, start_s + self._axis.span_s)
