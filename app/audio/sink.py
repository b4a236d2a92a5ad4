"""Outputs for sound: the interface of a device, and a silent one that stands in for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Protocol

from app.audio.track import RATE_HZ, Block

BUFFER_S: Final = 0.2
"""Sound that waits in the device: long enough for a busy window, short enough for the hand."""


class Sink(Protocol):
    """A device that plays stereo at `RATE_HZ`."""

    def free(self) -> int:
        """Samples that may be written now."""
        ...

    def write(self, block: Block) -> None:
        """Play this next; not more than `free`. Shape (n, 2)."""
        ...

    def processed_s(self) -> float:
        """Seconds that were played since the start."""
        ...

    def set_volume(self, gain: float) -> None:
        """0..1, linear."""
        ...

    def failed(self) -> bool:
        """Return whether the device went away."""
        ...

    def stop(self) -> None:
        """Be silent at once."""
        ...


class SilentSink:
    """Plays nothing, in time: the clock where there is no device.

    Parameters
    ----------
    now : callable
        A monotonic clock in seconds.
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self._now = now
        self._start_s = now()
        self._written = 0

    def free(self) -> int:
        """Samples that may be written now."""
        waiting = self._written - round((self._now() - self._start_s) * RATE_HZ)
        return max(round(BUFFER_S * RATE_HZ) - waiting, 0)

    def write(self, block: Block) -> None:
        """Count the samples."""
        self._written += len(block)

    def processed_s(self) -> float:
        """Seconds since the start: late data is not waited for."""
        return self._now() - self._start_s

    def set_volume(self, gain: float) -> None:
        """Silence has no volume."""

    def failed(self) -> bool:
        """Silence does not go away."""
        return False

    def stop(self) -> None:
        """Do nothing: there is no sound to stop."""
