"""Running of the ffmpeg bundled with imageio-ffmpeg on one of the user's files.

It is a separate process within the limits of `app.child_limits`; it opens only this file, not files named in it, and
reads no input.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from typing import IO, Any, Final

import imageio_ffmpeg

from app.child_limits import confine, limited_command
from app.errors import FileError
from app.formats.files import open_file
from app.formats.media_kind import MediaKind, media_kind

_CONTAINERS: Final = "mov,matroska,avi,mpeg,asf,ogg,flv,mxf,mp3,wav,aac,flac"
"""Container formats that may be opened. Playlists are excluded since they open other files, and transport streams since
the bundled ffmpeg crashes on them.
"""
_MOST_PIXELS: Final = 1 << 26
"""Largest picture in pixels: 8192 x 8192."""
_DETAIL: Final = 300
"""Greatest number of characters of ffmpeg's error output that are shown."""
_STREAM: Final = re.compile(rb"^  Stream #0:\d+.*?: (Video|Audio): ", re.MULTILINE)
_PREFIX: Final = re.compile(r"^\[[^]]*\] ")
_GENERAL: Final = ("Error opening input file", "Conversion failed!")
"""Error lines of ffmpeg that contain no reason."""
_NO_MEMORY: Final = ("Cannot allocate memory", "Failed to allocate", "failed to create thread", "Resource temporarily")
_OVER: Final = frozenset(-number for name in ("SIGXCPU", "SIGXFSZ", "SIGKILL") if (number := getattr(signal, name, 0)))
"""Exit statuses of a process that the system ended at a resource limit."""
_WINDOWS_CRASH: Final = 0xC0000000
"""Lowest exit status that is an exception on Windows."""


@contextlib.contextmanager
def ffmpeg_on(
    path: str, limits: str, before: tuple[str, ...], after: tuple[str, ...], quiet: bool = False
) -> Iterator[subprocess.Popen[bytes]]:
    """Run ffmpeg on a file; the process has ended when the block is left.

    Parameters
    ----------
    path : str
        The file.
    limits : str
        Name of a row of `app.child_limits.LIMITS`.
    before, after : tuple of str
        Options before and after the input.
    quiet : bool
        Suppress ffmpeg's report.

    Raises
    ------
    FileError
        The file is an MPEG transport stream, or ffmpeg cannot be started; also the errors of
        `app.formats.files.open_file`.
    """
    with open_file(path) as stream:
        size = os.fstat(stream.fileno()).st_size
    if media_kind(path) is MediaKind.TRANSPORT:
        raise FileError("video.transport_stream", file=path)
    options: dict[str, Any] = {}
    if sys.platform == "win32":
        options["creationflags"] = subprocess.CREATE_NO_WINDOW
    else:
        options["process_group"] = 0
    only = ("-protocol_whitelist", "file", "-format_whitelist", _CONTAINERS, "-max_pixels", str(_MOST_PIXELS))
    try:
        command = [
            *(imageio_ffmpeg.get_ffmpeg_exe(), "-hide_banner", "-nostdin", "-nostats", "-y"),
            *(("-loglevel", "quiet") if quiet else ()),
            *(*only, *before, "-i", f"file:{path}", *after),
        ]
        process = subprocess.Popen(
            limited_command(limits, command, size),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if quiet else subprocess.PIPE,
            **options,
        )
    except (OSError, RuntimeError, ValueError) as error:
        raise FileError("video.not_readable", file=path, detail=str(error)) from error
    try:
        try:
            job = confine(limits, process, size)
        except OSError as error:
            raise FileError("video.not_readable", file=path, detail=str(error)) from error
        yield process
        del job
    finally:
        process.kill()
        streams: tuple[IO[bytes] | None, ...] = (process.stdout, process.stderr)
        for stream_ in streams:
            if stream_ is not None:
                stream_.close()
        process.wait()


def kinds_in(report: bytes) -> set[bytes]:
    """Return the kinds of streams that ffmpeg found in a file: ``b"Video"`` and ``b"Audio"``."""
    return set(_STREAM.findall(report))


def was_ended(status: int) -> bool:
    """Return whether the system ended a process because of a limit or a crash."""
    return status < 0 or status >= _WINDOWS_CRASH


def refusal(report: bytes, path: str, status: int) -> FileError:
    """Return the error for a file that ffmpeg could not read, from its report and exit status."""
    lines = report.decode(errors="replace").splitlines()
    if status in _OVER or any(reason in line for line in lines for reason in _NO_MEMORY):
        return FileError("video.too_costly", file=path)
    if was_ended(status):
        return FileError("video.reader_ended", file=path, status=status)
    reasons = [line for line in lines if not line.startswith(_GENERAL)] or [f"ffmpeg: {status}"]
    detail = _PREFIX.sub("", reasons[-1]).replace(f"file:{path}", "").strip(" :.")
    return FileError("video.not_readable", file=path, detail=detail[-_DETAIL:])
