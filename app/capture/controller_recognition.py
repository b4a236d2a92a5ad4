"""Recognition of the MIDI controllers for breath and bite from a few seconds of blowing and biting."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import pairwise
from statistics import median
from typing import Final

import msgspec

from metadata.model import BiteSource, BreathSource

_CONTROLLERS: Final[dict[int, BreathSource]] = {2: "cc2", 7: "cc7", 11: "cc11"}
_BITES: Final[tuple[BiteSource, ...]] = ("pitch_bend", "cc1", "channel_pressure")
_STATUS: Final[dict[BiteSource, int]] = {"pitch_bend": 0xE, "cc1": 0xB, "channel_pressure": 0xD}
_LEAST_VALUES: Final = 6
_LEAST_RANGE: Final = 16
_LARGEST_STEP: Final = 24
"""Greatest step between values of a breath controller, which varies smoothly; larger steps indicate a switch."""
_AS_MUCH: Final = 0.8


class Learned(msgspec.Struct, frozen=True):
    """Recognised breath controller: the MIDI message that carries breath, and its channel, 1..16."""

    source: BreathSource
    channel: int


def recognised_controller(events: Iterable[tuple[int, bytes]], trusted: Sequence[BreathSource] = ()) -> Learned | None:
    """Find the MIDI controller that carries the breath: the one with the largest variation without jumps; None if there
    is none.

    Some instruments send breath by two messages: among those that vary about as much as the largest, the most trusted
    is chosen.

    Parameters
    ----------
    events : iterable of (int, bytes)
        Time on any clock, and bytes, of each message.
    trusted : sequence of BreathSource
        Sources in order of trust, as `metadata.model.Controller.breath`; all others come after.
    """
    values: dict[Learned, list[int]] = defaultdict(list)
    for _, message in events:
        source = _source(message)
        if source is not None:
            values[Learned(source, (message[0] & 0x0F) + 1)].append(message[-1])
    moved = {found: _movement(own) for found, own in values.items()}
    most = max(moved.values(), default=0)
    if most == 0:
        return None
    order = [*trusted, *(source for source in ("cc2", "cc11", "channel_pressure", "cc7") if source not in trusted)]
    return min(
        (found for found, movement in moved.items() if movement >= _AS_MUCH * most),
        key=lambda found: (order.index(found.source), -moved[found], found.channel),
    )


def learned_bite(
    bitten: Iterable[tuple[int, bytes]], blown: Iterable[tuple[int, bytes]], breath: Learned
) -> BiteSource | None:
    """Find the MIDI controller that carries the bite: the one with the largest variation while biting; None if there is
    none.

    Parameters
    ----------
    bitten, blown : iterable of (int, bytes)
        Times and messages during biting, and during blowing before.
    breath : Learned
        Recognised breath controller. A pressure message that varied with it is a duplicate of the breath.
    """
    moved = {source: _range(bitten, source, breath.channel) for source in _BITES if source != breath.source}
    if _range(blown, "channel_pressure", breath.channel) >= _LEAST_RANGE:
        moved.pop("channel_pressure", None)
    source = max(moved, key=lambda source: moved[source])
    return source if moved[source] >= _LEAST_RANGE else None


def _range(events: Iterable[tuple[int, bytes]], source: BiteSource, channel: int) -> int:
    values = [
        message[-1]
        for _, message in events
        if (message[0] & 0x0F) + 1 == channel
        and (message[0] >> 4 == _STATUS[source])
        and (source != "cc1" or message[1] == 1)
    ]
    return max(values) - min(values) if len(set(values)) >= _LEAST_VALUES else 0


def breath_value(message: bytes, source: BreathSource) -> int | None:
    """Return the breath value 0..127 if a MIDI message carries breath by the controller ``source``; else None."""
    return message[-1] if _source(message) == source else None


def _source(message: bytes) -> BreathSource | None:
    if message[0] >> 4 == 0xB:
        return _CONTROLLERS.get(message[1])
    return "channel_pressure" if message[0] >> 4 == 0xD else None


def _movement(values: Sequence[int]) -> int:
    steps = [abs(b - a) for a, b in pairwise(values) if a != b]
    is_breath = (
        len(set(values)) >= _LEAST_VALUES
        and max(values) - min(values) >= _LEAST_RANGE
        and median(steps) <= _LARGEST_STEP
    )
    return sum(steps) if is_breath else 0
