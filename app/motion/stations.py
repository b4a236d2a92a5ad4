"""Where every finger is: which of its places it goes to, made from the notes as curves of time.

A finger is over its key before the key goes down and stays for repeats. Once it has let go it goes straight to the next
key it is needed at, and home where that is a while off. It waits higher over its keys in fast passages (Palmer &
Dalla Bella 2004; Goebl & Palmer 2008).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from app.motion.curve import Curve, FloatArray, moves
from app.plan.model import FingeringEvent
from app.rig.hold import Placed
from app.rig.stations import Station, fingers_at_work, station_for, stations
from instrument_maps.model import InstrumentMap

TRAVEL_S = 0.16
"""An unhurried way from one key to another."""
AHEAD_S = 0.10
"""A finger that has time is over its key this long before it goes down."""
HOME_S = 0.9
"""A finger that is not needed for so long goes home."""
LEAST_TRAVEL_S = 0.05
"""Where there is less time between two keys, the finger is on its way while the one comes up and the other goes down
..."""
STAYS_SHARE = 0.12
"""... but for this share of each of these moves, in which the keys hardly move."""
SHORTEST_S = 0.002
"""No way is shorter, however the notes lie."""
SLOW_NOTE_S, FAST_NOTE_S = 0.5, 0.12
"""Fingers wait low where notes follow each other as slowly as this, and highest where as fast."""
NEIGHBOURS = 3
"""Notes before and after that make a passage fast."""


Span: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class _Visit:
    """A finger at work at one station.

    ``down`` is while what it works there goes down, ``up`` while that comes up again; None where the finger already
    worked all of it at the station before, or goes on working it at the next. ``start_s`` and ``end_s`` are the notes'.
    """

    station: int
    start_s: float
    end_s: float
    down: Span | None
    up: Span | None


def station_curves(
    fingerings: Sequence[FingeringEvent], instrument: InstrumentMap, controls: Mapping[str, Curve]
) -> dict[str, Curve]:
    """Which station each finger is at, by finger; only those that leave their home.

    A curve's moves go from the number of one station to that of another, as `sampled` reads them.

    Parameters
    ----------
    fingerings : sequence of FingeringEvent
        In order.
    instrument : InstrumentMap
    controls : mapping of str to Curve
        What `app.motion.controls.control_curves` makes of the same fingerings.
    """
    travelled = {finger: places for finger, places in stations(instrument).items() if len(places) > 1}
    if not travelled:
        return {}
    at_work = [fingers_at_work(instrument, event.controls, event.fingers) for event in fingerings]
    result = {}
    for finger, places in travelled.items():
        worked = [found.get(finger, frozenset()) for found in at_work]
        visits = _visits(fingerings, worked, places, controls)
        result[finger] = moves(_ways(visits), 0.0)
    return result


def sampled(curve: Curve, times_s: FloatArray) -> Placed:
    """Between which stations a finger is at ascending times."""
    return Placed(*curve.between(times_s))


def raised_curve(fingerings: Sequence[FingeringEvent]) -> Curve:
    """How high fingers wait over their keys, 0..1, from the pace of the notes around."""
    if len(fingerings) < 2:
        return moves(())
    onsets_s = np.array([event.start_s for event in fingerings])
    steps_s = np.maximum(np.diff(onsets_s), 1e-3)
    pace = np.clip(np.log(SLOW_NOTE_S / steps_s) / np.log(SLOW_NOTE_S / FAST_NOTE_S), 0.0, 1.0)
    padded = np.pad(np.append(pace, pace[-1]), NEIGHBOURS, mode="edge")
    window = 2 * NEIGHBOURS + 1
    mean = np.round(np.convolve(padded, np.full(window, 1.0 / window), mode="valid"), 2)
    segments = []
    for index in range(1, len(onsets_s)):
        start_s = max(onsets_s[index - 1], onsets_s[index] - HOME_S)
        if onsets_s[index] > start_s:
            segments.append((float(start_s), float(onsets_s[index]), float(mean[index])))
    return moves(segments, float(mean[0]))


def _visits(
    fingerings: Sequence[FingeringEvent],
    worked: Sequence[frozenset[str]],
    places: Sequence[Station],
    controls: Mapping[str, Curve],
) -> list[_Visit]:
    """The finger's times at work; notes that follow one another at one station are one visit."""
    found: list[_Visit] = []
    nothing: frozenset[str] = frozenset()
    index = 0
    while index < len(fingerings):
        last = index
        while last + 1 < len(fingerings) and _goes_on(fingerings, worked, last, index):
            last += 1
        if worked[index]:
            before = worked[index - 1] if index and _follows(fingerings, index) else nothing
            after = worked[last + 1] if last + 1 < len(fingerings) and _follows(fingerings, last + 1) else nothing
            onset_s, last_onset_s, end_s = fingerings[index].start_s, fingerings[last].start_s, fingerings[last].end_s
            down = [_down(controls[name], onset_s) for name in sorted(worked[index] - before)]
            up = [_up(controls[name], last_onset_s, end_s) for name in sorted(worked[index] - after)]
            station = station_for(places, worked[index])
            found.append(_Visit(station, onset_s, end_s, _hull(down), _hull(up)))
        index = last + 1
    return found


def _goes_on(fingerings: Sequence[FingeringEvent], worked: Sequence[frozenset[str]], last: int, first: int) -> bool:
    return worked[last + 1] == worked[first] and _follows(fingerings, last + 1)


def _follows(fingerings: Sequence[FingeringEvent], index: int) -> bool:
    """Whether a note follows the one before without a rest that would take a finger off."""
    return fingerings[index].start_s - fingerings[index - 1].end_s < HOME_S


def _hull(spans: Sequence[Span]) -> Span | None:
    if not spans:
        return None
    return min(start_s for start_s, _ in spans), max(end_s for _, end_s in spans)


def _down(curve: Curve, onset_s: float) -> Span:
    """While a control goes to the place it has at an onset."""
    index = int(np.searchsorted(curve.end_s, onset_s - 1e-6))
    there = index < len(curve.end_s) and abs(curve.end_s[index] - onset_s) < 1e-6
    return (float(curve.start_s[index]) if there else onset_s), onset_s


def _up(curve: Curve, onset_s: float, end_s: float) -> Span:
    """While a control leaves the place it has at an onset."""
    index = int(np.searchsorted(curve.start_s, onset_s - 1e-6))
    if index == len(curve.start_s):
        return end_s, end_s
    return float(curve.start_s[index]), float(curve.end_s[index])


def _ways(visits: Sequence[_Visit]) -> list[tuple[float, float, float]]:
    """Moves (start_s, end_s, station) between visits."""
    ways: list[tuple[float, float, float]] = []
    here = 0

    def go(start_s: float, end_s: float, station: int) -> None:
        nonlocal here
        if station != here:
            start_s = max(start_s, ways[-1][1]) if ways else start_s
            ways.append((start_s, max(end_s, start_s + SHORTEST_S), float(station)))
            here = station

    last: _Visit | None = None
    for visit in visits:
        start_s = visit.start_s if visit.down is None else visit.down[0]
        free_s = -np.inf if last is None else last.end_s if last.up is None else last.up[1]
        if start_s - free_s > HOME_S + 2.0 * TRAVEL_S:
            if last is not None:
                go(free_s, free_s + TRAVEL_S, 0)
            go(start_s - AHEAD_S - TRAVEL_S, start_s - AHEAD_S, visit.station)
        elif last is not None:
            go(*_straight(last, visit), visit.station)
        last = visit
    if last is not None:
        free_s = last.end_s if last.up is None else last.up[1]
        go(free_s, free_s + TRAVEL_S, 0)
    return ways


def _straight(last: _Visit, visit: _Visit) -> Span:
    """When a finger goes from a key to another that it needs soon: between the two, or while they move."""
    if last.up is not None and visit.down is not None:
        room_s = visit.down[0] - last.up[1]
        if room_s >= LEAST_TRAVEL_S:
            travel_s = min(room_s, TRAVEL_S)
            spare_s = min(room_s - travel_s, AHEAD_S)
            return visit.down[0] - spare_s - travel_s, visit.down[0] - spare_s
    first, second = last.up or visit.down, visit.down or last.up
    if first is None or second is None:
        return visit.start_s, visit.start_s
    return first[0] + STAYS_SHARE * (first[1] - first[0]), second[1] - STAYS_SHARE * (second[1] - second[0])
