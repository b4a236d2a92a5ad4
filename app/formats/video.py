"""Films of other programs and cameras: their pictures and their sound, by the ffmpeg that imageio-ffmpeg brings.

ffmpeg runs as a process of its own, reads this one file and no other that the file names, and takes no input.

Messages
--------
video.not_readable(file, detail): ffmpeg cannot read it.
video.no_pictures(file): there is sound alone.
video.no_sound(file): there are pictures alone.
"""

from __future__ import annotations

import contextlib
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import IO, Any, Final

import imageio_ffmpeg
import numpy as np
import numpy.typing as npt

from app.errors import FileError, raise_if_stopped
from app.formats.files import open_file

SUFFIXES: Final = (".mp4", ".mov", ".m4v", ".mkv", ".webm", ".avi", ".mpg", ".mpeg", ".wmv", ".ogv")
"""Shown where one is chosen. Transport streams (.mts) are not among them: the ffmpeg 7.0.2 of Linux crashes on them."""
_CONTAINERS: Final = "mov,matroska,avi,mpegts,mpeg,asf,ogg,flv,mxf,mp3,wav,aac,flac"
"""What may be opened: no playlist, which would open other files."""
_MOST_PIXELS: Final = 1 << 26
"""Of a picture: 8192 x 8192."""
_FACTS_S: Final = 30.0
"""The longest time for the first picture."""
_LOOK_S: Final = 0.1
"""Between two looks whether to stop."""
_DETAIL: Final = 300
"""Characters of ffmpeg's complaint that are passed on."""
_LEAST_RATE, _MOST_RATE, _USUAL_RATE = Fraction(1), Fraction(480), Fraction(30)
_STREAM: Final = re.compile(rb"^  Stream #0:\d+.*?: (Video|Audio): ", re.MULTILINE)
_LENGTH: Final = re.compile(rb"^  Duration: (\d+):(\d\d):(\d\d(?:\.\d+)?)", re.MULTILINE)
_HEADER: Final = re.compile(rb"YUV4MPEG2 W(\d+) H(\d+) F(\d+):(\d+) ")
_LONGEST_HEADER: Final = 256
_PREFIX: Final = re.compile(r"^\[[^]]*\] ")
_GENERAL: Final = ("Error opening input file", "Conversion failed!")
"""Lines of ffmpeg that say no reason."""

Picture = npt.NDArray[np.uint8]
"""(height, width, 3), top row first."""


@dataclass(frozen=True)
class VideoFacts:
    """What a film is.

    Attributes
    ----------
    width, height : int
        Pixels, as it is seen: a film that a phone took upright is higher than wide.
    rate : Fraction
        Pictures per second; the mean where they come at uneven times.
    duration_s : float
        Of the file; 0.0 where it does not say.
    has_sound : bool
    """

    width: int
    height: int
    rate: Fraction
    duration_s: float
    has_sound: bool

    def fitted(self, most_width: int, most_height: int) -> tuple[int, int]:
        """The size, even and in proportion, that fits; never larger than the film is."""
        share = min(most_width / self.width, most_height / self.height, 1.0)
        width, height = (max(round(share * length / 2.0) * 2, 2) for length in (self.width, self.height))
        return width, height


def video_facts(path: str) -> VideoFacts:
    """Look at a film: reads its first picture.

    Raises
    ------
    FileError
        ``video.not_readable``, ``video.no_pictures``; see `app.formats.files.open_file`.
    """
    open_file(path).close()
    first = ("-map", "0:V:0", "-frames:v", "1", "-pix_fmt", "yuv420p", "-f", "yuv4mpegpipe", "-")
    with _started(path, (), first) as process:
        try:
            output, report = process.communicate(timeout=_FACTS_S)
        except subprocess.TimeoutExpired as error:
            raise FileError("video.not_readable", file=path, detail=f"{_FACTS_S:g} s") from error
    kinds = set(_STREAM.findall(report))
    header = _HEADER.match(output[:_LONGEST_HEADER])
    if header is None:
        if b"Audio" in kinds:
            raise FileError("video.no_pictures", file=path)
        raise FileError("video.not_readable", file=path, detail=_complaint(report, path, process.returncode))
    width, height, *per_s = (int(number) for number in header.groups())
    rate = Fraction(*per_s) if all(per_s) else _USUAL_RATE
    length = _LENGTH.search(report)
    hours, minutes, seconds = (float(part) for part in length.groups()) if length is not None else (0.0, 0.0, 0.0)
    return VideoFacts(
        width=width,
        height=height,
        rate=rate if _LEAST_RATE <= rate <= _MOST_RATE else _USUAL_RATE,
        duration_s=3600.0 * hours + 60.0 * minutes + seconds,
        has_sound=b"Audio" in kinds,
    )


class VideoPictures:
    """Pictures of a film, one after the other from one of them on; see `video_pictures`."""

    def __init__(self, path: str, process: subprocess.Popen[bytes], size: tuple[int, int], first: int) -> None:
        self._path, self._process, self._size = path, process, size
        self.next = first
        """Number of the picture that is read next."""

    def read(self) -> Picture | None:
        """The next picture; None after the last, which is where the file breaks off."""
        width, height = self._size
        stream = self._process.stdout
        assert stream is not None
        data = stream.read(3 * width * height)
        if len(data) < 3 * width * height:
            return None
        self.next += 1
        return np.frombuffer(data, np.uint8).reshape(height, width, 3)

    def stop(self) -> None:
        """End it from another thread: `read` returns None."""
        self._process.kill()


@contextlib.contextmanager
def video_pictures(path: str, rate: Fraction, size: tuple[int, int], first: int = 0) -> Iterator[VideoPictures]:
    """Read a film's pictures, at its own rate, whichever of them is the first.

    Picture k is the one that is seen k / rate seconds after the beginning of the file.

    Parameters
    ----------
    path : str
    rate : Fraction
        Pictures per second: `VideoFacts.rate`, or another at which they are sampled.
    size : (int, int)
        Width and height that they are brought to, pixels.
    first : int
        Number of the picture to begin with.

    Raises
    ------
    FileError
        ``video.not_readable``: ffmpeg does not start; see `app.formats.files.open_file`.
    """
    open_file(path).close()
    # A quarter of a picture early: what is sought is not missed for a rounded time, nor the one before taken for it.
    sought = ("-ss", f"{float((first - Fraction(1, 4)) / rate):.6f}") if first > 0 else ()
    shown = f"fps=fps={rate}:start_time=0:round=near,scale={size[0]}:{size[1]}:flags=bilinear"
    with _started(
        path, sought, ("-map", "0:V:0", "-vf", shown, "-pix_fmt", "rgb24", "-f", "rawvideo", "-"), True
    ) as process:
        yield VideoPictures(path, process, size, first)


def sound_into(
    path: str, wave: Path, rate_hz: int, most_s: float, stop_requested: Callable[[], bool] = lambda: False
) -> None:
    """Write a film's sound as a stereo WAV file that begins with the film.

    Parameters
    ----------
    path : str
    wave : Path
        Of the new file.
    rate_hz : int
        Samples per second of it.
    most_s : float
        What comes later is left out.
    stop_requested : callable
        Asked now and then; true ends the work.

    Raises
    ------
    FileError
        ``video.no_sound``, ``video.not_readable``; see `app.formats.files.open_file`.
    Cancelled
    """
    open_file(path).close()
    # Silence where the sound begins after the pictures or is broken: both keep the same time.
    heard = (
        "-map",
        "0:a:0",
        "-af",
        "aresample=async=1:first_pts=0",
        "-ac",
        "2",
        "-ar",
        str(rate_hz),
        "-t",
        f"{most_s:g}",
    )
    with _started(path, (), (*heard, "-c:a", "pcm_s16le", "-f", "wav", f"file:{wave}")) as process:
        report = None
        while report is None:
            raise_if_stopped(stop_requested)
            with contextlib.suppress(subprocess.TimeoutExpired):
                _, report = process.communicate(timeout=_LOOK_S)
    if process.returncode:
        kinds = set(_STREAM.findall(report))
        if b"Video" in kinds and b"Audio" not in kinds:
            raise FileError("video.no_sound", file=path)
        raise FileError("video.not_readable", file=path, detail=_complaint(report, path, process.returncode))


@contextlib.contextmanager
def _started(
    path: str, before: tuple[str, ...], after: tuple[str, ...], quiet: bool = False
) -> Iterator[subprocess.Popen[bytes]]:
    """ffmpeg at work on a file; it has ended when the block is done."""
    options: dict[str, Any] = {}
    if sys.platform == "win32":
        options["creationflags"] = subprocess.CREATE_NO_WINDOW
    else:
        options["process_group"] = 0
    only = ("-protocol_whitelist", "file", "-format_whitelist", _CONTAINERS, "-max_pixels", str(_MOST_PIXELS))
    try:
        process = subprocess.Popen(
            [
                *(imageio_ffmpeg.get_ffmpeg_exe(), "-hide_banner", "-nostdin", "-nostats", "-y"),
                *(("-loglevel", "quiet") if quiet else ()),
                *(*only, *before, "-i", f"file:{path}", *after),
            ],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if quiet else subprocess.PIPE,
            **options,
        )
    except (OSError, RuntimeError, ValueError) as error:
        raise FileError("video.not_readable", file=path, detail=str(error)) from error
    try:
        yield process
    finally:
        process.kill()
        streams: tuple[IO[bytes] | None, ...] = (process.stdout, process.stderr)
        for stream in streams:
            if stream is not None:
                stream.close()
        process.wait()


def _complaint(report: bytes, path: str, status: int) -> str:
    """The last reason that ffmpeg gives, without the path that the message names already."""
    reasons = [
        _PREFIX.sub("", line).replace(f"file:{path}", "").strip(" :.")
        for line in report.decode(errors="replace").splitlines()
        if not line.startswith(_GENERAL)
    ]
    return reasons[-1][-_DETAIL:] if reasons and status >= 0 else f"ffmpeg: {status}"
