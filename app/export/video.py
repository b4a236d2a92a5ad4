"""Encoding of pictures and sound as an MP4 file (H.264 and AAC) with the ffmpeg bundled with imageio-ffmpeg."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import subprocess
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import IO, Final

import imageio_ffmpeg
import numpy as np
import numpy.typing as npt
import soundfile

from app.arrays import SingleArray
from app.child_limits import limited_command
from app.errors import FileError
from app.export.tree import tree_into
from app.formats.temporary_folders import scratch_folder

SOUND_RATE_HZ = 48_000
QUALITY_CRF = 18
"""Constant rate factor of x264 at which most people see no loss."""
_TOLD = 2000
"""Greatest number of characters of the encoder's error output that are shown."""
_REFUSALS: Final = tuple(
    getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EROFS") if hasattr(errno, name)
)
"""Numbers of the system's reasons for refusing to write a large file."""


class VideoWriter:
    """Receives pictures one after the other; see `video_into`."""

    def __init__(self, pipe: IO[bytes], size: tuple[int, int]) -> None:
        self._pipe, self._size = pipe, size

    def write(self, picture: npt.NDArray[np.uint8]) -> None:
        """Add a picture.

        Parameters
        ----------
        picture : (H, W, 3) or (H, W, 4) uint8
            The picture, top row first; alpha is dropped.

        Raises
        ------
        BrokenPipeError
            The encoder has ended; `video_into` reports the reason.
        """
        width, height = self._size
        if picture.shape[:2] != (height, width):
            raise ValueError(f"a picture of {picture.shape[1]} x {picture.shape[0]} in a film of {width} x {height}")
        self._pipe.write(np.ascontiguousarray(picture[..., :3]).tobytes())


@contextlib.contextmanager
def video_into(
    path: Path,
    size: tuple[int, int],
    fps: Fraction,
    sound: SingleArray | None = None,
    sound_rate: int = SOUND_RATE_HZ,
    crf: int = QUALITY_CRF,
) -> Iterator[VideoWriter]:
    """Write a video atomically at the end of the block.

    Parameters
    ----------
    path : path
        File to write; an existing one is replaced.
    size : (int, int)
        Width and height in pixels; even, as required by H.264 with 4:2:0 colours.
    fps : Fraction
        Frames per second.
    sound : (N, 2) float32, optional
        Samples -1..1 that start with the first picture.
    sound_rate : int
        Samples per second.
    crf : int
        x264's constant rate factor.

    Raises
    ------
    FileError
        The encoder failed, or the file cannot be written; see `app.export.tree.tree_into`.
    """
    if any(length % 2 or length <= 0 for length in size):
        raise ValueError(f"a film's width and height are even: {size}")
    if not os.path.isdir(path.parent):
        raise FileError("file.cannot_write", file=os.fspath(path), reason=os.strerror(errno.ENOENT))
    # In a folder of its own, because other films may be written here at the same time.
    making = path.with_name(f".{hashlib.sha256(os.fsencode(path.name)).hexdigest()[:16]}.making")
    with tree_into(path.parent, making) as change:
        partial = change.new / path.name
        with _encoder(path, lambda wave: _command(partial, size, fps, wave, crf), sound, sound_rate) as encoder:
            yield VideoWriter(encoder, size)


@contextlib.contextmanager
def _encoder(
    path: Path, command: Callable[[Path | None], list[str]], sound: SingleArray | None, sound_rate: int
) -> Iterator[IO[bytes]]:
    """Start an encoder, and yield the stream that takes pictures; when the block ends, the encoder has finished
    successfully.

    Parameters
    ----------
    path : path
        Path for error messages.
    command : callable
        Returns the encoder's command, given the file of the sound or None.
    """
    with contextlib.ExitStack() as stack:
        try:
            folder = stack.enter_context(scratch_folder())
            wave = folder / "sound.wav"
            if sound is not None:
                soundfile.write(wave, sound, sound_rate, subtype="PCM_16")
            complaint = stack.enter_context((folder / "complaint.txt").open("w+b"))
            encoder = subprocess.Popen(
                limited_command("ffmpeg.encode", command(None if sound is None else wave)),
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=complaint,
            )
        except (OSError, RuntimeError, soundfile.SoundFileError) as error:
            raise FileError("video.failed", file=str(path), detail=str(error)) from error
        pipe = encoder.stdin
        assert pipe is not None
        try:
            yield pipe
            pipe.close()
            status = encoder.wait()
        except BrokenPipeError:
            status = encoder.wait() or 1
        except BaseException:
            encoder.kill()
            encoder.wait()
            raise
        finally:
            with contextlib.suppress(OSError):
                pipe.close()
        if status:
            complaint.seek(0)
            raise _failed(path, complaint.read(), status)


def _failed(path: Path, complaint: bytes, status: int) -> FileError:
    """Return the error for an encoder that failed with a complaint and an exit status: the system's reason alone if it
    names one of those for which another place or more space helps.
    """
    detail = complaint.decode(errors="replace").strip()[-_TOLD:]
    for number in _REFUSALS:
        if os.strerror(number) in detail:
            return FileError("file.cannot_write", file=str(path), reason=os.strerror(number))
    return FileError("video.failed", file=str(path), detail=detail or f"status {status}")


def side_by_side(path: Path, left: Path, right: Path, crf: int = QUALITY_CRF) -> None:
    """Combine two videos of equal height and length side by side, with the sound of the left one.

    Raises
    ------
    FileError
        The encoder failed.
    """
    films = ["-i", f"file:{left}", "-i", f"file:{right}"]
    joined = ["-filter_complex", "[0:v][1:v]hstack=inputs=2[v]", "-map", "[v]", "-map", "0:a?", "-c:a", "copy"]
    try:
        done = subprocess.run(
            limited_command("ffmpeg.join", [*_ffmpeg(), *films, *joined, *_coded(crf), *_into(path)]),
            stdin=subprocess.DEVNULL,
            capture_output=True,
        )
    except (OSError, RuntimeError) as error:
        raise FileError("video.failed", file=str(path), detail=str(error)) from error
    if done.returncode:
        raise _failed(path, done.stderr, done.returncode)


def _command(path: Path, size: tuple[int, int], fps: Fraction, wave: Path | None, crf: int) -> list[str]:
    pictures = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-framerate", str(fps), "-i", "-"]
    listened = ["-i", str(wave), "-c:a", "aac", "-b:a", "192k", "-shortest"] if wave is not None else []
    return [*_ffmpeg(), *pictures, *listened, *_coded(crf), *_into(path)]


def _ffmpeg() -> list[str]:
    return [imageio_ffmpeg.get_ffmpeg_exe(), "-hide_banner", "-loglevel", "error", "-y"]


def _coded(crf: int) -> list[str]:
    return ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", str(crf), "-preset", "fast"]


def _into(path: Path) -> list[str]:
    # The index comes first, so that a browser can play the file while loading it.
    return ["-movflags", "+faststart", "-f", "mp4", f"file:{path}"]
