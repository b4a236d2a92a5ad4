"""Remarks about earlier exports in a folder: with other bars, or of the same music under another name."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import msgspec

from app.errors import FileError, Message
from app.export.file_names import REPORT
from app.export.unreal.layout import DESCRIPTION, SOURCES, Layout
from app.formats.files import read_file
from app.formats.json_data import decode_json
from app.project.model import Project

MOST_BYTES: Final = 2**26
MOST_PIECES: Final = 64
"""Greatest number of pieces of an Unreal project that are examined."""


class _EarlierReport(msgspec.Struct, frozen=True):
    """The exported bars in the ``report.json`` of an earlier export; None for the whole piece."""

    bars: tuple[int, int] | None


class _Named(msgspec.Struct, frozen=True):
    name: str
    instrument_id: str


class _EarlierTempo(msgspec.Struct, frozen=True):
    tick: int
    quarters_per_minute: float


class _EarlierMetre(msgspec.Struct, frozen=True):
    tick: int
    numerator: int
    denominator: int


class _EarlierPerformance(msgspec.Struct, frozen=True):
    """Fields of a ``performance.json`` of an earlier export, by which it is recognised as one of the same piece."""

    players: tuple[_Named, ...]
    ticks_per_quarter: int
    pickup_ticks: int
    tempo: tuple[_EarlierTempo, ...]
    metres: tuple[_EarlierMetre, ...]


def other_bars(folder: Path, bars: tuple[int, int] | None) -> Message | None:
    """Return a remark if the earlier export in a folder has other bars than ``bars`` (first and last; None for the
    whole piece); None if there is nothing to remark.
    """
    try:
        there = decode_json(read_file(folder / REPORT, MOST_BYTES), _EarlierReport, REPORT).bars
    except (OSError, FileError):
        # No report, or not one of ours: nothing is known of the files there.
        return None
    if there == bars:
        return None
    if there is None or bars is None:
        first, last = there or bars or (0, 0)
        return Message(f"export.{'whole_before' if there is None else 'bars_before'}", {"first": first, "last": last})
    return Message(
        "export.other_bars_before",
        {"first": there[0], "last": there[1], "new_first": bars[0], "new_last": bars[1]},
    )


def same_music(project_folder: Path, layout: Layout, project: Project) -> Message | None:
    """Return a remark if an Unreal project contains the same music under another name, and not under its own.

    Music is the same if tempo map, metres and at least one player (name and instrument) are equal.
    """
    sources = project_folder / SOURCES
    if os.path.exists(sources / layout.piece / DESCRIPTION) or not os.path.isdir(sources):
        return None
    try:
        names = sorted(path.name for path in sources.iterdir())[:MOST_PIECES]
    except OSError:
        return None
    for name in names:
        try:
            content = read_file(sources / name / DESCRIPTION, MOST_BYTES)
            earlier = decode_json(content, _EarlierPerformance, DESCRIPTION)
        except (OSError, FileError):
            continue
        if _is_same(earlier, project):
            return Message("unreal.second_performance", {"piece": layout.piece, "earlier": name})
    return None


def _is_same(earlier: _EarlierPerformance, project: Project) -> bool:
    score = project.score
    now = (
        score.ticks_per_quarter,
        score.pickup_ticks,
        [(one.tick, round(60e6 / one.microseconds_per_quarter, 3)) for one in score.tempo_map.changes],
        [(one.tick, one.numerator, one.denominator) for one in score.metres],
    )
    before = (
        earlier.ticks_per_quarter,
        earlier.pickup_ticks,
        [(one.tick, round(one.quarters_per_minute, 3)) for one in earlier.tempo],
        [(one.tick, one.numerator, one.denominator) for one in earlier.metres],
    )
    players = {(player.name, player.instrument_id) for player in project.players}
    return now == before and any((one.name, one.instrument_id) in players for one in earlier.players)
