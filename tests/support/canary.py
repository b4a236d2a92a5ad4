"""Files that must not be opened, and texts that would make Qt open them if they were interpreted as HTML."""

from __future__ import annotations

import ctypes
import os
import re
import struct
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from PySide6.QtGui import QColor, QImage

_IN_OPEN = 0x00000020
"""Event mask of ``inotify(7)`` for opening a file in the folder."""
_EVENT = struct.Struct("iIII")
_MOST_BYTES = 65_536

WATCHES = sys.platform == "linux"
"""True if the system reports which files any process opens."""


class Canary:
    """A folder with a picture and a style sheet, and a record of the files opened in it.

    Parameters
    ----------
    folder : Path
        Made for this alone.
    """

    def __init__(self, folder: Path, descriptor: int) -> None:
        self.folder = folder
        self._descriptor = descriptor
        self.picture, self.sheet = folder / "c.png", folder / "c.css"
        image = QImage(4, 4, QImage.Format.Format_RGB32)
        image.fill(QColor("#ff00ff"))
        image.save(str(self.picture))
        self.sheet.write_text("p { color: #ff00ff }", encoding="utf-8")

    @property
    def html(self) -> str:
        """Text that opens the picture when laid out as HTML."""
        return f'<img src="file://{self.picture}">'

    def name(self, field: str) -> str:
        """Name with a label of its place that would open the picture as HTML, and that contains ``&8``, a shortcut on
        buttons, and ``[*]``, a placeholder in window titles.
        """
        # A folder may be named as an instrument is ("tmp": timpani); in an address, its first letter may be a code.
        address = re.sub(r"/(\w)", lambda found: f"/%{ord(found[1]):02x}", self.picture.as_posix())
        return f'<img alt="{field}" src="file://{address}">&8[*]'

    def file_name(self, field: str) -> str:
        """File name that would open the picture as HTML if the picture is in the working directory."""
        return f'<img alt="{field}" src="{self.picture.name}">&8[*]'

    @property
    def eager(self) -> str:
        """Text that opens the style sheet as soon as it is parsed as HTML, as for a screen reader."""
        return f'<html><head><link rel="stylesheet" type="text/css" href="file://{self.sheet}"></head><p>x</p></html>'

    def opened(self) -> list[str]:
        """Names of the files that were opened since the last call."""
        names: list[str] = []
        try:
            events = os.read(self._descriptor, _MOST_BYTES)
        except BlockingIOError:
            return names
        place = 0
        while place < len(events):
            *_, length = _EVENT.unpack_from(events, place)
            place += _EVENT.size + length
            # An empty name means the folder itself.
            if length:
                names.append(events[place - length : place].rstrip(b"\0").decode())
        return names


@contextmanager
def canary(folder: Path) -> Iterator[Canary]:
    """Monitor a new folder by inotify."""
    folder.mkdir()
    system = ctypes.CDLL(None, use_errno=True)
    descriptor = system.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
    if descriptor < 0:
        raise OSError(ctypes.get_errno(), "inotify_init1")
    try:
        result = Canary(folder, descriptor)
        if system.inotify_add_watch(descriptor, os.fsencode(folder), _IN_OPEN) < 0:
            raise OSError(ctypes.get_errno(), "inotify_add_watch")
        yield result
    finally:
        os.close(descriptor)
