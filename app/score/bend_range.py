"""The range of a channel's pitch bend, and its MPE zones, as registered parameters and sound modules set them.

Sources: MIDI 1.0 Detailed Specification 4.2 (registered parameters 0/0, pitch bend sensitivity, and 127/127, null);
RP-018 (data increment and decrement step the cents of a range); RP-015 (reset all controllers deselects the parameter);
MIDI Polyphonic Expression 1.0 (parameter 0/6 on channel 1 or 16 makes a zone; its members then have a range of 48
semitones, which all of them share).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable, Mapping
from math import ceil
from typing import Final, NamedTuple

import msgspec

from app.score.model import MOST_BEND

USUAL_SEMITONES: Final = 2.0
"""Range of a channel that no one set; the unit of pitch bend curves (`app.score.model.ControllerCurve`)."""
_MEMBER_SEMITONES: Final = 48.0
"""Range of the members of a new MPE zone."""
_DATA, _DATA_FINE, _INCREMENT, _DECREMENT = 6, 38, 96, 97
_UNREGISTERED: Final = (98, 99)
_REGISTERED_FINE, _REGISTERED = 100, 101
RESET: Final = 121
"""Reset all controllers."""
PARAMETERS: Final = frozenset({_DATA, _DATA_FINE, _INCREMENT, _DECREMENT, *_UNREGISTERED, 100, 101, RESET})
"""Controllers by which a range is set."""
_BEND, _ZONE, _NULL = (0, 0), (0, 6), (127, 127)
_LOWER, _UPPER = 0, 15
"""Manager channels of the two zones."""
_MOST_MEMBERS: Final = 15
_MOST_SEMITONES: Final = 127
_ROUNDING: Final = 1e-3
"""Semitones: the highest step of a wheel is a little less than its range."""


class _Channel(msgspec.Struct):
    """The parameter a channel has selected, and its range in semitones and cents.

    Attributes
    ----------
    number : tuple of int
        Registered parameter, coarse and fine; valid while ``registered``.
    coarse, fine_first : bool
        The semitones were sent since the parameter was selected; the cents were sent before them.
    """

    number: tuple[int, int] = _NULL
    registered: bool = False
    coarse: bool = False
    fine_first: bool = False
    semitones: int = 2
    cents: int = 0


class BendRanges:
    """Follows the controllers of one port's sixteen channels.

    Attributes
    ----------
    zones : dict of int to frozenset of int
        Members of each MPE zone by its manager channel, 0..15; the last that was not empty.
    """

    def __init__(self) -> None:
        self._channels: dict[int, _Channel] = {}
        self.zones: dict[int, frozenset[int]] = {}
        self._active: dict[int, frozenset[int]] = {}

    def semitones(self, channel: int) -> float:
        """Return how far a full bend of a channel goes."""
        state = self._channels.get(channel)
        return USUAL_SEMITONES if state is None else min(state.semitones + state.cents / 100, 2.0 * MOST_BEND)

    def receive(self, channel: int, control: int, value: int) -> Collection[int]:
        """Take a controller of `PARAMETERS`; others say nothing here.

        Returns
        -------
        collection of int
            The channels whose range it sets.
        """
        state = self._channels.setdefault(channel, _Channel())
        if control == RESET:
            state.number, state.registered = _NULL, False
        elif control in _UNREGISTERED:
            state.registered = False
        elif control in (_REGISTERED, _REGISTERED_FINE):
            coarse, fine = state.number
            state.number = (value, fine) if control == _REGISTERED else (coarse, value)
            state.registered, state.coarse, state.fine_first = True, False, False
        elif state.registered and state.number == _BEND:
            return self._set_range(channel, state, control, value)
        elif state.registered and state.number == _ZONE and control == _DATA and channel in (_LOWER, _UPPER):
            return self._set_zone(channel, value)
        return ()

    def take(self, one: ModuleRange) -> Collection[int]:
        """Take the range that a message to a sound module sets; the channels that have it then."""
        if one.channel is None:
            self._channels.clear()
            self._active.clear()
            return range(16)
        state = self._channels.setdefault(one.channel, _Channel())
        state.semitones, state.cents = int(one.semitones), 0
        return (one.channel,)

    def _set_range(self, channel: int, state: _Channel, control: int, value: int) -> Collection[int]:
        if control == _DATA:
            # Semitones alone mean no cents; both may come in either order.
            state.semitones, state.cents = value, state.cents if state.fine_first else 0
            state.coarse, state.fine_first = True, False
        elif control == _DATA_FINE:
            state.cents, state.fine_first = value, not state.coarse
        elif control in (_INCREMENT, _DECREMENT):
            total = 100 * state.semitones + state.cents + (1 if control == _INCREMENT else -1)
            state.semitones, state.cents = divmod(min(max(total, 0), 100 * 127 + 99), 100)
        members = next((members for members in self._active.values() if channel in members), frozenset[int]())
        for member in members - {channel}:
            other = self._channels.setdefault(member, _Channel())
            other.semitones, other.cents = state.semitones, state.cents
        return members | {channel}

    def _set_zone(self, manager: int, count: int) -> Collection[int]:
        count = min(count, _MOST_MEMBERS)
        members = frozenset(range(1, 1 + count) if manager == _LOWER else range(15 - count, 15))
        for other, had in list(self._active.items()):
            self._active[other] = had - members - {manager}
        self._active[manager] = members
        if members:
            self.zones[manager] = members
        for member in members:
            state = self._channels.setdefault(member, _Channel())
            state.semitones, state.cents = int(_MEMBER_SEMITONES), 0
        state = self._channels.setdefault(manager, _Channel())
        state.semitones, state.cents = int(USUAL_SEMITONES), 0
        return members | {manager}


class ModuleRange(NamedTuple):
    """The range that a message to a sound module sets (`app.score.sound_module`).

    Attributes
    ----------
    channel : int or None
        None: a reset, which is for all channels.
    semitones : float
        Of a full bend upwards; negative where it goes down.
    """

    tick: int
    channel: int | None
    semitones: float


class RangeHistory(msgspec.Struct, frozen=True):
    """Values of some controllers in the order of time.

    Attributes
    ----------
    ranges : dict of channel to dict of tick to semitones
        Of the channels whose range is set; the last one of each tick.
    zones : dict of channel to frozenset of int
        As `BendRanges.zones`.
    """

    ranges: dict[int, dict[int, float]]
    zones: dict[int, frozenset[int]]

    @classmethod
    def of(cls, controls: Iterable[tuple[int, int, int, int]], modules: Iterable[ModuleRange] = ()) -> RangeHistory:
        """The history of controllers (tick, channel, control, value) and of messages to a sound module, which come
        first at a tick; both in the order of time."""
        state = BendRanges()
        ranges: dict[int, dict[int, float]] = {}
        waiting = deque(modules)
        for tick, channel, control, value in controls:
            while waiting and waiting[0].tick <= tick:
                _take(waiting.popleft(), state, ranges)
            for changed in state.receive(channel, control, value):
                ranges.setdefault(changed, {})[tick] = state.semitones(changed)
        for one in waiting:
            _take(one, state, ranges)
        return cls(ranges, state.zones)


def _take(one: ModuleRange, state: BendRanges, ranges: dict[int, dict[int, float]]) -> None:
    """Let a sound module's range take effect."""
    for channel in state.take(one):
        ranges.setdefault(channel, {})[one.tick] = state.semitones(channel)


def bent(raw: Mapping[int, float], ranges: Mapping[int, float]) -> dict[int, float]:
    """Pitch bends of a channel in units of the usual range.

    Parameters
    ----------
    raw : mapping of tick to float
        -1..1 of the range that the channel has there.
    ranges : mapping of tick to float
        Semitones of a full bend, from each tick on; the usual ones before.
    """
    now, semitones, result = 0.0, USUAL_SEMITONES, dict[int, float]()
    for tick in sorted({*raw, *ranges}):
        now, before = raw.get(tick, now), semitones
        semitones = ranges.get(tick, semitones)
        if tick in raw or (now and semitones != before):
            result[tick] = now if semitones == USUAL_SEMITONES else now * semitones / USUAL_SEMITONES
    return result


def range_for(values: Iterable[float]) -> int:
    """The semitones of the least whole range, the usual one at least, that holds bends in units of the usual range."""
    most = max(map(abs, values), default=0.0)
    return min(max(ceil(most * USUAL_SEMITONES - _ROUNDING), int(USUAL_SEMITONES)), _MOST_SEMITONES)


def range_controls(semitones: int) -> tuple[tuple[int, int], ...]:
    """The controllers, as (number, value), that set a range, and then select no parameter."""
    select, done = ((_REGISTERED, 0), (_REGISTERED_FINE, 0)), ((_REGISTERED, 127), (_REGISTERED_FINE, 127))
    return (*select, (_DATA, semitones), (_DATA_FINE, 0), *done)


def wheel(value: float, semitones: int) -> int:
    """A bend in units of the usual range as a pitch wheel of a range has it, -8192..8191."""
    return min(max(round(8192 * value * USUAL_SEMITONES / semitones), -8192), 8191)
