"""The system's default sound output through miniaudio: WASAPI, Core Audio, PulseAudio (also PipeWire's) or ALSA.

If the default output changes during playback, WASAPI, Core Audio and PulseAudio switch the sound to the new one.
"""

from __future__ import annotations

import atexit
import contextlib
import ctypes
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator
from typing import Final

import miniaudio
import numpy as np
import soxr

from app.arrays import SingleArray
from app.audio.sink import BUFFER_S, Sink
from app.audio.track import RATE_HZ, Block

# JACK is left out: its library prints to the terminal where no server runs.
_BACKENDS: Final = tuple(
    miniaudio.Backend[name] for name in ("WASAPI", "DSOUND", "WINMM", "COREAUDIO", "PULSEAUDIO", "ALSA")
)
_PERIOD_MS: Final = 40
"""Duration in milliseconds of the sound fetched at a time; less would cause gaps while the interpreter is busy."""
_PERIODS: Final = 2
_STALLED_S: Final = 3.0
"""Seconds without a fetch after which a device is considered lost; Bluetooth devices may need a second or two to
start.
"""
_NATIVE_HZ: Final = 0
"""Value for the device's own rate, since miniaudio resamples linearly, with noise only 27 dB below a tone at 8 kHz."""


def open_output() -> Sink | None:
    """Return the system's default output, ready for writing; None if there is none or it cannot be opened."""
    with _quiet_alsa():
        try:
            return OutputSink(_BACKENDS)
        except miniaudio.MiniaudioError:
            return None


class OutputSink:
    """A sound output of the system.

    Parameters
    ----------
    backends : tuple of miniaudio.Backend
        Backends to try in order.

    Raises
    ------
    miniaudio.MiniaudioError
        No backend can open an output.
    """

    def __init__(self, backends: tuple[miniaudio.Backend, ...]) -> None:
        self._device = _Device(backends)
        rate_hz = self._device.rate_hz
        self._resampler = soxr.ResampleStream(RATE_HZ, rate_hz, 2, dtype="float32") if rate_hz != RATE_HZ else None
        self._queue = Queue(rate_hz, _PERIOD_MS / 1000)
        try:
            self._device.start(self._queue.frames())
        except miniaudio.MiniaudioError:
            self._device.close()
            raise
        _playing.add(self)

    def free(self) -> int:
        """Return the number of samples at `RATE_HZ` that may be written now."""
        return max(round((BUFFER_S - self._queue.waiting_s()) * RATE_HZ), 0)

    def write(self, block: Block) -> None:
        """Append samples to those already written; they are resampled to the device's rate."""
        if self._resampler is not None:
            block = self._resampler.resample_chunk(np.ascontiguousarray(block))
        self._queue.put(block)

    def processed_s(self) -> float:
        """Return the seconds played since the start."""
        return self._queue.played_s()

    def set_volume(self, gain: float) -> None:
        """Set the volume as a linear factor, 0..1."""
        self._queue.gain = gain

    def failed(self) -> bool:
        """Return whether the device was lost; miniaudio does not notice the end of the sound server."""
        return not self._device.is_started or self._queue.unfetched_s() > _STALLED_S

    def stop(self) -> None:
        """Stop the sound immediately and close the device."""
        self._device.close()
        _playing.discard(self)


_playing: Final[set[OutputSink]] = set()


@atexit.register
def _stop_all() -> None:
    """Stop all devices at exit; otherwise the interpreter and the device's thread would block each other."""
    for sink in tuple(_playing):
        sink.stop()


class Queue:
    """Queue of sound between the writing thread and the device's thread.

    Parameters
    ----------
    delay_s : float
        Delay in seconds from the device's fetching of sound to its being audible.
    now : callable
        Function that returns a monotonic time in seconds.

    Attributes
    ----------
    gain : float
        Factor for sound fetched from now on.
    """

    def __init__(self, rate_hz: int, delay_s: float, now: Callable[[], float] = time.perf_counter) -> None:
        self.gain = 1.0
        self._rate_hz = rate_hz
        self._delay_s = delay_s
        self._now = now
        self._lock = threading.Lock()
        self._blocks: deque[Block] = deque()
        self._put = 0
        self._fetched_s = now()
        self._fetches: deque[tuple[float, int, int]] = deque([(now(), 0, 0)])
        """For each fetch: the time at which it begins to sound, samples fetched before, and samples of this one."""

    def put(self, block: Block) -> None:
        """Add sound at the end; shape (n, 2)."""
        with self._lock:
            self._blocks.append(block)
            self._put += len(block)

    def fetch(self, count: int) -> Block:
        """Return the next ``count`` samples, padded with silence."""
        out = np.zeros((count, 2), np.float32)
        done = 0
        with self._lock:
            while done < count and self._blocks:
                block = self._blocks.popleft()
                part = block[: count - done]
                out[done : done + len(part)] = part
                done += len(part)
                if len(part) < len(block):
                    self._blocks.appendleft(block[len(part) :])
            self._fetched_s = self._now()
            _, before, last = self._fetches[-1]
            self._fetches.append((self._fetched_s + self._delay_s, before + last, done))
        return out * np.float32(self.gain)

    def frames(self) -> Generator[SingleArray | bytes, int, None]:
        """Return a started generator in the form that miniaudio expects: it yields the next sound when a number of
        samples is sent to it.
        """
        generator = self._frames()
        next(generator)
        return generator

    def _frames(self) -> Generator[SingleArray | bytes, int, None]:
        count = yield b""
        while True:
            count = yield self.fetch(count)

    def played_s(self) -> float:
        """Return the seconds of queued sound that were played."""
        with self._lock:
            return self._played() / self._rate_hz

    def waiting_s(self) -> float:
        """Return the seconds of queued sound that were not played yet."""
        with self._lock:
            return (self._put - self._played()) / self._rate_hz

    def unfetched_s(self) -> float:
        """Return the seconds since the device last fetched sound, which grow if the device was lost."""
        return self._now() - self._fetched_s

    def _played(self) -> float:
        now_s = self._now()
        while len(self._fetches) > 1 and self._fetches[1][0] <= now_s:
            self._fetches.popleft()
        begins_s, before, count = self._fetches[0]
        return before + min(max((now_s - begins_s) * self._rate_hz, 0.0), count)


class _Device(miniaudio.PlaybackDevice):  # type: ignore[misc]
    """Miniaudio's device with access to its private state, rate and context."""

    def __init__(self, backends: tuple[miniaudio.Backend, ...]) -> None:
        try:
            super().__init__(
                output_format=miniaudio.SampleFormat.FLOAT32,
                nchannels=2,
                sample_rate=_NATIVE_HZ,
                buffersize_msec=_PERIOD_MS,
                callback_periods=_PERIODS,
                backends=list(backends),
                app_name="Suisou",
            )
        except miniaudio.MiniaudioError:
            self.close()
            raise
        self.rate_hz: int = self._device.sampleRate

    @property
    def is_started(self) -> bool:
        """True if the device plays; false after it was disconnected."""
        return (
            self._device is not None
            and self.callback_generator is not None
            and bool(miniaudio.lib.ma_device_is_started(self._device))
        )

    def close(self) -> None:
        """Close the device and its connection to the sound server, which version 1.71 keeps open (pyminiaudio issue
        86).
        """
        super().close()
        context, self._context = getattr(self, "_context", miniaudio.ffi.NULL), miniaudio.ffi.NULL
        if context != miniaudio.ffi.NULL:
            miniaudio.lib.ma_context_uninit(context)


_AlsaHandler = ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p)
_say_nothing = _AlsaHandler(lambda file, line, function, error, text: None)


@contextlib.contextmanager
def _quiet_alsa() -> Iterator[None]:
    """Context manager that suppresses the messages that ALSA prints on systems without a sound card; the program
    reports a missing output itself.
    """
    try:
        set_handler = ctypes.CDLL("libasound.so.2").snd_lib_error_set_handler if sys.platform == "linux" else None
    except OSError:
        set_handler = None
    if set_handler is None:
        yield
        return
    set_handler(_say_nothing)
    try:
        yield
    finally:
        set_handler(None)
