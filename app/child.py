"""Child processes and communication with them: typed messages, each preceded by its length.

A child works until its input ends, so that it never outlives its parent. Limits are in `app.child_limits`.
"""

from __future__ import annotations

import contextlib
import os
import shlex
import signal
import struct
import subprocess
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import IO, Any, Final, Generic, NoReturn, TypeVar

import msgspec

from app.child_limits import confine_this_process
from app.errors import StopRequested

_LENGTH: Final = struct.Struct("<I")
_ENDING: Final = (signal.SIGINT, signal.SIGTERM)
_LOOK_S: Final = 0.1
_ENCODER: Final = msgspec.msgpack.Encoder()
T = TypeVar("T")


def typed_python() -> str:
    """Return the Python in which the program runs, as it is typed in a shell: packages that it lacks belong there."""
    return shlex.quote(sys.executable) if os.name == "posix" else f'"{sys.executable}"'


class MessageChannel(Generic[T]):
    """Typed messages to and from another process.

    Parameters
    ----------
    kind : type
        Type of received messages; may be a union of tagged structs.
    incoming, outgoing : binary stream
        Streams from and to the other process.
    """

    def __init__(self, kind: Any, incoming: IO[bytes], outgoing: IO[bytes]) -> None:
        self._decoder: msgspec.msgpack.Decoder[T] = msgspec.msgpack.Decoder(kind)
        self.incoming, self.outgoing = incoming, outgoing

    def send(self, message: object) -> None:
        """Send a message. Raises OSError if the other side has ended."""
        try:
            self.put(message)
            self.outgoing.flush()
        except ValueError as error:
            # Another thread closed the stream to end the process.
            if self.outgoing.closed:
                raise BrokenPipeError from error
            raise

    def put(self, message: object) -> None:
        """Add a message to those sent at the next `send` or flush."""
        data = _ENCODER.encode(message)
        self.outgoing.write(_LENGTH.pack(len(data)))
        self.outgoing.write(data)

    def receive(self) -> T:
        """Wait for a message and return it.

        Raises
        ------
        BrokenPipeError
            The other side has ended.
        msgspec.MsgspecError
            The other side sent something else.
        """
        (length,) = _LENGTH.unpack(self._exactly(_LENGTH.size))
        return self._decoder.decode(self._exactly(length))

    def hang_up(self) -> None:
        """Close the stream to the other process, which ends its input."""
        # Closing fails if the child was killed before it read everything; the stream is closed all the same.
        _close(self.outgoing)

    def _exactly(self, count: int) -> bytes:
        data = self.incoming.read(count)
        if len(data) < count:
            raise BrokenPipeError("the other side has ended")
        return data


def channel_to_parent(kind: Any, limits: str) -> MessageChannel[Any]:
    """Set this process's limits to a row of `app.child_limits.LIMITS`, and return the channel to its parent.

    Output that libraries print is redirected to standard error, since it would be read as an answer.
    """
    confine_this_process(limits)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # On Windows a program without a console has no standard error.
    elsewhere = os.open(os.devnull, os.O_WRONLY) if sys.stderr is None else sys.stderr.fileno()
    os.dup2(elsewhere, sys.stdout.fileno())
    return MessageChannel(kind, sys.stdin.buffer, answers)


class Child(MessageChannel[T]):
    """A process started by this one, and the channel of messages to it."""

    def end(self) -> None:
        """End the process immediately."""
        raise NotImplementedError


class StartedChild(Child[T]):
    """A module of this program run as a process.

    Parameters
    ----------
    kind : type
        Type of its answers.
    module : str
        Name of the module, which processes messages from its input.
    options
        Options of `subprocess.Popen`, in addition to those of `own_process`.

    Raises
    ------
    OSError
        The process cannot be started.
    """

    def __init__(self, kind: Any, module: str, **options: Any) -> None:
        self.process = subprocess.Popen(
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, **{**own_process(module), **options}
        )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        super().__init__(kind, self.process.stdout, self.process.stdin)

    def end(self) -> None:
        """End the process immediately."""
        self.process.kill()
        self.ended()

    def ended(self, within_s: float | None = None) -> int:
        """Close the process's input, wait and return its exit status; kill it if it does not end within ``within_s``
        seconds.
        """
        self.hang_up()
        try:
            status = self.process.wait(within_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = self.process.wait()
        # A thread that still reads from the child sees the end of the stream before it is closed.
        _close(self.incoming)
        return status


@contextmanager
def ended_on_request(
    process: subprocess.Popen[bytes], stop_requested: StopRequested, end: Callable[[], None]
) -> Iterator[None]:
    """Context manager that calls ``end`` if a stop is requested during the block. The process must end
    after that call.
    """

    def watch() -> None:
        while process.poll() is None:
            if stop_requested():
                end()
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(_LOOK_S)

    watcher = Thread(target=watch, name="child stop", daemon=True)
    watcher.start()
    try:
        yield
    finally:
        watcher.join()


class ForkedChild(Child[T]):
    """A copy of this process with all of its loaded data; only possible if `can_fork`.

    Parameters
    ----------
    kind : type
        Type of its answers.
    work : callable
        Function that the copy runs, with a channel to this process as argument; the copy ends afterwards.
    asked : type
        Type of messages sent to the copy.
    others : sequence of Child
        Children started earlier: the copy closes its inputs from them, so that they notice the end of this process.

    Raises
    ------
    OSError
        The process cannot be started.
    """

    def __init__(
        self, kind: Any, work: Callable[[MessageChannel[Any]], None], others: Sequence[Child[Any]], asked: Any = None
    ) -> None:
        ends = [*os.pipe(), *os.pipe()]
        there, to, back, here = (os.fdopen(end, mode) for end, mode in zip(ends, ("rb", "wb", "rb", "wb"), strict=True))
        super().__init__(kind, back, to)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
        try:
            # An exception raised by a signal handler during the fork would be lost.
            signal.pthread_sigmask(signal.SIG_BLOCK, _ENDING)
            self._id = os.fork()
            if not self._id:
                _close(to, back, *(stream for other in others for stream in (other.outgoing, other.incoming)))
                _in_copy(lambda: work(MessageChannel(asked, there, here)))
        except OSError:
            _close(there, to, back, here)
            raise
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        _close(there, here)

    def end(self) -> None:
        """End the process immediately."""
        os.kill(self._id, signal.SIGKILL)
        os.waitpid(self._id, 0)
        _close(self.outgoing, self.incoming)


def _in_copy(work: Callable[[], None]) -> NoReturn:
    """Run a function in a copied process, and end that process without the exit handlers of this one."""
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
    """Return whether this process can be copied: only on Linux and with a single thread, since another thread might
    hold a lock that would block the copy forever.
    """
    return sys.platform == "linux" and len(list(Path("/proc/self/task").iterdir())) == 1


def own_process(module: str, *arguments: str) -> dict[str, Any]:
    """Arguments for `subprocess` that run a module of this program: command, environment and process group.

    The child finds the same packages as this process and does not import from the current folder, which may contain
    downloaded files. Ctrl-C in the terminal is not sent to it; this process ends it.
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
    """Return the number of processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
