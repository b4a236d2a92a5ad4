"""Edits of additive curves: keys, handles, fades, weights.

Keys are identified by tick, curves by name. A key moved to the tick of another key replaces it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Final, Literal, TypeAlias

import msgspec

from app.plan.by_hand.additive_curve import CHANNELS, MOST_KEYS, AdditiveCurve, CurveKey, Interpolation, Tangent
from app.project import limits
from app.project.edit.corrections import take_back, with_corrections
from app.project.edit.found_events import OWN
from app.project.model import Project

Keys: TypeAlias = Mapping[str, Collection[int]]
"""Ticks of keys, by the name of their curve."""
Side: TypeAlias = Literal["arrive", "leave"]
BLEND_BEATS: Final = 1
"""Quarters over which a new curve fades in and out."""
DECIMALS: Final = 5


def curves_of(project: Project, player_id: str, channel: str | None = None) -> tuple[AdditiveCurve, ...]:
    """Return the additive animation curves of a player: all, or those of one channel."""
    return tuple(
        item
        for item in project.corrections.get(player_id, ())
        if isinstance(item, AdditiveCurve) and channel in (None, item.channel)
    )


def add_curve(
    project: Project, player_id: str, channel: str, keys: Iterable[tuple[int, float]], title: str = ""
) -> tuple[Project, str]:
    """Add an additive curve with keys (tick, value) and automatic handles. Returns the project and the curve's name.

    Raises
    ------
    KeyError
        The channel is unknown.
    """
    made = tuple(CurveKey(tick, _bounded(channel, value)) for tick, value in sorted(dict(keys).items()))
    blend = BLEND_BEATS * project.score.ticks_per_quarter
    curve = AdditiveCurve(_new_name(project, player_id), channel, made, blend, blend, title=title)
    return with_corrections(project, player_id, (curve,)), curve.name


def add_key(project: Project, player_id: str, name: str, tick: int, value: float) -> Project:
    """Add a key with the interpolation of the previous one; an existing key at the tick gets the value."""

    def added(curve: AdditiveCurve) -> AdditiveCurve:
        by_tick = {key.tick: key for key in curve.keys}
        before = [key for key in curve.keys if key.tick < tick]
        goes_on: Interpolation = before[-1].interpolation if before else curve.keys[0].interpolation
        key = by_tick.get(tick, CurveKey(tick, 0.0, goes_on))
        by_tick[tick] = msgspec.structs.replace(key, value=_bounded(curve.channel, value))
        return _with_keys(curve, by_tick.values())

    return _changed(project, player_id, name, added)


def move_keys(project: Project, player_id: str, keys: Keys, ticks: int, value: float = 0.0) -> Project:
    """Move keys of additive curves by ticks and value, together with their handles."""

    def moved(key: CurveKey, channel: str) -> CurveKey:
        tick = min(max(key.tick + ticks, -limits.LAST_TICK), limits.LAST_TICK)
        return msgspec.structs.replace(key, tick=tick, value=_bounded(channel, key.value + value))

    for name, chosen in keys.items():

        def shifted(curve: AdditiveCurve, chosen: Collection[int] = frozenset(chosen)) -> AdditiveCurve:
            staying = {key.tick: key for key in curve.keys if key.tick not in chosen}
            going = [moved(key, curve.channel) for key in curve.keys if key.tick in chosen]
            return _with_keys(curve, (staying | {key.tick: key for key in going}).values())

        project = _changed(project, player_id, name, shifted)
    return project


def set_values(project: Project, player_id: str, keys: Keys, value: float) -> Project:
    """Set the value of the chosen keys of a player's additive curves, clipped to the range of each channel."""
    return _each_key(project, player_id, keys, lambda key, channel: _valued(key, channel, value))


def set_interpolation(project: Project, player_id: str, keys: Keys, interpolation: Interpolation) -> Project:
    """Set the interpolation (such as linear) from each chosen key of an additive curve to the next key."""
    return _each_key(project, player_id, keys, lambda key, _: msgspec.structs.replace(key, interpolation=interpolation))


def set_tangent(
    project: Project,
    player_id: str,
    name: str,
    tick: int,
    side: Side,
    tangent: Tangent,
    other: Tangent | None = None,
) -> Project:
    """Place one handle of a curve's key; the opposite handle is set to ``other`` or stays."""

    def placed(key: CurveKey, channel: str) -> CurveKey:
        values: dict[str, Tangent] = {side: _sane(tangent, channel)}
        if other is not None:
            values["leave" if side == "arrive" else "arrive"] = _sane(other, channel)
        return msgspec.structs.replace(key, **values)

    return _each_key(project, player_id, {name: (tick,)}, placed)


def free_tangents(project: Project, player_id: str, keys: Keys) -> Project:
    """Make the handles of the chosen keys of additive curves automatic again."""
    return _each_key(project, player_id, keys, lambda key, _: msgspec.structs.replace(key, arrive=None, leave=None))


def flatten_tangents(project: Project, player_id: str, keys: Keys) -> Project:
    """Make curves horizontal at keys: handles reach a third of the way to the neighbouring keys."""
    for name, chosen in keys.items():

        def level(curve: AdditiveCurve, chosen: Collection[int] = frozenset(chosen)) -> AdditiveCurve:
            ticks = [key.tick for key in curve.keys]
            made = []
            for at, key in enumerate(curve.keys):
                if key.tick in chosen:
                    before = ticks[at] - ticks[at - 1] if at else 3
                    after = ticks[at + 1] - ticks[at] if at + 1 < len(ticks) else 3
                    key = msgspec.structs.replace(
                        key, arrive=Tangent(max(before // 3, 1), 0.0), leave=Tangent(max(after // 3, 1), 0.0)
                    )
                made.append(key)
            return _with_keys(curve, made)

        project = _changed(project, player_id, name, level)
    return project


def delete_keys(project: Project, player_id: str, keys: Keys) -> Project:
    """Delete the chosen keys of additive curves; a curve without keys is removed."""
    for name, chosen in keys.items():
        curve = _curve(project, player_id, name)
        left = [key for key in curve.keys if key.tick not in frozenset(chosen)]
        if left:
            project = with_corrections(project, player_id, (_with_keys(curve, left),))
        else:
            project = take_back(project, player_id, (curve,))
    return project


def paste_keys(project: Project, player_id: str, name: str, keys: Iterable[CurveKey], at_tick: int) -> Project:
    """Insert copied keys into a curve, the first at a tick; existing keys between the first and last are replaced."""
    copied = sorted(keys, key=lambda key: key.tick)
    if not copied:
        return project
    shift = at_tick - copied[0].tick

    def pasted(curve: AdditiveCurve) -> AdditiveCurve:
        new = {
            key.tick + shift: msgspec.structs.replace(
                key, tick=key.tick + shift, value=_bounded(curve.channel, key.value)
            )
            for key in copied
        }
        last = copied[-1].tick + shift
        staying = {key.tick: key for key in curve.keys if not at_tick <= key.tick <= last}
        return _with_keys(curve, (staying | new).values())

    return _changed(project, player_id, name, pasted)


def change_curves(project: Project, player_id: str, names: Iterable[str], **values: object) -> Project:
    """Set ``weight``, ``enabled``, ``title``, ``blend_in_ticks`` or ``blend_out_ticks`` of curves, clipped to their
    ranges.
    """
    if "weight" in values:
        values["weight"] = round(min(max(float(str(values["weight"])), 0.0), 1.0), 4)
    for field in ("blend_in_ticks", "blend_out_ticks"):
        if field in values:
            values[field] = min(max(int(str(values[field])), 0), limits.LAST_TICK)
    if "title" in values:
        values["title"] = str(values["title"]).strip()[: limits.MOST_NAME]
    for name in names:
        project = with_corrections(
            project, player_id, (msgspec.structs.replace(_curve(project, player_id, name), **values),)
        )
    return project


def delete_curves(project: Project, player_id: str, names: Iterable[str]) -> Project:
    """Delete the additive curves with the given names."""
    gone = frozenset(names)
    return take_back(project, player_id, [curve for curve in curves_of(project, player_id) if curve.name in gone])


def _curve(project: Project, player_id: str, name: str) -> AdditiveCurve:
    return next(curve for curve in curves_of(project, player_id) if curve.name == name)


def _changed(project: Project, player_id: str, name: str, change: Callable[[AdditiveCurve], AdditiveCurve]) -> Project:
    return with_corrections(project, player_id, (change(_curve(project, player_id, name)),))


def _each_key(project: Project, player_id: str, keys: Keys, change: Callable[[CurveKey, str], CurveKey]) -> Project:
    for name, chosen in keys.items():

        def changed(curve: AdditiveCurve, chosen: Collection[int] = frozenset(chosen)) -> AdditiveCurve:
            return _with_keys(curve, [change(key, curve.channel) if key.tick in chosen else key for key in curve.keys])

        project = _changed(project, player_id, name, changed)
    return project


def _with_keys(curve: AdditiveCurve, keys: Iterable[CurveKey]) -> AdditiveCurve:
    ordered = tuple(sorted(keys, key=lambda key: key.tick))[:MOST_KEYS]
    return msgspec.structs.replace(curve, keys=ordered)


def _valued(key: CurveKey, channel: str, value: float) -> CurveKey:
    return msgspec.structs.replace(key, value=_bounded(channel, value))


def _bounded(channel: str, value: float) -> float:
    most = CHANNELS[channel].most
    return round(min(max(value, -most), most), DECIMALS)


def _sane(tangent: Tangent, channel: str) -> Tangent:
    most = 10.0 * CHANNELS[channel].most
    ticks = min(max(tangent.ticks, 1), limits.LAST_TICK)
    return Tangent(ticks, round(min(max(tangent.value, -most), most), DECIMALS))


def _new_name(project: Project, player_id: str) -> str:
    taken = {curve.name for curve in curves_of(project, player_id)}
    return next(name for number in range(1, len(taken) + 2) if (name := f"{OWN}{number}") not in taken)
