"""Temporary folders that are deleted at the next start if their process was killed.

Each contains a locked file while its process runs; the system releases the lock at the end of the process.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final

from app.errors import FileError
from app.formats.cache import cache_folder
from app.formats.locks import is_same_file, lock, locked_here

_NAME: Final = re.compile(r"[0-9a-f]{16}")
_LOCK: Final = "lock"


def scratch_places() -> tuple[Path, ...]:
    """Return the parent folders for temporary folders; the second one is used if the first cannot be written."""
    user = os.getuid() if os.name == "posix" else ""
    return cache_folder("scratch"), Path(tempfile.gettempdir()) / f"suisou-{user}"


@contextlib.contextmanager
def scratch_folder() -> Iterator[Path]:
    """Create a folder that is deleted at the end of the block.

    Raises
    ------
    FileError
        No folder can be created.
    """
    folder, stream = _new_folder()
    try:
        yield folder
    finally:
        # Windows does not remove an open file.
        stream.close()
        shutil.rmtree(folder, ignore_errors=True)


def abandoned_folders() -> Iterator[Path]:
    """Yield the folders of killed processes. Each is deleted when the next one is requested; until then no other
    process uses it.
    """
    for place in scratch_places():
        try:
            found = [path for path in place.iterdir() if _NAME.fullmatch(path.name)] if _is_ours(place) else []
        except OSError:
            # No such folder exists yet.
            continue
        for folder in found:
            try:
                with locked_here(folder / _LOCK) as is_abandoned:
                    if is_abandoned:
                        yield folder
            except FileNotFoundError:
                # The process was killed between creating the folder and its lock.
                with contextlib.suppress(OSError):
                    folder.rmdir()
            except OSError:
                # Without locks its owner is unknown, so it is left alone.
                continue
            else:
                if is_abandoned:
                    shutil.rmtree(folder, ignore_errors=True)


def _is_ours(place: Path) -> bool:
    """Return whether a folder belongs to the current user, since other users may have created it in a shared folder."""
    found = place.stat(follow_symlinks=os.name != "posix")
    return os.name != "posix" or found.st_uid == os.getuid()


def _new_folder() -> tuple[Path, BinaryIO]:
    places, refusals = scratch_places(), []
    for place in places:
        try:
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
            if _is_ours(place):
                return _new_folder_in(place)
        except OSError as error:
            refusals.append(error.strerror or str(error))
    raise FileError("file.cannot_write", file=os.fspath(places[0]), reason=refusals[0])


def _new_folder_in(place: Path) -> tuple[Path, BinaryIO]:
    while True:
        folder = place / secrets.token_hex(8)
        folder.mkdir(mode=0o700)
        try:
            stream = (folder / _LOCK).open("xb")
        except FileNotFoundError:
            # Another process considered it abandoned and removed it.
            continue
        try:
            if lock(stream) and is_same_file(folder / _LOCK, stream):
                return folder, stream
        except OSError:
            # Without locks no process considers it abandoned.
            return folder, stream
        stream.close()
