"""Notes of one track on one channel, with everything that serves the choice of an instrument."""

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
        Index of the track in the file, from 0.
    name, instrument_name : str
        The track's names in the file, empty if there are none.
    onset_ticks, end_ticks, pitches, velocities, numbers : list of int
        One entry per note, by onset; ``numbers`` is the index among the track's note-ons, from 1.
    reported : tuple of str
        For a track without information about its instrument: ids of instruments suggested by the title or the ensemble.
    reported_by : {"title", "ensemble"}
        Source of ``reported``: the title of the piece, or the combination of staves (`app.score.ensembles`).
    played_on : str
        Id of the instrument that the player changes to for these notes (`app.score.doublings`); empty for the main
        instrument.
    change : int
        Index of that instrument among the player's, from 0.
    muted : tuple of (start, end)
        Spans of ticks that are played with a mute.
    stopped : tuple of (start, end)
        Those of the muted spans in which the hand stops the bell.
    mute_kinds : tuple of (tick, kind)
        Kind of mute from each tick on, where it is named.
    recorded : bool
        Whether the file is marked as a take of ``suisou record``.
    solos : tuple of (tick, player)
        Player who has the notes alone from each tick on, from 1; 0: all play (`app.score.solos`).
    desks : tuple of (number, player, players)
        Notes, by their numbers, that belong to one player of several by the voices of the staff: the player from 1, and
        the number of players.
    use : {"melodic", "rhythm", "effect"}
        Kind of the channel on a sound module (`app.score.sound_module`).
    certain : bool
        Whether ``use`` was set by an unambiguous message.
    struck : list of int
        For a rhythm part: General MIDI numbers of the notes' sounds; empty where they equal the pitches.
    line : int
        Index of the first of the tracks over which the line is spread (`app.score.lines_spread_over_tracks`); -1: not
        spread.
    marks, source
        As in `Part`; marks use the ids that `notes` returns.
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
        """Key of the channel: track, MIDI channel and instrument index; equal to `Part.place` of the parts made from
        it.
        """
        return self.track, self.channel, self.change

    def notes(self) -> list[Note]:
        """The notes as `Note` values, in the same order."""
        ids = [f"{self.track + 1}:{number}" for number in self.numbers]
        durations = map(sub, self.end_ticks, self.onset_ticks)
        return list(map(Note, ids, self.onset_ticks, durations, self.pitches, self.velocities))

    def seats(self, players: int) -> dict[str, int]:
        """Return the player of each note, by note id, for those notes whose voices divide the staff among exactly this
        number of players.
        """
        return {f"{self.track + 1}:{number}": player for number, player, of in self.desks if of == players}
