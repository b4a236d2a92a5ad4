"""Writing of pictures as PNG files: separately, or together on a contact sheet."""

from __future__ import annotations

import contextlib
import math
import os
import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import BinaryIO, Final, Protocol

import numpy as np
import numpy.typing as npt
from PIL import Image

from app.errors import FileError
from app.export.folder import files_into
from app.formats.atomic import atomic_write

Picture = npt.NDArray[np.uint8]
"""Pixels (H, W, 3) or (H, W, 4), top row first; alpha is ignored."""

MOST_SHEET_PX: Final = 16_384
"""Largest side in pixels that common programs and graphics cards support."""
GAP_PX: Final = 4
"""Margin in pixels around each picture of a sheet."""
_FRAME: Final = re.compile(r"frame_\d{5,}\.png")
_COMPRESSION: Final = 3
"""Level of zlib: files 1.5 times as large as the smallest, in a fraction of the time."""


class PictureWriter(Protocol):
    """Writer that receives the pictures of a film or sequence one after the other."""

    def write(self, picture: Picture) -> None:
        """Add a picture behind those already written."""


class FrameWriter:
    """Writes a file for every picture; see `frames_into`."""

    def __init__(self, folder: Path, first: int) -> None:
        self._folder, self._number = folder, first

    def write(self, picture: Picture) -> None:
        """Write the next picture as a numbered PNG file."""
        with (self._folder / frame_name(self._number)).open("wb") as stream:
            _write_png(stream, picture)
        self._number += 1


class SheetWriter:
    """Places pictures side by side on one sheet; see `sheet_into`."""

    def __init__(self, sheet: Picture, columns: int, captions: Sequence[Picture]) -> None:
        self._sheet, self._columns, self._captions = sheet, columns, captions
        self._count = 0

    def write(self, picture: Picture) -> None:
        """Add the next picture with its caption."""
        caption = self._captions[self._count]
        row, column = divmod(self._count, self._columns)
        height, width = picture.shape[:2]
        top = GAP_PX + row * (height + len(caption) + GAP_PX)
        left = GAP_PX + column * (width + GAP_PX)
        self._sheet[top : top + height, left : left + width] = picture[..., :3]
        self._sheet[top + height : top + height + len(caption), left : left + width] = caption[..., :3]
        self._count += 1


def frame_name(number: int) -> str:
    """Return the file name of a frame, numbered from the start of the whole performance."""
    return f"frame_{number:05d}.png"


@contextlib.contextmanager
def frames_into(folder: Path, first: int, count: int) -> Iterator[FrameWriter]:
    """Write a folder of PNG files atomically at the end of the block.

    Parameters
    ----------
    folder : path
        Folder, created if it does not exist. Frames with the same numbers are replaced, other files are kept.
    first, count : int
        Number of the first frame, and number of frames.

    Raises
    ------
    FileError
        The folder has frames of another film, or a file cannot be written; see `app.export.folder.files_into`.
    """
    require_no_other_frames(folder, first, count)
    with files_into(folder) as new:
        try:
            yield FrameWriter(new, first)
        except OSError as error:
            raise FileError("file.cannot_write", file=os.fspath(folder), reason=error.strerror or str(error)) from error


def require_no_other_frames(folder: Path, first: int, count: int) -> None:
    """Raise FileError if frames of another film would remain among the new ones."""
    coming = {frame_name(number) for number in range(first, first + count)}
    try:
        there = {path.name for path in folder.iterdir() if _FRAME.fullmatch(path.name)}
    except OSError:
        return  # nothing is there, or writing reports the error
    if there - coming:
        raise FileError("picture.other_frames", file=os.fspath(folder))


@contextlib.contextmanager
def sheet_into(path: Path, size: tuple[int, int], columns: int, captions: Sequence[Picture]) -> Iterator[SheetWriter]:
    """Write a contact sheet atomically at the end of the block.

    Parameters
    ----------
    path : path
        File to write; an existing one is replaced.
    size : (int, int)
        Width and height of each picture in pixels.
    columns : int
        Number of pictures in a row.
    captions : sequence of Picture
        Captions below the pictures, as images as wide as a picture and of equal height.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    width, height = sheet_size(size, len(captions[0]), columns, len(captions))
    with atomic_write(path) as stream:
        sheet = np.empty((height, width, 3), np.uint8)
        sheet[:] = captions[0][0, 0, :3]
        yield SheetWriter(sheet, columns, captions)
        _write_png(stream, sheet)


def sheet_size(size: tuple[int, int], caption_px: int, columns: int, count: int) -> tuple[int, int]:
    """Return width and height, pixels, of a contact sheet of ``count`` pictures of a size, each with a caption of
    ``caption_px`` below."""
    rows = -(-count // columns)
    return GAP_PX + columns * (size[0] + GAP_PX), GAP_PX + rows * (size[1] + caption_px + GAP_PX)


def usual_columns(count: int, every_s: Fraction) -> int:
    """Return a suitable number of columns: a row for each second if that is 4 to 12 pictures, else about as many
    columns as rows.
    """
    in_a_second = 1 / every_s
    if in_a_second.denominator == 1 and 4 <= in_a_second <= 12:
        return min(int(in_a_second), count)
    return math.ceil(math.sqrt(count))


def _write_png(stream: BinaryIO, picture: Picture) -> None:
    Image.fromarray(np.ascontiguousarray(picture[..., :3])).save(stream, "PNG", compress_level=_COMPRESSION)
