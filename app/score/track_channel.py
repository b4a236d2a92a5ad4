"""The notes of one track on one channel, as they are read and as instruments are chosen for them."""

from __future__ import annotations

from operator import sub
from typing import Literal

import msgspec

from app.score.channel_sound import Use
from app.score.marks import Mark, Source
from app.score.model import ControllerCurve, Note


class TrackChannel(msgspec.Struct, frozen=True):
    """The notes of one track on one channel, as read.

    Attributes
    ----------
    track : int
        Counted from 0.
    name, instrument_name : str
        The track's texts for people, empty if there are none.
    onset_ticks, end_ticks, pitches, velocities, numbers : list of int
        One entry per note, by onset; ``numbers`` is the note's place among the track's note-ons, from 1.
    reported : tuple of str
        Of a track that says nothing itself: ids of the instruments that it may be for.
    reported_by : {"title", "ensemble"}
        What says so: the piece's title, or the staves together (`app.score.ensembles`).
    played_on : str
        Id of the instrument that its player changes to for these notes (`app.score.doublings`); empty: that of the
        track.
    change : int
        Which of its player's instruments that is, from 0.
    muted : tuple of (start, end)
        Spans of ticks in which the track is played with a mute.
    stopped : tuple of (start, end)
        Those of them in which the hand stops the bell.
    mute_kinds : tuple of (tick, kind)
        Which mute is in the bell from there on, where it is named.
    recorded : bool
        The file says that it is a take of ``suisou record``.
    solos : tuple of (tick, player)
        Who of several players has the notes alone from there on, from 1; 0: all play (`app.score.solos`).
    desks : tuple of (number, player, players)
        Notes, by their numbers, that are for one of so many players by the voices of their staff, from 1.
    use : {"melodic", "rhythm", "effect"}
        What its channel is on a sound module while it plays (`app.score.sound_module`).
    certain : bool
        A message says so that means nothing else.
    struck : list of int
        Of a rhythm part: the sounds of its notes as General MIDI numbers them; empty where they are its pitches.
    line : int
        The first of the tracks over which its line is spread (`app.score.lines_spread_over_tracks`); -1: it has the
        line to itself.
    marks, source
        As those of a `Part`; marks are of the ids that `notes` gives.
    """

    track: int
    channel: int
    name: str
    instrument_name: str
    program: int | None
    onset_ticks: list[int]
    end_ticks: list[int]
    pitches: list[int]
    velocities: list[int]
    numbers: list[int]
    curves: tuple[ControllerCurve, ...]
    reported: tuple[str, ...] = ()
    reported_by: Literal["title", "ensemble"] = "title"
    played_on: str = ""
    change: int = 0
    muted: tuple[tuple[int, int], ...] = ()
    stopped: tuple[tuple[int, int], ...] = ()
    mute_kinds: tuple[tuple[int, str], ...] = ()
    solos: tuple[tuple[int, int], ...] = ()
    desks: tuple[tuple[int, int, int], ...] = ()
    recorded: bool = False
    use: Use = "melodic"
    certain: bool = False
    struck: list[int] = []
    line: int = -1
    marks: tuple[Mark, ...] = ()
    source: Source = "sound"

    @property
    def place(self) -> tuple[int, int, int]:
        """Track, channel and instrument, as the parts made of the channel have them."""
        return self.track, self.channel, self.change

    def notes(self) -> list[Note]:
        """The notes, in the same order."""
        ids = [f"{self.track + 1}:{number}" for number in self.numbers]
        durations = map(sub, self.end_ticks, self.onset_ticks)
        return list(map(Note, ids, self.onset_ticks, durations, self.pitches, self.velocities))

    def seats(self, players: int) -> dict[str, int]:
        """The player of each note whose voice is for one of so many players, by the note's id."""
        return {f"{self.track + 1}:{number}": player for number, player, of in self.desks if of == players}
