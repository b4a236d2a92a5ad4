"""Reading of files by libraries in C, each in a process of its own.

What a damaged file does to a library is a status here and no crash of this process; what it may cost says a row of
`app.child_limits.LIMITS`.
"""

from __future__ import annotations

import signal
import subprocess
from typing import Final

from app.child import own_process
from app.child_limits import LIMITS, confine
from app.errors import FileError

UNREADABLE, NO_MEMORY, NO_READER = 3, 4, 5
"""Statuses of a child: the bytes cannot be read, they ask for too much, the library is not installed."""
_LIMITS: Final = frozenset(-number for name in ("SIGXCPU", "SIGKILL") if (number := getattr(signal, name, 0)))
"""The system ended the child: it had taken too long, or all the memory there is."""


def read_by_child(module: str, limits: str, data: bytes, file: str, *arguments: str) -> tuple[int, bytes]:
    """Hand bytes to a module of ours that runs as a process.

    Parameters
    ----------
    limits : str
        Row of `app.child_limits.LIMITS`, which the module sets for itself too.
    file : str
        For messages.

    Returns
    -------
    int
        Status: 0, or one of those above; `NO_MEMORY` too where the child exceeded a limit.
    bytes
        What it printed.

    Raises
    ------
    FileError
        No process can be started.
    """
    try:
        process: subprocess.Popen[bytes]
        with subprocess.Popen(
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            **own_process(module, *arguments),
        ) as process:
            try:
                job = confine(limits, process, len(data))
                printed, _ = process.communicate(data, LIMITS[limits].wall_s)
                del job
            finally:
                process.kill()
    except subprocess.TimeoutExpired:
        return NO_MEMORY, b""
    except OSError as error:
        raise FileError("file.cannot_read", file=file, reason=str(error)) from error
    return NO_MEMORY if process.returncode in _LIMITS else process.returncode, printed
