"""Summary of an export as a table: the written files and their quality."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final

from app.cli.speech import said, sentence
from app.cli.widths import on_left, on_right, width
from app.contacts.bounds import GRIP_MM, TOUCH_MM, Spread
from app.encoding import shown
from app.export.joint_measures import BEYOND_DEG
from app.export.measure import PlayerMeasures
from app.export.report import (
    BONES_BOUND_MM,
    SLIDE_BOUND_MM_S,
    DancerReport,
    DoubleReport,
    PlayerReport,
    Report,
    failures,
    missed_by_hold,
)

if TYPE_CHECKING:
    from app.export.target import SkeletonChoice
    from app.export.unreal.project import UnrealProject
    from app.export.unreal.run import UnrealExport

_MEASURES, _DANCE_MEASURES = 9, 3
"""Number of columns after a player's notes, and after a dancer's steps."""


def summary(report: Report, folder: Path) -> list[str]:
    """Return the table of measures, the written files, notes that are not played, and warnings."""
    lines = [
        said(
            "export_report.files",
            count=report.file_count,
            folder=str(folder),
            frames=report.frames,
            fps=report.fps_exact,
            place=_from_start(report.first_frame_s),
        )
    ]
    if report.keys != "every":
        lines += [said("export_report.reduced_keys", share=100.0 * share_of_keys(report))]
    return [*lines, *_judgement(report)]


def _from_start(time_s: float) -> str:
    return said("export_report.before_piece" if time_s < 0.0 else "export_report.into_piece", seconds=abs(time_s))


def share_of_keys(report: Report) -> float:
    """Return the written animation keys as a share of those that a key in every frame would give."""
    counts = [player.keys for player in report.players] + [dancer.keys for dancer in report.dancers]
    counts += [double.keys for player in report.players for double in player.doubles]
    known = [count for count in counts if count is not None]
    return sum(count.written for count in known) / max(sum(count.every for count in known), 1)


_SKELETONS: Final[dict[SkeletonChoice, str]] = {
    "own": "export_report.skeleton_own",
    "ue5": "export_report.skeleton_ue5",
    "suisou": "export_report.skeleton_suisou",
}


def project_summary(written: UnrealExport, project: UnrealProject, skeleton: SkeletonChoice, chosen: bool) -> list[str]:
    """Return the files of an Unreal project after an export as a tree, the skeleton, and `summary`.

    Parameters
    ----------
    chosen : bool
        Whether the user chose the skeleton; otherwise the option for choosing one is printed.
    """
    plan, report = written.plan, written.report
    known = project.version is not None
    engine = (
        said("export_report.engine", version=str(project.engine)) if known else said("export_report.engine_unknown")
    )
    lines = [
        said(
            "export_report.project",
            file=str(project.file),
            engine=engine,
            frames=report.frames,
            fps=report.fps_exact,
        ),
        *tree(plan.written, lambda path: said("export_report.replaced") if path in plan.replaced else ""),
    ]
    lines += [
        said(
            "export_report.skeleton" if chosen else "export_report.skeleton_or_own", skeleton=said(_SKELETONS[skeleton])
        )
    ]
    lines += [said("export_report.removed", path=str(path)) for path in plan.removed]
    lines += [sentence(message) for message in plan.kept]
    lines += [said("export_report.in_unreal", content=str(plan.layout.content))]
    return [*lines, *_judgement(report)]


def tree(paths: Iterable[PurePosixPath], mark: Callable[[PurePosixPath], str] = lambda path: "") -> list[str]:
    """Return files as a tree indented by two spaces a level; folders end with a slash."""
    lines: list[str] = []
    before: tuple[str, ...] = ()
    for path in paths:
        folders = path.parts[:-1]
        same = 0
        while same < min(len(folders), len(before)) and folders[same] == before[same]:
            same += 1
        lines += [f"{'  ' * (depth + 1)}{folders[depth]}/" for depth in range(same, len(folders))]
        lines.append(f"{'  ' * len(path.parts)}{path.name}{mark(path)}")
        before = folders
    return lines


def _judgement(report: Report) -> list[str]:
    """Return the table of measures, notes that are not played, and warnings."""
    lines: list[str] = []
    if any(player.measures is not None for player in report.players):
        played: list[PlayerReport | DoubleReport] = []
        for player in report.players:
            played += [player, *player.doubles]
        lines += ["", *columns([heads("export_report.heads"), *map(_row, played)])]
        lines += [said("export_report.measures", joints=BEYOND_DEG)]
        if any(one.measures is not None and one.measures.breaths.jaw_open is None for one in played):
            lines += [said("export_report.mouth_left_out")]
        guessed = [one.name for one in played if one.measures is not None and one.measures.lips_guessed]
        if guessed:
            lines += [said("export_report.lips_guessed", names=", ".join(guessed))]
        lines += [f"! {one.name}: {', '.join(wrong)}" for one in played if (wrong := _beyond(one))]
    if any(dancer.measures is not None for dancer in report.dancers):
        lines += [
            "",
            *columns([heads("export_report.dance_heads"), *(_dance_row(dancer) for dancer in report.dancers)]),
        ]
        lines += [said("export_report.dance_measures")]
    if report.left_out:
        lines += ["", said("export_report.excluded"), *(f"  {one.player}: {one.reason}" for one in report.left_out)]
    if report.unplayed:
        lines += ["", said("export_report.not_played")]
        lines += [
            f"  {said('export_report.part', name=part.name, count=part.note_count, reason=part.reason)}"
            for part in report.unplayed
        ]
    return [*lines, *look_at(report.warnings, report.ignored_problems)]


def _beyond(player: PlayerReport | DoubleReport) -> list[str]:
    """Return texts that name all measures of a player that are beyond their bounds, each with a mark in the table or
    without a column there.
    """
    wrong, held = list(failures(player)), missed_by_hold(player)
    if player.measures is not None and not player.measures.arms.kept:
        wrong.append("arms")
    return [*wrong, *([said("export_report.of_hold", names=", ".join(held))] if held else [])]


def look_at(warnings: Sequence[str], ignored: int = 0) -> list[str]:
    """Return lines of text with the warnings and the number of ignored problems; empty if there are none."""
    lines = [said("export_report.look_at"), *(f"  {warning}" for warning in warnings)] if warnings else []
    if ignored:
        lines.append(f"{said('problem.ignored', count=ignored)} (--ignored)")
    return ["", *lines] if lines else []


def heads(id: str) -> tuple[str, ...]:
    """Return the column headings of a table, which are one text with vertical bars between them."""
    return tuple(said(id).split("|"))


def columns(rows: Iterable[tuple[str, ...]], of_numbers: bool = True, names: int = 1) -> list[str]:
    """Return the rows of a table as lines, with columns two spaces apart.

    The columns after the first ``names`` are aligned right if ``of_numbers`` is set.
    """
    table = [tuple(map(shown, row)) for row in rows]
    widths = [max(width(row[column]) for row in table) for column in range(len(table[0]))]
    placed = [on_left] * names + [on_right if of_numbers else on_left] * (len(widths) - names)
    return [
        "  ".join(place(cell, wide) for place, cell, wide in zip(placed, row, widths, strict=True)).rstrip()
        for row in table
    ]


def _row(player: PlayerReport | DoubleReport) -> tuple[str, ...]:
    measures = player.measures
    if measures is None:
        return (player.name, str(player.notes), *[""] * _MEASURES)
    judged = sum(control.judged for control in measures.controls.values())
    right = sum(control.right for control in measures.controls.values())
    correlation = player.sway_correlation if isinstance(player, PlayerReport) else None
    sway = "" if correlation is None else f"{correlation:.2f}"
    return (
        player.name,
        str(player.notes),
        f"{right}/{judged}",
        _worst(_contacts(measures, TOUCH_MM)),
        _worst(_contacts(measures, GRIP_MM)),
        "?" if measures.lips_guessed and measures.lips.frames else _worst([measures.lips]),
        _worst(measures.feet.values()),
        _worst([measures.penetration]),
        f"{measures.arms.depth_mm:.1f}{'' if measures.arms.kept else '*'}",
        f"{measures.breaths.shown}/{measures.breaths.planned}",
        sway,
    )


def _dance_row(dancer: DancerReport) -> tuple[str, ...]:
    measures = dancer.measures
    if measures is None:
        return (dancer.name, str(dancer.steps), *[""] * _DANCE_MEASURES)
    return (
        dancer.name,
        str(dancer.steps),
        f"{measures.standing_s:.1f}",
        f"{measures.slide_mm_s:.2f}{'' if measures.slide_mm_s <= SLIDE_BOUND_MM_S else '*'}",
        f"{measures.bones_mm:.2f}{'' if measures.bones_mm <= BONES_BOUND_MM else '*'}",
    )


def _contacts(measures: PlayerMeasures, bound_mm: float) -> list[Spread]:
    return [spread for spread in measures.contacts.values() if spread.bound_mm == bound_mm]


def _worst(spreads: Iterable[Spread]) -> str:
    measured = [spread for spread in spreads if spread.frames]
    if not measured:
        return "-"
    worst = max(measured, key=lambda spread: spread.max_mm / spread.bound_mm)
    return f"{worst.max_mm:.2f}{'' if worst.kept else '*'}"
