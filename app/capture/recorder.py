"""The recorder: a separate process that listens to one MIDI port, time-stamps messages and writes the journal.

It is independent of the window's redrawing and of the editor's end. The process runs this module: commands are read
from its input, news are written to its output (`app.capture.protocol`), and it finishes the journal and ends when its
input ends.

Threads: the driver's thread calls `_receive`, which only stamps and queues messages; further threads send news, write
the journal and read commands. The main thread opens the port and lists the ports twice a second.

A recorder opens a single port. To listen to another, the editor starts another recorder, since a port that sends events
cannot be closed (`app.capture.midi_library.OpenInput`). The same is done if the MIDI system ends.
"""

from __future__ import annotations

import contextlib
import gc
import os
import sys
import threading
import time
import traceback
from collections.abc import Callable
from functools import partial
from itertools import groupby
from pathlib import Path
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import IO, Any, Final

from app.capture.journal import is_whole
from app.capture.journal_keeper import JournalKeeper
from app.capture.midi_library import OpenInput
from app.capture.port_names import Port
from app.capture.ports import MidiSystem, PortError
from app.capture.protocol import (
    Back,
    Command,
    Events,
    Leave,
    Lost,
    News,
    NewsQueue,
    Open,
    Opened,
    Opening,
    Ports,
    RequestRefused,
    StartRecording,
    SystemEnded,
)
from app.child import MessageChannel
from app.child_limits import confine_this_process
from app.errors import Message

SYSTEM_VARIABLE: Final = "SUISOU_MIDI_API"
"""Environment variable with the only MIDI system to try, by rtmidi's name."""
_LOOK_S: Final = 0.5
_NO_SYSTEM_LOOK_S: Final = 2.0
_SENT_WITHIN_S: Final = 1.0
_SWITCH_S: Final = 0.0005
"""Longest time in seconds for which a Python thread may delay the driver's thread."""
_PRIORITY: Final = -10
"""Unix priority without real-time scheduling: lower runs first."""


class RecorderProcess:
    """Main loop of the recorder's process: executes commands and monitors the port.

    Parameters
    ----------
    news : SimpleQueue of News or StampedMessage
        Queue of news to send.
    journal : SimpleQueue
        Queue of items for the journal.
    on_opening : callable
        Called after the opening of a port was reported and before it is opened; must return when the report is sent.
    on_open : callable
        Called after a port was opened, when the driver's threads exist.

    Attributes
    ----------
    has_ended : bool
        Whether the MIDI system has ended, so that another recorder must continue.
    """

    def __init__(
        self,
        news: NewsQueue,
        journal: SimpleQueue[Any],
        requested_system: str = "",
        on_opening: Callable[[], None] = lambda: None,
        on_open: Callable[[], None] = lambda: None,
    ) -> None:
        self._news, self._journal = news, journal
        self._requested_system, self._on_opening, self._on_open = requested_system, on_opening, on_open
        self._system: MidiSystem | None = None
        self._has_ports = False
        self._tried_at_s = -_NO_SYSTEM_LOOK_S
        self._reported: News | None = None
        self._refused: list[Message] = []
        self._asked: Open | None = None
        self._not_before_s = 0.0
        self._input: OpenInput | None = None
        self._identity = ""
        self._was_open = False
        self.has_ended = False

    def obey(self, command: Command) -> None:
        """Execute a command that the editor sent, such as to open or close a port."""
        match command:
            case Open():
                self._asked, self._was_open = command, command.is_lost
                self._not_before_s = time.perf_counter() + command.after_s
                self.look()
            case StartRecording(resumed_ns=None):
                self._journal.put(command)
                if self._input is None:
                    self._journal.put(("lost", time.perf_counter_ns()))
            case _:
                self._journal.put(command)

    def look(self) -> None:
        """Check the system's ports: report changes, and detect the loss or return of the open one."""
        system = self._answering()
        if system is None:
            return
        if system.has_ended:
            self._end()
            return
        inputs, outputs = system.inputs(), system.outputs()
        self._lose(inputs)
        self._report(Ports(_names(inputs), _names(outputs), system.name))
        if self._input is None:
            self._open(system, inputs)
        self._has_ports = bool(inputs or outputs)

    def _answering(self) -> MidiSystem | None:
        """Return the MIDI system, if one responds; otherwise try again at intervals. A missing JACK server looks like a
        server without ports.
        """
        is_sure = self._system is not None and (self._has_ports or self._system.name != "jack")
        now_s = time.perf_counter()
        if not is_sure and now_s >= self._tried_at_s + _NO_SYSTEM_LOOK_S:
            self._tried_at_s = now_s
            self._leave_system()
            try:
                self._system = MidiSystem(self._requested_system)
                self._refused.clear()
            except PortError as error:
                self._report(Ports((), (), ""))
                self._refuse(error.message)
        return self._system

    def _leave_system(self) -> None:
        if self._system is not None:
            self._system.close()
        self._system = None

    def _lose(self, inputs: tuple[Port, ...]) -> None:
        if self._input is not None and self._identity not in {port.identity for port in inputs}:
            self._input.close()
            self._input = None
            self._report_lost()

    def _report_lost(self) -> None:
        assert self._asked is not None
        ns = time.perf_counter_ns()
        self._journal.put(("lost", ns))
        self._news.put(Lost(self._asked.port, ns))

    def _end(self) -> None:
        """Report the end of the MIDI system and end this recorder, since its objects can only be freed by ending the
        process.
        """
        if self._input is not None:
            self._report_lost()
        self._news.put(SystemEnded())
        self.has_ended = True

    def _open(self, system: MidiSystem, inputs: tuple[Port, ...]) -> None:
        if self._asked is None:
            return
        name = self._asked.port
        port = next((port for port in inputs if port.name == name), None)
        if port is None:
            if not self._was_open:
                self._refuse(Message("capture.port_not_here", {"port": name}))
            return
        if self._asked.after_s and time.perf_counter() < self._not_before_s:
            return
        self._news.put(Opening(name))
        self._on_opening()
        try:
            self._input = system.open_input(port, self._receive)
            self._on_open()
        except PortError as error:
            self._refuse(error.message)
            return
        ns = time.perf_counter_ns()
        self._identity = port.identity
        self._journal.put(("back", ns))
        self._news.put(Back(name, ns) if self._was_open else Opened(name, ns))
        self._was_open = True
        self._refused.clear()

    def _receive(self, ns: int, message: bytes) -> None:
        received = (ns, message)
        self._journal.put(received)
        self._news.put(received)

    def _report(self, ports: Ports) -> None:
        if ports != self._reported:
            self._reported = ports
            self._news.put(ports)

    def _refuse(self, reason: Message) -> None:
        """Report why a request fails, once for as long as the reason persists."""
        if reason not in self._refused:
            self._refused.append(reason)
            self._news.put(RequestRefused(reason))


def _names(ports: tuple[Port, ...]) -> tuple[str, ...]:
    return tuple(port.name for port in ports)


def send_news(queue: NewsQueue, channel: MessageChannel[Command]) -> None:
    """Send the items of a queue, combining events, until None or until the editor stops reading."""
    with contextlib.suppress(OSError):
        while True:
            items = [queue.get()]
            with contextlib.suppress(Empty):
                while True:
                    items.append(queue.get_nowait())
            for is_audible, group in groupby(items, lambda item: isinstance(item, tuple)):
                if is_audible:
                    received = [item for item in group if isinstance(item, tuple) and is_whole(item[1])]
                    if received:
                        times_ns, messages = zip(*received, strict=True)
                        channel.put(Events(times_ns, messages))
                    continue
                for item in group:
                    if item is None:
                        channel.outgoing.flush()
                        return
                    if isinstance(item, threading.Event):
                        channel.outgoing.flush()
                        item.set()
                        continue
                    assert not isinstance(item, tuple)
                    channel.put(item)
            channel.outgoing.flush()


def wait_until_sent(queue: NewsQueue) -> None:
    """Block until the present items of the queue are sent, or the editor has stopped reading."""
    sent = threading.Event()
    queue.put(sent)
    sent.wait(_SENT_WITHIN_S)


def _read_commands(queue: SimpleQueue[Command | None], channel: MessageChannel[Command]) -> None:
    with contextlib.suppress(BrokenPipeError):
        while True:
            queue.put(channel.receive())
    queue.put(None)


def _private_output() -> IO[bytes]:
    """Return a private copy of standard output, for messages to the editor. Output of drivers' libraries is discarded
    from then on; Python's own errors still appear.
    """
    own = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # On Windows a program without a console has no standard error.
    if sys.stderr is not None:
        sys.stderr = os.fdopen(os.dup(sys.stderr.fileno()), "w", errors="backslashreplace", buffering=1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    return own


def _end_at_once(kind: type[BaseException], error: BaseException | None, trace: TracebackType | None) -> None:
    """Print an exception and end the process, since the recorder is useless without one of its threads."""
    traceback.print_exception(kind, error, trace)
    os._exit(1)


def take_precedence() -> None:
    """Raise the scheduling priority of the process as far as the system allows.

    All threads of the process: a fast driver's thread would still wait for Python's lock while a slow thread holds it.
    Threads of a driver's library do not always inherit the priority, so call this again after opening a port. On
    Windows the parent process sets it.
    """
    with contextlib.suppress(PermissionError):
        if sys.platform == "linux":
            first = os.sched_param(os.sched_get_priority_min(os.SCHED_RR))
            for task in (int(path.name) for path in Path("/proc/self/task").iterdir()):
                # The process may have ended since.
                with contextlib.suppress(ProcessLookupError):
                    if os.sched_getscheduler(task) == os.SCHED_OTHER:
                        os.sched_setscheduler(task, os.SCHED_RR, first)
        elif hasattr(os, "setpriority"):
            os.setpriority(os.PRIO_PROCESS, 0, _PRIORITY)


def main() -> None:
    """Run the recorder in this process, with commands from standard input and news to standard output."""
    sys.excepthook = _end_at_once
    threading.excepthook = lambda failed: _end_at_once(failed.exc_type, failed.exc_value, failed.exc_traceback)
    confine_this_process("recorder")
    take_precedence()
    sys.setswitchinterval(_SWITCH_S)
    # Loaded objects are exempt from garbage collection, so that no time stamp is delayed by a full collection.
    gc.freeze()
    channel = MessageChannel[Command](Command, sys.stdin.buffer, _private_output())
    news: NewsQueue = SimpleQueue()
    journal: SimpleQueue[Any] = SimpleQueue()
    commands: SimpleQueue[Command | None] = SimpleQueue()
    writing = threading.Thread(target=JournalKeeper(journal, news).run, name="journal")
    sending = threading.Thread(target=send_news, args=(news, channel), name="news")
    reading = threading.Thread(target=_read_commands, args=(commands, channel), name="commands", daemon=True)
    for thread in (writing, sending, reading):
        thread.start()
    requested = os.environ.get(SYSTEM_VARIABLE, "")
    recorder = RecorderProcess(news, journal, requested, partial(wait_until_sent, news), take_precedence)
    next_look_s = time.perf_counter()
    command: Command | None = None
    while True:
        try:
            command = commands.get(timeout=max(next_look_s - time.perf_counter(), 0.0))
            if command is None or isinstance(command, Leave):
                break
            recorder.obey(command)
        except Empty:
            recorder.look()
            next_look_s = time.perf_counter() + _LOOK_S
        if recorder.has_ended:
            command = Leave()
            break
    journal.put(command)
    writing.join()
    news.put(None)
    sending.join()
    # The port stays open: see `app.capture.midi_library.OpenInput`.
    os._exit(0)


if __name__ == "__main__":
    main()
