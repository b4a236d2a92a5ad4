"""Solution of fingers for values of their controls between rest and fully worked, with the wrist fixed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.errors import Progress
from app.rig.grip.finger_stations import Station, hover_m
from app.rig.grip.fitting.finger_on_touches import EXACTER, FingerOnTouches, touches_at
from app.rig.grip.fitting.fit_terms import GripScene
from app.rig.grip.fitting.hand_model import (
    FINGERS,
    joint_rotations,
    skinned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.grip.fitting.hand_problem import HandProblem, finger_dofs
from app.rig.grip.fitting.residuals import WORKED_RAD
from app.rig.grip.grip_pose import Chain, FingerTable, StationTable

LESS_EXACT = 1.5
"""Factor of the tolerance of fingers that stay while the hand is offset for another finger, so that they do not bend
unnaturally.
"""
FOLLOW_RAD = 0.15
"""Standard deviation in radians of angles between samples."""
SMOOTH_DEGREE = 3
SMOOTH_RAD = 0.04
"""Spread of a sample's angles about the smooth path over the control."""
MOVED_VALUES = np.linspace(0.0, 1.0, 17)
"""Solved values of a control on which a finger stays, or that moves its hand."""
HOVER_VALUES = np.linspace(0.0, 1.0, 9)
"""Solved values of a control over which a finger waits; keys have short travel."""
STILL_VALUES = np.zeros(1)


@dataclass(frozen=True, eq=False)
class Solved:
    """Joint angles (S, 16, 3) of the hand with one finger solved at one station for S values of its control; the other
    fingers keep the angles that were given.
    """

    number: int
    station: Station
    values: FloatArray
    angles: FloatArray


def values_of(scene: GripScene, station: Station) -> FloatArray:
    """Return the values of the finger's control at which its pose is solved at a station."""
    if scene.carrier is None and not station.controls:
        return STILL_VALUES
    return HOVER_VALUES if hover_m(station, scene.instrument_map) else MOVED_VALUES


def solve_tables(
    problem: HandProblem,
    scene: GripScene,
    angles: FloatArray,
    elsewhere: FloatArray,
    reported: Progress = lambda share: None,
) -> tuple[Solved, ...]:
    """Solve the fingers at each station over the values of their controls with the wrist fixed; a finger without
    contacts stays relaxed. Return one result for each finger and station.

    Parameters
    ----------
    angles : (S, configs, 16, 3) float64
        Joint angles of the solved grip: S is 1, or the number of values of the control that moves the hand.
    elsewhere : (n,) float64
        Parameters of the solved grip for the fingers' other stations.

    A finger has more joints than a touch needs, so samples solved separately may bend differently and the finger would
    twitch. Samples are solved one after another, from either end of the control's range, then again near a smooth path,
    and the better of the two results is kept.
    """
    result = []
    others = {(one.number, one.station.controls): elsewhere[one.angles] for one in problem.elsewhere}
    for number, places in enumerate(problem.stations):
        for index, station in enumerate(places or (Station("", (), ()),)):
            reported((number + index / (len(places) + 1)) / len(problem.stations))
            values = values_of(scene, station)
            pose = angles[:, 0] if len(angles) == len(values) else np.repeat(angles[:1, 0], len(values), axis=0)
            if not station.contacts:
                result.append(Solved(number, station, values, pose))
                continue
            finger = FingerOnTouches(problem, scene.over(values), number, station, values, pose)
            first = finger.taken(angles[0, 0])
            last = finger.taken(angles[-1, -1 if number in problem.worked else 0])
            if index:
                last = others.get((number, station.controls), last)
            found = _both_ways(finger, first, last)
            if finger.shuts(found):
                found = _both_ways(finger.opening(), first, last)
            solved = pose.copy()
            solved[:, finger.joints, finger.kinds] = found
            result.append(Solved(number, station, values, solved))
    return tuple(result)


def followed_table(problem: HandProblem, scene: GripScene, number: int, station: Station, angles: FloatArray) -> Solved:
    """Solve one finger at a station for all values of its control, starting from the angles (16, 3) of a hand with
    controls fully worked.
    """
    values = values_of(scene, station)
    pose = np.repeat(angles[None], len(values), axis=0)
    finger = FingerOnTouches(problem, scene.over(values), number, station, values, pose)
    found, _ = _followed(finger, finger.taken(angles), range(len(values))[::-1])
    if finger.shuts(found):
        found, _ = _followed(finger.opening(), finger.taken(angles), range(len(values))[::-1])
    pose[:, finger.joints, finger.kinds] = found
    return Solved(number, station, values, pose)


def solved_about(
    problem: HandProblem, scene: GripScene, home: Solved, values: FloatArray, angles: FloatArray
) -> Solved:
    """Solve a finger at its home station for another wrist, starting near the angles (16, 3) of a hand with controls
    fully worked.
    """
    pose = home.angles[np.searchsorted(home.values, values)].copy()
    pose += angles - pose[-1]
    exacter = LESS_EXACT if home.station.controls else EXACTER
    finger = FingerOnTouches(problem, scene.over(values), home.number, home.station, values, pose, exacter)
    usual = np.clip(finger.taken(pose), finger.low, finger.high)
    found, _ = finger.solve(usual, usual, FOLLOW_RAD, np.arange(len(values)))
    pose[:, finger.joints, finger.kinds] = found
    return Solved(home.number, home.station, values, pose)


def missed_m(problem: HandProblem, scene: GripScene, one: Solved) -> float:
    """Return the distance in metres of a finger from its touch points while its controls are fully worked."""
    if not one.station.contacts:
        return 0.0
    values = one.values[-1:]
    matrices = wrist_from_mesh(
        problem.hand, wrist_from_joint(problem.hand, joint_rotations(problem.hand, one.angles[-1:]))
    )
    far = 0.0
    for touch in touches_at(scene, one.station, values):
        at = scene.over(values).placed(skinned(matrices, problem.hand.landmarks[touch.contact.part][:, :, None]))
        if touch.active[-1]:
            far = max(far, float(np.linalg.norm(at[0, 0] - touch.positions[-1])))
    return far


def _both_ways(finger: FingerOnTouches, first: FloatArray, last: FloatArray) -> FloatArray:
    """Return the angles (S, n) of a finger over S samples, solved one after another from that end of its control's
    range which gives the lower cost.
    """
    count = len(finger.values)
    if count == 1:
        return finger.solve(last[None], last[None], WORKED_RAD, np.arange(1))[0]
    ways = [(first, range(count)), (last, range(count)[::-1])]
    return min((_followed(finger, *way) for way in ways), key=lambda one: one[1])[0]


def _followed(finger: FingerOnTouches, start: FloatArray, order: Sequence[int]) -> tuple[FloatArray, float]:
    """Return the angles (S, n) of a finger, solved from sample to sample in an order and smoothed, and their cost."""
    found = np.zeros((len(order), len(start)))
    here = start
    for sample in order:
        here = finger.solve(here[None], here[None], FOLLOW_RAD, np.array([sample]))[0][0]
        found[sample] = here
    everywhere = np.arange(len(order))
    cost = np.zeros(len(order))
    powers = np.vander(finger.values, SMOOTH_DEGREE + 1)
    for _ in range(2):
        path = powers @ np.linalg.lstsq(powers, found, rcond=None)[0]
        found, cost = finger.solve(path, path, SMOOTH_RAD, everywhere)
    return found, float(cost.sum())


def finger_tables(problem: HandProblem, scene: GripScene, solved: Sequence[Solved]) -> tuple[FingerTable, ...]:
    """Return the tables of finger poses (rotations) for the solved angles."""
    hand = problem.hand
    tables = []
    for number, name in enumerate(FINGERS):
        places = slice(1 + 3 * number, 4 + 3 * number)
        found = []
        for one in solved:
            if one.number == number:
                moves = one.station.controls or (() if scene.carrier is None else (scene.carrier.name,))
                hovers = hover_m(one.station, scene.instrument_map) > 0.0
                rotations = joint_rotations(hand, one.angles)[:, places]
                found.append(StationTable(moves, hovers, one.values, rotations, *_tip(problem, scene, one)))
        chain = None if scene.carrier is not None else _chain(problem, number)
        tables.append(FingerTable(f"{hand.side}.{name}", hand.joints[places], tuple(found), chain))
    return tuple(tables)


def _tip(problem: HandProblem, scene: GripScene, one: Solved) -> tuple[int, FloatArray]:
    """Return the index of the finger's joint that carries a station's touching point, and the point (3,) in that
    joint's frame; -1 if nothing is touched."""
    if not one.station.contacts:
        return -1, np.zeros(3)
    hand = problem.hand
    part = scene.instrument_map.contacts[one.station.contacts[0]].part
    transforms = wrist_from_joint(hand, joint_rotations(hand, one.angles[-1:]))
    point = skinned(wrist_from_mesh(hand, transforms), hand.landmarks[part][:, :, None])[0, 0]
    joint = {"proximal": 0, "middle": 1}.get(part.partition("_")[2], 2)
    carrier = transforms[0, 1 + 3 * one.number + joint]
    return joint, (point - carrier[:, 3]) @ carrier[:, :3]


def _chain(problem: HandProblem, number: int) -> Chain:
    hand, places = problem.hand, slice(1 + 3 * number, 4 + 3 * number)
    dofs = [problem.dofs[i] for i in finger_dofs(problem, number)]
    return Chain(
        offsets_m=hand.offsets_m[places],
        axes=hand.axes[places],
        dofs=np.array([(dof.joint - places.start, dof.kind) for dof in dofs], dtype=np.float64),
        low=np.array([dof.low for dof in dofs]),
        high=np.array([dof.high for dof in dofs]),
    )
