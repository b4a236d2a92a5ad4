"""Reading of the sound of a video, or of any file that ffmpeg decodes, aligned with the video's time.

ffmpeg decodes the existing blocks and reports their start times, without filling gaps: a few bytes of the file can
state a gap of an hour, and filling it would allocate that hour before it could be checked. Gaps are filled here after
the total is known.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable
from threading import Thread
from typing import IO, Final

import numpy as np
import numpy.typing as npt

from app.child import ended_on_request
from app.errors import FileError, StopRequested, raise_if_stopped
from app.formats.ffmpeg import ffmpeg_on, kinds_in, refusal

_BLOCK: Final = 1 << 18
"""Number of bytes read at a time."""
_FRAME: Final = re.compile(rb"\] n: *\d+ pts: *\S+ pts_time: *(\S+) .*?rate: *(\d+) nb_samples: *(\d+) ")
_LONGEST_LINE: Final = 1 << 12
_KEPT_LINES: Final = 200
"""Number of kept lines of ffmpeg's output: the first ones list the streams, the last ones the error."""
_MOST_LEFT_OUT: Final = 0.25
"""Greatest share of the sound, 0..1, that may be removed for overlaps; more indicates wrong time stamps."""
_JUMP_S: Final = 0.02
"""Difference in seconds of time stamps from the expected ones that is attributed to rounding."""

Samples = npt.NDArray[np.int16]


class _Timing:
    """Start times of the continuous stretches of sound, parsed from ffmpeg's report on a thread.

    Attributes
    ----------
    stretches : list of (float, float)
        For each stretch, the seconds of sound decoded before it, and the time of the video at which it begins.
    reached_s : float
        Time of the video reached so far.
    first_block_s : float
        Length of the first decoded block.
    """

    def __init__(self, stream: IO[bytes]) -> None:
        self.stretches: list[tuple[float, float]] = []
        self.reached_s = 0.0
        self.first_block_s = 0.0
        self._sound_s = 0.0
        self._first: list[bytes] = []
        self._last: deque[bytes] = deque(maxlen=_KEPT_LINES)
        self._stream = stream
        self.thread = Thread(target=self._read, name="ffmpeg report", daemon=True)
        self.thread.start()

    def report(self) -> bytes:
        """Return ffmpeg's output without the time stamps."""
        return b"".join([*self._first, *self._last])

    def _read(self) -> None:
        while line := self._stream.readline(_LONGEST_LINE):
            found = _FRAME.search(line)
            if found is not None and b"ashowinfo" in line:
                self._add(*found.groups())
            elif len(self._first) < _KEPT_LINES:
                self._first.append(line)
            else:
                self._last.append(line)

    def _add(self, at: bytes, rate: bytes, count: bytes) -> None:
        try:
            begin_s = float(at)
        except ValueError:
            begin_s = self.reached_s  # no time stamp: the packet continues the last one
        if not np.isfinite(begin_s):
            begin_s = self.reached_s
        if not self.stretches or abs(begin_s - self.reached_s) > _JUMP_S:
            self.stretches.append((self._sound_s, begin_s))
            self.reached_s = begin_s
        length_s = int(count) / max(int(rate), 1)
        self.first_block_s = self.first_block_s or length_s
        self._sound_s += length_s
        self.reached_s += length_s


def film_sound(
    path: str,
    rate_hz: int,
    check: Callable[[float], None],
    stop_requested: StopRequested = lambda: False,
    delay_s: float | None = 0.0,
) -> Samples:
    """Read the sound of a video, from the video's start on.

    Parameters
    ----------
    path : str
        The video.
    rate_hz : int
        Samples per second of the result.
    check : callable
        Called repeatedly with the length of the result in seconds so far; raises an error if that is too long.
    stop_requested : callable
        Called repeatedly; once it returns True, Cancelled is raised.
    delay_s : float or None
        Seconds to remove from the start; None for the length of the first block, which transform codecs only need for
        start-up.

    Returns
    -------
    int16 array, shape (n, 2)
        Stereo samples; silence before the sound begins and in gaps.

    Raises
    ------
    FileError
        There is no sound; also the errors of `app.formats.ffmpeg` and ``check``.
    Cancelled
    """
    made, timing, status = _decoded(path, rate_hz, check, stop_requested)
    report = timing.report()
    if status:
        kinds = kinds_in(report)
        if b"Video" in kinds and b"Audio" not in kinds and status > 0:
            raise FileError("video.no_sound", file=path)
        raise refusal(report, path, status)
    sound = np.frombuffer(made, "<i2", len(made) // 4 * 2).reshape(-1, 2)
    late_s = timing.first_block_s if delay_s is None else delay_s
    placed, left_out = _placed(sound, timing.stretches, rate_hz)
    if left_out > _MOST_LEFT_OUT * len(sound):
        raise FileError("video.sound_times", file=path)
    return placed[round(late_s * rate_hz) :]


def _decoded(
    path: str, rate_hz: int, check: Callable[[float], None], stop_requested: StopRequested
) -> tuple[bytearray, _Timing, int]:
    """Decode the sound of a film with ffmpeg. Return samples (16 bits, stereo), their timing, and ffmpeg's
    exit status.
    """
    # ffmpeg would treat a gap of more than thirty hours as an error and remove it.
    exact = ("-dts_error_threshold", "1e12")
    heard = ("-map", "0:a:0", "-af", "ashowinfo", "-ac", "2", "-ar", str(rate_hz))
    made = bytearray()
    with ffmpeg_on(path, "ffmpeg.sound", exact, (*heard, "-c:a", "pcm_s16le", "-f", "s16le", "pipe:1")) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        timing = _Timing(process.stderr)
        # Also while ffmpeg reads without decoding.
        with ended_on_request(process, stop_requested, process.kill):
            try:
                while block := process.stdout.read(_BLOCK):
                    made += block
                    check(max(len(made) / (4 * rate_hz), timing.reached_s))
                status = process.wait()
            finally:
                # The reading threads end with the process, and before its streams are closed.
                process.kill()
                timing.thread.join()
    raise_if_stopped(stop_requested)
    check(max(len(made) / (4 * rate_hz), timing.reached_s))
    return made, timing, status


def _placed(sound: Samples, stretches: list[tuple[float, float]], rate_hz: int) -> tuple[Samples, int]:
    """Place stretches of decoded sound at their times in the film; overlapping samples are dropped. Return the sound
    and the number of samples dropped.
    """
    begins = [min(round(sound_s * rate_hz), len(sound)) for sound_s, _ in stretches]
    parts: list[Samples] = []
    length = heard = 0
    for begin, end, (_, at_s) in zip(begins, [*begins[1:], len(sound)], stretches, strict=True):
        at = round(at_s * rate_hz)
        if at > length and end > begin:
            parts.append(np.zeros((at - length, 2), np.int16))
            length = at
        part = sound[begin + length - at : end] if at < length else sound[begin:end]
        parts.append(part)
        length += len(part)
        heard += len(part)
    return (np.concatenate(parts), len(sound) - heard) if parts else (sound, 0)
