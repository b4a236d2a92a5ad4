"""Application of stored import decisions to a re-read MIDI file: its tracks are recognised regardless of order and
name, and get their previous players.

Tracks without a decision are treated as in a new import, except that a name need not contain an instrument. Decisions
about tracks missing in the file are kept, in case these return.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import msgspec
import numpy as np

from app.project.import_decisions import (
    MOST_ROWS,
    ImportDecisions,
    Place,
    RowDecision,
    TrackMark,
    mark_of,
    melody_of,
)
from app.project.importing import ImportRow, decision_of, usual_rows
from app.project.melody_likeness import ALIKE, sketched_shares
from app.score.assignments import PERCUSSION, PartAssignment
from app.score.contents import PieceContents
from app.score.instrument_choice import How, MapCandidates, MapChoice, candidates, refusal
from app.score.track_channel import TrackChannel
from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import InstrumentMap

_NAMED: Final = 0.32
"""Similarity of names from which a completely rewritten track is the same track if everything else is equal."""


@dataclass(frozen=True)
class MidiReading:
    """A MIDI file with the user's decisions about its tracks.

    Attributes
    ----------
    contents : PieceContents
        Contents of the file; tracks that no longer have the data by which their instrument was chosen get it back.
    rows : tuple of ImportRow
        Import rows of its channels.
    decisions : ImportDecisions
        Previous decisions and those about new tracks, with marks of the current file.
    places : mapping of Place to Place
        Current place of each part read earlier, by its previous place.
    """

    contents: PieceContents
    rows: tuple[ImportRow, ...]
    decisions: ImportDecisions
    places: Mapping[Place, Place] = field(default_factory=dict)


def read_as_decided(
    contents: PieceContents,
    decisions: ImportDecisions,
    maps: Mapping[str, InstrumentMap],
    choices: Sequence[MapChoice],
    played_on: Mapping[Place, str],
) -> MidiReading:
    """Return import rows for a file from decisions about another version of it.

    Parameters
    ----------
    choices : sequence of MapChoice
        Facts about the maps.
    played_on : mapping of Place to str
        Instrument map of each part of the project, by place; used if nothing else is known.
    """
    channels = list(contents.channels)
    quarter = contents.tempo_map.ticks_per_quarter
    marks = [mark for row in decisions.rows for mark in row.tracks]
    found = iter(recognised_streams(marks, channels, [melody_of(channel, quarter) for channel in channels]))
    rows: list[ImportRow] = []
    kept: list[RowDecision] = []
    places: dict[Place, Place] = {}
    known: set[int] = set()
    spare = MOST_ROWS - len(channels)
    for decision in decisions.rows:
        own = [(mark, next(found)) for mark in decision.tracks]
        there = [(mark, place) for mark, place in own if place is not None]
        known.update(place for _, place in there)
        renewed = []
        for mark, place in own:
            if place is None:
                renewed.append(mark)
                continue
            channel = contents.channels[place]
            says = not decision.requested or _says_who(channel, mark, choices)
            channels[place] = channel if says else _as_before(channel, mark)
            renewed.append(mark_of(channel, quarter, None if says else mark))
        spare -= not there
        if there or spare >= 0:
            kept.append(msgspec.structs.replace(decision, tracks=tuple(renewed)))
        if there:
            lead = decision.tracks[0].place
            places[lead] = contents.channels[there[0][1]].place
            before = played_on.get(lead)
            rows.append(_row(decision, [place for _, place in there], contents.channels, channels, choices, before))
    for row in usual_rows(contents, maps):
        new = tuple(place for place in row.assignment.channels if place not in known)
        if new:
            added = msgspec.structs.replace(row, assignment=msgspec.structs.replace(row.assignment, channels=new))
            added = _played(added, contents.channels, choices)
            rows.append(added)
            kept.append(decision_of(added, [mark_of(contents.channels[place], quarter) for place in new]))
    read = msgspec.structs.replace(contents, channels=tuple(channels))
    return MidiReading(read, tuple(rows), msgspec.structs.replace(decisions, rows=tuple(kept)), places)


def _played(row: ImportRow, channels: Sequence[TrackChannel], choices: Sequence[MapChoice]) -> ImportRow:
    """Return the row of new tracks, completed: if the names do not give an instrument, it is chosen by range, since the
    user is not asked here.
    """
    own = [
        msgspec.structs.replace(channels[place], name="", instrument_name="", program=None)
        for place in row.assignment.channels
    ]
    unknown = not row.requested and candidates([channels[place] for place in row.assignment.channels], choices).unknown
    if not unknown or any(refusal(channel, choices) is not None for channel in own):
        return row
    pitches = [pitch for channel in own for pitch in channel.pitches]
    map_id = candidates(own, choices).best(pitches).map_id
    return ImportRow(msgspec.structs.replace(row.assignment, map_id=map_id))


def recognised_streams(
    marks: Sequence[TrackMark], channels: Sequence[TrackChannel], melodies: Sequence[tuple[int, ...]]
) -> list[int | None]:
    """Return the index of the channel that each mark identifies, with the greatest total similarity; None if it is
    missing.

    Parameters
    ----------
    melodies : sequence of tuple of int
        Sketches of the channels' melodies.
    """
    result: list[int | None] = [None] * len(marks)
    if not marks or not channels:
        return result
    content = sketched_shares([mark.melody for mark in marks], melodies)
    kin = np.array([[_kinship(mark, channel) for channel in channels] for mark in marks])
    from scipy.optimize import linear_sum_assignment  # slow to import and rarely needed

    for one, other in zip(*linear_sum_assignment(-(content + kin)), strict=True):
        if content[one, other] >= ALIKE or kin[one, other] >= _NAMED:
            result[int(one)] = int(other)
    return result


def _kinship(mark: TrackMark, channel: TrackChannel) -> float:
    """Return the similarity of a mark and a channel apart from their notes: names, program and numbers."""
    named = channel.name.casefold() in (mark.called.casefold(), mark.name.casefold())
    return (
        (0.25 if channel.name else 0.1) * named
        + 0.04 * (channel.instrument_name == mark.instrument_name)
        + 0.06 * (channel.program == mark.program)
        + 0.06 * (channel.track == mark.track)
        + 0.04 * (channel.channel == mark.channel)
        + 0.06 * (channel.change == mark.change)
    )


def _says_who(channel: TrackChannel, mark: TrackMark, choices: Sequence[MapChoice]) -> bool:
    """Return whether the names of a channel identify its instrument at least as well as those of its mark."""
    found = candidates([channel], choices)
    if found.how is not How.SAID or not found.maps or found.unknown:
        return False
    # A name contains more information than a program number, such as the number of players.
    return _understood(channel) >= _understood(mark)


def _understood(track: TrackChannel | TrackMark) -> int:
    """Return 2 if the names of a track identify an instrument clearly, 1 if vaguely, 0 if not at all."""
    named = [vocabulary().by_name(text) for text in (track.name, track.instrument_name) if text]
    return max((1 if found.vague else 2 for found in named if found is not None), default=0)


def _says_the_same(channel: TrackChannel, marks: Sequence[TrackMark]) -> bool:
    """Return whether a channel has the same names and program as one of the marks."""
    said = channel.name, channel.instrument_name, channel.program
    return any((mark.name, mark.instrument_name, mark.program) == said for mark in marks)


def _as_before(channel: TrackChannel, mark: TrackMark) -> TrackChannel:
    """Return a channel with the names and program that it had when it was imported."""
    return msgspec.structs.replace(
        channel,
        name=mark.name,
        instrument_name=mark.instrument_name,
        program=mark.program,
        reported=tuple(id_ for id_ in mark.reported if id_ in vocabulary().instruments),
    )


def _row(
    decision: RowDecision,
    places: Sequence[int],
    called: Sequence[TrackChannel],
    channels: Sequence[TrackChannel],
    choices: Sequence[MapChoice],
    before: str | None,
) -> ImportRow:
    """Return the import row of a decision.

    Parameters
    ----------
    places : sequence of int
        Indices of its channels in the file.
    called, channels : sequence of TrackChannel
        Channels as in the file, and channels with the names by which instruments were chosen.
    before : str or None
        Instrument map used before.
    """
    own = [channels[place] for place in places]
    installed = {PERCUSSION, *(choice.map_id for choice in choices)}
    map_id = decision.map_id if decision.map_id in installed else None
    if map_id is None and decision.requested and before is not None:
        found = candidates(own, choices)
        if found.how is How.SAID and before in installed and _says_the_same(own[0], decision.tracks):
            # Chosen by the same words under the rules of an earlier version.
            map_id = None if any(choice.map_id == before for choice in found.maps) else before
        elif found.unknown or not found.maps:
            # The player remains and has an instrument of its own, so any map can be used to read the notes.
            pitches = [pitch for channel in own for pitch in channel.pitches]
            map_id = (
                before if before in installed else MapCandidates(How.RANGE, None, tuple(choices)).best(pitches).map_id
            )
    name = decision.name
    if not name and own[0].name != called[places[0]].name:
        name = called[places[0]].name
    assignment = PartAssignment(
        tuple(places),
        map_id,
        name,
        decision.split,
        decision.written,
        decision.solos,
        decision.clean,
        tuple(voice if voice in installed else None for voice in decision.voice_maps),
    )
    return ImportRow(assignment, decision.requested, decision.character_id)


def characters_of(reading: MidiReading) -> dict[Place, str]:
    """Return the characters chosen in import rows, by the places of the parts read from them."""
    return {
        reading.contents.channels[row.assignment.channels[0]].place: row.character_id
        for row in reading.rows
        if row.character_id is not None
    }
