"""Decisions made at the import of a MIDI file, stored with the project and applied whenever the file is read again.

Tracks are stored as marks that identify them in another version of the file (`app.project.rereading`).
"""

from __future__ import annotations

from typing import Final, TypeAlias

import msgspec

from app.project.melody_likeness import sketch, turns
from app.score.assignments import Split
from app.score.limits import MOST_STREAMS
from app.score.metre_map import Metre
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel

Place: TypeAlias = tuple[int, int, int]
"""Track, channel, and index of the instrument among its player's."""

MOST_ROWS: Final = 2 * MOST_STREAMS
"""Greatest number of stored rows: those of the file, and those of tracks in earlier versions of the file."""


class TrackMark(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Identification of one channel of a track in another version of the file.

    Attributes
    ----------
    track, channel, change : int
        See `TrackChannel`; values when the file was last read.
    name, instrument_name, program, reported
        Data from which the instrument was chosen.
    called : str
        The track's name when the file was read last.
    melody : tuple of int
        Sketch of its melody (`app.project.melody_likeness.sketch`).
    """

    track: int
    channel: int
    change: int
    name: str
    instrument_name: str
    program: int | None
    reported: tuple[str, ...]
    called: str
    melody: tuple[int, ...]

    @property
    def place(self) -> Place:
        """Track, channel and instrument index of the channel, by which it is identified in a file."""
        return self.track, self.channel, self.change


class RowDecision(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Decision about the player of some tracks.

    Attributes
    ----------
    tracks : tuple of TrackMark
        Tracks; several are merged into one part, which is named after the first.
    requested : bool
        Whether the tracks get a player; otherwise they are left out.
    map_id, name, split, written
        See `app.score.parts.PartAssignment`.
    character_id : str or None
        Id of the character; None to choose automatically.
    solos : bool
        See `PartAssignment`; False for imports of earlier versions, which did not interpret "solo" and similar words.
    clean : bool
        See `PartAssignment`; False for imports of earlier versions.
    voice_maps : tuple of (str or None)
        See `PartAssignment`.
    """

    tracks: tuple[TrackMark, ...]
    requested: bool = True
    map_id: str | None = None
    name: str = ""
    split: Split = "sustained"
    written: bool = False
    character_id: str | None = None
    solos: bool = False
    clean: bool = False
    voice_maps: tuple[str | None, ...] = ()


class ImportDecisions(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All decisions about a file.

    Attributes
    ----------
    encoding : str or None
        Encoding of the file's texts; None to guess it for each text.
    rows : tuple of RowDecision
        Decisions in the order of the parts.
    """

    encoding: str | None = None
    rows: tuple[RowDecision, ...] = ()


class ReadTiming(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Tempo and metres in a MIDI file; see `app.score.model.Score`."""

    tempo_map: TempoMap
    metres: tuple[Metre, ...]
    pickup_ticks: int


def mark_of(channel: TrackChannel, quarter: int, decided: TrackMark | None = None) -> TrackMark:
    """Return a mark by which a channel can be found again in another version of its file.

    Parameters
    ----------
    quarter : int
        Ticks per quarter.
    decided : TrackMark, optional
        Earlier mark, with the names and program from which the instrument was chosen.
    """
    source = channel if decided is None else decided
    return TrackMark(
        track=channel.track,
        channel=channel.channel,
        change=channel.change,
        name=source.name,
        instrument_name=source.instrument_name,
        program=source.program,
        reported=source.reported,
        called=channel.name,
        melody=melody_of(channel, quarter),
    )


def melody_of(channel: TrackChannel, quarter: int) -> tuple[int, ...]:
    """Return hashes of the intervals between a channel's notes, by which its melody is found again in a changed file;
    ``quarter`` is ticks per quarter note.
    """
    notes = sorted(zip(channel.onset_ticks, channel.pitches, strict=True))
    return sketch(turns([onset for onset, _ in notes], [pitch for _, pitch in notes], quarter))
