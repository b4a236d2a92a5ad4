"""A sound device and a clock controlled by tests."""

from __future__ import annotations

import numpy as np

from app.audio.sink import BUFFER_S
from app.audio.track import RATE_HZ, Block


class Time:
    """A clock."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


class FakeSink:
    """Plays the data as its clock advances, and records them."""

    def __init__(self, time: Time) -> None:
        self._time = time
        self._start_s = time()
        self.blocks: list[Block] = []
        self.written = 0
        self.gain = 1.0
        self.stopped = False
        self.broken = False

    def _played(self) -> int:
        return min(round((self._time() - self._start_s) * RATE_HZ), self.written)

    def free(self) -> int:
        return round(BUFFER_S * RATE_HZ) - (self.written - self._played())

    def write(self, block: Block) -> None:
        assert not self.stopped
        assert len(block) <= self.free()
        self.blocks.append(block.copy())
        self.written += len(block)

    def processed_s(self) -> float:
        return self._played() / RATE_HZ

    def set_volume(self, gain: float) -> None:
        self.gain = gain

    def failed(self) -> bool:
        return self.broken

    def stop(self) -> None:
        self.stopped = True

    @property
    def sound(self) -> np.ndarray:
        """All that was written."""
        return np.concatenate(self.blocks) if self.blocks else np.zeros((0, 2), np.float32)


class FakeDevices:
    """The system's device, which can be removed."""

    def __init__(self, time: Time) -> None:
        self._time = time
        self.there = True
        self.sinks: list[FakeSink] = []

    def open(self) -> FakeSink | None:
        if not self.there:
            return None
        self.sinks.append(FakeSink(self._time))
        return self.sinks[-1]

    @property
    def sink(self) -> FakeSink:
        """Most recently opened sink."""
        return self.sinks[-1]
