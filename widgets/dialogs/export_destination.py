"""Destination of an export: a folder of files or an Unreal project; what it will find there, and how it is written."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from app.encoding import shown
from app.errors import Message
from app.export.earlier_exports import other_bars
from app.export.file_names import REPORT, file_names, sound_name, stage_names
from app.export.formats import Format
from app.export.report import Report
from app.export.request import ExportRequest
from app.export.run import export
from app.export.unreal.project import UnrealProject, find_project
from app.export.unreal.run import export_into, plan_export
from app.messages import text
from app.performance.ensemble import Performance
from widgets.common.text import message_text

Destination = Literal["folder", "unreal"]


@dataclass(frozen=True)
class Foreseen:
    """Files that an export will write, replace, remove or keep.

    Attributes
    ----------
    count : int
        Files that will be written.
    replaced, removed : tuple of str
        Names of files that are there.
    kept : tuple of Message
    remarks : tuple of Message
        What an earlier export has otherwise: other bars, or the same music under another name.
    project : UnrealProject or None
    """

    count: int
    replaced: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    kept: tuple[Message, ...] = ()
    remarks: tuple[Message, ...] = ()
    project: UnrealProject | None = None


@dataclass(frozen=True)
class Done:
    """The result of an export: the number of files, the folder to show, the excluded players, the warnings; whether
    Unreal has a plug-in now that it loads when its editor starts."""

    count: int
    folder: Path
    left_out: tuple[Message, ...]
    warnings: tuple[str, ...]
    project: UnrealProject | None = None
    new_plugin: bool = False


def foresee_unreal(
    place: Path, performance: Performance, player_ids: tuple[str, ...], source: str, bars: tuple[int, int] | None
) -> Foreseen:
    """Foresee an export of some bars (None: all) into an Unreal project, by its file or folder.

    Raises
    ------
    FileError
        There is no project, or files of another program are in the way.
    """
    unreal = find_project(place)
    plan = plan_export(performance, player_ids, source, unreal, by_length=True, bars=bars)
    return Foreseen(
        count=len(plan.written),
        replaced=tuple(shown(path.name) for path in plan.replaced),
        removed=tuple(shown(path.name) for path in plan.removed),
        kept=plan.kept,
        remarks=plan.remarks,
        project=unreal,
    )


def foresee_folder(
    folder: Path,
    performance: Performance,
    player_ids: tuple[str, ...],
    formats: frozenset[Format],
    source: str,
    sound: bool,
    stage: bool,
    *,
    bars: tuple[int, int] | None = None,
) -> Foreseen:
    """Foresee an export into a folder.

    Parameters
    ----------
    source : str
        Name of the piece's file.
    sound, stage : bool
        Whether the sound is written too, and the whole stage in one file.
    bars : (int, int) or None
        First and last bar that is exported; None: the whole piece.
    """
    names = file_names(performance, formats)
    project = performance.project
    # Of a musician also the other instruments.
    everything = [
        *player_ids,
        *(one.id for one in project.players if one.doubles in player_ids and project.musician(one) is not one),
    ]
    requested = [name for player_id in everything for name in names[player_id].values()] + [REPORT]
    if sound:
        requested.append(sound_name(source))
    if stage:
        requested += stage_names(performance, formats, source).values()
    replaced = tuple(name for name in requested if os.path.exists(folder / name))
    remark = other_bars(folder, bars) if replaced else None
    return Foreseen(len(requested), replaced, remarks=() if remark is None else (remark,))


def write(
    destination: Destination,
    request: ExportRequest,
    stop_requested: Callable[[], bool],
    progress: Callable[[float, str], None],
) -> Done:
    """Write an export; the request's folder is the place. Files are worded in English, as the command line words them,
    the result in the language of the editor."""
    if destination == "unreal":
        project = find_project(request.folder)
        written = export_into(request, project, text, stop_requested, progress, message_text)
        kept = tuple(message_text(message) for message in written.plan.kept)
        folder = project.folder / written.plan.layout.sources
        warnings = kept + _warnings(written.report)
        return Done(
            len(written.plan.written), folder, _left_out(written.report), warnings, project, bool(written.plan.plugin)
        )
    report = export(request, text, stop_requested, progress, message_text)
    return Done(report.file_count, request.folder, _left_out(report), _warnings(report))


def _warnings(report: Report) -> tuple[str, ...]:
    """Warnings of a report, after the number of the problems that the project ignores."""
    if not report.ignored_problems:
        return report.warnings
    return message_text(Message("problem.ignored", {"count": report.ignored_problems})), *report.warnings


def _left_out(report: Report) -> tuple[Message, ...]:
    return tuple(Message("player.left_out", {"player": one.player, "reason": one.reason}) for one in report.left_out)


class Written:
    """Progress of an export, noted by its thread.

    Parameters
    ----------
    performers : collection of str
        Names of the performers that files are written of.

    Attributes
    ----------
    share : float
        Share of the whole that is written.
    label : str
        The performer or file that was worked on last.
    """

    def __init__(self, performers: Collection[str]) -> None:
        self.performers, self.share, self.label = performers, 0.0, ""
        self._begun: dict[str, int] = {}

    def report(self, share: float, label: str) -> None:
        """Note how far it is, and what was worked on."""
        if label in self.performers:
            self._begun.setdefault(label, len(self._begun) + 1)
        self.share, self.label = share, label

    @property
    def number(self) -> int | None:
        """Place of the performer that was worked on last in the order of their beginning, from 1; None of a file of
        everyone."""
        return self._begun.get(self.label)
