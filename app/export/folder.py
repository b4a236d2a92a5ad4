"""Atomic writing of a set of files into a folder."""

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
    """Yield a temporary folder whose files move to ``folder`` at the end of the block.

    If the block raises, including KeyboardInterrupt, nothing is changed, and folders created for it are removed.

    Parameters
    ----------
    folder : path
        Created if it does not exist. Files of the same names are replaced, others are kept.

    Yields
    ------
    path
        An empty folder.

    Raises
    ------
    FileError
        The system refuses; see `app.export.tree.tree_into`.
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
            with contextlib.suppress(OSError):  # another program has written a file there meanwhile
                parent.rmdir()


def _make(folder: Path, made: list[Path]) -> None:
    """Create a folder and its parents; new ones are appended to ``made``."""
    if os.path.isdir(folder):
        return
    if os.path.exists(folder):
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), folder)
    if folder.parent != folder:
        _make(folder.parent, made)
    folder.mkdir()
    made.append(folder)
