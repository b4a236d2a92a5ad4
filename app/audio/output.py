"""The system's default sound output, by miniaudio: WASAPI, Core Audio, PulseAudio (PipeWire's too) or ALSA.

Where the default output changes while it plays, WASAPI, Core Audio and PulseAudio move the sound to the new one.
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

# JACK is missing: its library prints to the terminal wherever its server does not run.
_BACKENDS: Final = tuple(
    miniaudio.Backend[name] for name in ("WASAPI", "DSOUND", "WINMM", "COREAUDIO", "PULSEAUDIO", "ALSA")
)
_PERIOD_MS: Final = 40
"""The device fetches as much at once; less would run dry where the interpreter is busy elsewhere."""
_PERIODS: Final = 2
_STALLED_S: Final = 3.0
"""A device fetches many times a second; a Bluetooth one may need a second or two to wake up."""
_NATIVE_HZ: Final = 0
"""The device's own rate: miniaudio's resampler is linear, 27 dB above its own noise at 8 kHz."""


def open_output() -> Sink | None:
    """The system's default output, ready to be written to; None where there is none, or none that can be opened."""
    with _quiet_alsa():
        try:
            return OutputSink(_BACKENDS)
        except miniaudio.MiniaudioError:
            return None


class OutputSink:
    """An output of the system.

    Parameters
    ----------
    backends : tuple of miniaudio.Backend
        The first that is there is used.

    Raises
    ------
    miniaudio.MiniaudioError
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
        """Samples that may be written now, at `RATE_HZ`."""
        return max(round((BUFFER_S - self._queue.waiting_s()) * RATE_HZ), 0)

    def write(self, block: Block) -> None:
        """Queue samples behind those already written."""
        if self._resampler is not None:
            block = self._resampler.resample_chunk(np.ascontiguousarray(block))
        self._queue.put(block)

    def processed_s(self) -> float:
        """Seconds that were played since the start."""
        return self._queue.played_s()

    def set_volume(self, gain: float) -> None:
        """0..1, linear."""
        self._queue.gain = gain

    def failed(self) -> bool:
        """Return whether the device went away; miniaudio does not notice that the sound server did."""
        return not self._device.is_started or self._queue.unfetched_s() > _STALLED_S

    def stop(self) -> None:
        """Be silent at once."""
        self._device.close()
        _playing.discard(self)


_playing: Final[set[OutputSink]] = set()


@atexit.register
def _stop_all() -> None:
    """Stop all devices at exit; otherwise the interpreter and the device's thread would wait for each other."""
    for sink in tuple(_playing):
        sink.stop()


class Queue:
    """Sound between the thread that writes it and the device's own, which fetches it.

    Parameters
    ----------
    delay_s : float
        Time from when the device fetches sound until that begins to sound.
    now : callable
        A monotonic clock in seconds.

    Attributes
    ----------
    gain : float
        Factor of what is fetched from now on.
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
        """The next ``count`` samples, with silence where there are too few."""
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
        """`fetch` as the generator that miniaudio sends counts to, begun."""
        generator = self._frames()
        next(generator)
        return generator

    def _frames(self) -> Generator[SingleArray | bytes, int, None]:
        count = yield b""
        while True:
            count = yield self.fetch(count)

    def played_s(self) -> float:
        """Seconds of the queued sound that were played."""
        with self._lock:
            return self._played() / self._rate_hz

    def waiting_s(self) -> float:
        """Seconds that were queued and not played yet."""
        with self._lock:
            return (self._put - self._played()) / self._rate_hz

    def unfetched_s(self) -> float:
        """Seconds since the device fetched anything."""
        return self._now() - self._fetched_s

    def _played(self) -> float:
        now_s = self._now()
        while len(self._fetches) > 1 and self._fetches[1][0] <= now_s:
            self._fetches.popleft()
        begins_s, before, count = self._fetches[0]
        return before + min(max((now_s - begins_s) * self._rate_hz, 0.0), count)


class _Device(miniaudio.PlaybackDevice):  # type: ignore[misc]
    """miniaudio's device, with what it keeps to itself: its state, its own rate, and its context's end."""

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
        """True if it plays; not after it was taken away."""
        return (
            self._device is not None
            and self.callback_generator is not None
            and bool(miniaudio.lib.ma_device_is_started(self._device))
        )

    def close(self) -> None:
        """Stop, and let go of everything: 1.71 keeps a connection to the sound server (pyminiaudio issue 86)."""
        super().close()
        context, self._context = getattr(self, "_context", miniaudio.ffi.NULL), miniaudio.ffi.NULL
        if context != miniaudio.ffi.NULL:
            miniaudio.lib.ma_context_uninit(context)


_AlsaHandler = ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p)
_say_nothing = _AlsaHandler(lambda file, line, function, error, text: None)


@contextlib.contextmanager
def _quiet_alsa() -> Iterator[None]:
    """ALSA prints forty lines where there is no sound card; a missing output is reported by us."""
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
