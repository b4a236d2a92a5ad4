"""Visible range of the performance in seconds as a value, with its scale in pixels."""

from __future__ import annotations

from typing import NamedTuple, Protocol, overload

from app.arrays import FloatArray

LEAST_SPAN_S = 0.05
"""Visible range in seconds at the greatest zoom: a few frames."""
PADDING = 0.02
"""Share of the visible width left free at either side when something is revealed."""


class Scale(Protocol):
    """Scale from seconds to pixels, implemented by `TimeView` and by the time axis, which is a QObject."""

    @property
    def px_per_s(self) -> float: ...
    @overload
    def x_px(self, seconds: float) -> float: ...
    @overload
    def x_px(self, seconds: FloatArray) -> FloatArray: ...
    def seconds(self, x_px: float) -> float: ...


class VisibleSpan(Scale, Protocol):
    """Scale with the visible time range."""

    @property
    def start_s(self) -> float: ...
    @property
    def end_s(self) -> float: ...


class Limited(Scale, Protocol):
    """A time scale that can only be scrolled within limits."""

    @property
    def limits_s(self) -> tuple[float, float]: ...


class TimeView(NamedTuple):
    """The visible time range in seconds; each change returns a new one within the limits.

    Attributes
    ----------
    limits_s : (float, float)
        Range that can be scrolled to.
    start_s, end_s : float
        Visible range; the end is excluded.
    width_px : int
        Of the plot area, device-independent pixels.
    """

    limits_s: tuple[float, float]
    start_s: float
    end_s: float
    width_px: int

    @property
    def span_s(self) -> float:
        """Length of the visible range in seconds."""
        return self.end_s - self.start_s

    @property
    def px_per_s(self) -> float:
        """Pixels per second."""
        return self.width_px / self.span_s

    @overload
    def x_px(self, seconds: float) -> float: ...
    @overload
    def x_px(self, seconds: FloatArray) -> FloatArray: ...
    def x_px(self, seconds: float | FloatArray) -> float | FloatArray:
        """Convert seconds to x positions in pixels; accepts a number or an array of any shape."""
        return (seconds - self.start_s) * self.px_per_s

    def seconds(self, x_px: float) -> float:
        """Return the time in seconds at an x position of the view."""
        return self.start_s + x_px / self.px_per_s

    def within(self, start_s: float, end_s: float) -> TimeView:
        """Return the view with other limits of scrolling; the visible range moves only if necessary."""
        return self._replace(limits_s=(start_s, max(end_s, start_s + LEAST_SPAN_S))).showing(self.start_s, self.end_s)

    def widened(self, width_px: int) -> TimeView:
        """Return the view at another width with the same zoom, so that a wider window shows more."""
        width_px = max(width_px, 1)
        if width_px == self.width_px:
            return self
        return self._replace(width_px=width_px).showing(self.start_s, self.start_s + width_px / self.px_per_s)

    def showing(self, start_s: float, end_s: float) -> TimeView:
        """Return the view that shows a range of seconds, within the limits of zoom and scrolling."""
        low, high = self.limits_s
        span = min(max(end_s - start_s, LEAST_SPAN_S), high - low)
        start_s = min(max(start_s, low), high - span)
        return self._replace(start_s=start_s, end_s=start_s + span)

    def zoomed(self, factor: float, at_s: float) -> TimeView:
        """Return the view with ``factor`` times less visible; the time ``at_s`` keeps its pixel."""
        low, high = self.limits_s
        span = min(max(self.span_s / factor, LEAST_SPAN_S), high - low)
        start_s = at_s - (at_s - self.start_s) / self.span_s * span
        return self.showing(start_s, start_s + span)

    def panned(self, by_s: float) -> TimeView:
        """Return the view scrolled by seconds; for a positive number later times come into view."""
        return self.showing(self.start_s + by_s, self.end_s + by_s)

    def revealing(self, time_s: float, end_s: float | None = None) -> TimeView:
        """Return the view scrolled so that a time, or a span that begins there, is visible; unchanged if it is already
        visible with some margin.
        """
        until_s = time_s if end_s is None else min(end_s, time_s + self.span_s * (1 - 2 * PADDING))
        margin = self.span_s * PADDING
        if self.start_s + margin <= time_s and until_s <= self.end_s - margin:
            return self
        start_s = (time_s + until_s - self.span_s) / 2
        return self.showing(start_s, start_s + self.span_s)
