"""What sounds and how: state of the editor that the transport, the commands and the sound share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from PySide6.QtCore import QObject, Signal

from app.audio.peaks import Peaks

Source = Literal["recording", "synthesiser", "both"]
SOURCES: Final[tuple[Source, ...]] = ("recording", "synthesiser", "both")

LEAST_SPEED, MOST_SPEED = 0.25, 2.0


@dataclass(frozen=True)
class RecordedTake:
    """A take that is listened to without being taken.

    Attributes
    ----------
    player_id, take_id : str
        ``take_id`` is empty for what was there before the first take.
    alone : bool
        Whether all others are silent.
    """

    player_id: str
    take_id: str
    alone: bool


class Listening(QObject):
    """How the user listens.

    Attributes
    ----------
    speed : float
        0.25..2; the pitch stays.
    volume : float
        0..1 as the ear judges it.
    click : bool
        Whether the metronome sounds.
    scrub_sound : bool
        Whether scrubbing sounds.
    source : str
        The sound of a project that has a recording; without one it is the synthesiser.
    silent : bool
        There is no device for sound: the performance plays in time all the same.
    waveform : Peaks or None
        Of the project's recording, once it is read.
    ready : float
        0..1: how much of the score the synthesiser has made.
    take : HeardTake or None
        Heard in the place of its player's part until the sound stops.

    Signals
    -------
    changed()
        One of these is another.
    waveform_changed()
        The recording is another, or was read.
    """

    changed = Signal()
    waveform_changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.speed = 1.0
        self.volume = 0.8
        self.click = False
        self.scrub_sound = True
        self.source: Source = "recording"
        self.silent = False
        self.ready = 1.0
        self.waveform: Peaks | None = None
        self.take: RecordedTake | None = None

    def set(
        self,
        *,
        speed: float | None = None,
        volume: float | None = None,
        click: bool | None = None,
        scrub_sound: bool | None = None,
        source: Source | None = None,
        silent: bool | None = None,
        ready: float | None = None,
    ) -> None:
        """Change what is not None."""
        before = self._state()
        self.speed = self.speed if speed is None else min(max(speed, LEAST_SPEED), MOST_SPEED)
        self.volume = self.volume if volume is None else min(max(volume, 0.0), 1.0)
        self.click = self.click if click is None else click
        self.scrub_sound = self.scrub_sound if scrub_sound is None else scrub_sound
        self.source = self.source if source is None else source
        self.silent = self.silent if silent is None else silent
        self.ready = self.ready if ready is None else ready
        if before != self._state():
            self.changed.emit()

    def set_take(self, take: RecordedTake | None) -> None:
        """Hear a take in the place of its player's part; None: the part."""
        if take != self.take:
            self.take = take
            self.changed.emit()

    def set_waveform(self, waveform: Peaks | None) -> None:
        """The recording's picture; None: there is no recording, or it is not read yet."""
        if waveform is not self.waveform:
            self.waveform = waveform
            self.waveform_changed.emit()

    def _state(self) -> tuple[object, ...]:
        return (self.speed, self.volume, self.click, self.scrub_sound, self.source, self.silent, self.ready)
