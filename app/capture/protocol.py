"""Messages between the editor and its recorder: commands one way, news the other."""

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
    """Listen to a port, again whenever it comes back; to a recorder this is said only once (see
    `app.capture.recorder`). ``is_lost``: it was listened to and went away. ``after_s``: not before so many seconds."""

    port: str
    is_lost: bool = False
    after_s: float = 0.0


class StartRecording(_Report, frozen=True):
    """Write received messages into a journal, whose path is as `os.fsencode` has it: not all names are text.
    ``resumed_ns``: another recorder began it, and nothing was received since. ``elsewhere``: a second path, used if the
    disk of the first is full; empty: wait for that disk."""

    path: bytes
    header: JournalHeader
    resumed_ns: int | None = None
    elsewhere: bytes = b""


class Sync(_Report, frozen=True):
    """At this moment that place of the piece sounds."""

    ns: int
    position_s: float
    pass_: int


class Stop(_Report, frozen=True):
    """Finish the journal."""


class Leave(_Report, frozen=True):
    """End and keep the journal: another recorder continues it."""


class Ports(_Report, frozen=True):
    """The devices that are there now; reported at the start and whenever they change.

    Attributes
    ----------
    inputs, outputs : tuple of str
        Names, each once; they stay the same when a device goes and comes back.
    system : str
        The MIDI system that is used (``alsa``, ``jack``, ``coremidi``, ``winmm``); empty while none answers.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    system: str


class Opening(_Report, frozen=True):
    """The port is about to be opened. If the recorder ends before it reports more, the port was refused: one of the
    MIDI libraries ends the process then."""

    port: str


class _OfPort(_Report, frozen=True):
    port: str
    ns: int


class Opened(_OfPort, frozen=True):
    """The port is listened to."""


class Lost(_OfPort, frozen=True):
    """The port has gone; it is opened again when it comes back."""


class Back(_OfPort, frozen=True):
    """The lost port is listened to again."""


class _Failure(_Report, frozen=True):
    reason: Message


class RequestRefused(_Failure, frozen=True):
    """A request that failed, with the reason."""


class NotStarted(_Failure, frozen=True):
    """The journal cannot be begun, and why: nothing is recorded."""


class Restarted(_Failure, frozen=True):
    """The recorder ended unexpectedly and was started again; the journal goes on."""


class SystemEnded(_Report, frozen=True):
    """The MIDI system has gone, with all of its ports: this recorder ends, another one waits for the system."""


class Events(_Report, frozen=True):
    """Received events: moments of `time.perf_counter_ns` and the bytes of the messages (channel messages only)."""

    times_ns: tuple[int, ...]
    messages: tuple[bytes, ...]


class EventsSaved(_Report, frozen=True):
    """Number of events of the running journal that are safely on disk."""

    count: int


class Moved(_Report, frozen=True):
    """The running journal continues, whole, at another path, because its disk is full."""

    path: bytes
    reason: str


class RecordingFinished(_Report, frozen=True):
    """The journal is complete and closed."""

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
"""Items to send, in order; an event is set once all before it is sent, None ends the sending."""
