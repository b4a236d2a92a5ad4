"""Earlier exports in a folder: their files that stay there, and remarks about other bars or the same music under
another name.
"""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path
from typing import Final

import msgspec

from app.encoding import shown
from app.errors import FileError, Message
from app.export.file_names import REPORT
from app.export.report import EarlierFiles
from app.export.unreal.layout import DESCRIPTION, SOURCES, Layout
from app.formats.files import read_file
from app.formats.json_data import decode_json
from app.project.model import Project

MOST_BYTES: Final = 2**26
MOST_PIECES: Final = 64
"""Greatest number of pieces of an Unreal project that are examined."""


MOST_NAMED: Final = 5
"""Greatest number of files that a remark names."""


class _WithFiles(msgspec.Struct, frozen=True):
    """Fields of a performer or the stage in an earlier report: file names by content or format."""

    files: dict[str, str] = {}
    doubles: tuple[_WithFiles, ...] = ()


class _EarlierReport(msgspec.Struct, frozen=True):
    """Fields of the ``report.json`` of an earlier export: bars (None for the whole piece), time of the first frame,
    and files.
    """

    bars: tuple[int, int] | None
    first_frame_s: float = 0.0
    players: tuple[_WithFiles, ...] = ()
    dancers: tuple[_WithFiles, ...] = ()
    stage: _WithFiles | None = None
    sound: str | None = None
    earlier: tuple[EarlierFiles, ...] = ()

    @property
    def files(self) -> tuple[str, ...]:
        """Names of the animation and sound files that the export wrote, in order."""
        listed = [*self.players, *(double for player in self.players for double in player.doubles), *self.dancers]
        if self.stage is not None:
            listed.append(self.stage)
        names = [name for one in listed for name in one.files.values()]
        return (*names, *([] if self.sound is None else [self.sound]))


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


def files_that_stay(folder: Path, written: Collection[str]) -> tuple[EarlierFiles, ...]:
    """Return the files in a folder that the report of an earlier export lists and that are not among the names
    ``written`` now, by export from the newest to the oldest.
    """
    report = _report_in(folder)
    if report is None:
        return ()
    seen = {name.casefold() for name in written}
    found: list[EarlierFiles] = []
    for one in (EarlierFiles(report.bars, report.first_frame_s, report.files), *report.earlier):
        names = [name for name in one.files if name.casefold() not in seen and _is_file(folder, name)]
        seen.update(name.casefold() for name in names)
        if names:
            found.append(msgspec.structs.replace(one, files=tuple(names)))
    return tuple(found)


def remark_on_files_that_stay(folder: Path, written: Collection[str]) -> Message | None:
    """Return a remark that names the files of `files_that_stay`; None if there are none."""
    names = [shown(name) for one in files_that_stay(folder, written) for name in one.files]
    listed = ", ".join([*names[:MOST_NAMED], *(["…"] if len(names) > MOST_NAMED else [])])
    return Message("export.earlier_files_stay", {"count": len(names), "files": listed}) if names else None


def _is_file(folder: Path, name: str) -> bool:
    # The names come from a file: only those within the folder count.
    return Path(name).name == name and os.path.isfile(folder / name)


def _report_in(folder: Path) -> _EarlierReport | None:
    """Return the report of an earlier export in a folder; None if there is none of this program."""
    try:
        return decode_json(read_file(folder / REPORT, MOST_BYTES), _EarlierReport, REPORT)
    except (OSError, FileError):
        # Without a report of ours the origin of the files is unknown.
        return None


def other_bars(folder: Path, bars: tuple[int, int] | None) -> Message | None:
    """Return a remark if the earlier export in a folder has other bars than ``bars`` (first and last; None for the
    whole piece); None if there is nothing to remark.
    """
    report = _report_in(folder)
    if report is None:
        return None
    there = report.bars
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
