"""A set of files that appears in a folder whole or not at all.

Messages: ``file.cannot_write`` (file, reason), as in `app.formats.atomic`.
"""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

from app.errors import FileError


@contextlib.contextmanager
def files_into(folder: Path) -> Iterator[Path]:
    """A folder to write into, whose files move to ``folder`` when the block is done.

    They are written beside their place, on the same disk, and take their names one after the other without anything
    left to compute. If the block raises, KeyboardInterrupt included, nothing has changed: folders made for it are
    taken away again.

    Parameters
    ----------
    folder : path
        Made if it is not there. Files of the same names are replaced, others are left alone.

    Yields
    ------
    path
        An empty folder; only files may be put into it.

    Raises
    ------
    FileError
        ``file.cannot_write`` if the system refuses.
    """
    made: list[Path] = []
    partial = folder / f".{secrets.token_hex(8)}.partial"
    try:
        try:
            _make(folder, made)
            partial.mkdir()
        except OSError as error:
            raise _cannot_write(folder, error) from error
        yield partial
        try:
            _move(partial, folder)
        except OSError as error:
            raise _cannot_write(folder, error) from error
        made.clear()
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        for parent in reversed(made):
            with contextlib.suppress(OSError):  # somebody else has put a file there meanwhile
                parent.rmdir()


def _make(folder: Path, made: list[Path]) -> None:
    """Make a folder and those above it; ``made`` gets the new ones."""
    if folder.is_dir():
        return
    if folder.exists():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), folder)
    if folder.parent != folder:
        _make(folder.parent, made)
    folder.mkdir()
    made.append(folder)


def _move(source: Path, folder: Path) -> None:
    """Give every file its name. What would be refused is found before the first one moves."""
    names = sorted(path.name for path in source.iterdir())
    for name in names:
        if (folder / name).is_dir():
            raise IsADirectoryError(f"{name} is a folder")
    while names:
        try:
            (source / names[0]).replace(folder / names[0])
            names.pop(0)
        except KeyboardInterrupt:
            # Too late to stop: a set of files half old and half new would be worse. What has moved is not there
            # any more, whether or not its name was struck off.
            names = [name for name in names if (source / name).exists()]


def _cannot_write(path: Path, error: OSError) -> FileError:
    return FileError("file.cannot_write", file=os.fspath(path), reason=error.strerror or str(error))
