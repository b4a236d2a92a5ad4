"""What makes an animator's curves sound."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from app.errors import shortened
from app.plan.by_hand.additive_curve import BODY_CHANNELS, CHANNELS, FACE, MOST_KEYS, AdditiveCurve, CurveKey
from app.project import limits
from app.project.fault import Fault, faults_of_bounds, text_faults

_POSSIBLE: Final = f"{', '.join(BODY_CHANNELS)}, {FACE}MORPH (an ARKit morph target)"


def curve_faults(curve: AdditiveCurve, place: str) -> Iterator[Fault]:
    """What is wrong with one curve."""
    channel = CHANNELS.get(curve.channel)
    if channel is None:
        yield f"{place}.channel", f"there is no channel {shortened(curve.channel, 40)!r}; possible: {_POSSIBLE}"
        return
    if curve.title:
        yield from text_faults(f"{place}.title", curve.title)
    yield from faults_of_bounds(f"{place}.weight", curve.weight, (0.0, 1.0))
    for field in ("blend_in_ticks", "blend_out_ticks"):
        yield from faults_of_bounds(f"{place}.{field}", getattr(curve, field), (0, limits.LAST_TICK))
    if not 1 <= len(curve.keys) <= MOST_KEYS:
        yield f"{place}.keys", f"must be from 1 to {MOST_KEYS}"
    for index, key in enumerate(curve.keys):
        at = f"{place}.keys[{index}]"
        yield from _key_faults(key, at, channel.most)
        if index and key.tick <= curve.keys[index - 1].tick:
            yield f"{at}.tick", "ticks must ascend"


def _key_faults(key: CurveKey, place: str, most: float) -> Iterator[Fault]:
    yield from faults_of_bounds(f"{place}.tick", key.tick, (-limits.LAST_TICK, limits.LAST_TICK))
    yield from faults_of_bounds(f"{place}.value", key.value, (-most, most))
    for side in ("arrive", "leave"):
        handle = getattr(key, side)
        if handle is not None:
            yield from faults_of_bounds(f"{place}.{side}.ticks", handle.ticks, (0, limits.LAST_TICK))
            yield from faults_of_bounds(f"{place}.{side}.value", handle.value, (-10.0 * most, 10.0 * most))
