"""Assignment of tracks to instruments and players: the suggestion, and the user's changes to it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias

import msgspec

from app.score.instrument_choice import LEAST_OUTSIDE, How, MapChoice, candidates, refusal
from app.score.sequencer_regions import groups
from app.score.track_channel import TrackChannel
from instrument_maps.instrument_names import vocabulary

PERCUSSION: Final = "percussion"
"""Assignment of a part that no player plays and whose notes dancers hear as percussion."""
Split: TypeAlias = Literal["sustained", "every", "never"]


class PartAssignment(msgspec.Struct, frozen=True):
    """The user's choices for the tracks that form one part.

    Attributes
    ----------
    channels : tuple of int
        Indices of the channels; the notes of several channels are merged into one line.
    map_id : str or None
        Id of the instrument map for the part. None: chosen by names, programs and ranges. `PERCUSSION`: the notes are
        the sounds of a drum kit, and the part has no player.
    name : str
        Name of the part; empty: the name in the file.
    split : {"sustained", "every", "never"}
        When a second player is added: for notes that go on sounding together, for every note that overlaps another, or
        never.
    written : bool
        Whether the file holds written pitches of a transposing instrument instead of sounding ones.
    clean : bool
        Whether the tracks are recorded takes, from which unintended notes are removed (`app.score.take_tracks`).
    solos : bool
        Whether words in the track about the number of players ("1. Solo", "a2") are followed.
    voice_maps : tuple of (str or None)
        The instrument maps of single players, from voice 0, where the track is split; None, and voices beyond the end:
        the map of the whole part.
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
        Whether an instrument map can play the tracks.
    """

    assignment: PartAssignment
    playable: bool


def usual_assignments(channels: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> tuple[PartAssignment, ...]:
    """Suggest assignments of tracks by names, programs and ranges, for the user to change: one for every playable group
    of tracks, and one for each instrument of a track that changes instruments.
    """
    return tuple(found.assignment for found in suggestions(channels, maps) if found.playable)


def suggestions(channels: Sequence[TrackChannel], maps: Sequence[MapChoice]) -> list[Suggestion]:
    """Suggest assignments for all channels; channels of one player are grouped.

    Pitches are taken for written ones if many are outside the instrument's range as sounding pitches and none as
    written pitches. If one part of a family of instruments is written so, the other parts of the family are too as soon
    as one note is unusually low or high.
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
    # One or two wrong notes prove nothing.
    return choice.outside(pitches) >= LEAST_OUTSIDE * len(pitches) and not choice.outside(pitches, written=True)
