"""Contents of the lane of additive curves: curves of a channel, positions of keys and handles, hit testing."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.errors import FileError
from app.formats.json_data import decode_json
from app.plan.by_hand.additive_curve import CHANNELS, AdditiveCurve, CurveKey
from app.plan.by_hand.additive_events import segments
from app.plan.by_hand.bezier import rows, sampled_rows
from app.plan.events_by_hand import CurveSegment
from app.project.edit.additive import Side, curves_of
from app.project.model import Project
from app.score.tempo import TempoMap
from widgets.timeline.model.gestures import Plane

REACH_PX: Final = 7.0
"""Distance in pixels within which a key, a handle or a blend is hit."""
LINE_REACH_PX: Final = 5.0
"""Distance in pixels within which a curve is hit."""
JOINS_BARS: Final = 1
"""Distance in bars from a curve's end within which a new key is added to that curve."""
LEAST_RANGE: Final = {"deg": 12.0, "m": 0.03, "weight": 1.0}
"""Least displayed distance from 0, by unit."""
AIR: Final = 1.25
DECIMALS: Final = {"deg": 1, "m": 3, "weight": 2}
"""Number of decimals of displayed values, by unit."""


class KeyRef(NamedTuple):
    """A key of an additive curve, identified by the curve's name and the key's tick."""

    name: str
    tick: int


class Hit(NamedTuple):
    """Part of an additive curve under the mouse.

    Attributes
    ----------
    what : {"key", "arrive", "leave", "blend_in", "blend_out", "curve"}
        A key, its left or right handle, the end of a fade, or the curve.
    name : str
        Name of the curve.
    tick : int
        Tick of the key; for a curve, that of its first key.
    """

    what: Literal["key", "arrive", "leave", "blend_in", "blend_out", "curve"]
    name: str
    tick: int

    @property
    def key(self) -> KeyRef:
        return KeyRef(self.name, self.tick)


BEYOND_STEP_S, BEYOND_SHARE = 0.01, 0.01
"""Step in seconds at which a curve is examined for values out of range, and the share of the range below which an
excess is not marked.
"""


@dataclass(frozen=True, eq=False)
class ShownCurve:
    """An additive curve at full weight, as displayed.

    Attributes
    ----------
    key_s : (K,) array
        Times of the keys.
    shape : tuple of CurveSegment
        Segments from the start of the fade-in to the end of the fade-out.
    table : (S, 9) array
        The S segments as an array.
    """

    curve: AdditiveCurve
    key_s: FloatArray
    shape: tuple[CurveSegment, ...]
    table: FloatArray

    @classmethod
    def of(cls, curve: AdditiveCurve, clock: TempoMap) -> ShownCurve:
        """Return the display form of one of the project's additive curves; ``clock`` converts its ticks."""
        shape = segments(msgspec.structs.replace(curve, weight=1.0), clock)
        key_s = np.array([clock.seconds(float(key.tick)) for key in curve.keys], np.float64)
        return cls(curve, key_s, shape, rows(shape))

    @property
    def start_s(self) -> float:
        """Start time of the fade-in in seconds."""
        return self.shape[0].start_s

    @property
    def end_s(self) -> float:
        """End time of the fade-out in seconds."""
        return self.shape[-1].end_s

    def values(self, times_s: FloatArray) -> FloatArray:
        """Values (N,) of the curve at ascending seconds (N,)."""
        return sampled_rows(self.table, times_s)

    def beyond_s(self, limits: tuple[float, float]) -> list[tuple[float, float]]:
        """Return the spans (start, end) in seconds, in order, in which the curve's values lie outside ``limits``."""
        if not self.curve.enabled or not self.shape:
            return []
        times_s = np.arange(self.start_s, self.end_s + BEYOND_STEP_S, BEYOND_STEP_S)
        values, (low, high) = self.curve.weight * self.values(times_s), limits
        slack = 1e-6 + BEYOND_SHARE * (high - low)
        outside = np.concatenate(([False], (values < low - slack) | (values > high + slack), [False]))
        turns = np.flatnonzero(outside[1:] != outside[:-1]).reshape(-1, 2)
        return [(float(times_s[first]), float(times_s[last - 1]) + BEYOND_STEP_S) for first, last in turns.tolist()]

    def handles(self, at: int) -> Iterable[tuple[Side, float, float]]:
        """Yield the handles of the key with index ``at``, each as side, time in seconds and value. Only sides with a
        Bézier segment have one.
        """
        start_s = float(self.key_s[at])
        for segment in self.shape:
            if segment.eased:
                continue
            before, after = segment.start_s == start_s, segment.end_s == start_s
            if before and self.curve.keys[at].interpolation == "bezier":
                yield "leave", segment.leave_s, segment.leave_value
            if after and self.curve.keys[at - 1].interpolation == "bezier":
                yield "arrive", segment.arrive_s, segment.arrive_value


def shown_curves(project: Project, player_id: str, channel: str) -> tuple[ShownCurve, ...]:
    """Return a player's additive curves of a channel that have keys, in order of time."""
    clock = project.score.tempo_map
    found = [ShownCurve.of(curve, clock) for curve in curves_of(project, player_id, channel) if curve.keys]
    return tuple(sorted(found, key=lambda shown: (shown.start_s, shown.curve.name)))


def vertical_range(channel: str, curves: Sequence[ShownCurve], generated: FloatArray | None) -> float:
    """Return the greatest displayed absolute value: it includes all keys, handles and generated values."""
    unit = CHANNELS[channel].unit
    most = LEAST_RANGE[unit]
    for shown in curves:
        for segment in shown.shape:
            values = (segment.before, segment.after, segment.leave_value, segment.arrive_value)
            most = max(most, AIR * max(map(abs, values)))
    if generated is not None and len(generated):
        most = max(most, AIR * float(np.max(np.abs(generated))))
    return most


def rounded(channel: str, value: float) -> float:
    """Return a value rounded to the decimals of its unit."""
    return round(value, DECIMALS[CHANNELS[channel].unit])


def hit(
    curves: Sequence[ShownCurve], selected: Collection[KeyRef], plane: Plane, x_px: float, y_px: float
) -> Hit | None:
    """Return the object at a point: handles of selected keys take precedence over keys, keys over fades and curves;
    among several the nearest.
    """
    found: list[tuple[int, float, Hit]] = []

    def near(rank: int, time_s: float, value: float, what: Hit) -> None:
        distance = float(np.hypot(plane.axis.x_px(time_s) - x_px, plane.y_px(value) - y_px))
        if distance <= REACH_PX:
            found.append((rank, distance, what))

    for shown in curves:
        name, first = shown.curve.name, shown.curve.keys[0].tick
        for at, key in enumerate(shown.curve.keys):
            if KeyRef(name, key.tick) in selected:
                for side, time_s, value in shown.handles(at):
                    near(1, time_s, value, Hit(side, name, key.tick))
            near(
                0 if KeyRef(name, key.tick) in selected else 2,
                float(shown.key_s[at]),
                key.value,
                Hit("key", name, key.tick),
            )
        near(3, shown.start_s, 0.0, Hit("blend_in", name, first))
        near(3, shown.end_s, 0.0, Hit("blend_out", name, shown.curve.keys[-1].tick))
        x = np.arange(x_px - LINE_REACH_PX, x_px + LINE_REACH_PX + 0.5)
        times_s = np.array([plane.axis.seconds(each) for each in x])
        inside = (times_s >= shown.start_s) & (times_s <= shown.end_s)
        if inside.any():
            y = np.array([plane.y_px(value) for value in shown.values(times_s)])
            distance = float(np.min(np.hypot(x - x_px, y - y_px)[inside]))
            if distance <= LINE_REACH_PX:
                found.append((4, distance, Hit("curve", name, first)))
    return min(found, key=lambda item: item[:2])[2] if found else None


def joined(curves: Sequence[ShownCurve], project: Project, tick: int, active: str | None) -> str | None:
    """Return the name of the curve that a new key at a tick is added to: the active one, else the nearest that covers
    or nearly reaches the tick.
    """
    metres = project.score.metre_map
    bar = metres.bar_of_tick(max(tick, 0))
    reach = JOINS_BARS * (metres.tick_of_bar(bar + 1) - metres.tick_of_bar(bar))
    near: list[tuple[int, bool, str]] = []
    for shown in curves:
        curve = shown.curve
        beside = max(curve.start_tick - tick, tick - curve.end_tick, 0)
        if beside <= reach:
            near.append((beside, curve.name != active, curve.name))
    return min(near)[2] if near else None


def keys_in(
    curves: Sequence[ShownCurve], plane: Plane, left: float, top: float, right: float, bottom: float
) -> frozenset[KeyRef]:
    """Return the keys of additive curves inside a rectangle of pixels."""
    return frozenset(
        KeyRef(shown.curve.name, key.tick)
        for shown in curves
        for key, time_s in zip(shown.curve.keys, shown.key_s.tolist(), strict=True)
        if left <= plane.axis.x_px(time_s) <= right and top <= plane.y_px(key.value) <= bottom
    )


def by_curve(keys: Iterable[KeyRef]) -> dict[str, frozenset[int]]:
    """Group keys by their curve: return the ticks of the keys by the name of the curve."""
    result: dict[str, set[int]] = {}
    for key in keys:
        result.setdefault(key.name, set()).add(key.tick)
    return {name: frozenset(ticks) for name, ticks in result.items()}


def chosen_keys(curves: Sequence[ShownCurve], selected: Collection[KeyRef]) -> tuple[CurveKey, ...]:
    """Return the selected keys of additive curves in order of time."""
    found = [key for shown in curves for key in shown.curve.keys if KeyRef(shown.curve.name, key.tick) in selected]
    return tuple(sorted(found, key=lambda key: key.tick))


def still_there(curves: Sequence[ShownCurve], selected: Collection[KeyRef]) -> frozenset[KeyRef]:
    """Return the selected keys that still exist."""
    known = {KeyRef(shown.curve.name, key.tick) for shown in curves for key in shown.curve.keys}
    return frozenset(selected) & known


def clip_text(channel: str, keys: Sequence[CurveKey]) -> bytes:
    """Return the clipboard contents (JSON) for copied keys of a channel."""
    return msgspec.json.encode(_Clip(channel, tuple(keys)))


def clip_keys(content: bytes, channel: str) -> tuple[CurveKey, ...]:
    """Return the keys in clipboard contents; empty if they are invalid or their unit differs from that of
    ``channel``.
    """
    try:
        clip = decode_json(content, _Clip, "")
    except FileError:
        return ()
    known: Mapping[str, object] = CHANNELS
    fits = clip.channel in known and CHANNELS[clip.channel].unit == CHANNELS[channel].unit
    return clip.keys if fits else ()


class _Clip(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    channel: str
    keys: tuple[CurveKey, ...]
