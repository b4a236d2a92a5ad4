"""Summary of an export as a table: the written files and their quality."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final

from app.contacts.bounds import GRIP_MM, TOUCH_MM, Spread
from app.encoding import shown
from app.errors import Message
from app.export.measure import PlayerMeasures
from app.export.report import (
    BONES_BOUND_MM,
    SLIDE_BOUND_MM_S,
    DancerReport,
    DoubleReport,
    PlayerReport,
    Report,
    failures,
)
from app.messages import filled, text

if TYPE_CHECKING:
    from app.export.target import SkeletonChoice
    from app.export.unreal.project import UnrealProject
    from app.export.unreal.run import UnrealExport

_DANCE_HEAD = ("dancer", "steps", "standing s", "slide mm/s", "bones mm")
_HEAD = (
    "player",
    "notes",
    "controls",
    "fingers mm",
    "grips mm",
    "lips mm",
    "feet mm",
    "penetration mm",
    "arms mm",
    "breaths",
    "sway",
)


def summary(report: Report, folder: Path) -> list[str]:
    """The table of measures, what was written, what is not played and what to look at."""
    lines = [
        filled("{count} {count:file|files} in {folder}: ", {"count": report.file_count, "folder": folder})
        + f"{report.frames} frames at {report.fps_exact} frames/s; "
        f"frame 0 is {_from_start(report.first_frame_s)}"
    ]
    if report.keys == "reduced":
        lines += [f"reduced keys: {100.0 * share_of_keys(report):.1f} % of those on every frame"]
    return [*lines, *_judgement(report)]


def _from_start(time_s: float) -> str:
    return f"{-time_s:.3f} s before the piece begins" if time_s < 0.0 else f"{time_s:.3f} s into the piece"


def share_of_keys(report: Report) -> float:
    """Return how many keys were written, of those that would be on every frame."""
    counts = [player.keys for player in report.players] + [dancer.keys for dancer in report.dancers]
    counts += [double.keys for player in report.players for double in player.doubles]
    known = [count for count in counts if count is not None]
    return sum(count.written for count in known) / max(sum(count.every for count in known), 1)


_SKELETONS: Final[dict[SkeletonChoice, str]] = {
    "own": "the characters' own",
    "ue5": "Unreal Engine 5's mannequin",
    "suisou": "ours",
}


def project_summary(written: UnrealExport, project: UnrealProject, skeleton: SkeletonChoice, chosen: bool) -> list[str]:
    """The tree of what is in an Unreal project now, on which skeleton, and what `summary` says of it.

    Parameters
    ----------
    chosen : bool
        Whether the skeleton was; otherwise it is said how another is.
    """
    plan, report = written.plan, written.report
    engine = f"Unreal Engine {project.engine}" if project.version is not None else "unknown engine version"
    lines = [
        f"{shown(project.file)} ({engine}): {report.frames} frames at {report.fps_exact} frames/s; "
        "the sound starts with the first one",
        *tree(plan.written, lambda path: " (replaced)" if path in plan.replaced else ""),
    ]
    other = "" if chosen else " (--skeleton own: the characters' own)"
    lines += [f"skeleton: {_SKELETONS[skeleton]}{other}"]
    lines += [f"removed: {path}" for path in plan.removed]
    lines += [text(message) for message in plan.kept]
    lines += [
        f"in Unreal: Suisou > Import Performance, or Update Performance; the assets come to {plan.layout.content}"
    ]
    return [*lines, *_judgement(report)]


def tree(paths: Iterable[PurePosixPath], mark: Callable[[PurePosixPath], str] = lambda path: "") -> list[str]:
    """Files as a tree, two blanks a level; folders have a slash."""
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
    """The table of measures, what is not played and what to look at."""
    lines: list[str] = []
    if any(player.measures is not None for player in report.players):
        played: list[PlayerReport | DoubleReport] = []
        for player in report.players:
            played += [player, *player.doubles]
        lines += ["", *columns([_HEAD, *map(_row, played)])]
        lines += [
            "(greatest distance at any frame of a sounding note, on the meshes read back; arms: depth of forearms in "
            "trunk and clothes; * beyond its bound)"
        ]
        for one in played:
            wrong = failures(one)
            if wrong:
                lines.append(f"! {one.name}: {', '.join(wrong)}")
    if any(dancer.measures is not None for dancer in report.dancers):
        lines += ["", *columns([_DANCE_HEAD, *(_dance_row(dancer) for dancer in report.dancers)])]
        lines += ["(feet that stand, and bones, of the files read back; * beyond its bound)"]
    if report.left_out:
        lines += ["", "excluded:", *(f"  {one.player}: {one.reason}" for one in report.left_out)]
    if report.unplayed:
        lines += ["", "not played:"]
        lines += [
            f"  {part.name} ({filled('{count} {count:note|notes}', {'count': part.note_count})}): {part.reason}"
            for part in report.unplayed
        ]
    return [*lines, *look_at(report.warnings, report.ignored_problems)]


def look_at(warnings: Sequence[str], ignored: int = 0) -> list[str]:
    """Warnings to look at, after an empty line, and the number of ignored problems that are not among them; nothing if
    there are none of either."""
    lines = ["to look at:", *(f"  {warning}" for warning in warnings)] if warnings else []
    if ignored:
        lines.append(f"{text(Message('problem.ignored', {'count': ignored}))} (--ignored)")
    return ["", *lines] if lines else []


def columns(rows: Iterable[tuple[str, ...]], of_numbers: bool = True, names: int = 1) -> list[str]:
    """Rows as columns two spaces apart; all but the first ``names`` are ``of_numbers``, on the right of their
    columns."""
    table = [tuple(map(shown, row)) for row in rows]
    widths = [max(len(row[column]) for row in table) for column in range(len(table[0]))]
    placed = [str.ljust] * names + [str.rjust if of_numbers else str.ljust] * (len(widths) - names)
    return [
        "  ".join(place(cell, width) for place, cell, width in zip(placed, row, widths, strict=True)).rstrip()
        for row in table
    ]


def _row(player: PlayerReport | DoubleReport) -> tuple[str, ...]:
    measures = player.measures
    if measures is None:
        return (player.name, str(player.notes), *[""] * (len(_HEAD) - 2))
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
        _worst([measures.lips]),
        _worst(measures.feet.values()),
        _worst([measures.penetration]),
        f"{measures.arms.depth_mm:.1f}{'' if measures.arms.kept else '*'}",
        f"{measures.breaths.shown}/{measures.breaths.planned}",
        sway,
    )


def _dance_row(dancer: DancerReport) -> tuple[str, ...]:
    measures = dancer.measures
    if measures is None:
        return (dancer.name, str(dancer.steps), *[""] * (len(_DANCE_HEAD) - 2))
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
