"""Recordings: WAV, FLAC, OGG and MP3 files, and the sound of films, as samples at the rate everything is mixed at.

Messages: ``audio.not_readable``, ``audio.empty``, ``audio.too_long``, ``audio.too_dense``, ``audio.unusable``,
``audio.breaks_off``; of films ``video.not_readable``, ``video.no_sound``.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import soundfile
import soxr

from app.audio.track import RATE_HZ, Block, Samples
from app.errors import FileError, Message, raise_if_stopped
from app.formats.files import open_file
from app.formats.scratch import scratch_folder
from app.formats.video import SUFFIXES, sound_into

MOST_HOURS: Final = 4
"""Longer recordings would fill the memory: an hour takes 0.7 GB."""
FREE_S: Final = 600.0
LEAST_BYTES_PER_S: Final = 100.0
"""A file may hold `FREE_S`, and a second more for so many of its bytes: the least that speech takes is ten times that,
but silence can be packed into a thousandth of it, and a small file fill the memory."""
MOST_CHANNELS: Final = 64
LEAST_RATE_HZ, MOST_RATE_HZ = 1000, 768_000
_BLOCK: Final = 1 << 16
FILM_SUFFIXES: Final = (*SUFFIXES, ".m4a", ".aac")
"""Files whose sound is taken out first, by ffmpeg."""


@dataclass(frozen=True, eq=False)
class Recording:
    """A recording in memory.

    Attributes
    ----------
    samples : int16 array, shape (n, 2)
        At `RATE_HZ`.
    """

    path: str
    samples: Samples
    warnings: tuple[Message, ...] = ()

    @property
    def duration_s(self) -> float:
        """Its length."""
        return len(self.samples) / RATE_HZ


def decode(
    path: str,
    progress: Callable[[float], None] = lambda share: None,
    stop_requested: Callable[[], bool] = lambda: False,
) -> Recording:
    """Read a recording.

    Parameters
    ----------
    progress : callable
        Called with the share 0..1 that is read.
    stop_requested : callable
        Asked now and then; true ends the work.

    Raises
    ------
    FileError
        The file cannot be read, has no sound, or is longer than `MOST_HOURS`.
    Cancelled
    """
    if path.lower().endswith(FILM_SUFFIXES):
        with scratch_folder() as folder:
            wave = folder / "sound.wav"
            sound_into(path, wave, RATE_HZ, MOST_HOURS * 3600.0 + 1.0, stop_requested)
            return replace(decode(os.fspath(wave), progress, stop_requested), path=path)
    try:
        with open_file(path) as stream, soundfile.SoundFile(stream) as file:
            most_s = FREE_S + os.fstat(stream.fileno()).st_size / LEAST_BYTES_PER_S
            return _read(path, file, most_s, progress, stop_requested)
    except (soundfile.SoundFileError, RuntimeError, TypeError) as error:
        raise FileError("audio.not_readable", file=path, detail=_detail(error)) from error


def _read(
    path: str,
    file: soundfile.SoundFile,
    most_s: float,
    progress: Callable[[float], None],
    stop_requested: Callable[[], bool],
) -> Recording:
    rate_hz, channels = file.samplerate, file.channels
    if not (LEAST_RATE_HZ <= rate_hz <= MOST_RATE_HZ and 1 <= channels <= MOST_CHANNELS):
        raise FileError("audio.unusable", file=path, rate_hz=rate_hz, channels=channels)
    resampler = soxr.ResampleStream(rate_hz, RATE_HZ, 2, dtype="float32") if rate_hz != RATE_HZ else None
    blocks: list[Samples] = []
    warnings: tuple[Message, ...] = ()
    frames, most = 0, MOST_HOURS * 3600 * rate_hz
    # The length in the header is a claim: it is used for the progress only.
    expected = max(file.frames, 1)
    while True:
        raise_if_stopped(stop_requested)
        try:
            raw = file.read(_BLOCK, dtype="float32", always_2d=True)
        except (soundfile.SoundFileError, RuntimeError):
            if not frames:
                raise
            raw = np.zeros((0, channels), np.float32)
            warnings = (Message("audio.breaks_off", {"file": path, "seconds": round(frames / rate_hz, 1)}),)
        frames += len(raw)
        if frames > most:
            raise FileError("audio.too_long", file=path, most_hours=MOST_HOURS)
        if frames > most_s * rate_hz:
            raise FileError("audio.too_dense", file=path, minutes=int(most_s // 60))
        block = _stereo(np.nan_to_num(raw, nan=0.0, posinf=1.0, neginf=-1.0))
        if resampler is not None:
            block = resampler.resample_chunk(block, last=not len(raw))
        blocks.append(np.round(np.clip(block, -1.0, 1.0) * 32767.0).astype(np.int16))
        progress(min(frames / expected, 1.0))
        if not len(raw):
            break
    if not frames:
        raise FileError("audio.empty", file=path)
    if frames < expected and not warnings and file.seekable() and expected < most:
        warnings = (Message("audio.breaks_off", {"file": path, "seconds": round(frames / rate_hz, 1)}),)
    return Recording(path, np.concatenate(blocks), warnings)


def _stereo(block: Block) -> Block:
    """Two channels: one is played on both sides; channels beside left and right are added to both."""
    if block.shape[1] == 1:
        return np.ascontiguousarray(np.repeat(block, 2, axis=1))
    if block.shape[1] == 2:
        return block
    others = block[:, 2:].mean(axis=1, keepdims=True)
    return np.ascontiguousarray((block[:, :2] + others) / np.float32(1.5))


def _detail(error: Exception) -> str:
    """What the library says, without the path that the message names already."""
    return str(error).rsplit(": ", 1)[-1].rstrip(".")
