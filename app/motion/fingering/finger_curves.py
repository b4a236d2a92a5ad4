"""Curves of every finger between its stations (the positions at its keys, 0 is its home), made from the notes.

A finger is above its key before the key goes down, and stays for repeated notes. After release it moves directly to its
next key, or home if that is needed much later. It waits higher above keys in fast passages (Palmer & Dalla Bella 2004;
Goebl & Palmer 2008).
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.motion.curves.curve import Curve, moves, moves_to
from app.plan.model import FingeringEvent
from app.rig.grip.finger_stations import Station, kinds_of_notes, station_for, stations
from app.rig.grip.grip_pose import StationBlend, giving_for
from instrument_maps.model import InstrumentMap

TRAVEL_S = 0.17
"""Seconds of a finger's unhurried move between two keys."""
AHEAD_S = 0.10
"""Seconds before pressing at which a finger with enough time is above its key."""
HOME_S = 0.9
"""Seconds without work after which a finger returns to its home position."""
LEAST_TRAVEL_S = 0.05
"""Least time in seconds of a move between two keys; if there is less, the move overlaps releasing one key and pressing
the other.
"""
STAYS_SHARE = 0.12
"""Share of releasing and pressing, in which keys hardly move, that this overlap leaves free."""
SHORTEST_S = 0.002
"""Shortest move in seconds."""
SLOW_NOTE_S, FAST_NOTE_S = 0.5, 0.12
"""Mean times in seconds between notes at which waiting fingers are lowest and highest."""
NEIGHBOURS = 3
"""Number of notes before and after a note that determine the speed of a passage."""


Span: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class _Visit:
    """A span of notes in which a finger works at one station.

    ``down`` and ``up`` are the spans in which its controls go down and come up; None if the finger already worked all
    of them at the previous station, or continues at the next. ``start_s`` and ``end_s`` span the notes from ``first``
    to before ``end``.
    """

    station: int
    first: int
    end: int
    start_s: float
    end_s: float
    down: Span | None
    up: Span | None


def station_curves(
    fingerings: Sequence[FingeringEvent], instrument: InstrumentMap, controls: Mapping[str, Curve]
) -> dict[str, Curve]:
    """Return the station curve of each finger that leaves its home.

    Values are station numbers, between which the curves move; read them with `sampled`. A second curve per finger,
    under the name from `giving_for`, has the station for which the whole hand shifts: a finger waits above its key
    while others are still at theirs, and the hand shifts only as the key goes down.

    Parameters
    ----------
    fingerings : sequence of FingeringEvent
        Fingerings in order.
    controls : mapping of str to Curve
        Curves from `app.motion.fingering.control_curves.control_curves` for the same fingerings.
    """
    travelled = {finger: places for finger, places in stations(instrument).items() if len(places) > 1}
    if not travelled:
        return {}
    kinds, at_work = kinds_of_notes(instrument, ((event.controls, event.fingers) for event in fingerings))
    follows = np.zeros(len(fingerings), dtype=np.bool_)
    follows[1:] = _silences_s(fingerings) < HOME_S
    result = {}
    for finger, places in travelled.items():
        worked = [found.get(finger, frozenset()) for found in at_work]
        sets = list(dict.fromkeys(worked))
        found = np.array([sets.index(one) for one in worked], np.intp)[kinds]
        visits = _visits(fingerings, found, sets, follows, places, controls)
        result[finger] = moves(_ways(visits), 0.0)
        result[giving_for(finger)] = moves(_givings(visits, kinds, _others_away(finger, travelled, at_work)), 0.0)
    return result


def _others_away(
    finger: str, travelled: Mapping[str, Sequence[Station]], at_work: Sequence[Mapping[str, frozenset[str]]]
) -> list[frozenset[tuple[str, int]]]:
    """For each combination of controls in ``at_work`` the set of (finger, station) of all other fingers of the same
    hand that are away from their home stations.
    """
    hand = finger.split(".")[0]
    others = {name: places for name, places in travelled.items() if name != finger and name.split(".")[0] == hand}
    found = [
        {(name, station_for(places, work[name])) for name, places in others.items() if name in work} for work in at_work
    ]
    return [frozenset(place for place in places if place[1]) for places in found]


def _silences_s(fingerings: Sequence[FingeringEvent]) -> FloatArray:
    """Seconds (N - 1,) from each note's end to the next onset."""
    starts_s, ends_s = (
        np.array([getattr(event, name) for event in fingerings], np.float64) for name in ("start_s", "end_s")
    )
    return np.asarray(starts_s[1:] - ends_s[:-1])


def sampled(curve: Curve, times_s: FloatArray) -> StationBlend:
    """Sample a finger's curve at ascending times: the station it leaves, the one it moves to, and its share
    of the way.
    """
    return StationBlend(*curve.between(times_s))


def raised_curve(fingerings: Sequence[FingeringEvent]) -> Curve:
    """Return the height of waiting fingers above their keys, 0..1, by the pace of the surrounding notes."""
    if len(fingerings) < 2:
        return moves(())
    onsets_s = np.array([event.start_s for event in fingerings])
    steps_s = np.maximum(np.diff(onsets_s), 1e-3)
    pace = np.clip(np.log(SLOW_NOTE_S / steps_s) / np.log(SLOW_NOTE_S / FAST_NOTE_S), 0.0, 1.0)
    padded = np.pad(np.append(pace, pace[-1]), NEIGHBOURS, mode="edge")
    window = 2 * NEIGHBOURS + 1
    mean = np.round(np.convolve(padded, np.full(window, 1.0 / window), mode="valid"), 2)
    start_s = np.maximum(onsets_s[:-1], onsets_s[1:] - HOME_S)
    goes = onsets_s[1:] > start_s
    return moves_to(start_s[goes], onsets_s[1:][goes], mean[1:][goes], float(mean[0]))


def _visits(
    fingerings: Sequence[FingeringEvent],
    worked: IndexArray,
    sets: Sequence[frozenset[str]],
    follows: BoolArray,
    places: Sequence[Station],
    controls: Mapping[str, Curve],
) -> list[_Visit]:
    """Find the spans in which a finger works; consecutive notes at one station form one visit.

    ``worked`` (N,) selects one of ``sets`` of controls for each note; ``follows`` (N,) marks notes that follow the
    previous one without a rest that would lift the finger.
    """
    found: list[_Visit] = []
    if not fingerings:
        return found
    firsts = np.flatnonzero(~(follows[1:] & (worked[1:] == worked[:-1]))) + 1
    edges = [0, *firsts.tolist(), len(fingerings)]
    onsets_s = [fingerings[first].start_s for first in edges[:-1]]
    last_onsets_s = [fingerings[end - 1].start_s for end in edges[1:]]
    moved = {name: _Moves.of(controls[name], onsets_s, last_onsets_s) for name in sorted(frozenset().union(*sets))}
    numbers = [station_for(places, work) if work else -1 for work in sets]
    orders = [sorted(work) for work in sets]
    nothing: frozenset[str] = frozenset()
    for visit, (first, end) in enumerate(itertools.pairwise(edges)):
        kind = int(worked[first])
        if numbers[kind] < 0:
            continue
        before = sets[worked[first - 1]] if first and follows[first] else nothing
        after = sets[worked[end]] if end < len(fingerings) and follows[end] else nothing
        onset_s, end_s = onsets_s[visit], fingerings[end - 1].end_s
        # A key pressed at both of two notes is released between them if there is a rest.
        ended_s = fingerings[first - 1].end_s if first else -np.inf
        next_s = fingerings[end].start_s if end < len(fingerings) else np.inf
        downs, ups = [], []
        for name in orders[kind]:
            down, up = moved[name].down(visit, onset_s), moved[name].up(visit, end_s)
            if name not in before or ended_s <= down[0] < down[1]:
                downs.append(down)
            if name not in after or end_s <= up[0] < up[1] <= next_s:
                ups.append(up)
        found.append(_Visit(numbers[kind], first, end, onset_s, end_s, _hull(downs), _hull(ups)))
    return found


def _hull(spans: Sequence[Span]) -> Span | None:
    if len(spans) < 2:
        return spans[0] if spans else None
    starts_s, ends_s = zip(*spans, strict=True)
    return min(starts_s), max(ends_s)


class _Moves(NamedTuple):
    """Moves of a control before and after a finger's visits.

    ``coming`` and ``leaving`` are indices into the moves ``start_s``..``end_s`` for every visit; an index past the end
    means none.
    """

    start_s: list[float]
    end_s: list[float]
    coming: list[int]
    leaving: list[int]

    @classmethod
    def of(cls, curve: Curve, onsets_s: Sequence[float], last_onsets_s: Sequence[float]) -> _Moves:
        coming = np.searchsorted(curve.end_s, np.array(onsets_s) - 1e-6)
        leaving = np.searchsorted(curve.start_s, np.array(last_onsets_s) - 1e-6)
        return cls(curve.start_s.tolist(), curve.end_s.tolist(), coming.tolist(), leaving.tolist())

    def down(self, visit: int, onset_s: float) -> Span:
        """Span in which the control moves to its place at the onset of a visit."""
        index = self.coming[visit]
        there = index < len(self.end_s) and abs(self.end_s[index] - onset_s) < 1e-6
        return (self.start_s[index] if there else onset_s), onset_s

    def up(self, visit: int, end_s: float) -> Span:
        """Span in which the control leaves its place after the end of a visit."""
        index = self.leaving[visit]
        return (end_s, end_s) if index == len(self.start_s) else (self.start_s[index], self.end_s[index])


def _ways(visits: Sequence[_Visit]) -> list[tuple[float, float, float]]:
    """Moves (start_s, end_s, station) of a finger between its visits to stations."""
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


def _givings(
    visits: Sequence[_Visit], kinds: IndexArray, others: Sequence[frozenset[tuple[str, int]]]
) -> list[tuple[float, float, float]]:
    """Moves (start_s, end_s, station) of a hand that shifts to bring a finger to its stations: together with the keys,
    and held where the notes return to the station, as in a trill.

    The hand does not stay shifted while other fingers leave home: ``others`` has their stations, selected for each note
    by ``kinds`` (N,).
    """
    ways: list[tuple[float, float, float]] = []

    def go(start_s: float, end_s: float, station: int) -> None:
        start_s = max(start_s, ways[-1][1]) if ways else start_s
        ways.append((start_s, max(end_s, start_s + SHORTEST_S), float(station)))

    here = 0
    last: _Visit | None = None
    for visit in visits:
        if last is not None and here:
            up = last.up or (last.end_s, last.end_s)
            start_s = visit.start_s if visit.down is None else visit.down[0]
            goes_on = visit.down is None or last.up is None or start_s < up[1]
            known = others[kinds[last.end - 1]] | others[kinds[visit.first]]
            apart = any(others[kind] - known for kind in kinds[last.end : visit.first].tolist())
            if start_s - up[1] > TRAVEL_S or apart or (here != visit.station and not goes_on):
                go(*up, 0)
                here = 0
        if here != visit.station:
            # Moves from one key to another at once, while one key rises and the other goes down.
            spans = [span for span in ((last.up if last and here else None), visit.down) if span is not None]
            start_s, end_s = _hull(spans) or (visit.start_s, visit.start_s)
            go(start_s, end_s, visit.station)
        here, last = visit.station, visit
    if here and last is not None:
        go(*(last.up or (last.end_s, last.end_s)), 0)
    return ways


def _straight(last: _Visit, visit: _Visit) -> Span:
    """Return the span in which a finger moves directly to the next key that it needs soon: between the notes, or while
    the keys move.
    """
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
