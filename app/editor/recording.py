"""State of recording, shared by transport, panels and recorder: player, device and progress."""

from __future__ import annotations

from typing import Final, Literal

from PySide6.QtCore import Signal

from app.editor.state import State
from app.errors import Message
from app.score.take import ControllerMapping

Connection = Literal["none", "waiting", "open", "lost", "refused"]
"""State of the chosen device: none chosen, chosen but not connected, open, disconnected, or refused by the system."""


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
"""Ids of the errors after which no device can be opened."""


class RecordingState(State):
    """State of recording: device, armed player, running take and settings.

    Attributes
    ----------
    ports : tuple of str
        Available devices.
    port : str
        The chosen device, whether available or not; empty if none is chosen.
    refusal : Message or None
        Reason why the device, or all devices, are unavailable.
    controller : str
        Id of the device's preset in ``metadata/controllers``.
    mapping : ControllerMapping
        MIDI messages by which the device sends breath and bite.
    armed : str
        Id of the player to record; empty for the active one.
    running : bool
        Whether a take is being recorded or counted in.
    start_s, counted_from_s : float
        Times in the performance, in seconds, at which the take and its count-in began, while `running`.
    passes : int
        Number of the pass through the loop, from 1, while `running`.
    events : int
        Number of events of the running take that are safely on disk.
    count_in_bars : int
        Bars of count-in, 0..4.
    punch : bool
        Whether the part uses only the punch range of a new take.
    punch_ticks : (int, int) or None
        First tick of the punch range and the tick after its last one; None if no range is set.
    breath : float
        Current breath value, 0..1.
    pitch : int or None
        Concert pitch of the note being played; None if none is.
    latency_s : float
        Latency of the device in seconds, subtracted from the time of every event.

    Signals
    -------
    changed()
        An attribute other than `breath` and `pitch` has changed.
    played()
        `breath` or `pitch` has changed.
    received(object)
        An `app.capture.protocol.Events` was received, for the monitor and the live pose.
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
        """Set the breath 0..1 and the pitch that are played at present; pitch None if nothing sounds."""
        if (breath, pitch) != (self.breath, self.pitch):
            self.breath, self.pitch = breath, pitch
            self.played.emit()
