"""The one time axis that the ruler and all lanes share: which seconds of the performance are visible."""

from __future__ import annotations

from typing import overload

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QObject, Signal

from app.project.grid import Grid
from app.score.model import Score
from widgets.timeline.model.lines import LineCache, Lines

Floats = npt.NDArray[np.float64]

LEAST_SPAN_S = 0.05
"""The closest zoom shows this much: a few frames."""
PADDING = 0.02
"""What fitting leaves free at either side, of the visible width."""


class TimeAxis(QObject):
    """The visible range of seconds, and where they lie in pixels.

    Pixels count from the left edge of the plot area, which is as wide in every lane. Nothing scrolls past the limits.

    Signals
    -------
    changed()
        The range, the limits or the width are other ones.
    """

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._limits_s = (0.0, 60.0)
        self._start_s, self._end_s = self._limits_s
        self._width_px = 800
        self._line_cache = LineCache()

    @property
    def start_s(self) -> float:
        """The time at the left edge."""
        return self._start_s

    @property
    def end_s(self) -> float:
        """The time at the right edge; the range is half-open."""
        return self._end_s

    @property
    def span_s(self) -> float:
        """How much is visible."""
        return self._end_s - self._start_s

    @property
    def limits_s(self) -> tuple[float, float]:
        """What can be scrolled to."""
        return self._limits_s

    @property
    def width_px(self) -> int:
        """Width of the plot area, device-independent pixels."""
        return self._width_px

    @property
    def px_per_s(self) -> float:
        """The zoom."""
        return self._width_px / self.span_s

    @overload
    def x_px(self, seconds: float) -> float: ...
    @overload
    def x_px(self, seconds: Floats) -> Floats: ...
    def x_px(self, seconds: float | Floats) -> float | Floats:
        """Where times lie; numbers or arrays of any shape."""
        return (seconds - self._start_s) * self.px_per_s

    def seconds(self, x_px: float) -> float:
        """The time at a place."""
        return self._start_s + x_px / self.px_per_s

    def lines(self, score: Score, grid: Grid) -> Lines:
        """Bars, beats and grid lines of the visible range."""
        return self._line_cache.get(score, grid, self._start_s, self._end_s, self.px_per_s)

    def set_limits(self, start_s: float, end_s: float) -> None:
        """Change what can be scrolled to; the visible range moves only where it must."""
        limits = (start_s, max(end_s, start_s + LEAST_SPAN_S))
        if limits != self._limits_s:
            self._limits_s = limits
            if not self._become(self._start_s, self._end_s):
                self.changed.emit()

    def set_width(self, width_px: int) -> None:
        """The plot areas are this wide now. The zoom stays, so that widening a window shows more."""
        width_px = max(width_px, 1)
        if width_px != self._width_px:
            end_s = self._start_s + width_px / self.px_per_s
            self._width_px = width_px
            if not self._become(self._start_s, end_s):
                self.changed.emit()

    def show(self, start_s: float, end_s: float) -> None:
        """Show this range, as far as the limits allow."""
        self._become(start_s, end_s)

    def fit(self) -> None:
        """Show everything between the limits."""
        self._become(*self._limits_s)

    def zoom(self, factor: float, at_s: float) -> None:
        """Show ``factor`` times less; the time ``at_s`` stays where it is."""
        low, high = self._limits_s
        span = min(max(self.span_s / factor, LEAST_SPAN_S), high - low)
        share = (at_s - self._start_s) / self.span_s
        start_s = at_s - share * span
        self._become(start_s, start_s + span)

    def pan(self, by_s: float) -> None:
        """Scroll; later times come into view for a positive distance."""
        self._become(self._start_s + by_s, self._end_s + by_s)

    def reveal(self, time_s: float, end_s: float | None = None) -> None:
        """Scroll only if a time (or a span from it on) is not comfortably in view."""
        until_s = time_s if end_s is None else min(end_s, time_s + self.span_s * (1 - 2 * PADDING))
        margin = self.span_s * PADDING
        if time_s < self._start_s + margin or until_s > self._end_s - margin:
            start_s = (time_s + until_s - self.span_s) / 2
            self._become(start_s, start_s + self.span_s)

    def _become(self, start_s: float, end_s: float) -> bool:
        low, high = self._limits_s
        span = min(max(end_s - start_s, LEAST_SPAN_S), high - low)
        start_s = min(max(start_s, low), high - span)
        if (start_s, start_s + span) == (self._start_s, self._end_s):
            return False
        self._start_s, self._end_s = start_s, start_s + span
        self.changed.emit()
        return True
