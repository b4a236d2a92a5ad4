"""Sound outputs: the interface of a device, and a silent substitute."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from app.audio.track import RATE_HZ, Block

BUFFER_S: Final = 0.2
"""Seconds of sound queued in the device: enough for a busy window, short enough for quick response."""


class Sink(Protocol):
    """A device that plays stereo sound at `RATE_HZ`."""

    def free(self) -> int:
        """Return the number of samples that may be written now."""
        ...

    def write(self, block: Block) -> None:
        """Queue samples of shape (n, 2); not more than `free`."""
        ...

    def processed_s(self) -> float:
        """Return the seconds played since the start."""
        ...

    def set_volume(self, gain: float) -> None:
        """Set the volume as a linear factor, 0..1."""
        ...

    def failed(self) -> bool:
        """Return whether the device was lost."""
        ...

    def stop(self) -> None:
        """Stop the sound immediately."""
        ...


class SilentSink:
    """A silent output in real time, used as a clock if there is no device.

    Parameters
    ----------
    now : callable
        Function that returns a monotonic time in seconds.
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._start_s = now()
        self._written = 0

    def free(self) -> int:
        """Return the number of samples that may be written now."""
        waiting = self._written - round((self._now() - self._start_s) * RATE_HZ)
        return max(round(BUFFER_S * RATE_HZ) - waiting, 0)

    def write(self, block: Block) -> None:
        """Count the samples as if they were played."""
        self._written += len(block)

    def processed_s(self) -> float:
        """Return the seconds since the start, even if data is late."""
        return self._now() - self._start_s

    def set_volume(self, gain: float) -> None:
        """Ignore the volume, since nothing is heard."""

    def failed(self) -> bool:
        """Return False, since a silent output cannot be lost."""
        return False

    def stop(self) -> None:
        """Do nothing."""
