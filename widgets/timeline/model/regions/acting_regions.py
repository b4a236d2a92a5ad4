"""Regions of the acting lane: cues, expressions, poses and gestures, each kind in rows of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.plan.events_by_hand import PoseEvent, StyleEvent
from app.plan.kinds import GESTURE_KINDS, GESTURES
from app.plan.model import CueEvent, ExpressionEvent, GestureEvent
from app.project.edit.events import OWN
from app.score.tempo import TempoMap
from widgets.timeline.model.geometry import packed_rows
from widgets.timeline.model.regions.shown_event import Region

_ROWS: Final = ("cue", "expression", "pose", "beside", "bell_height", "weight_shift", "feet", "sway", "lean", "accent")
"""Kinds in rows from the top; other kinds of gestures are below."""
ROW_OF: Final[Mapping[str, str]] = {
    **{kind.id: kind.row or kind.id for kind in GESTURES},
    **{kind: kind for kind in ("cue", "expression", "pose")},
}
"""The rows of every kind."""
GROUPS: Final = tuple(
    tuple(kind for kind, row in ROW_OF.items() if row == shared) for shared in dict.fromkeys((*_ROWS, *ROW_OF.values()))
)
"""Kinds that share rows, from the top."""
VARIED = "vary"
"""Kind of bars with another variation, in a row above all others that is visible only if there are any."""
STYLE = "style"
"""Kind of bars with another style, in a row that is visible only if there are any."""
STRIPS: Final = tuple(kind.id for kind in GESTURES if kind.look != "span")
"""Kinds so frequent that generated events are drawn as one dim strip."""
CURVES: Final = tuple(kind.id for kind in GESTURES if kind.look == "curve")
"""Kinds among these whose curve continues from the previous event."""
BASE = "expression:neutral"
"""Id of the underlying face for the whole piece, drawn as a thin line at the bottom of its row."""


class Names(NamedTuple):
    """Functions that return names of expressions, kinds of gestures, poses and so on in the user's language."""

    expression: Callable[[str], str]
    kind: Callable[[str], str]
    pose: Callable[[str], str]
    gesture: Callable[[str], str]
    style: Callable[[str], str]


def packed_group(members: Sequence[Region], clock: TempoMap) -> tuple[list[int], int]:
    """Assign the regions of a group to rows so that regions in one row do not overlap in time.

    Expressions that last throughout, below all others, are in the last row. Returns the row of each region and the
    number of rows; ``clock`` converts ticks to seconds.
    """
    packed = sorted(
        (*extent(region, clock), region.event_id, place)
        for place, region in enumerate(members)
        if region.event_id != BASE
    )
    spans = np.array([item[:2] for item in packed], np.float64).reshape(-1, 2)
    own = packed_rows(spans[:, 0], spans[:, 1])
    count = int(own.max(initial=0)) + 1
    rows = [count - 1] * len(members)
    for item, place in zip(packed, own.tolist(), strict=True):
        rows[item[3]] = place
    return rows, count


def entry_near(onset_ticks: FloatArray, near_tick: float, clock: TempoMap, reach_s: float) -> int | None:
    """Return the tick of the onset nearest to ``near_tick``; None if it is more than ``reach_s`` seconds away."""
    if not len(onset_ticks):
        return None
    nearest = float(onset_ticks[np.argmin(np.abs(onset_ticks - near_tick))])
    return int(nearest) if abs(clock.seconds(nearest) - clock.seconds(near_tick)) <= reach_s else None


def extent(region: Region, clock: TempoMap) -> tuple[float, float]:
    """Return the first and last tick of a region including fades outside of it; unlike its seconds they are exact, so
    that neighbours touch without overlapping.
    """
    start, end = float(region.start_tick), float(max(region.end_tick, region.start_tick + 1))
    if region.fades_outside:
        return min(start, clock.ticks(region.first_s)), max(end, clock.ticks(region.last_s))
    return start, end


def in_guest(region: Region) -> Region:
    """Mark a region as another player's, and return it."""
    region.guest = True
    return region


def cue_region(event: CueEvent, name: str, pattern: str) -> Region:
    """Return the region of a cue; ``pattern`` is its label with ``{name}`` for ``name``."""
    return Region(
        event.player_id, event.id, "cue", event.start_tick, event.end_tick, event.start_s, event.end_s,
        label=pattern.format(name=name), reason=event.reason, by_hand=event.corrected, steady=True,
        peak_s=event.peak_s,
    )  # fmt: skip


def expression_region(player_id: str, event: ExpressionEvent, names: Names) -> Region:
    """Return the region that displays a facial expression event in the lane."""
    return Region(
        player_id, event.id, "expression", event.start_tick, event.end_tick, event.start_s, event.end_s,
        amount=event.strength, label=names.expression(event.expression), reason=event.reason,
        by_hand=event.corrected, fade_in_s=event.fade_in_s, fade_out_s=event.fade_out_s,
        fades=event.id != BASE,
    )  # fmt: skip


def gesture_region(player_id: str, event: GestureEvent, names: Names) -> Region:
    """Return the region that displays a gesture event in the lane."""
    label = names.gesture(event.name) if event.part == "tracks" else names.kind(event.kind)
    return Region(
        player_id, event.id, event.kind, event.start_tick, event.end_tick, event.start_s, event.end_s,
        amount=event.amount, label=label, reason=event.reason, by_hand=event.corrected,
        signed=GESTURE_KINDS[event.kind].signed,
    )  # fmt: skip


def pose_region(player_id: str, event: PoseEvent, names: Names) -> Region:
    """Return the region that displays a pose event in the lane."""
    return Region(
        player_id, event.id, "pose", event.start_tick, event.end_tick, event.start_s, event.end_s,
        label=names.pose(event.target), reason=event.reason, by_hand=event.corrected, steady=True,
        fade_in_s=event.fade_in_s, fade_out_s=event.fade_out_s, fades=True, fades_outside=True,
    )  # fmt: skip


def style_region(player_id: str, event: StyleEvent, names: Names) -> Region:
    """Return the region that displays a span of bars played in another style."""
    return Region(
        player_id, event.id, STYLE, event.start_tick, event.end_tick, event.start_s, event.end_s,
        label=names.style(event.style), reason=event.reason, by_hand=event.corrected, steady=True,
        fade_in_s=event.fade_in_s, fade_out_s=event.fade_out_s, fades=True,
    )  # fmt: skip


def strip(regions: Sequence[Region], kind: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return starts (N,), ends (N,) and amounts (N,) of the events of a kind, such as sway, that are drawn as one
    strip; includes events that the user changed but not those added.
    """
    chosen = [
        region
        for region in regions
        if region.kind == kind and (not region.by_hand or (kind in CURVES and f":{OWN}" not in region.event_id))
    ]
    return (
        np.array([region.start_s for region in chosen], np.float64),
        np.array([region.end_s for region in chosen], np.float64),
        np.array([region.amount for region in chosen], np.float64),
    )
