"""Offsets of a hand for a finger that cannot reach one of its stations with the wrist at home.

A player rolls the hand to a side key and lifts it to a palm key while the other fingers stay on their holes. For such a
station the wrist and the other fingers are solved again near home.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.errors import Progress
from app.rig import quaternion
from app.rig.grip.finger_stations import Station
from app.rig.grip.fitting.fit_terms import GripScene
from app.rig.grip.fitting.hand_model import FINGERS
from app.rig.grip.fitting.hand_problem import (
    HandProblem,
    finger_dofs,
    home_controls,
    joint_angles,
    worked_dofs,
    wrist_transform,
)
from app.rig.grip.fitting.residuals import Residuals
from app.rig.grip.fitting.search import solve
from app.rig.grip.fitting.solved_fingers import Solved, followed_table, missed_m, solved_about
from app.rig.grip.fitting.touch_targets import TouchTarget, nodes_at, touch_at
from app.rig.grip.grip_pose import WristOffset

LEAN_FROM_M = 0.0015
"""Distance in metres by which a finger misses a station from which an offset of the hand is tried; see
`LEAN_WORTH_M`.
"""
LEAN_WORTH_M = 0.0005
"""Least gain in metres for the finger for which the offset is used."""
LEAN_SPREAD = (0.07, 0.12, 0.5)
"""Standard deviations of wrist (in 0.1 m), its rotation and fingers (rad) from home, smaller than between knots of a
slide.
"""
OWN_EASED, OTHERS_EASED = (1.5, 0.5), 1.5
"""Factors of the tolerances of working fingers while the wrist is searched: those that hold the instrument keep it,
others are mostly lifted anyway.
"""
LEFT_M = 0.0018
"""Distance in metres by which the finger must still miss its station for it to get a smaller tolerance."""
ROUNDS = 14
VALUES = np.array([0.0, 1.0])
"""Values of the other fingers' controls that are solved."""


@dataclass(frozen=True, eq=False)
class Leaning:
    """Offset of a hand by which one finger reaches a station that it cannot reach otherwise.

    ``solved`` is that finger at the station, ``others`` are the other fingers at home, ``scene`` is the offset wrist.
    """

    index: int
    scene: GripScene
    solved: Solved
    others: tuple[Solved, ...]


def leanings(
    problem: HandProblem,
    scene: GripScene,
    x: FloatArray,
    solved: Sequence[Solved],
    reported: Progress = lambda share: None,
) -> tuple[Leaning, ...]:
    """Return the wrist offset for every station that its finger cannot reach with the wrist at home; empty if the hand
    moves with a part of the instrument.
    """
    found = []
    if scene.carrier is not None:
        return ()
    homes = {one.number: one for one in reversed(solved)}
    for place, one in enumerate(solved):
        reported(place / len(solved))
        index = problem.stations[one.number].index(one.station) if one.station in problem.stations[one.number] else 0
        missed = missed_m(problem, scene, one)
        if not index or missed <= LEAN_FROM_M:
            continue
        tries: list[tuple[float, Leaning]] = []
        for eased in OWN_EASED:
            leant = _leant(problem, scene, x, one, index, homes, eased)
            tries.append((missed_m(problem, leant.scene, leant.solved), leant))
            if tries[-1][0] <= LEFT_M:
                break
        left, leant = min(tries, key=lambda one: one[0])
        if left < missed - LEAN_WORTH_M:
            found.append(leant)
    return tuple(found)


def _leant(
    problem: HandProblem,
    scene: GripScene,
    x: FloatArray,
    one: Solved,
    index: int,
    homes: dict[int, Solved],
    eased: float,
) -> Leaning:
    there = _lean_problem(problem, scene, one.number, one.station, x, eased)
    assert there.anchor is not None
    best = np.asarray(solve(Residuals(there, 1.0), there.anchor, ROUNDS).x)[None]
    position, turn = wrist_transform(there, best)
    moved = GripScene(scene.model, scene.instrument_map, None, position, quaternion.to_matrix(turn))
    angles = joint_angles(there, best)[0, 0]
    solved = followed_table(problem, moved, one.number, one.station, angles)
    others = tuple(
        solved_about(problem, moved, home, VALUES if len(home.values) > 1 else home.values, angles)
        for number, home in sorted(homes.items())
        if number != one.number and home.station.contacts
    )
    return Leaning(index, moved, solved, others)


def _lean_problem(
    problem: HandProblem, scene: GripScene, number: int, station: Station, x: FloatArray, eased: float
) -> HandProblem:
    """Return the least-squares problem of a hand whose finger ``number`` is at a station while the others stay at home.

    The wrist is kept near that in the parameters ``x``; ``eased`` relaxes the contacts of the station.
    """
    instrument, hand = scene.instrument_map, problem.hand
    chosen = [station if n == number else places[0] for n, places in enumerate(problem.stations) if places]
    worked = home_controls([[place] for place in chosen])
    of_fingers = {index for place in chosen for index in place.contacts}
    whole = whole_hand(hand.side)
    touches = tuple(
        _eased(
            touch_at(scene.model, instrument, contact, worked, None, np.ones(1)),
            eased if index in station.contacts else OTHERS_EASED,
        )
        for index, contact in enumerate(instrument.contacts)
        if index in of_fingers or contact.part in whole
    )
    place, turn = nodes_at(scene.model, instrument, worked, None, np.ones(1))
    count = 7 + len(problem.dofs)
    start = x[:count].copy()
    for offset, dof in enumerate(worked_dofs(problem)):
        start[7 + dof] = x[count + offset]
    for one in problem.elsewhere:
        if one.number == number and one.station == station:
            start[[7 + dof for dof in finger_dofs(problem, number)]] = x[one.angles]
    return replace(
        problem,
        touches=touches,
        touch_points=np.stack([hand.landmarks[t.contact.part] for t in touches], axis=2),
        touch_normals=np.stack([hand.landmark_normals[t.contact.part] for t in touches], axis=2),
        node_place=place,
        node_turn=turn,
        worked=(),
        configs=1,
        elsewhere=(),
        anchor=start,
        anchor_spread=LEAN_SPREAD,
        low=problem.low[:count],
        high=problem.high[:count],
    )


def _eased(touch: TouchTarget, by: float) -> TouchTarget:
    return touch if touch.contact.control is None else replace(touch, spread_m=touch.spread_m * by)


def whole_hand(side: str) -> tuple[str, ...]:
    """Return the names of the parts of a hand that touch without a finger."""
    return f"{side}.palm", f"{side}.thumb_web"


def lean_of(problem: HandProblem, scene: GripScene, leaning: Leaning) -> WristOffset:
    """Return the solved wrist of a leaning as an offset from the wrist at home."""
    before, after = quaternion.from_matrix(scene.basis[0]), quaternion.from_matrix(leaning.scene.basis[0])
    return WristOffset(
        finger=f"{problem.hand.side}.{FINGERS[leaning.solved.number]}",
        station=leaning.index,
        moved_m=leaning.scene.position_m[0] - scene.position_m[0],
        turned=quaternion.to_rotation_vector(quaternion.multiply(after, quaternion.conjugate(before))),
    )
