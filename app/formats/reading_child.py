"""Running of C libraries that read files in separate processes.

A crash on a damaged file becomes an exit status; time and memory are limited by a row of `app.child_limits.LIMITS`.
"""

from __future__ import annotations

import signal
import subprocess
from typing import Final

from app.child import own_process
from app.child_limits import LIMITS, confine
from app.errors import FileError

UNREADABLE, NO_MEMORY, NO_READER = 3, 4, 5
"""Exit statuses of a child process: the bytes cannot be read, they need too much memory, or the library is not
installed.
"""
_LIMITS: Final = frozenset(-number for name in ("SIGXCPU", "SIGKILL") if (number := getattr(signal, name, 0)))
"""Exit statuses of a child process that the system ended at a limit of time or memory."""


def read_by_child(module: str, limits: str, data: bytes, file: str, *arguments: str) -> tuple[int, bytes]:
    """Run a module of this program as a process with bytes as its input, and return its output.

    Parameters
    ----------
    limits : str
        Row of `app.child_limits.LIMITS`, which the module also applies to itself.
    file : str
        File name for messages.

    Returns
    -------
    int
        Exit status: 0, or one of the constants of this module; `NO_MEMORY` also if the child exceeded a limit.
    bytes
        Output of the process.

    Raises
    ------
    FileError
        The process cannot be started.
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
