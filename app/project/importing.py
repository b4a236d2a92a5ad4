"""From the tracks of a MIDI file to a project, as a person wishes: who plays what, on what, as whom."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import msgspec

from app.project.model import Project, map_choices, project_from_score
from app.score.model import Score
from app.score.parts import PartWish, usual_wishes
from app.score.read import MidiContents, wished_score
from instrument_maps.model import InstrumentMap


class ImportRow(msgspec.Struct, frozen=True):
    """Some tracks and who plays them.

    Attributes
    ----------
    wish : PartWish
    wanted : bool
        False: the tracks are left out.
    character_id : str or None
        None: chosen automatically.
    """

    wish: PartWish
    wanted: bool = True
    character_id: str | None = None


def usual_rows(contents: MidiContents, maps: Mapping[str, InstrumentMap]) -> tuple[ImportRow, ...]:
    """A row for every track, as it would be imported if nobody said anything."""
    played = {wish.streams[0] for wish in usual_wishes(contents.streams, map_choices(maps.values()))}
    return tuple(ImportRow(PartWish((index,)), index in played) for index in range(len(contents.streams)))


def merged(rows: Sequence[ImportRow], places: Sequence[int]) -> tuple[ImportRow, ...]:
    """The rows with those at some places made into one, where the first of them stood."""
    first, *others = sorted(places)
    streams = tuple(stream for place in (first, *others) for stream in rows[place].wish.streams)
    together = msgspec.structs.replace(
        rows[first], wish=msgspec.structs.replace(rows[first].wish, streams=streams), wanted=True
    )
    gone = set(others)
    return tuple(together if place == first else row for place, row in enumerate(rows) if place not in gone)


def separated(rows: Sequence[ImportRow], place: int) -> tuple[ImportRow, ...]:
    """The rows with the one at a place taken apart into its tracks."""
    row = rows[place]
    parts = tuple(
        msgspec.structs.replace(row, wish=msgspec.structs.replace(row.wish, streams=(stream,), name=""))
        for stream in row.wish.streams
    )
    return (*rows[:place], *parts, *rows[place + 1 :])


def score_of_rows(contents: MidiContents, rows: Sequence[ImportRow], maps: Mapping[str, InstrumentMap]) -> Score:
    """The score with the parts of the wanted rows."""
    return wished_score(contents, [row.wish for row in rows if row.wanted], map_choices(maps.values()))


def import_project(
    contents: MidiContents, rows: Sequence[ImportRow], maps: Mapping[str, InstrumentMap], source: str = ""
) -> Project:
    """A project in which the wanted rows are played.

    Parameters
    ----------
    source : str
        Absolute path of the MIDI file.
    """
    project = project_from_score(score_of_rows(contents, rows, maps), maps)
    characters = {}
    for row in rows:
        if row.wanted and row.character_id is not None:
            first = contents.streams[row.wish.streams[0]]
            characters[first.track, first.channel] = row.character_id
    players = []
    for player in project.players:
        part = project.part(player)
        character = characters.get((part.track, part.channel), player.character_id)
        players.append(msgspec.structs.replace(player, character_id=character))
    return replace(project, players=tuple(players), source=source)
