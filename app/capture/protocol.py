"""Messages between the editor and its recorder: commands to the recorder, and news from it."""

from __future__ import annotations

import threading
from queue import SimpleQueue
from typing import TypeAlias

import msgspec

from app.capture.journal import JournalHeader
from app.errors import Message


class _Report(msgspec.Struct, frozen=True, tag=True, array_like=True, gc=False):
    pass


class Open(_Report, frozen=True):
    """Command to listen to a port, now and whenever it reconnects; a recorder gets it once (see
    `app.capture.recorder`). ``is_lost``: whether the port was open before and was disconnected. ``after_s``: seconds to
    wait first.
    """

    port: str
    is_lost: bool = False
    after_s: float = 0.0


class StartRecording(_Report, frozen=True):
    """Command to write received messages to a journal. Its path is encoded by `os.fsencode`, since not all paths are
    text. ``resumed_ns``: time of the last message of another recorder that began the journal. ``elsewhere``: path to
    use if the first disk is full; empty to wait until it has room.
    """

    path: bytes
    header: JournalHeader
    resumed_ns: int | None = None
    elsewhere: bytes = b""


class Sync(_Report, frozen=True):
    """Command that reports the position of the piece heard at a moment, for the journal."""

    ns: int
    position_s: float
    pass_: int


class Stop(_Report, frozen=True):
    """Command to finish the journal."""


class Leave(_Report, frozen=True):
    """Command to end without finishing the journal, which another recorder continues."""


class Ports(_Report, frozen=True):
    """Report of the connected devices, sent at the start and whenever they change.

    Attributes
    ----------
    inputs, outputs : tuple of str
        Unique names, which do not change when a device is reconnected.
    system : str
        MIDI system in use (``alsa``, ``jack``, ``coremidi``, ``winmm``); empty if none responds.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    system: str


class Opening(_Report, frozen=True):
    """Report that the port will be opened. If the recorder ends before its next report, the port was refused: one of
    the MIDI libraries ends the process then.
    """

    port: str


class _OfPort(_Report, frozen=True):
    port: str
    ns: int


class Opened(_OfPort, frozen=True):
    """Report that the port is open."""


class Lost(_OfPort, frozen=True):
    """Report that the port was disconnected; it is opened again when it reconnects."""


class Back(_OfPort, frozen=True):
    """Report that a disconnected port is open again."""


class _Failure(_Report, frozen=True):
    reason: Message


class RequestRefused(_Failure, frozen=True):
    """Report of a request that failed, with the reason."""


class NotStarted(_Failure, frozen=True):
    """Report that the journal cannot be started, with the reason; nothing is recorded."""


class Restarted(_Failure, frozen=True):
    """Report that the recorder ended unexpectedly and was restarted, with the reason; the journal is continued."""


class SystemEnded(_Report, frozen=True):
    """Report that the MIDI system ended with all of its ports: this recorder ends, and another waits for the system."""


class Events(_Report, frozen=True):
    """Report of received channel messages: moments of `time.perf_counter_ns` and bytes."""

    times_ns: tuple[int, ...]
    messages: tuple[bytes, ...]


class EventsSaved(_Report, frozen=True):
    """Report of the number of events of the running journal that are safely on disk."""

    count: int


class Moved(_Report, frozen=True):
    """Report that the running journal was moved completely to another path, because its disk is full."""

    path: bytes
    reason: str


class RecordingFinished(_Report, frozen=True):
    """Report that the journal is complete and closed."""

    path: bytes
    count: int


Command: TypeAlias = Open | StartRecording | Sync | Stop | Leave
News: TypeAlias = (
    Ports
    | Opening
    | Opened
    | Lost
    | Back
    | RequestRefused
    | NotStarted
    | Restarted
    | Events
    | EventsSaved
    | Moved
    | RecordingFinished
    | SystemEnded
)

StampedMessage: TypeAlias = tuple[int, bytes]
"""A moment of `time.perf_counter_ns` and a message."""
NewsQueue: TypeAlias = "SimpleQueue[News | StampedMessage | threading.Event | None]"
"""Items to send in order; an event is set once everything before it is sent, and None ends the sending."""
