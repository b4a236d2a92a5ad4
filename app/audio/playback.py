"""Playback of a mix on the sound device, and the current position for the picture."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np
from PySide6.QtCore import QObject, Qt, QTimer, Signal

from app.audio.clock import DeviceClock
from app.audio.output import open_output
from app.audio.reader import Mark, Reader
from app.audio.sink import BUFFER_S, SilentSink, Sink
from app.audio.track import RATE_HZ, Mix

_FEED_MS: Final = 10
_GRAIN_S: Final = 0.09
"""Length in seconds of the sound played while scrubbing."""
_GRAINS_REST_MS: Final = 3000
"""Milliseconds for which the device stays open after a short preview sound, since opening it takes time."""
_LEAST_S: Final = 1e-3
_HOPELESS_S: Final = 1.0
_RETRY_S: Final = 2.0
"""Interval in seconds at which a missing device is tried again."""


class Playback(QObject):
    """Plays a mix from any moment, at other speeds, in a loop, or in short pieces while scrubbing.

    Without a device, time advances silently. All times are seconds of the performance.

    Parameters
    ----------
    open_sink : callable
        Returns the system's output, ready for writing; None if there is none.
    now : callable
        Returns a monotonic time in seconds.

    Signals
    -------
    playing_changed(bool)
        Whether the performance plays now.
    silent_changed(bool)
        Whether there is no device to play on.
    """

    playing_changed = Signal(bool)
    silent_changed = Signal(bool)

    def __init__(
        self,
        open_sink: Callable[[], Sink | None] = open_output,
        now: Callable[[], float] = time.perf_counter,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._open_sink = open_sink
        self._now = now
        self._mix = Mix()
        self._position_s = 0.0
        self._span_s = (0.0, float("inf"))
        self._loop_s: tuple[float, float] | None = None
        self._speed = 1.0
        self._gain = 1.0
        self._silent = False
        self._retry_s = 0.0
        """Time at which a missing device is looked for again."""
        self._sink: Sink | None = None
        self._clock = DeviceClock(now)
        self._reader = Reader(self._mix)
        self._marks: deque[Mark] = deque()
        self._sought: tuple[int, float] | None = None
        self._written = 0
        self._begun_s = 0.0
        self._grains: Sink | None = None
        self._feed_timer = QTimer(self)
        self._feed_timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._feed_timer.setInterval(_FEED_MS)
        self._feed_timer.timeout.connect(self.feed)
        self._rest_timer = QTimer(self)
        self._rest_timer.setSingleShot(True)
        self._rest_timer.setInterval(_GRAINS_REST_MS)
        self._rest_timer.timeout.connect(self._end_grains)

    # Performance and output

    @property
    def mix(self) -> Mix:
        """The mix of sources (score, recording, metronome) that is being played."""
        return self._mix

    def set_mix(self, mix: Mix) -> None:
        """Set the mix, effective from the next sample on."""
        self._mix = self._reader.mix = mix

    def set_span(self, start_s: float, end_s: float) -> None:
        """Set the beginning and the end of the performance; playing stops at the end."""
        self._span_s = (start_s, end_s)

    def set_loop(self, loop_s: tuple[float, float] | None) -> None:
        """Set a range to repeat; None to play on to the end."""
        self._loop_s = loop_s
        self._reader.set_loop(loop_s)

    def set_speed(self, speed: float) -> None:
        """Set the speed as a factor, 0.25..2; the pitch does not change."""
        self._speed = speed
        self._reader.set_speed(speed)

    def set_volume(self, volume: float) -> None:
        """Set the volume as perceived, 0..1; the gain is its square."""
        self._gain = volume**2
        for sink in (self._sink, self._grains):
            if sink is not None:
                sink.set_volume(self._gain)

    # Transport

    @property
    def is_playing(self) -> bool:
        """True while the performance plays."""
        return self._sink is not None

    @property
    def is_silent(self) -> bool:
        """True if a device was missing when sound was last requested."""
        return self._silent

    def play(self, from_s: float | None = None) -> None:
        """Start playing at ``from_s``, by default at the current position, or at the beginning if that is the end."""
        start_s = self.position_s() if from_s is None else from_s
        if self._loop_s is not None and start_s >= self._loop_s[1] - _LEAST_S:
            start_s = self._loop_s[0]
        elif start_s >= self._span_s[1] - _LEAST_S:
            start_s = self._span_s[0]
        was_playing = self.is_playing
        self._end_grains()
        self._begin(start_s)
        if not was_playing:
            self._feed_timer.start()
            self.playing_changed.emit(True)

    def stop(self) -> None:
        """Stop at the current position."""
        if self._sink is None:
            return
        self._position_s = self.position_s()
        self._feed_timer.stop()
        self._sink.stop()
        self._sink = None
        self.playing_changed.emit(False)

    def seek(self, position_s: float) -> None:
        """Move to another position; if the performance is playing, it continues from there."""
        if self._sink is None:
            self._position_s = position_s
            return
        self._reader.seek(position_s)
        self._sought = (self._written, position_s)
        self.feed()

    def scrub(self, position_s: float) -> None:
        """Move to a moment, and play a short piece of sound unless playback is running."""
        self.seek(position_s)
        if self._sink is not None:
            return
        if self._grains is not None and self._grains.failed():
            self._end_grains()
        if self._grains is None:
            if self._now() < self._retry_s:
                return
            self._grains = self._open_sink()
            if self._grains is None:
                self._retry_s = self._now() + _RETRY_S
                return
            self._grains.set_volume(self._gain)
        self._rest_timer.start()
        count = round(_GRAIN_S * RATE_HZ)
        # One grain at a time: sound queued in the device would play on after the hand has moved.
        if self._grains.free() >= round(BUFFER_S * RATE_HZ) - count // 2:
            window = np.hanning(count).astype(np.float32)[:, None]
            self._grains.write(self._mix.read(round(position_s * RATE_HZ) - count // 2, count) * window)

    def position_s(self) -> float:
        """Return the position of the audible sound in seconds, without waiting."""
        if self._sink is None:
            return self._position_s
        self._clock.observe(self._sink.processed_s())
        sample = self._clock.time_s() * RATE_HZ
        if self._sought is not None:
            if sample < self._sought[0]:
                return self._sought[1]
            self._sought = None
        while len(self._marks) > 1 and self._marks[1][0] <= sample:
            self._marks.popleft()
        if not self._marks:
            return self._position_s
        at, position_s, speed = self._marks[0]
        position_s += max(sample - at, 0.0) / RATE_HZ * speed
        # Between marks the position must not pass the end of the loop.
        return min(position_s, self._loop_s[1]) if self._in_loop(position_s) and self._loop_s else position_s

    def feed(self) -> None:
        """Write as much sound as the device accepts; called regularly during playback."""
        sink = self._sink
        if sink is None:
            return
        if sink.failed():
            # A device that fails right after opening is not tried repeatedly.
            self._begin(self.position_s(), may_sound=self._now() - self._begun_s > _HOPELESS_S)
            return
        if self._silent and self._now() >= self._retry_s:
            self._retry_s = self._now() + _RETRY_S
            found = self._open_sink()
            if found is not None:
                self._begin(self.position_s(), found)
                return
        free = sink.free()
        if free > 0:
            block, marks = self._reader.read(free)
            self._marks.extend(marks)
            self._written += len(block)
            sink.write(block)
        position_s = self.position_s()
        if position_s >= self._span_s[1] and not self._in_loop(position_s):
            self.stop()
            self._position_s = self._span_s[1]

    def _begin(self, start_s: float, sink: Sink | None = None, may_sound: bool = True) -> None:
        """Start playing at ``start_s``: into the given open device, else into a newly opened one, or silently if
        ``may_sound`` is False."""
        if self._sink is not None:
            self._sink.stop()
        self._begun_s = self._now()
        if sink is None and may_sound:
            sink = self._open_sink()
        # A device that exists but failed at once is not looked for again.
        self._retry_s = self._begun_s + _RETRY_S if may_sound else float("inf")
        self._set_silent(sink is None)
        self._sink = sink if sink is not None else SilentSink(self._now)
        self._sink.set_volume(self._gain)
        self._clock = DeviceClock(self._now)
        self._reader = Reader(self._mix, start_s, self._speed, self._loop_s, silent=self._silent)
        self._marks.clear()
        self._sought = None
        self._written = 0
        self._position_s = start_s
        self.feed()

    def _set_silent(self, silent: bool) -> None:
        if silent != self._silent:
            self._silent = silent
            self.silent_changed.emit(silent)

    def _in_loop(self, position_s: float) -> bool:
        return self._loop_s is not None and position_s <= self._loop_s[1] + BUFFER_S

    def _end_grains(self) -> None:
        self._rest_timer.stop()
        if self._grains is not None:
            self._grains.stop()
            self._grains = None
