"""Controllers of a part whose file is read again: what was edited here stays where the file says the same as before."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from app.score.model import ControllerCurve, CurveKind


@dataclass(frozen=True)
class MergedCurves:
    """The controllers of the new part.

    Attributes
    ----------
    replaced : bool
        Some were edited here and in the file: the file's are taken.
    """

    curves: tuple[ControllerCurve, ...]
    replaced: bool = False


def merged_curves(
    ours: Sequence[ControllerCurve],
    read: Sequence[ControllerCurve],
    file: Sequence[ControllerCurve],
    place: Callable[[int], int],
) -> MergedCurves:
    """Three-way merge of each controller: ours where the file did not change it, else the file's.

    Parameters
    ----------
    ours, read, file : sequence of ControllerCurve
        As they are here, as the file had them, and as it has them now.
    place : callable
        Where a tick of the former score is now.
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
    """A curve where its music is now; of points that come together the last one holds."""
    points = {max(place(tick), 0): value for tick, value in zip(curve.ticks, curve.values, strict=True)}
    return ControllerCurve(curve.kind, tuple(points), tuple(points.values()))


def _by_kind(curves: Sequence[ControllerCurve]) -> dict[CurveKind, ControllerCurve]:
    return {curve.kind: curve for curve in curves}
