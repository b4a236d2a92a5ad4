"""Chords and notes at the times they are played, with the players of a shared staff who play them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

from app.score.musicxml.written import Chord, Tone


class Desk(NamedTuple):
    """Assignment of a chord to some of the players who share a staff.

    Attributes
    ----------
    first : int
        Number of the player who has the chord's highest note, from 1; the next players have the lower notes. 0:
        unknown.
    players : int
        Number of players in the measure.
    """

    first: int = 0
    players: int = 0


EVERYONE: Final = Desk()


@dataclass(slots=True, eq=False)
class PlayedNote:
    """A note as it is played, with tied notes joined.

    Attributes
    ----------
    rows : list of (onset, end, pitch)
        Start tick, end tick and pitch of each note that is played for it: several if an ornament is written out, else
        one.
    last : Tone
        Last of the tied tones.
    """

    onset: int
    end: int
    tone: Tone
    chord: Chord
    last: Tone
    rows: list[tuple[int, int, int]] = field(default_factory=list)
    marks: list[tuple[str, str]] = field(default_factory=list)
    numbers: list[int] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class PlayedChord:
    """A chord at the time it is played: the notes that begin with it, and those it continues by ties."""

    onset: int
    end: int
    chord: Chord
    notes: list[PlayedNote] = field(default_factory=list)
    begun: list[PlayedNote] = field(default_factory=list)
    desk: Desk = EVERYONE

    def desk_of(self, note: PlayedNote) -> Desk:
        """Return the player who has one of the chord's notes, if the chord is divided among several players
        of a staff.
        """
        above = sum(tone.pitch > note.tone.pitch for tone in self.chord.tones)
        return Desk(self.desk.first + above, self.desk.players) if self.desk.first else self.desk
