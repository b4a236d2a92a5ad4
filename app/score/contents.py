"""Contents of a music file of any format, and the score built from them once players are assigned."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from app.errors import Message, StopRequested
from app.score.assignments import PartAssignment
from app.score.instrument_choice import MapChoice
from app.score.metre_map import Metre
from app.score.model import MOST_VOICES, Marker, Part, PercussionHit, Score, UnplayedPart
from app.score.parts import assigned_parts, rhythm_parts, stream_name
from app.score.tempo import TempoMap
from app.score.track_channel import TrackChannel
from app.score.track_instrument import sounds_of, use_of


class PieceContents(msgspec.Struct, frozen=True):
    """Contents of a music file, before players are assigned.

    Attributes
    ----------
    channels : tuple of TrackChannel
        Notes of each track, by channel; from a score file: of each part, by instrument.
    warnings : tuple of Message
        Messages about repaired or skipped content.
    encoding : str
        Encoding of texts that are not Unicode, given or guessed; empty if all are Unicode.
    """

    title: str
    tempo_map: TempoMap
    metres: tuple[Metre, ...]
    pickup_ticks: int
    channels: tuple[TrackChannel, ...]
    warnings: tuple[Message, ...]
    markers: tuple[Marker, ...] = ()
    encoding: str = ""


def assigned_score(
    contents: PieceContents,
    assignments: Sequence[PartAssignment],
    maps: Sequence[MapChoice],
    stop_requested: StopRequested = lambda: False,
) -> Score:
    """Build the score with the parts that the assignments describe. Raises Cancelled as `assigned_parts`."""
    parts, unplayed, warnings = assigned_parts(contents.channels, assignments, maps, score_of(contents), stop_requested)
    return score_of(contents, parts, unplayed, (*contents.warnings, *warnings), assignments)


def uncast_score(contents: PieceContents) -> Score:
    """Build a score without players, for listening: every track except percussion and sound effects becomes one part
    without an instrument map.
    """
    parts = tuple(
        Part(
            id=f"{channel.track + 1}.{channel.channel + 1}.{channel.change + 1}",
            name=stream_name(channel),
            track=channel.track,
            voice=MOST_VOICES * channel.change,
            channel=channel.channel,
            program=channel.program,
            instrument=None,
            map_id="",
            notes=tuple(sorted(channel.notes(), key=lambda note: (note.onset_tick, note.pitch))),
            curves=channel.curves,
        )
        for channel in contents.channels
        if use_of(channel) == "melodic"
    )
    return score_of(contents, parts)


def score_of(
    contents: PieceContents,
    parts: tuple[Part, ...] = (),
    unplayed: tuple[UnplayedPart, ...] = (),
    warnings: tuple[Message, ...] = (),
    assignments: Sequence[PartAssignment] = (),
) -> Score:
    return Score(
        title=contents.title,
        ticks_per_quarter=contents.tempo_map.ticks_per_quarter,
        tempo_map=contents.tempo_map,
        metres=contents.metres,
        pickup_ticks=contents.pickup_ticks,
        parts=parts,
        unplayed=unplayed,
        warnings=warnings,
        markers=contents.markers,
        percussion=_percussion(rhythm_parts(contents.channels, assignments)),
    )


def _percussion(channels: Sequence[TrackChannel]) -> tuple[PercussionHit, ...]:
    """All notes of the given percussion tracks as hits in order of time."""
    hits = (
        hit
        for channel in channels
        for hit in zip(channel.onset_ticks, sounds_of(channel), channel.velocities, strict=True)
    )
    return tuple(PercussionHit(tick, pitch, velocity) for tick, pitch, velocity in sorted(hits))
