"""File locks that the system releases when their process ends."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, Final
from weakref import WeakSet

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

_BYTE: Final = 2**30
"""Offset of the byte that is locked on Windows, far behind the content, which stays readable."""
_held: Final = WeakSet[IO[Any]]()


def lock(stream: IO[Any]) -> bool:
    """Lock a file while it is open; return False if another process has locked it. Raises OSError if locks are not
    supported.
    """
    try:
        if sys.platform == "win32":
            place = stream.tell()
            stream.seek(_BYTE)
            try:
                msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)
            finally:
                stream.seek(place)
        else:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _held.add(stream)
    except OSError as error:
        if error.errno in (errno.EACCES, errno.EAGAIN, errno.EDEADLK):
            return False
        raise
    return True


def _let_go() -> None:
    """Drop the locks in a forked copy of this process, which must not hold them."""
    held = [stream for stream in _held if not stream.closed]
    if held:
        nothing = os.open(os.devnull, os.O_RDWR)
        for stream in held:
            os.dup2(nothing, stream.fileno(), inheritable=False)
        os.close(nothing)


if sys.platform != "win32":
    os.register_at_fork(after_in_child=_let_go)


@contextlib.contextmanager
def locked_here(path: Path) -> Iterator[bool]:
    """Lock an existing file during the block; yield False if another process has locked it. Raises OSError."""
    with path.open("r+b") as stream:
        yield lock(stream)


def is_locked(path: Path) -> bool:
    """Return whether a running process has locked a file, or may have."""
    try:
        with locked_here(path) as is_ours:
            return not is_ours
    except FileNotFoundError:
        return False
    except OSError:
        # The file belongs to another user and is left alone.
        return True


def is_same_file(path: Path, stream: IO[Any]) -> bool:
    """Return whether an open file is still the one at a path."""
    try:
        return os.path.samestat(path.stat(), os.fstat(stream.fileno()))
    except OSError:
        return False
