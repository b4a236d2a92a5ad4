"""Range of pitch bend and the MPE zones of MIDI channels, from registered parameters and messages to sound modules.

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
"""Default range of pitch bends in semitones; the unit of pitch bend curves (`app.score.model.ControllerCurve`)."""
_MEMBER_SEMITONES: Final = 48.0
"""Default range in semitones of a new MPE zone's member channels."""
_DATA, _DATA_FINE, _INCREMENT, _DECREMENT = 6, 38, 96, 97
_UNREGISTERED: Final = (98, 99)
_REGISTERED_FINE, _REGISTERED = 100, 101
RESET: Final = 121
"""Number of the controller "reset all controllers"."""
PARAMETERS: Final = frozenset({_DATA, _DATA_FINE, _INCREMENT, _DECREMENT, *_UNREGISTERED, 100, 101, RESET})
"""Controllers that set a range."""
_BEND, _ZONE, _NULL = (0, 0), (0, 6), (127, 127)
_LOWER, _UPPER = 0, 15
"""Manager channels of the lower and upper MPE zone."""
_MOST_MEMBERS: Final = 15
_MOST_SEMITONES: Final = 127
_ROUNDING: Final = 1e-3
"""Tolerance in semitones, since the highest value of a pitch wheel is slightly less than its range."""


class _Channel(msgspec.Struct):
    """State of a channel: the registered parameter it has selected, and its bend range in semitones and cents.

    Attributes
    ----------
    number : tuple of int
        Registered parameter, coarse and fine; valid while ``registered``.
    coarse, fine_first : bool
        Whether the semitones were sent since the parameter was selected, and whether the cents were sent before them.
    """

    number: tuple[int, int] = _NULL
    registered: bool = False
    coarse: bool = False
    fine_first: bool = False
    semitones: int = 2
    cents: int = 0


class BendRanges:
    """Tracks the pitch bend ranges of one port's sixteen channels while its controllers are received in order.

    Attributes
    ----------
    zones : dict of int to frozenset of int
        Members of each MPE zone by its manager channel, 0..15: those of the last setting that was not empty.
    """

    def __init__(self) -> None:
        self._channels: dict[int, _Channel] = {}
        self.zones: dict[int, frozenset[int]] = {}
        self._active: dict[int, frozenset[int]] = {}

    def semitones(self, channel: int) -> float:
        """Return the semitones of a full pitch bend on a channel."""
        state = self._channels.get(channel)
        return USUAL_SEMITONES if state is None else min(state.semitones + state.cents / 100, 2.0 * MOST_BEND)

    def receive(self, channel: int, control: int, value: int) -> Collection[int]:
        """Update the ranges by a controller message; controllers not in `PARAMETERS` are ignored.

        Returns
        -------
        collection of int
            Channels whose range the message sets.
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
        """Apply the bend range of a message to a sound module, and return the channels that it affects."""
        if one.channel is None:
            self._channels.clear()
            self._active.clear()
            return range(16)
        state = self._channels.setdefault(one.channel, _Channel())
        state.semitones, state.cents = int(one.semitones), 0
        return (one.channel,)

    def _set_range(self, channel: int, state: _Channel, control: int, value: int) -> Collection[int]:
        if control == _DATA:
            # Semitones alone imply 0 cents; both messages may come in either order.
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
        The channel; None for a reset, which is for all channels.
    semitones : float
        Range of a full upward bend; negative if the bend is inverted.
    """

    tick: int
    channel: int | None
    semitones: float


class RangeHistory(msgspec.Struct, frozen=True):
    """Bend ranges of some channels over time.

    Attributes
    ----------
    ranges : dict of channel to dict of tick to semitones
        Range of each channel that is set, by tick; at one tick the last setting counts.
    zones : dict of channel to frozenset of int
        As `BendRanges.zones`.
    """

    ranges: dict[int, dict[int, float]]
    zones: dict[int, frozenset[int]]

    @classmethod
    def of(cls, controls: Iterable[tuple[int, int, int, int]], modules: Iterable[ModuleRange] = ()) -> RangeHistory:
        """Build the history from controllers (tick, channel, control, value) and messages to a sound module, both in
        the order of time; at one tick the messages come first.
        """
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
    """Apply the range of a sound module's message and record it in ``ranges``."""
    for channel in state.take(one):
        ranges.setdefault(channel, {})[one.tick] = state.semitones(channel)


def bent(raw: Mapping[int, float], ranges: Mapping[int, float]) -> dict[int, float]:
    """Convert the pitch bends of a channel to units of the usual range.

    Parameters
    ----------
    raw : mapping of tick to float
        Bends by tick, -1..1 of the range in force at the tick.
    ranges : mapping of tick to float
        Semitones of a full bend from each tick on; before the first one the usual range.
    """
    now, semitones, result = 0.0, USUAL_SEMITONES, dict[int, float]()
    for tick in sorted({*raw, *ranges}):
        now, before = raw.get(tick, now), semitones
        semitones = ranges.get(tick, semitones)
        if tick in raw or (now and semitones != before):
            result[tick] = now if semitones == USUAL_SEMITONES else now * semitones / USUAL_SEMITONES
    return result


def range_for(values: Iterable[float]) -> int:
    """Return the smallest bend range in whole semitones, not below the usual range, that can represent all of the
    bends; these are in units of the usual range.
    """
    most = max(map(abs, values), default=0.0)
    return min(max(ceil(most * USUAL_SEMITONES - _ROUNDING), int(USUAL_SEMITONES)), _MOST_SEMITONES)


def range_controls(semitones: int) -> tuple[tuple[int, int], ...]:
    """Controllers (number, value) that set a bend range in semitones and then deselect the parameter."""
    select, done = ((_REGISTERED, 0), (_REGISTERED_FINE, 0)), ((_REGISTERED, 127), (_REGISTERED_FINE, 127))
    return (*select, (_DATA, semitones), (_DATA_FINE, 0), *done)


def wheel(value: float, semitones: int) -> int:
    """Convert a bend in units of the usual range to a MIDI pitch wheel value, -8192..8191, for a bend range of
    ``semitones``.
    """
    return min(max(round(8192 * value * USUAL_SEMITONES / semitones), -8192), 8191)
