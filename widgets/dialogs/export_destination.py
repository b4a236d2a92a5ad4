"""Destination of an export (a folder or an Unreal project), and writing to it."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from app.errors import Message
from app.export.report import Report
from app.export.request import ExportRequest
from app.export.run import export
from app.export.unreal.project import UnrealProject, find_project
from app.export.unreal.run import export_into
from app.messages import text
from widgets.common.text import message_text

Destination = Literal["folder", "unreal"]


@dataclass(frozen=True)
class Done:
    """Result of an export: number of files, folder, excluded players, warnings, and the Unreal project if it is one.

    ``new_plugin`` is True if the project got a plug-in that the Unreal editor loads only when it starts.
    """

    count: int
    folder: Path
    left_out: tuple[Message, ...]
    warnings: tuple[str, ...]
    project: UnrealProject | None = None
    new_plugin: bool = False


def write(
    destination: Destination,
    request: ExportRequest,
    stop_requested: Callable[[], bool],
    progress: Callable[[float, str], None],
) -> Done:
    """Write an export to its destination. Texts in files are English as on the command line; the result is in the
    editor's language.
    """
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
    """Return the warnings of a report after the number of ignored problems."""
    if not report.ignored_problems:
        return report.warnings
    return message_text(Message("problem.ignored", {"count": report.ignored_problems})), *report.warnings


def _left_out(report: Report) -> tuple[Message, ...]:
    return tuple(Message("player.left_out", {"player": one.player, "reason": one.reason}) for one in report.left_out)


class Written:
    """Progress of an export, set by the exporting thread and read by the dialog.

    Parameters
    ----------
    performers : collection of str
        Names of the exported performers.

    Attributes
    ----------
    share : float
        Completed share, 0..1.
    label : str
        Current performer or file.
    """

    def __init__(self, performers: Collection[str]) -> None:
        self.performers, self.share, self.label = performers, 0.0, ""
        self._begun: dict[str, int] = {}

    def report(self, share: float, label: str) -> None:
        """Store the completed share and the current label."""
        if label in self.performers:
            self._begun.setdefault(label, len(self._begun) + 1)
        self.share, self.label = share, label

    @property
    def number(self) -> int | None:
        """Return the number of the current performer in the order of starting, from 1; None while a file of several
        performers is written.
        """
        return self._begun.get(self.label)
