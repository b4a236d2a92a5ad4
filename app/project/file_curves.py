"""Merging of controllers when a part's file is read again: edits stay where the file is unchanged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from app.score.model import ControllerCurve, CurveKind


@dataclass(frozen=True)
class MergedCurves:
    """Merged controllers of a part.

    Attributes
    ----------
    replaced : bool
        Whether curves were edited both in the project and in the file; the file's are used.
    """

    curves: tuple[ControllerCurve, ...]
    replaced: bool = False


def merged_curves(
    ours: Sequence[ControllerCurve],
    read: Sequence[ControllerCurve],
    file: Sequence[ControllerCurve],
    place: Callable[[int], int],
) -> MergedCurves:
    """Merge each controller of three versions: the project's is used if the file did not change it, else the file's.

    Parameters
    ----------
    ours, read, file : sequence of ControllerCurve
        Curves in the project, in the file when last read, and in the file now.
    place : callable
        Function from ticks of the previous score to ticks of the new one.
    """
    mine, former, new = (_by_kind(curves) for curves in (ours, read, file))
    result, replaced = [], False
    for kind in dict.fromkeys((*mine, *former, *new)):
        here, before, now = mine.get(kind), former.get(kind), new.get(kind)
        if here != before:
            if now == before or (before is not None and now == moved_curve(before, place)):
                now = None if here is None else moved_curve(here, place)
            else:
                replaced = True
        if now is not None:
            result.append(now)
    return MergedCurves(tuple(result), replaced)


def moved_curve(curve: ControllerCurve, place: Callable[[int], int]) -> ControllerCurve:
    """Return a curve with its ticks converted by ``place``; of points that then coincide, the last one is used."""
    points = {max(place(tick), 0): value for tick, value in zip(curve.ticks, curve.values, strict=True)}
    return ControllerCurve(curve.kind, tuple(points), tuple(points.values()))


def _by_kind(curves: Sequence[ControllerCurve]) -> dict[CurveKind, ControllerCurve]:
    return {curve.kind: curve for curve in curves}
