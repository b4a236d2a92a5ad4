"""Processes that this one starts, and what they send each other: typed messages, each after its length.

A child works until its input ends, so that it never outlives who started it. What limits it is in `app.child_limits`.
"""

from __future__ import annotations

import contextlib
import os
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


class MessageChannel(Generic[T]):
    """Typed messages to another process and back.

    Parameters
    ----------
    kind : type
        Of what is received; may be a union of tagged structs.
    incoming, outgoing : binary stream
    """

    def __init__(self, kind: Any, incoming: IO[bytes], outgoing: IO[bytes]) -> None:
        self._decoder: msgspec.msgpack.Decoder[T] = msgspec.msgpack.Decoder(kind)
        self.incoming, self.outgoing = incoming, outgoing

    def send(self, message: object) -> None:
        """Send a message. Raises OSError where the other side has ended."""
        self.put(message)
        self.outgoing.flush()

    def put(self, message: object) -> None:
        """Send a message with those that follow, at the next `send` or flush."""
        data = _ENCODER.encode(message)
        self.outgoing.write(_LENGTH.pack(len(data)))
        self.outgoing.write(data)

    def receive(self) -> T:
        """Wait for a message.

        Raises
        ------
        BrokenPipeError
            The other side has ended.
        msgspec.MsgspecError
            It sent something else.
        """
        (length,) = _LENGTH.unpack(self._exactly(_LENGTH.size))
        return self._decoder.decode(self._exactly(length))

    def hang_up(self) -> None:
        """End the input of the other side."""
        # It may have been killed with something unsaid; the stream is closed all the same.
        _close(self.outgoing)

    def _exactly(self, count: int) -> bytes:
        data = self.incoming.read(count)
        if len(data) < count:
            raise BrokenPipeError("the other side has ended")
        return data


def channel_to_parent(kind: Any, limits: str) -> MessageChannel[Any]:
    """Confine this process by a row of `app.child_limits.LIMITS`, and reach the one that started it.

    What libraries print goes to standard error: it would be taken for an answer.
    """
    confine_this_process(limits)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # On Windows a program without a console has no standard error.
    elsewhere = os.open(os.devnull, os.O_WRONLY) if sys.stderr is None else sys.stderr.fileno()
    os.dup2(elsewhere, sys.stdout.fileno())
    return MessageChannel(kind, sys.stdin.buffer, answers)


class Child(MessageChannel[T]):
    """A process that this one has started."""

    def end(self) -> None:
        """End the process, even in the middle of its work."""
        raise NotImplementedError


class StartedChild(Child[T]):
    """One of our modules, run as a program.

    Parameters
    ----------
    kind : type
        Of its answers.
    module : str
        It works for what comes to its input.
    options
        Of `subprocess.Popen`, above those of `own_process`.

    Raises
    ------
    OSError
        No process can be started.
    """

    def __init__(self, kind: Any, module: str, **options: Any) -> None:
        self.process = subprocess.Popen(
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, **{**own_process(module), **options}
        )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        super().__init__(kind, self.process.stdout, self.process.stdin)

    def end(self) -> None:
        """End the process, even in the middle of its work."""
        self.process.kill()
        self.ended()

    def ended(self, within_s: float | None = None) -> int:
        """The status of the process, whose input ends now; it is killed if it works on for longer."""
        self.hang_up()
        try:
            status = self.process.wait(within_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = self.process.wait()
        # Who still reads from it, in a thread, is reported first that nothing comes.
        _close(self.incoming)
        return status


@contextmanager
def ended_on_request(
    process: subprocess.Popen[bytes], stop_requested: StopRequested, end: Callable[[], None]
) -> Iterator[None]:
    """Call ``end`` once that is requested during the block, after which the process must have ended."""

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
    """A copy of this process, with all that it has loaded and made; only where `can_fork`.

    Parameters
    ----------
    kind : type
        Of its answers.
    work : callable
        What the copy does with a channel of this process's messages; then it ends.
    asked : type
        Of these messages.
    others : sequence of Child
        Started before: the copy lets go of what they read, so that they still see when this process ends.

    Raises
    ------
    OSError
        No process can be started.
    """

    def __init__(
        self, kind: Any, work: Callable[[MessageChannel[Any]], None], others: Sequence[Child[Any]], asked: Any = None
    ) -> None:
        ends = [*os.pipe(), *os.pipe()]
        there, to, back, here = (os.fdopen(end, mode) for end, mode in zip(ends, ("rb", "wb", "rb", "wb"), strict=True))
        super().__init__(kind, back, to)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, ())
        try:
            # What a signal raises within a fork is lost.
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
        """End the process, even in the middle of its work."""
        os.kill(self._id, signal.SIGKILL)
        os.waitpid(self._id, 0)
        _close(self.outgoing, self.incoming)


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
    """Return whether a copy of this process can work: only on Linux, and where no other thread runs. It might hold a
    lock, for which the copy would wait for ever."""
    return sys.platform == "linux" and len(list(Path("/proc/self/task").iterdir())) == 1


def own_process(module: str, *arguments: str) -> dict[str, Any]:
    """Arguments of `subprocess` for one of our modules: the command, its environment and its process group.

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
