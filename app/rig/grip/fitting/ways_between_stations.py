"""Heights of fingers on their way between stations, and the heights at which they wait until the hand has its
offset.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.finger_poses import LOW_HOVER, raised_way, solved_pose, with_wrist
from app.rig.grip.finger_stations import MOST_HOVER_M, Station, hover_m
from app.rig.grip.fitting.fit_terms import GripScene
from app.rig.grip.fitting.hand_model import skinned, wrist_from_joint, wrist_from_mesh
from app.rig.grip.fitting.hand_problem import HandProblem
from app.rig.grip.fitting.residuals import inside_proxy
from app.rig.grip.fitting.touch_targets import HOVER_MORE, nodes_at
from app.rig.grip.grip_pose import FingerTable, StationTable
from app.rig.quaternion import interpolated, mixed

WAYS = np.arange(1, 16) / 16.0
"""Examined positions on a way, since a finger passes a narrow tube in a tenth of it."""
LIFTS_M = np.linspace(0.0, 0.030, 11)
WAY_CLEAR_M, WORTH_M = 0.0025, 0.0005
"""Tried heights in metres of a finger on its way from home to another station, and while it waits for a hand offset:
the first that clears all obstacles, else the best; higher only for the least gain.
"""
BACK, FROM_NEXT = 0.5, 0.1
"""Shares of a finger's detour if the direct way is not clear or leads too far from the keys: back from the palm, and
away from the other key, around obstacles between the two.
"""


@dataclass(frozen=True)
class _Height:
    """Height of a finger on its way between stations, and the greatest depth of its skin in the instrument there."""

    lift_m: float
    deep_m: float

    @property
    def clear(self) -> bool:
        return self.deep_m <= WAY_CLEAR_M

    @property
    def near(self) -> bool:
        """True if the finger clears the instrument and is not higher than a waiting finger."""
        return self.clear and self.lift_m <= MOST_HOVER_M

    def betters(self, other: _Height) -> bool:
        if self.clear and other.clear:
            return self.lift_m < other.lift_m
        return self.clear or (not other.clear and self.deep_m < other.deep_m - WORTH_M)


def lifted_ways(
    problem: HandProblem, scene: GripScene, tables: tuple[FingerTable, ...], wrists: Mapping[tuple[int, int], GripScene]
) -> tuple[FingerTable, ...]:
    """Return the tables of fingers with the height by which each finger is lifted on its way between home and another
    station.

    ``wrists`` are the offset wrists by (finger, station).
    """
    result = []
    for number, table in enumerate(tables):
        found = [table.stations[0]] if table.stations else []
        for index, station in enumerate(table.stations[1:], 1):
            place = problem.stations[number][index]
            found.append(_lifted(problem, scene, table, number, index, place, wrists.get((number, index), scene)))
            assert station.controls == found[-1].controls
        result.append(replace(table, stations=tuple(found)))
    return tuple(result)


def _lifted(
    problem: HandProblem,
    scene: GripScene,
    table: FingerTable,
    number: int,
    index: int,
    place: Station,
    wrist: GripScene,
) -> StationTable:
    home, there = table.stations[0], table.stations[index]
    if table.chain is None or home.tip_joint < 0 or there.tip_joint < 0 or set(home.controls) & set(there.controls):
        return there
    instrument = scene.instrument_map
    off, out = (
        np.asarray(instrument.contacts[at].normal)
        for at in (place.contacts[0], problem.stations[number][0].contacts[0])
    )
    palm = next(seed for seed in instrument.hands if place.finger.startswith(f"{seed.hand}.")).palm_normal
    back = _unit(out - BACK * _unit(np.asarray(palm)) - FROM_NEXT * off)
    found, best = there, _Height(0.0, np.inf)
    for away, waits in ((_unit(out + off), off), (back, back)):
        lifted, height = _lifted_along(problem, (scene, wrist), table, (number, index), away, waits)
        if height.betters(best):
            found, best = lifted, height
        if best.near:
            break
    return found


def _unit(vector: FloatArray) -> FloatArray:
    return vector / max(float(np.linalg.norm(vector)), 1e-6)


def _lifted_along(
    problem: HandProblem,
    scenes: tuple[GripScene, GripScene],
    table: FingerTable,
    which: tuple[int, int],
    away: FloatArray,
    off: FloatArray,
) -> tuple[StationTable, _Height]:
    """Return a station with the height of its finger on the way in direction ``away`` and while waiting in direction
    ``off`` (instrument's frame), and that height.

    ``scenes`` are the wrists at home and at the station, ``which`` the indices of finger and station.
    """
    (scene, wrist), (number, index) = scenes, which
    home, there = table.stations[0], table.stations[index]
    away, off = away @ scene.basis[0], off @ scene.basis[0]
    near, come = _waiting(home), _waiting(there)
    way = np.tile(WAYS, 2)

    def on_way(waits: FloatArray) -> Callable[[float], FloatArray]:
        first, last = (np.repeat(end, len(WAYS), axis=0) for end in (near, waits))
        pose = mixed(first, last, way[:, None, None])
        return lambda lift: solved_pose(raised_way(table, 0, index, pose, way, lift * away))

    if wrist is scene:
        found = _Height(*_least_lift(problem, scene, number, on_way(come), LIFTS_M))
        return replace(there, away_m=found.lift_m * away), found

    # A yielding hand moves together with the key, when the finger has already arrived.
    own, at_home = ((one.position_m[:1], quaternion.from_matrix(one.basis[:1])) for one in (wrist, scene))

    def waiting(lift: float) -> FloatArray:
        return solved_pose(with_wrist(table, there, come, own, at_home, lift * off))

    least, _ = _least_lift(problem, scene, number, waiting, LIFTS_M[: len(LIFTS_M) // 2 + 1])
    # If no height clears the path to a station, it goes to a raised finger instead, unless that is too far.
    place = problem.stations[number][index]
    most = max(least, MOST_HOVER_M - HOVER_MORE * hover_m(place, scene.instrument_map))
    found, best = _Height(0.0, np.inf), least
    for height in (one for one in LIFTS_M.tolist() if least <= one <= most):
        one = _Height(*_least_lift(problem, scene, number, on_way(waiting(height)), LIFTS_M))
        if one.betters(found):
            found, best = one, height
        if found.near:
            break
    return replace(there, away_m=found.lift_m * away, waits_m=best * off), found


def _waiting(station: StationTable) -> FloatArray:
    """Return the rotations (2, n, 4) of a waiting finger at its greatest and its least height."""
    low = LOW_HOVER if station.hovers else 0.0
    return interpolated(station.values, station.rotations, np.array([0.0, low]))


def _least_lift(
    problem: HandProblem, scene: GripScene, number: int, lifted: Callable[[float], FloatArray], lifts_m: FloatArray
) -> tuple[float, float]:
    """Return the first of the heights ``lifts_m`` at which a finger clears the instrument, else the best of them, and
    the greatest depth there in metres.

    ``lifted`` returns the poses (K, n, 4) of the finger for a height.
    """
    hand = problem.hand
    own = slice(1 + 3 * number, 4 + 3 * number)
    carried = hand.all_points[own, 3].sum(axis=0) > 0.5
    skin = np.ascontiguousarray(hand.all_points[:, :, carried])
    place_m, bases = nodes_at(scene.model, scene.instrument_map, frozenset(), None, np.zeros(1))
    best, least = 0.0, np.inf
    for lift in lifts_m.tolist():
        fingers = lifted(lift)
        rotations = np.tile(quaternion.IDENTITY, (len(fingers), 16, 1))
        rotations[:, own] = fingers
        placed = scene.over(np.zeros(len(fingers)))
        flesh = placed.placed(skinned(wrist_from_mesh(hand, wrist_from_joint(hand, rotations)), skin))
        deep = max(
            float(inside_proxy(problem.proxies, place_m[0], bases[0], points, np.zeros(len(points)))[0].max())
            for points in flesh
        )
        clear = deep <= WAY_CLEAR_M
        if clear or deep < least - WORTH_M:
            best, least = lift, deep
        if clear:
            break
    return best, least
