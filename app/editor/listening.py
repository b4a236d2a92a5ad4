"""Listening settings, shared by transport, commands and sound."""

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
    """A take that is auditioned without using it in the part.

    Attributes
    ----------
    player_id, take_id : str
        Ids of the player and the take; ``take_id`` is empty for the notes from before the first take.
    alone : bool
        Whether all other players are muted.
    """

    player_id: str
    take_id: str
    alone: bool


class Listening(State):
    """Listening settings of the user.

    Attributes
    ----------
    speed : float
        Playback speed 0.25..2 at constant pitch.
    volume : float
        Perceived volume 0..1.
    click : bool
        Whether the metronome is audible.
    percussion : bool
        Whether percussion is audible.
    scrub_sound : bool
        Whether scrubbing is audible.
    source : str
        Sound source for projects with a recording; others use the synthesiser.
    silent : bool
        True without a sound device: playback then runs silently.
    waveform : Peaks or None
        Waveform of the project's recording, once it is read.
    ready : float
        Share 0..1 of the score whose sound the synthesiser has rendered.
    take : RecordedTake or None
        Take that is played in place of its player's part until playback stops.

    Signals
    -------
    changed()
        One of the settings has changed.
    waveform_changed()
        Another recording was chosen, or the recording was read.
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
        """Change some attributes, clipped to their ranges; `changed` is emitted once if any of them has changed."""
        for name, (least, most) in {"speed": (LEAST_SPEED, MOST_SPEED), "volume": (0.0, 1.0)}.items():
            if name in values:
                values[name] = min(max(values[name], least), most)
        super().set(**values)

    def set_waveform(self, waveform: Peaks | None) -> None:
        """Set the waveform of the recording; None if there is no recording, or before it is read."""
        if waveform is not self.waveform:
            self.waveform = waveform
            self.waveform_changed.emit()
