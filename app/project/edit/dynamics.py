"""Edits of dynamics curves, taken from a recording or corrected by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import msgspec
import numpy as np

from app.errors import UsageError
from app.project.edit.length import with_score
from app.project.model import Project
from app.score.model import ControllerCurve, CurveKind, Part

_RESOLUTION: Final = 127


def set_dynamics(project: Project, curves: Mapping[str, ControllerCurve]) -> Project:
    """Replace for each part, by part id, its controller curve of the same kind."""
    return _with_curves(
        project,
        {
            part.id: (*(curve for curve in part.curves if curve.kind != curves[part.id].kind), curves[part.id])
            for part in project.score.parts
            if part.id in curves
        },
    )


def change_level(
    project: Project, player_id: str, kind: CurveKind, spans: Sequence[tuple[int, int]], by: float, blend_beats: float
) -> Project:
    """Raise or lower a controller (by ``by``, -1..1) in some spans of ticks.

    Parameters
    ----------
    blend_beats : float
        Felt beats next to a span over which the curve returns to its previous values.

    Raises
    ------
    UsageError
        The part has no such controller.
    """
    part = project.part(project.player(player_id))
    curve = next((curve for curve in part.curves if curve.kind == kind), None)
    if curve is None:
        raise UsageError("dynamics.no_curve")
    if not spans or not by:
        return project
    changed = _shifted(curve, spans, by, blend_beats * project.metre_map.felt_ticks_at(spans[0][0]))
    if changed == curve:
        return project
    return _with_curves(project, {part.id: tuple(changed if item is curve else item for item in part.curves)})


def _shifted(
    curve: ControllerCurve, spans: Sequence[tuple[int, int]], by: float, blend_ticks: float
) -> ControllerCurve:
    ticks = np.array(curve.ticks, np.int64)
    # The blend has steps of its own, independent of the steps of the curve.
    ramp = np.unique(np.round(np.linspace(0.0, blend_ticks, 7)).astype(np.int64))
    edges = np.concatenate([np.concatenate((start - ramp, end + ramp)) for start, end in spans])
    places = np.unique(np.concatenate((ticks, edges[edges >= 0])))
    held = np.array(curve.values)[np.maximum(np.searchsorted(ticks, places, side="right") - 1, 0)]
    share = np.zeros(len(places))
    for start, end in spans:
        away = np.maximum(np.maximum(start - places, places - end), 0)
        share = np.maximum(share, 1.0 - away / max(blend_ticks, 1.0))
    low, high = curve.shown_range
    values = np.where(share > 0.0, np.round(np.clip(held + by * share, low, high) * _RESOLUTION) / _RESOLUTION, held)
    kept = np.append(True, np.diff(values) != 0.0)
    return ControllerCurve(curve.kind, tuple(places[kept].tolist()), tuple(values[kept].tolist()))


def _with_curves(project: Project, curves: Mapping[str, tuple[ControllerCurve, ...]]) -> Project:
    def changed(part: Part) -> Part:
        given = curves.get(part.id, part.curves)
        return part if given == part.curves else msgspec.structs.replace(part, curves=given)

    parts = tuple(changed(part) for part in project.score.parts)
    if all(one is other for one, other in zip(parts, project.score.parts, strict=True)):
        return project
    return with_score(project, msgspec.structs.replace(project.score, parts=parts))
