"""Mouse position over a plot, and rectangles in the plot's pixels, independent of Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


class PixelRect(NamedTuple):
    """A rectangle, pixels from the upper left corner of a plot."""

    left: float
    top: float
    right: float
    bottom: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.bottom - self.top

    def contains(self, x_px: float, y_px: float, slack_px: float = 0.0) -> bool:
        """Return whether a place is inside or on the edge; ``slack_px`` to the left and right count as inside."""
        return self.left - slack_px <= x_px <= self.right + slack_px and self.top <= y_px <= self.bottom

    def meets(self, other: PixelRect) -> bool:
        """Return whether two rectangles overlap; a rectangle without width or height overlaps nothing."""
        return (
            max(self.left, other.left) < min(self.right, other.right)
            and max(self.top, other.top) < min(self.bottom, other.bottom)
        )  # fmt: skip


def spanned(x0: float, y0: float, x1: float, y1: float) -> PixelRect:
    """Return the rectangle given by two opposite corners in any order."""
    return PixelRect(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))


@dataclass(frozen=True)
class LaneMouse:
    """Mouse position over a plot.

    Attributes
    ----------
    x_px, y_px : float
        Position from the upper left corner of the plot.
    value : float
        Value on the lane's vertical scale.
    tick : float
        Tick of ``time_s``.
    snapped_tick : int
        The nearest line of the session's grid; the nearest tick while Alt is held.
    shift, ctrl, alt : bool
        Modifier keys that are held.
    screen_px : (int, int)
        Position on the screen, for menus.
    """

    x_px: float
    y_px: float
    time_s: float
    value: float
    tick: float
    snapped_tick: int
    shift: bool = False
    ctrl: bool = False
    alt: bool = False
    screen_px: tuple[int, int] = (0, 0)
