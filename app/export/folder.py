"""A set of files that appears in a folder whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterator
from pathlib import Path

from app.export.tree import tree_into
from app.formats.files import cannot_write


@contextlib.contextmanager
def files_into(folder: Path) -> Iterator[Path]:
    """A folder to write into, whose files move to ``folder`` when the block is done.

    If the block raises, KeyboardInterrupt included, nothing has changed: folders made for it are taken away again.

    Parameters
    ----------
    folder : path
        Made if it is not there. Files of the same names are replaced, others are left alone.

    Yields
    ------
    path
        An empty folder.

    Raises
    ------
    FileError
        ``file.cannot_write`` if the system refuses; see `app.export.tree.tree_into`.
    """
    made: list[Path] = []
    try:
        try:
            _make(folder, made)
        except OSError as error:
            raise cannot_write(folder, error) from error
        with tree_into(folder, folder) as change:
            yield change.new
        made.clear()
    finally:
        for parent in reversed(made):
            with contextlib.suppress(OSError):  # another program has put a file there meanwhile
                parent.rmdir()


def _make(folder: Path, made: list[Path]) -> None:
    """Make a folder and those above it; ``made`` gets the new ones."""
    if os.path.isdir(folder):
        return
    if os.path.exists(folder):
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), folder)
    if folder.parent != folder:
        _make(folder.parent, made)
    folder.mkdir()
    made.append(folder)
