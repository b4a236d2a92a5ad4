"""The instrument and the players that each track is assigned to, as suggested and as the user changes it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias

import msgspec

from app.score.instrument_choice import LEAST_OUTSIDE, How, MapChoice, candidates, refusal
from app.score.sequencer_regions import groups
from app.score.track_channel import TrackChannel
from instrument_maps.instrument_names import vocabulary

PERCUSSION: Final = "percussion"
"""Assignment of a part, in place of an instrument, whose notes dancers hear as percussion."""
Split: TypeAlias = Literal["sustained", "every", "never"]


class PartAssignment(msgspec.Struct, frozen=True):
    """The user's choices for some tracks.

    Attributes
    ----------
    channels : tuple of int
        Places among the channels; several are merged into one line.
    map_id : str or None
        The instrument map that plays it; None: what the names, programs and ranges say; `PERCUSSION`: no one, for its
        notes are the sounds of a drum kit.
    name : str
        Of the part; empty: what the file calls it.
    split : {"sustained", "every", "never"}
        Another player for notes that go on sounding together; for every note that does; or one player has them all.
    written : bool
        The file has the pitches that stand in the part of a transposing instrument, not those that sound.
    clean : bool
        The tracks are takes: notes that were not meant are left out (`app.score.take_tracks`).
    solos : bool
        The track's words about who plays ("1. Solo", "a2") are followed.
    voice_maps : tuple of (str or None)
        The instrument maps of single players, from voice 0, where the track is split; None, and voices beyond: as of
        the whole part.
    """

    channels: tuple[int, ...]
    map_id: str | None = None
    name: str = ""
    split: Split = "sustained"
    written: bool = False
    solos: bool = True
    clean: bool = False
    voice_maps: tuple[str | None, ...] = ()


class Suggestion(msgspec.Struct, frozen=True):
    """Default import of the tracks of one player.

    Attributes
    ----------
    playable : bool
        A map plays them.
    """

    assignment: PartAssignment
    playable: bool


def usual_assignments(channels: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> tuple[PartAssignment, ...]:
    """Suggested assignments by names, programs and ranges, for the user to change: one for every playable stream, and
    one for the regions of a track."""
    return tuple(found.assignment for found in suggestions(channels, maps) if found.playable)


def suggestions(channels: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> list[Suggestion]:
    """Suggested assignments of all channels, those that are one player's together.

    The pitches of a part are taken for written ones where many lie outside its instrument's range as they sound and
    none as they are written; where one of a family is written so, the others are with any note that is unusually low or
    high.
    """
    found = []
    likely: list[tuple[bool, str]] = []
    certain = set()
    for own in groups(channels):
        tracks = [channels[index] for index in own]
        playable = all(refusal(channel, maps) is None for channel in tracks)
        written, family = False, ""
        possible = candidates(tracks, maps) if playable else None
        if possible is not None and possible.how is not How.RANGE:
            pitches = [pitch for channel in tracks for pitch in channel.pitches]
            choice = possible.best(pitches)
            family = vocabulary().family(choice.plays)
            high = choice.outside(pitches, usual=True) > 0
            written = high and not choice.outside(pitches, written=True, usual=choice.outside(pitches) == 0)
            if fits_as_written(choice, pitches):
                certain.add(family)
        likely.append((written, family))
        found.append(Suggestion(PartAssignment(own), playable))
    return [
        msgspec.structs.replace(one, assignment=msgspec.structs.replace(one.assignment, written=True))
        if written and family in certain
        else one
        for one, (written, family) in zip(found, likely, strict=True)
    ]


def fits_as_written(choice: MapChoice, pitches: Sequence[int]) -> bool:
    # A wrong note or two says nothing.
    return choice.outside(pitches) >= LEAST_OUTSIDE * len(pitches) and not choice.outside(pitches, written=True)
