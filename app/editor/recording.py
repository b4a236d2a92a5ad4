"""State of the recording, shared by the transport, the panels and the recorder: player, device and progress."""

from __future__ import annotations

from typing import Final, Literal

from PySide6.QtCore import Signal

from app.editor.state import State
from app.errors import Message
from app.score.take import ControllerMapping

Connection = Literal["none", "waiting", "open", "lost", "refused"]
"""State of the chosen device: none is chosen; not there (yet); listened to; gone; not available."""


NO_DEVICE: Final = frozenset(
    {
        "capture.no_library",
        "capture.no_system",
        "capture.api_unknown",
        "capture.port_refused",
        "capture.port_taken",
        "capture.recorder_fails",
    }
)
"""Refusals that leave no device to listen to."""


class RecordingState(State):
    """State of the recording.

    Attributes
    ----------
    ports : tuple of str
        Devices that are there.
    port : str
        The chosen one, there or not; empty: none.
    refusal : Message or None
        Why the device, or every device, cannot be had.
    controller : str
        Id of the preset in ``metadata/controllers``.
    mapping : ControllerMapping
        With what the device sends breath and bite.
    armed : str
        Id of the player to record; empty: the active one.
    running : bool
        A take is being recorded, or counted in.
    start_s, counted_from_s : float
        Where the take begins, and where counting in did; seconds of the performance, while `running`.
    passes : int
        Of the loop, while `running`; from 1.
    events : int
        That are safe on the disk, of the running take.
    count_in_bars : int
        0..4.
    punch : bool
        The part only takes what lies in the punch range.
    punch_ticks : (int, int) or None
        That range, half-open.
    breath : float
        What is blown now, 0..1.
    pitch : int or None
        The note that is played now; concert pitch.
    latency_s : float
        Of the device, taken off every event.

    Signals
    -------
    changed()
        One of these has changed, `breath` and `pitch` excepted.
    played()
        `breath` or `pitch` has changed.
    received(object)
        An `app.capture.protocol.Events` came in; for the monitor and the live pose.
    """

    played = Signal()
    received = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.ports: tuple[str, ...] = ()
        self.port = ""
        self.connection: Connection = "none"
        self.refusal: Message | None = None
        self.controller = ""
        self.mapping = ControllerMapping()
        self.armed = ""
        self.running = False
        self.start_s = 0.0
        self.counted_from_s = 0.0
        self.passes = 0
        self.events = 0
        self.count_in_bars = 1
        self.punch = False
        self.punch_ticks: tuple[int, int] | None = None
        self.breath = 0.0
        self.pitch: int | None = None
        self.latency_s = 0.0

    def set_played(self, breath: float, pitch: int | None) -> None:
        """Report the breath and the pitch of the moment."""
        if (breath, pitch) != (self.breath, self.pitch):
            self.breath, self.pitch = breath, pitch
            self.played.emit()
