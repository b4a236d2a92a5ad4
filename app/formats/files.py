"""Safe opening of files of any origin: only regular files, only up to a size, and without blocking.

Reading a pipe may block forever and a device may be endless, so the file's type is checked after opening.
"""

from __future__ import annotations

import os
import stat
from io import BufferedReader
from pathlib import Path
from typing import Final

from app.errors import FileError
from app.formats.other_computers import refuse_others

_FLAGS: Final = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY"))
"""Flags for opening a file that avoid waiting for a pipe's writer and attaching a terminal to the process."""


def open_file(path: str | os.PathLike[str]) -> BufferedReader:
    """Open a regular file for reading.

    Raises
    ------
    FileError
        The file cannot be read; is a folder, a pipe or a device; or is on another computer that the user has not agreed
        to access.
    """
    refuse_others(path)
    try:
        if stat.S_ISREG(Path(path).stat().st_mode):
            stream = open(os.open(path, _FLAGS), "rb")  # noqa: PTH123, SIM115 - a descriptor; the caller closes it
            if stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
                return stream
            stream.close()  # it was replaced in between
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise cannot_read(path, error) from error
    raise FileError("file.not_regular", file=os.fspath(path))


def read_file(path: str | os.PathLike[str], most_bytes: int) -> bytes:
    """Read a regular file.

    Parameters
    ----------
    most_bytes : int
        Larger files are refused before reading.

    Raises
    ------
    FileError
        See `open_file`; or the file is too large.
    """
    with open_file(path) as stream:
        try:
            size = os.fstat(stream.fileno()).st_size
            content = b"" if size > most_bytes else stream.read(size + 1)
            if len(content) > size:  # the file grows while it is read, or is a system file without a size
                content += stream.read(most_bytes + 1 - len(content)) or b""
                size = len(content)
        except OSError as error:
            raise cannot_read(path, error) from error
    if size > most_bytes:
        raise FileError("file.too_large", file=os.fspath(path), size_mb=_mb(size), most_mb=_mb(most_bytes))
    return content


def files_in(folder: Path, *suffixes: str) -> list[Path]:
    """Return the files in a folder with one of some suffixes (ignoring case), sorted by name; empty if the folder does
    not exist.

    Raises FileError if an existing folder cannot be listed.
    """
    try:
        return sorted(path for path in folder.iterdir() if path.suffix.lower() in suffixes)
    except FileNotFoundError:
        return []
    except (OSError, ValueError) as error:
        raise cannot_read(folder, error) from error


def cannot_read(path: str | os.PathLike[str], error: OSError | ValueError) -> FileError:
    """Return the error for a file that cannot be read."""
    reason = error.strerror if isinstance(error, OSError) else None
    return FileError("file.cannot_read", file=os.fspath(path), reason=reason or str(error))


def cannot_write(path: str | os.PathLike[str], error: OSError | ValueError) -> FileError:
    """Return the error for a file that cannot be written."""
    reason = error.strerror if isinstance(error, OSError) else None
    return FileError("file.cannot_write", file=os.fspath(path), reason=reason or str(error))


def _mb(size: int) -> float:
    return round(size / 2**20, 1)
