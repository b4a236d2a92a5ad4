"""Reading of the frames of videos with ffmpeg."""

from __future__ import annotations

import contextlib
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import numpy as np
import numpy.typing as npt

from app.child_limits import LIMITS
from app.errors import FileError
from app.formats.ffmpeg import ffmpeg_on, kinds_in, refusal, was_ended

SUFFIXES: Final = (".mp4", ".mov", ".m4v", ".mkv", ".webm", ".avi", ".mpg", ".mpeg", ".wmv", ".ogv")
"""Suffixes in file dialogs. Transport streams (.mts) are excluded, since the bundled ffmpeg 7.0.2 of Linux crashes on
them.
"""
_LEAST_RATE, _MOST_RATE, _USUAL_RATE = Fraction(1), Fraction(480), Fraction(30)
_LENGTH: Final = re.compile(rb"^  Duration: (\d+):(\d\d):(\d\d(?:\.\d+)?)", re.MULTILINE)
_HEADER: Final = re.compile(rb"YUV4MPEG2 W(\d+) H(\d+) F(\d+):(\d+) ")
_LONGEST_HEADER: Final = 256

Picture = npt.NDArray[np.uint8]
"""Pixels (height, width, 3), top row first."""


@dataclass(frozen=True)
class VideoFacts:
    """Facts about a video.

    Attributes
    ----------
    width, height : int
        Size in pixels as displayed, after rotation.
    rate : Fraction
        Frames per second; the mean for uneven frame times.
    duration_s : float
        Duration of the file; 0.0 if unknown.
    has_sound : bool
        Whether it has sound.
    """

    width: int
    height: int
    rate: Fraction
    duration_s: float
    has_sound: bool

    def fitted(self, most_width: int, most_height: int) -> tuple[int, int]:
        """Return the largest even width and height with the video's proportions that fit, never larger than the
        video."""
        share = min(most_width / self.width, most_height / self.height, 1.0)
        width, height = (max(round(share * length / 2.0) * 2, 2) for length in (self.width, self.height))
        return width, height


def video_facts(path: str) -> VideoFacts:
    """Examine a video, reading its first frame.

    Raises
    ------
    FileError
        The file cannot be read or contains no pictures; also the errors of `app.formats.files.open_file`.
    """
    first = ("-map", "0:V:0", "-frames:v", "1", "-pix_fmt", "yuv420p", "-f", "yuv4mpegpipe", "-")
    with ffmpeg_on(path, "ffmpeg.facts", (), first) as process:
        try:
            output, report = process.communicate(timeout=LIMITS["ffmpeg.facts"].wall_s)
        except subprocess.TimeoutExpired as error:
            raise FileError("video.too_costly", file=path) from error
    kinds = kinds_in(report)
    header = _HEADER.match(output[:_LONGEST_HEADER])
    if header is None:
        if b"Audio" in kinds:
            raise FileError("video.no_pictures", file=path)
        raise refusal(report, path, process.returncode)
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
    """Consecutive frames of a video; see `video_pictures`."""

    def __init__(self, path: str, process: subprocess.Popen[bytes], size: tuple[int, int], first: int) -> None:
        self._path, self._process, self._size = path, process, size
        self._is_stopped = False
        self.next = first
        """Number of the picture that is read next."""

    def read(self) -> Picture | None:
        """Return the next frame; None after the last one, or at the point where the file is cut off.

        Raises
        ------
        FileError
            The system ended ffmpeg because of a limit or a crash.
        """
        width, height = self._size
        stream = self._process.stdout
        assert stream is not None
        data = stream.read(3 * width * height)
        if len(data) < 3 * width * height:
            status = self._process.wait()
            if was_ended(status) and not self._is_stopped:
                raise refusal(b"", self._path, status)
            return None
        self.next += 1
        return np.frombuffer(data, np.uint8).reshape(height, width, 3)

    def stop(self) -> None:
        """Stop reading from another thread; `read` then returns None."""
        self._is_stopped = True
        self._process.kill()


@contextlib.contextmanager
def video_pictures(path: str, rate: Fraction, size: tuple[int, int], first: int = 0) -> Iterator[VideoPictures]:
    """Read the frames of a video from any frame on.

    Frame k is the one displayed k / rate seconds after the start of the file.

    Parameters
    ----------
    path : str
        The video.
    rate : Fraction
        Frames per second: `VideoFacts.rate`, or another rate for resampling.
    size : (int, int)
        Width and height in pixels to which frames are scaled.
    first : int
        Index of the first frame.

    Raises
    ------
    FileError
        ffmpeg cannot be started; also the errors of `app.formats.files.open_file`.
    """
    # A quarter of a frame early: rounding neither skips the requested frame nor selects the one before it.
    sought = ("-ss", f"{float((first - Fraction(1, 4)) / rate):.6f}") if first > 0 else ()
    shown = f"fps=fps={rate}:start_time=0:round=near,scale={size[0]}:{size[1]}:flags=bilinear"
    after = ("-map", "0:V:0", "-vf", shown, "-pix_fmt", "rgb24", "-f", "rawvideo", "-")
    with ffmpeg_on(path, "ffmpeg.pictures", sought, after, quiet=True) as process:
        yield VideoPictures(path, process, size, first)
