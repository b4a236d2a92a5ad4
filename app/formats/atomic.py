"""Atomic writing of files: a file appears complete or not at all."""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
import stat
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final

from app.formats.files import cannot_write
from app.formats.locks import is_locked, is_same_file, lock

_PARTIAL: Final = re.compile(r"\.[0-9a-f]{16}\.partial")
_swept: set[Path] = set()
"""Folders into which this process has written."""
_FRESH_S: Final = 60.0
"""Age in seconds below which a temporary file is not swept: on Windows a file cannot be renamed while open, so that it
belongs to no process for a moment.
"""


@contextlib.contextmanager
def atomic_write(
    path: str | os.PathLike[str], backup: Path | None = None, follow_link: bool = True, durable: bool = True
) -> Iterator[BinaryIO]:
    """Open a file for writing; it gets its name only once it is complete and synced to disk.

    The bytes go to a temporary file in the same folder; on leaving the block it is flushed, synced and renamed to
    `path`. If the block raises, also KeyboardInterrupt, the temporary file is deleted and `path` is unchanged. Files
    left by killed processes are deleted by `sweep`; running processes keep theirs locked.

    Parameters
    ----------
    path : str or path-like
        The folder must exist.
    backup : path, optional
        The previous content of `path` is kept under this name in the same folder; at every moment one of the two files
        is complete.
    follow_link : bool
        Whether a symbolic link is kept and its target replaced, as for files named by the user. Otherwise the link
        itself is replaced, for files whose names only this program chooses.
    durable : bool
        Whether the file is synced to the disk before it gets its name, which takes some hundredths of a second. A cache
        that is checked when it is read needs none of it.

    Yields
    ------
    binary file
        The temporary file, open for writing.

    Raises
    ------
    FileError
        The system refuses: the folder is missing, there is no permission, or the disk is full.
    """
    try:
        target = Path(os.path.realpath(path)) if follow_link else Path(path)
        if target.parent not in _swept:
            _swept.add(target.parent)
            sweep(target.parent)
        partial, stream = _new_partial(target.parent)
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise cannot_write(path, error) from error
    try:
        with stream:
            yield stream
            stream.flush()
            if durable:
                os.fsync(stream.fileno())
            if backup is not None and os.path.exists(target):
                shutil.copymode(target, partial)
                _keep(target, backup)
            _rename(stream, partial, target)
        if durable:
            _sync_folder(target.parent)
    except OSError as error:
        raise cannot_write(path, error) from error
    finally:
        partial.unlink(missing_ok=True)


def sweep(folder: Path) -> None:
    """Delete temporary files of processes that were killed while writing into a folder."""
    try:
        found = [path for path in folder.iterdir() if _PARTIAL.fullmatch(path.name)]
    except OSError:
        # The folder cannot be listed, so nothing is cleaned up.
        return
    for path in found:
        with contextlib.suppress(OSError):
            if not stat.S_ISREG(path.lstat().st_mode):
                continue  # not one of our files: a link, pipe or device is not even opened
            fresh = sys.platform == "win32" and time.time() - path.stat().st_mtime < _FRESH_S
            if not fresh and not is_locked(path):
                path.unlink()


def _new_partial(folder: Path) -> tuple[Path, BinaryIO]:
    """Create a new temporary file, locked if the file system supports locks."""
    while True:
        partial = folder / f".{secrets.token_hex(8)}.partial"
        # "x" never overwrites another program's file; the mode follows the umask, as for any new file.
        stream = partial.open("xb")
        try:
            # Another process that cleans up may have removed it before it was locked.
            if lock(stream) and is_same_file(partial, stream):
                return partial, stream
        except OSError:
            return partial, stream
        stream.close()
        partial.unlink(missing_ok=True)


def _rename(stream: BinaryIO, partial: Path, target: Path) -> None:
    """Rename a written file to its final name; it stays locked until it is renamed."""
    if sys.platform == "win32":
        stream.close()
    partial.replace(target)


def _keep(file: Path, backup: Path) -> None:
    """Give a file a second name as a hard link, or copy it where hard links are not supported."""
    partial = file.parent / f".{secrets.token_hex(8)}.partial"
    try:
        with file.open("rb") as content:
            if sys.platform != "win32":
                # The second name of the locked file must not be cleaned up either.
                with contextlib.suppress(OSError):
                    lock(content)
            try:
                os.link(file, partial)
            except OSError:
                _copy(content, file, backup)
                return
            if sys.platform != "win32":
                partial.replace(backup)
        if sys.platform == "win32":
            partial.replace(backup)
    finally:
        partial.unlink(missing_ok=True)


def _copy(content: BinaryIO, file: Path, backup: Path) -> None:
    partial, stream = _new_partial(file.parent)
    try:
        with stream:
            shutil.copyfileobj(content, stream)
            stream.flush()
            shutil.copystat(file, partial)
            _rename(stream, partial, backup)
    finally:
        partial.unlink(missing_ok=True)


def _sync_folder(folder: Path) -> None:
    """Sync a folder, so that a new name is on the disk too, where the system supports it."""
    if os.name != "posix":
        return
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
