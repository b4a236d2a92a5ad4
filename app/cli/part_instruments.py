"""Parts of a MIDI file without an instrument, and options that assign instruments and pitches to parts."""

from __future__ import annotations

import argparse
import os
import re
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

import msgspec

from app.encoding import shown
from app.errors import Message, UsageError
from app.project.importing import ImportRow, score_of_rows
from app.project.names import unique_names
from app.project.parameters import select_players
from app.score.assignments import PERCUSSION
from app.score.contents import PieceContents
from app.score.instrument_choice import How, MapCandidates, MapChoice, candidates, require_map
from app.score.parts import stream_name
from app.score.track_channel import TrackChannel
from app.score.track_instrument import use_of
from instrument_maps.model import InstrumentMap

_SPECIAL: Final = re.compile(r'["$`\\!]')
"""Characters with a special meaning between double quotes in a shell."""


class Unassigned(NamedTuple):
    """A part of a MIDI file whose instrument is unknown: it is not played, or by an instrument with a suitable range.

    Attributes
    ----------
    part : str
        Name of the part for ``--assign``.
    map_id : str
        Instrument with the best fitting range.
    """

    part: str
    map_id: str


def unassigned_parts(
    channels: Sequence[TrackChannel], rows: Sequence[ImportRow], maps: Sequence[MapChoice], of_others: bool = False
) -> tuple[Unassigned, ...]:
    """Return the melodic parts whose instrument neither the file nor the user names, in the order of the file; with
    ``of_others``, the parts for instruments without a map, such as a piano."""
    found = []
    for row, name in zip(rows, part_names(channels, rows), strict=True):
        played = [channels[index] for index in row.assignment.channels]
        if row.assignment.map_id is None and all(use_of(channel) == "melodic" for channel in played):
            possible = candidates(played, maps)
            if of_others and not possible.maps:
                possible = MapCandidates(How.RANGE, None, tuple(maps))
            elif of_others or possible.how is not How.RANGE or not possible.maps:
                continue
            pitches = [pitch for channel in played for pitch in channel.pitches]
            found.append(Unassigned(name, possible.best(pitches).map_id))
    return tuple(found)


def part_names(channels: Sequence[TrackChannel], rows: Sequence[ImportRow]) -> tuple[str, ...]:
    """Return the names of the parts for ``--assign``: the name of the first stream of each row."""
    return unique_names(stream_name(channels[row.assignment.channels[0]]) for row in rows)


def with_pitches(
    contents: PieceContents,
    rows: Sequence[ImportRow],
    names: Sequence[str],
    written: bool,
    maps: Mapping[str, InstrumentMap],
) -> Sequence[ImportRow]:
    """Return the rows of an import with the pitches of some players interpreted as written or as sounding."""
    parts = score_of_rows(contents, rows, maps).parts
    places = {parts[index].place for index in select_players(names, unique_names(part.name for part in parts))}
    return [
        msgspec.structs.replace(row, assignment=msgspec.structs.replace(row.assignment, written=written))
        if contents.channels[row.assignment.channels[0]].place in places
        else row
        for row in rows
    ]


def with_instruments(
    channels: Sequence[TrackChannel], rows: Sequence[ImportRow], texts: Sequence[str], maps: Sequence[str]
) -> Sequence[ImportRow]:
    """Return the rows of an import with instruments assigned by texts ``PART=INSTRUMENT``; a row has the name of its
    first stream.

    Raises
    ------
    UsageError
        A text is malformed, or names an unknown instrument or part.
    """
    names = part_names(channels, rows) if texts else ()
    assigned = list(rows)
    for text in texts:
        part, equals, map_id = (piece.strip() for piece in text.rpartition("="))
        if not (part and equals and map_id):
            raise UsageError("assign.malformed", assignment=text)
        require_map(map_id, [*maps, PERCUSSION])
        for index in select_players([part], names):
            asked = msgspec.structs.replace(rows[index].assignment, map_id=map_id)
            assigned[index] = msgspec.structs.replace(rows[index], assignment=asked, requested=True)
    return assigned


def assign_message(arguments: argparse.Namespace, parts: Sequence[Unassigned], id: str = "assign.parts") -> Message:
    """Return a message with the parts, and the command line that was given extended by instruments for them.

    Parameters
    ----------
    id : str
        Message id: about parts without instruments, or about parts for instruments without a map.
    arguments : Namespace
        Arguments with ``file``, and ``given``, the command line.
    """
    added = [word for one in parts for word in _option(f"{one.part}={one.map_id}")]
    words = list(arguments.given)
    if getattr(arguments, "piece", None) is not None:
        # A piece of a folder; the other pieces have other parts.
        words = ["export", os.fspath(arguments.piece), "--to", os.fspath(arguments.to)]
    named = ", ".join(one.part for one in parts)
    command = shown(_joined(["suisou", *words, *added]))
    return Message(id, {"file": shown(arguments.file), "parts": named, "command": command})


def _option(value: str) -> tuple[str, ...]:
    """Return the command-line words for ``--assign`` with a value, joined if the value begins with a hyphen and would
    be read as an option."""
    return (f"--assign={value}",) if value.startswith("-") else ("--assign", value)


def _joined(words: Sequence[str]) -> str:
    """Return command-line words joined to one text that the shell of this system splits into the same words."""
    return subprocess.list2cmdline(words) if os.name == "nt" else " ".join(map(_quoted, words))


def _quoted(word: str) -> str:
    """Return a word of a command line in the most readable quotes of this system's shell."""
    return f'"{word}"' if "'" in word and not _SPECIAL.search(word) else shlex.quote(word)
