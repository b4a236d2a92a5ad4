"""Smoothed clock of a sound device, so that the picture moves evenly.

A device reports the played time in steps of some milliseconds, with varying delay. The computer's clock is even but has
another rate. So the result is the computer's time plus a slow average of the difference.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

_AVERAGED: Final = 150
"""Number of observations in the average: many compared with the jitter, few compared with the drift of two crystals."""
_JUMP_S: Final = 0.04
"""Change of the difference in seconds that is no jitter: the device paused or was suspended."""
_SHIFT_S: Final = 0.01
_SHIFTED: Final = 8
"""Number of consecutive observations off to the same side that count as a shift and not as jitter."""
_AHEAD_S: Final = 0.03
"""Greatest lead in seconds over the time that the device has reported."""


class DeviceClock:
    """Clock of a sound device: seconds of sound played since it was started.

    Parameters
    ----------
    now : callable
        Function that returns a monotonic time in seconds.
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._processed_s = 0.0
        self._offset_s: float | None = None
        self._count = 0
        self._off = 0
        """Observations in a row that were off; positive and negative by their side."""
        self._time_s = 0.0

    def observe(self, processed_s: float) -> None:
        """Add an observation: the device has played this many seconds."""
        if processed_s == self._processed_s:
            return
        moved_first = self._processed_s == 0.0
        self._processed_s = processed_s
        offset_s = processed_s - self._now()
        away_s = offset_s - self._offset_s if self._offset_s is not None else 0.0
        side = (away_s > _SHIFT_S) - (away_s < -_SHIFT_S)
        self._off = self._off + side if side and side * self._off >= 0 else side
        if self._offset_s is None or moved_first or abs(away_s) > _JUMP_S or abs(self._off) >= _SHIFTED:
            self._offset_s, self._count, self._off = offset_s, 1, 0
            return
        self._count = min(self._count + 1, _AVERAGED)
        self._offset_s += away_s / self._count

    def time_s(self) -> float:
        """Return the position of the audible sound in seconds; it never decreases, and is constant until the device
        begins to play.
        """
        if self._offset_s is None:
            return 0.0
        time_s = min(self._now() + self._offset_s, self._processed_s + _AHEAD_S)
        self._time_s = max(self._time_s, time_s, 0.0)
        return self._time_s
