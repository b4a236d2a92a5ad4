"""Parts of this program as processes of their own, and what they send each other: bytes, with their length first."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
from typing import IO, Any, Final

_LENGTH: Final = struct.Struct("<I")


def own_process(module: str, *arguments: str) -> dict[str, Any]:
    """What `subprocess` needs to run one of our modules: the command, its environment and its process group.

    The child finds the packages that this process finds, wherever it is started, and none that happen to lie in the
    folder where it is: what the user has downloaded is not run. Ctrl-C in the terminal is not sent to it: this process
    ends it.
    """
    options: dict[str, Any] = {
        "args": [sys.executable, "-P", "-m", module, *arguments],
        "env": {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    }
    if sys.platform == "win32":
        options["creationflags"] = subprocess.CREATE_NO_WINDOW | subprocess.CREATE_NEW_PROCESS_GROUP
    else:
        options["process_group"] = 0
    return options


def core_count() -> int:
    """Processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def send(stream: IO[bytes], data: bytes) -> None:
    """Write data with its length."""
    stream.write(_LENGTH.pack(len(data)))
    stream.write(data)
    stream.flush()


def receive(stream: IO[bytes]) -> bytes:
    """Read what was sent. Raises BrokenPipeError where the other side has ended."""
    (length,) = _LENGTH.unpack(_exactly(stream, _LENGTH.size))
    return _exactly(stream, length)


def _exactly(stream: IO[bytes], count: int) -> bytes:
    data = stream.read(count)
    if len(data) < count:
        raise BrokenPipeError("the other side has ended")
    return data
