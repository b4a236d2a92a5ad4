"""Decoding of recordings (WAV, FLAC, OGG and MP3 files, and the sound of films) to samples at the rate of the mix.

The decoder is chosen by the file's content and not by its name.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from mmap import ACCESS_READ, mmap
from typing import Final

import numpy as np
import soundfile
import soxr

from app.audio.track import RATE_HZ, Block, Samples
from app.errors import FileError, Message, Progress, StopRequested, raise_if_stopped
from app.formats.files import cannot_read, open_file
from app.formats.film_sound import film_sound
from app.formats.media_kind import MediaKind, media_kind
from app.formats.mpeg_audio import MpegAudio, mpeg_audio

MOST_HOURS: Final = 4
"""Longest recording in hours; an hour takes 0.7 GB of memory."""
FREE_S: Final = 600.0
LEAST_BYTES_PER_S: Final = 500.0
"""Least bytes per second of sound: a file may contain `FREE_S` seconds, plus one second for each such number of bytes.
Real sound needs more; silence can take a hundredth of this, so that a small file could fill the memory.
"""
FREE_VALUES: Final = 2**26
VALUES_PER_BYTE: Final = 256
"""Greatest number of samples in all channels per byte of a file, since a few bytes can stand for 65,536 samples in each
of eight channels.
"""
MOST_CHANNELS: Final = 64
LEAST_RATE_HZ, MOST_RATE_HZ = 1000, 768_000
_BLOCK: Final = 1 << 16
_UNKNOWN: Final = 2**63 - 1
"""Length that libsndfile reports if it is unknown, as for some Ogg streams."""


@dataclass(frozen=True, eq=False)
class AudioRecording:
    """An audio file's samples in memory.

    Attributes
    ----------
    samples : int16 array, shape (n, 2)
        Samples at `RATE_HZ`.
    """

    path: str
    samples: Samples
    warnings: tuple[Message, ...] = ()

    @property
    def duration_s(self) -> float:
        """Duration of the recording in seconds."""
        return len(self.samples) / RATE_HZ


class _Forward(soundfile.SoundFile):  # type: ignore[misc]
    """A sound file read in order without seeking, since soundfile seeks after each block, which is inexact for MP3."""

    @property
    def is_seekable(self) -> bool:
        """Return whether the file's length is known."""
        return bool(super().seekable())

    def seekable(self) -> bool:
        return False


def decode(
    path: str, progress: Progress = lambda share: None, stop_requested: StopRequested = lambda: False
) -> AudioRecording:
    """Decode a recording.

    Parameters
    ----------
    progress : callable
        Called with the share 0..1 that has been read.
    stop_requested : callable
        Called regularly; true cancels decoding.

    Raises
    ------
    FileError
        The file cannot be read, contains no sound, or is longer than `MOST_HOURS`.
    Cancelled
        ``stop_requested`` returned true.
    """
    kind = media_kind(path)
    if kind is not MediaKind.SOUND:
        delay_s = None if kind is MediaKind.ADTS else 0.0
        return AudioRecording(path, _by_ffmpeg(path, delay_s, progress, stop_requested))
    headless = _headless(path)
    if headless is not None:
        samples = _by_ffmpeg(path, headless.delay_samples / headless.rate_hz, progress, stop_requested)
        return AudioRecording(path, samples, _breaks_off(path, len(samples) / RATE_HZ) if headless.breaks_off else ())
    try:
        with open_file(path) as stream, _Forward(stream) as file:
            return _read(path, file, os.fstat(stream.fileno()).st_size, progress, stop_requested)
    except (soundfile.SoundFileError, RuntimeError, TypeError) as error:
        raise FileError("audio.not_readable", file=path, detail=_detail(error)) from error


def _most_s(size: int) -> float:
    """Return the longest duration in seconds that is allowed for a file of a size in bytes."""
    return FREE_S + size / LEAST_BYTES_PER_S


def _check_length(path: str, seconds: float, most_s: float) -> None:
    if seconds > MOST_HOURS * 3600:
        raise FileError("audio.too_long", file=path, most_hours=MOST_HOURS)
    if seconds > most_s:
        raise FileError("audio.too_dense", file=path, minutes=int(most_s // 60))


def _check_said(path: str, file: _Forward, most_s: float) -> None:
    """Raise FileError if the length stated in the file's header is too long. Headers may be wrong, so the length only
    counts if the file's size agrees; Ogg has no header, and its length is the position of the last page.
    """
    said_s = file.frames / file.samplerate
    if file.frames < _UNKNOWN and (file.format == "OGG" or said_s <= most_s):
        _check_length(path, said_s, most_s)


def _headless(path: str) -> MpegAudio | None:
    """Return the file as MPEG audio without a length in its header, of which libsndfile only guesses the length, so
    that the end is missing or too much is stated; None for other files.
    """
    with open_file(path) as stream:
        if not os.fstat(stream.fileno()).st_size:
            return None
        try:
            with mmap(stream.fileno(), 0, access=ACCESS_READ) as data:
                return mpeg_audio(data)
        except OSError as error:
            raise cannot_read(path, error) from error


def _breaks_off(path: str, seconds: float) -> tuple[Message, ...]:
    return (Message("audio.breaks_off", {"file": path, "seconds": round(seconds, 1)}),)


def _by_ffmpeg(path: str, delay_s: float | None, progress: Progress, stop_requested: StopRequested) -> Samples:
    """Decode the sound of a film, or of a file that only ffmpeg can read."""
    with open_file(path) as stream:
        most_s = _most_s(os.fstat(stream.fileno()).st_size)
    check = partial(_check_length, path, most_s=most_s)
    samples = film_sound(path, RATE_HZ, check, stop_requested, delay_s)
    if not len(samples):
        raise FileError("audio.empty", file=path)
    progress(1.0)
    return samples


def _read(path: str, file: _Forward, size: int, progress: Progress, stop_requested: StopRequested) -> AudioRecording:
    rate_hz, channels = file.samplerate, file.channels
    if not (LEAST_RATE_HZ <= rate_hz <= MOST_RATE_HZ and 1 <= channels <= MOST_CHANNELS):
        raise FileError("audio.unusable", file=path, rate_hz=rate_hz, channels=channels)
    resampler = soxr.ResampleStream(rate_hz, RATE_HZ, 2, dtype="float32") if rate_hz != RATE_HZ else None
    most_s = _most_s(size)
    _check_said(path, file, most_s)
    # The buffer grows in place: joining a list of blocks at the end would take the memory twice.
    made = bytearray()
    warnings: tuple[Message, ...] = ()
    frames = 0
    # The length in the header may be wrong; it is used for the progress only.
    expected = max(file.frames, 1)
    while True:
        raise_if_stopped(stop_requested)
        try:
            raw = file.read(_BLOCK, dtype="float32", always_2d=True)
        except (soundfile.SoundFileError, RuntimeError):
            if not frames:
                raise
            raw = np.zeros((0, channels), np.float32)
            warnings = _breaks_off(path, frames / rate_hz)
        frames += len(raw)
        _check_length(path, frames / rate_hz, most_s)
        if frames * channels > FREE_VALUES + VALUES_PER_BYTE * size:
            raise FileError("audio.too_many_samples", file=path, rate_hz=rate_hz, channels=channels)
        block = _stereo(np.nan_to_num(raw, nan=0.0, posinf=1.0, neginf=-1.0))
        if resampler is not None:
            block = resampler.resample_chunk(block, last=not len(raw))
        made += np.round(np.clip(block, -1.0, 1.0) * 32767.0).astype(np.int16).tobytes()
        progress(min(frames / expected, 1.0))
        if not len(raw):
            break
    if not frames:
        raise FileError("audio.empty", file=path)
    if frames < expected and not warnings and file.is_seekable and expected < MOST_HOURS * 3600 * rate_hz:
        warnings = _breaks_off(path, frames / rate_hz)
    return AudioRecording(path, np.frombuffer(made, np.int16).reshape(-1, 2), warnings)


def _stereo(block: Block) -> Block:
    """Return two channels: a mono channel is doubled; further channels are added to left and right."""
    if block.shape[1] == 1:
        return np.ascontiguousarray(np.repeat(block, 2, axis=1))
    if block.shape[1] == 2:
        return block
    others = block[:, 2:].mean(axis=1, keepdims=True)
    return np.ascontiguousarray((block[:, :2] + others) / np.float32(1.5))


def _detail(error: Exception) -> str:
    """Return the library's error message without the path, which is in the program's message already."""
    return str(error).rsplit(": ", 1)[-1].rstrip(".")
