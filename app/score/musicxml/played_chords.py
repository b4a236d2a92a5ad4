"""Chords and notes where they are played, and which players of a staff have them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

from app.score.musicxml.written import Chord, Tone


class Desk(NamedTuple):
    """Players of a chord, of all who are written in its measure.

    Attributes
    ----------
    first : int
        The player of its highest note, from 1; the next have those below. 0: nothing says who.
    players : int
        All players of the measure.
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
        Ticks of what it is written out in; one row where that is the note itself.
    last : Tone
        The last of those tied together.
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
    """A chord of a part with repeats written out: the notes that it begins, and those that it holds on."""

    onset: int
    end: int
    chord: Chord
    notes: list[PlayedNote] = field(default_factory=list)
    begun: list[PlayedNote] = field(default_factory=list)
    desk: Desk = EVERYONE

    def desk_of(self, note: PlayedNote) -> Desk:
        """Return the player (desk) of one of the chord's notes, if its notes are shared among several."""
        above = sum(tone.pitch > note.tone.pitch for tone in self.chord.tones)
        return Desk(self.desk.first + above, self.desk.players) if self.desk.first else self.desk
