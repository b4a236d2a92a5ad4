"""Files that appear whole or not at all.

Messages: ``file.cannot_write`` (file, reason): "{file} cannot be written: {reason}".
"""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from app.errors import FileError


@contextlib.contextmanager
def atomic_write(path: str | os.PathLike[str], backup: Path | None = None) -> Iterator[BinaryIO]:
    """Open a file for writing that takes its name only once it is complete and on the disk.

    The bytes go to a temporary file in the same folder; on leaving the block it is flushed, synced and renamed over
    `path`. If the block raises, also on KeyboardInterrupt, the temporary file is removed and `path` is left as it was.

    Parameters
    ----------
    path : str or path-like
        A symbolic link is followed, so that the link stays a link. The folder must exist.
    backup : path, optional
        What `path` held before is kept under this name, in the same folder; at every moment one of the two is whole.

    Yields
    ------
    binary file

    Raises
    ------
    FileError
        ``file.cannot_write`` if the system refuses (folder missing, no permission, disk full).
    """
    target = Path(os.path.realpath(path))
    partial = target.parent / f".{secrets.token_hex(8)}.partial"
    try:
        # "x": never write into somebody else's file; the mode follows the umask, as for any new file.
        stream = partial.open("xb")
    except OSError as error:
        raise _cannot_write(path, error) from error
    try:
        with stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        if backup is not None and target.exists():
            shutil.copymode(target, partial)
            _keep(target, backup)
        partial.replace(target)
        _sync_folder(target.parent)
    except OSError as error:
        raise _cannot_write(path, error) from error
    finally:
        partial.unlink(missing_ok=True)


def _keep(file: Path, backup: Path) -> None:
    """Give a file a second name, or make a copy where the file system knows only one name for a file."""
    partial = file.parent / f".{secrets.token_hex(8)}.partial"
    try:
        try:
            os.link(file, partial)
        except OSError:
            shutil.copy2(file, partial)
        partial.replace(backup)
    finally:
        partial.unlink(missing_ok=True)


def _sync_folder(folder: Path) -> None:
    """Bring a new name onto the disk too, where the system can."""
    if os.name != "posix":
        return
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _cannot_write(path: str | os.PathLike[str], error: OSError) -> FileError:
    return FileError("file.cannot_write", file=os.fspath(path), reason=error.strerror or str(error))
