"""Listening settings: state of the editor that transport, commands and sound share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Literal

from PySide6.QtCore import Signal

from app.audio.waveform_peaks import Peaks
from app.editor.state import State

Source = Literal["recording", "synthesiser", "both"]
SOURCES: Final[tuple[Source, ...]] = ("recording", "synthesiser", "both")

LEAST_SPEED, MOST_SPEED = 0.25, 2.0


@dataclass(frozen=True)
class RecordedTake:
    """A take that is played for listening, without taking it over.

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


class Listening(State):
    """Listening settings of the user.

    Attributes
    ----------
    speed : float
        0.25..2; the pitch stays.
    volume : float
        0..1 as the ear judges it.
    click : bool
        Whether the metronome sounds.
    percussion : bool
        Whether the percussion sounds.
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
    take : RecordedTake or None
        Heard in the place of its player's part until the sound stops.

    Signals
    -------
    changed()
        One of these has changed.
    waveform_changed()
        Another recording was chosen, or it was read.
    """

    waveform_changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.speed = 1.0
        self.volume = 0.8
        self.click = False
        self.percussion = True
        self.scrub_sound = True
        self.source: Source = "recording"
        self.silent = False
        self.ready = 1.0
        self.waveform: Peaks | None = None
        self.take: RecordedTake | None = None

    def set(self, **values: Any) -> None:
        """Change some attributes; `changed` once if any changes. Speed and volume are held within their bounds."""
        for name, (least, most) in {"speed": (LEAST_SPEED, MOST_SPEED), "volume": (0.0, 1.0)}.items():
            if name in values:
                values[name] = min(max(values[name], least), most)
        super().set(**values)

    def set_waveform(self, waveform: Peaks | None) -> None:
        """The recording's picture; None: there is no recording, or it is not read yet."""
        if waveform is not self.waveform:
            self.waveform = waveform
            self.waveform_changed.emit()
