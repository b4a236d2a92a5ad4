"""Sequential reader of a mix with variable speed and loops, which reports the performance time of its output."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.audio.stretch import HOP, TimeStretcher
from app.audio.track import RATE_HZ, Block, Mix

Mark = tuple[int, float, float]
"""Output sample index, performance time in seconds of that sample, and performance seconds per second of output."""

_FADE: Final = 96
"""Number of samples over which a jump is faded to avoid a click."""
_LEAST_LOOP: Final = RATE_HZ // 50
"""Least length of a loop in samples; shorter ones would sound as a tone."""


class Reader:
    """Reads sound from a mix in sequence.

    Parameters
    ----------
    mix : Mix
        Mix, which may be replaced at any time.
    position_s : float
        Start position in seconds of the performance.
    speed : float
        Speed factor, 0.25..2; the pitch does not change.
    loop_s : (float, float), optional
        Start and end of a range in seconds that is repeated.
    silent : bool
        Whether only time is needed and no sound.
    """

    def __init__(
        self,
        mix: Mix,
        position_s: float = 0.0,
        speed: float = 1.0,
        loop_s: tuple[float, float] | None = None,
        silent: bool = False,
    ) -> None:
        self.mix = mix
        self.silent = silent
        self._speed = speed
        self._loop: tuple[int, int] | None = None
        self._made = 0
        self._waiting = np.zeros((0, 2), np.float32)
        self._marks: list[Mark] = []
        self.set_loop(loop_s)
        self.seek(position_s)

    def seek(self, position_s: float) -> None:
        """Continue reading the mix at another position in seconds."""
        self._begin(round(position_s * RATE_HZ))

    def set_speed(self, speed: float) -> None:
        """Set the speed factor from now on."""
        if speed != self._speed:
            at = self._position()
            self._speed = speed
            self._begin(at)

    def set_loop(self, loop_s: tuple[float, float] | None) -> None:
        """Set the range that is repeated when its end is reached."""
        loop = None if loop_s is None else (round(loop_s[0] * RATE_HZ), round(loop_s[1] * RATE_HZ))
        self._loop = loop if loop is not None and loop[1] - loop[0] >= _LEAST_LOOP else None

    def read(self, count: int) -> tuple[Block, list[Mark]]:
        """Return the next samples.

        Returns
        -------
        block : float32 array, shape (count, 2)
            The samples.
        marks : list of Mark
            Performance times that do not follow from the previous mark, such as after a jump; each is given for a
            sample, counted from the first one ever read.
        """
        parts, missing = [], count
        while missing:
            if not len(self._waiting):
                self._waiting = self._next(missing)
            part, self._waiting = self._waiting[:missing], self._waiting[missing:]
            parts.append(part)
            missing -= len(part)
        marks, self._marks = self._marks, []
        return (np.concatenate(parts) if parts else self._waiting[:0]), marks

    def _begin(self, at: int) -> None:
        """Continue reading at a sample, discarding sound rendered ahead."""
        self._made -= len(self._waiting)
        self._waiting = self._waiting[:0]
        # The stretcher centres a frame on its time, so reading begins earlier by half the difference.
        self._lead = 0 if self._speed == 1.0 or self.silent else round(HOP * (1.0 - self._speed))
        self._at = at - self._lead
        self._fade_in = True
        self._stream = 0
        self._segments = [(0, self._at)]
        self._stretch = TimeStretcher(self._input_all)
        self._marks = [mark for mark in self._marks if mark[0] < self._made]
        self._marks.append((self._made, at / RATE_HZ, self._speed))

    def _next(self, requested: int) -> Block:
        """Return the next block of output, about ``requested`` frames at the set speed."""
        if self._speed == 1.0:
            segments = len(self._segments)
            block = self._input(requested)
            self._made += len(block)
            if len(self._segments) > segments:
                self._marks.append((self._made, self._at / RATE_HZ, 1.0))
                del self._segments[:-1]
            return block
        self._marks.append((self._made, self._position() / RATE_HZ, self._speed))
        self._made += HOP
        if self.silent:
            # Advance through loops as with sound, without rendering any.
            self._input_all(round(HOP * self._speed))
            return np.zeros((HOP, 2), np.float32)
        return self._stretch.step(self._speed)

    def _position(self) -> int:
        """Return the position in the mix, in samples, that is processed next."""
        if self._speed == 1.0 or self.silent:
            return self._at - len(self._waiting) if self._speed == 1.0 else self._at
        stream = round(self._stretch.position) + self._lead
        while len(self._segments) > 1 and self._segments[1][0] <= stream:
            del self._segments[0]
        start, at = self._segments[0]
        return at + stream - start

    def _input_all(self, count: int) -> Block:
        """Read a number of samples from the mix, continuing at the start of a loop where its end is reached."""
        parts = []
        while count:
            part = self._input(count)
            parts.append(part)
            count -= len(part)
        return np.concatenate(parts) if parts else np.zeros((0, 2), np.float32)

    def _input(self, count: int) -> Block:
        """Read samples of the mix at the current position, up to the end of the loop at most."""
        ends = self._loop is not None and self._at < self._loop[1] <= self._at + count
        if self._loop is not None and ends:
            count = self._loop[1] - self._at
        block = np.zeros((count, 2), np.float32) if self.silent else self.mix.read(self._at, count)
        if self._fade_in:
            _fade(block[:_FADE], rising=True)
            self._fade_in = False
        self._at += count
        self._stream += count
        if self._loop is not None and ends:
            _fade(block[-_FADE:], rising=False)
            self._at = self._loop[0]
            self._fade_in = True
            self._segments.append((self._stream, self._at))
        return block


def _fade(block: Block, rising: bool) -> None:
    ramp = np.linspace(0.0, 1.0, len(block), dtype=np.float32)[:, None]
    block *= ramp if rising else ramp[::-1]
