"""Parts of this program as processes of their own, and what they send each other: bytes, with their length first."""

from __future__ import annotations

import contextlib
import os
import signal
import struct
import subprocess
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO, Any, Final, NoReturn, Protocol

_LENGTH: Final = struct.Struct("<I")
_ENDING: Final = (signal.SIGINT, signal.SIGTERM)


class Child(Protocol):
    """A process that this one has started.

    Attributes
    ----------
    to, back : binary stream
        What it reads, and what it answers.
    """

    to: IO[bytes]
    back: IO[bytes]

    def end(self) -> None:
        """End the process, whatever it does."""


class StartedChild:
    """One of our modules, run as a program.

    Parameters
    ----------
    module : str
        It works for what comes to its input.

    Raises
    ------
    OSError
        No process can be started.
    """

    def __init__(self, module: str) -> None:
        self._process = subprocess.Popen(stdin=subprocess.PIPE, stdout=subprocess.PIPE, **own_process(module))
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self.to: IO[bytes] = self._process.stdin
        self.back: IO[bytes] = self._process.stdout

    def end(self) -> None:
        """End the process, whatever it does."""
        self._process.kill()
        self._process.wait()
        _close(self.to, self.back)


class ForkedChild:
    """A copy of this process, with all that it has loaded and made; only where `can_fork`.

    Parameters
    ----------
    work : callable
        What the copy does with its input and its output; then it ends.
    others : sequence of Child
        Started before: the copy lets go of what they read, so that they still see when this process ends.

    Raises
    ------
    OSError
        No process can be started.
    """

    def __init__(self, work: Callable[[IO[bytes], IO[bytes]], None], others: Sequence[Child]) -> None:
        ends = [*os.pipe(), *os.pipe()]
        there, to, back, here = (os.fdopen(end, mode) for end, mode in zip(ends, ("rb", "wb", "rb", "wb"), strict=True))
        self.to: IO[bytes] = to
        self.back: IO[bytes] = back
        before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
        try:
            # What a signal raises within a fork is lost.
            signal.pthread_sigmask(signal.SIG_BLOCK, _ENDING)
            self._id = os.fork()
            if not self._id:
                _close(to, back, *(stream for other in others for stream in (other.to, other.back)))
                _in_copy(lambda: work(there, here))
        except OSError:
            _close(there, to, back, here)
            raise
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        _close(there, here)

    def end(self) -> None:
        """End the process, whatever it does."""
        os.kill(self._id, signal.SIGKILL)
        os.waitpid(self._id, 0)
        _close(self.to, self.back)


def _in_copy(work: Callable[[], None]) -> NoReturn:
    """Do the work of a copied process, and end it without what this process does at its own end."""
    status = 1
    try:
        os.setpgid(0, 0)
        for number in _ENDING:
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _ENDING)
        work()
        status = 0
    finally:
        if status:
            traceback.print_exc()
        os._exit(status)


def _close(*streams: IO[bytes]) -> None:
    for stream in streams:
        with contextlib.suppress(OSError):
            stream.close()


def can_fork() -> bool:
    """Whether a copy of this process can work: only on Linux, and where no other thread runs. It might hold a lock, for
    which the copy would wait for ever."""
    return sys.platform == "linux" and len(list(Path("/proc/self/task").iterdir())) == 1


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
