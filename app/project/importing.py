"""Creation of a project from the tracks of a MIDI file, with the user's choice of players, instruments and
characters.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import msgspec

from app.errors import Message, StopRequested
from app.project.doubling import doubled_parts
from app.project.import_decisions import ImportDecisions, RowDecision, TrackMark, mark_of
from app.project.model import Project, map_choices, project_from_score
from app.project.usual_outfits import outfit_of_piece, with_outfit
from app.score.assignments import PERCUSSION, PartAssignment, suggestions
from app.score.contents import PieceContents, assigned_score
from app.score.model import Score, UnplayedPart
from app.score.take_tracks import take_reason
from instrument_maps.model import InstrumentMap


class ImportRow(msgspec.Struct, frozen=True):
    """Tracks of a file and the players for them: one row of the import dialog.

    Attributes
    ----------
    assignment : PartAssignment
        Tracks, instrument and name.
    requested : bool
        Whether the tracks get a player; otherwise they are left out.
    character_id : str or None
        Id of the character; None to choose automatically.
    """

    assignment: PartAssignment
    requested: bool = True
    character_id: str | None = None


class ImportRequest(msgspec.Struct, frozen=True):
    """Settings for importing a MIDI file as a project.

    Attributes
    ----------
    dances : bool
        Whether to add a dancer for its percussion.
    contents : PieceContents or None
        Contents that the rows belong to, if texts were decoded again; None for those first read.
    encoding : str or None
        Encoding of the texts; None to guess.
    outfit : str or None
        Id of the outfit of all players, empty for their own clothes; None to choose by the kind of piece.
    """

    rows: tuple[ImportRow, ...]
    dances: bool = False
    contents: PieceContents | None = None
    encoding: str | None = None
    outfit: str | None = None


def usual_rows(contents: PieceContents, maps: Mapping[str, InstrumentMap]) -> tuple[ImportRow, ...]:
    """Return the default rows of an import: one for every track, or one for each instrument of a track that has
    several.
    """
    found = suggestions(contents.channels, map_choices(maps.values()))
    rows = []
    for one in found:
        own = (contents.channels[channel] for channel in one.assignment.channels)
        takes = all(take_reason(channel, contents.tempo_map) for channel in own)
        rows.append(ImportRow(msgspec.structs.replace(one.assignment, clean=takes), one.playable))
    return tuple(rows)


def cleaning(rows: Sequence[ImportRow], clean: bool) -> tuple[ImportRow, ...]:
    """Return the rows with cleaning of their notes switched on or off for all."""
    return tuple(
        msgspec.structs.replace(row, assignment=msgspec.structs.replace(row.assignment, clean=clean)) for row in rows
    )


def merged(rows: Sequence[ImportRow], places: Sequence[int]) -> tuple[ImportRow, ...]:
    """Merge the rows with the indices ``places`` into one, at the place of the first of them; it plays all their
    tracks."""
    first, *others = sorted(places)
    channels = tuple(channel for place in (first, *others) for channel in rows[place].assignment.channels)
    together = msgspec.structs.replace(
        rows[first],
        assignment=msgspec.structs.replace(rows[first].assignment, channels=channels, voice_maps=()),
        requested=True,
    )
    gone = set(others)
    return tuple(together if place == first else row for place, row in enumerate(rows) if place not in gone)


def carried_over(
    rows: Sequence[ImportRow],
    usual: Sequence[ImportRow],
    contents: PieceContents,
    again: PieceContents,
    usual_again: Sequence[ImportRow],
) -> tuple[ImportRow, ...]:
    """Return the rows after the texts of a file were decoded again: rows changed by the user stay, the others get the
    new defaults.

    Parameters
    ----------
    usual, usual_again : sequence of ImportRow
        Default rows of ``contents`` and of ``again``.
    """
    now = {channel.place: index for index, channel in enumerate(again.channels)}
    by_default = {row.assignment.channels: row for row in usual}
    kept: list[ImportRow] = []
    for row in rows:
        places = [now.get(contents.channels[channel].place) for channel in row.assignment.channels]
        channels = tuple(place for place in places if place is not None)
        if channels and row != by_default.get(row.assignment.channels):
            kept.append(
                msgspec.structs.replace(row, assignment=msgspec.structs.replace(row.assignment, channels=channels))
            )
    chosen = {channel for row in kept for channel in row.assignment.channels}
    kept += (row for row in usual_again if chosen.isdisjoint(row.assignment.channels))
    return tuple(sorted(kept, key=lambda row: row.assignment.channels[0]))


def separated(rows: Sequence[ImportRow], place: int) -> tuple[ImportRow, ...]:
    """Split the row with the index ``place`` into one row for each of its tracks."""
    row = rows[place]
    alone = tuple(
        msgspec.structs.replace(
            row, assignment=msgspec.structs.replace(row.assignment, channels=(channel,), name="", voice_maps=())
        )
        for channel in row.assignment.channels
    )
    return (*rows[:place], *alone, *rows[place + 1 :])


class ImportPreview(msgspec.Struct, frozen=True):
    """Preview of an import.

    Attributes
    ----------
    players : int
        Number of musicians; one with several instruments counts once.
    instruments : dict of PartAssignment to tuple of str
        Ids of the instrument maps for each assignment (without its name).
    """

    players: int
    warnings: tuple[Message, ...]
    unplayed: tuple[UnplayedPart, ...]
    instruments: dict[PartAssignment, tuple[str, ...]]

    def instruments_of(self, assignment: PartAssignment) -> tuple[str, ...]:
        """Return the ids of the instrument maps of an assignment; empty if not known yet."""
        return self.instruments.get(_unnamed(assignment), ())


def outcome_of(
    contents: PieceContents,
    rows: Sequence[ImportRow],
    maps: Mapping[str, InstrumentMap],
    before: ImportPreview | None = None,
    stop_requested: StopRequested = lambda: False,
) -> ImportPreview:
    """Return a preview of importing the rows.

    Parameters
    ----------
    before : ImportPreview, optional
        Previous preview of the same file, whose unchanged rows are reused.
    stop_requested : callable
        Called repeatedly; once it returns True, Cancelled is raised.
    """
    score = score_of_rows(contents, rows, maps, stop_requested)
    known = {} if before is None else before.instruments
    instruments: dict[PartAssignment, tuple[str, ...]] = {}
    for row in rows:
        for assignment in (_unnamed(row.assignment), _unnamed(automatic(row.assignment))):
            if assignment not in instruments:
                instruments[assignment] = known.get(assignment) or _instruments(
                    contents, assignment, maps, stop_requested
                )
    doubled = doubled_parts(score.parts, maps, score.tempo_map)
    return ImportPreview(len(score.parts) - len(doubled), score.warnings, score.unplayed, instruments)


def automatic(assignment: PartAssignment) -> PartAssignment:
    """Return an assignment without the user's choice of instruments, so that names, programs and ranges decide."""
    return msgspec.structs.replace(assignment, map_id=None, voice_maps=())


def _unnamed(assignment: PartAssignment) -> PartAssignment:
    return msgspec.structs.replace(assignment, name="")


def _instruments(
    contents: PieceContents,
    assignment: PartAssignment,
    maps: Mapping[str, InstrumentMap],
    stop_requested: StopRequested,
) -> tuple[str, ...]:
    """Return the ids of the instruments that would play the tracks of an assignment, one for each resulting part."""
    # As if the file contained no other parts.
    own = msgspec.structs.replace(
        contents, channels=tuple(contents.channels[channel] for channel in assignment.channels)
    )
    alone = msgspec.structs.replace(assignment, channels=tuple(range(len(assignment.channels))))
    return tuple(part.map_id for part in score_of_rows(own, [ImportRow(alone)], maps, stop_requested).parts)


def score_of_rows(
    contents: PieceContents,
    rows: Sequence[ImportRow],
    maps: Mapping[str, InstrumentMap],
    stop_requested: StopRequested = lambda: False,
) -> Score:
    """Return the score with the parts of the requested rows. Raises Cancelled once ``stop_requested`` returns True."""
    return assigned_score(
        contents,
        [row.assignment for row in rows if row.requested or row.assignment.map_id == PERCUSSION],
        map_choices(maps.values()),
        stop_requested,
    )


def import_project(
    contents: PieceContents,
    rows: Sequence[ImportRow],
    maps: Mapping[str, InstrumentMap],
    source: str = "",
    stop_requested: StopRequested = lambda: False,
    *,
    encoding: str | None = None,
    seed: int = 0,
    outfit: str | None = None,
) -> Project:
    """Create a project with players for the requested rows. All rows are stored for later readings of the file.

    Parameters
    ----------
    source : str
        Absolute path of the MIDI file.
    stop_requested : callable
        Called repeatedly; once it returns True, Cancelled is raised.
    encoding : str, optional
        Encoding with which the contents were read.
    outfit : str, optional
        Outfit of all players, as in `ImportRequest`.
    """
    project = project_from_score(score_of_rows(contents, rows, maps, stop_requested), maps, seed=seed)
    characters = {}
    for row in rows:
        if row.requested and row.character_id is not None:
            first = contents.channels[row.assignment.channels[0]]
            characters[first.place] = row.character_id
    players = []
    for player in project.players:
        # A musician with several instruments is the character chosen for the first instrument that has one.
        places = [project.part(one).place for one in project.played_by(player)]
        character = next((characters[place] for place in places if place in characters), player.character_id)
        players.append(msgspec.structs.replace(player, character_id=character))
    worn = outfit_of_piece(contents, len(project.bodies)) if outfit is None else outfit
    cast = with_outfit(replace(project, players=tuple(players)), worn)
    return replace(cast, source=source, imported=decisions_of(contents, rows, encoding))


def decisions_of(contents: PieceContents, rows: Sequence[ImportRow], encoding: str | None = None) -> ImportDecisions:
    """Return the decisions that a user made in an import, as they are stored with the project."""
    quarter = contents.tempo_map.ticks_per_quarter
    return ImportDecisions(
        encoding,
        tuple(
            decision_of(row, (mark_of(contents.channels[channel], quarter) for channel in row.assignment.channels))
            for row in rows
        ),
    )


def decision_of(row: ImportRow, marks: Iterable[TrackMark]) -> RowDecision:
    """Return the stored form of an import row, with the marks of its channels."""
    chosen = row.assignment
    return RowDecision(
        tuple(marks),
        row.requested,
        chosen.map_id,
        chosen.name,
        chosen.split,
        chosen.written,
        row.character_id,
        chosen.solos,
        chosen.clean,
        chosen.voice_maps,
    )
