"""The fingers between the ends of their controls, solved with the wrist held."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.errors import Progress
from app.rig.grip.finger_stations import Station, hover_m
from app.rig.grip.fitting.fit_terms import GripScene
from app.rig.grip.fitting.hand_model import (
    FINGERS,
    ball_centres,
    flesh_radius,
    joint_rotations,
    skinned,
    turned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.grip.fitting.hand_problem import (
    COUPLING_RAD,
    HandProblem,
    TouchTarget,
    contact_at,
    finger_dofs,
    nodes_at,
    touch_at,
)
from app.rig.grip.fitting.residuals import PENETRATION_M, STEP, WORKED_RAD, inside_proxy, pressure_cost
from app.rig.grip.grip_pose import Chain, FingerTable, StationTable

EXACTER = 0.3
"""Factor by which touches are met more exactly than in the search once the wrist is held."""
LESS_EXACT = 1.5
"""Fingers that stay while the hand gives way for another one keep their places less exactly, rather than break."""
ROUNDS = 12

CARRIED_SHARE = 0.1
"""Skin with at least this weight on a finger's joints moves with it: webs too."""
FOLLOW_RAD = 0.15
"""Spread of angles from one sample to the next."""
SMOOTH_DEGREE = 3
SMOOTH_RAD = 0.04
"""Spread of a sample's angles about the smooth path over the control."""
OPEN_M, OPEN_SPREAD_M = (0.007, 0.0045), (0.0005, 0.0001)
"""A finger at another place keeps so far from a hole that it is to leave open; the second where it otherwise ..."""
LEAST_OPEN_M = 0.0032
"""... comes nearer than this: the hole would not sound open."""
MOVED_VALUES = np.linspace(0.0, 1.0, 17)
"""Values of a control that a finger stays on, or that carries its hand, at which it is solved ..."""
HOVER_VALUES = np.linspace(0.0, 1.0, 9)
"""... and of one that it waits over; keys go a short way."""
STILL_VALUES = np.zeros(1)


@dataclass(frozen=True, eq=False)
class Solved:
    """Angles (S, 16, 3) of one finger at one station over values (S,); the other fingers' stand as they were given."""

    number: int
    station: Station
    values: FloatArray
    angles: FloatArray


def values_of(scene: GripScene, station: Station) -> FloatArray:
    """Values at which a finger is solved at a station."""
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
    """Solve the fingers at each of their stations over the values of their controls, the wrist held; a finger that
    touches nothing keeps its relaxed bend.

    Parameters
    ----------
    angles : (S, configs, 16, 3) float64
        Of the solved hold, one sample or one for every value of what carries the hand.
    elsewhere : (n,) float64
        The parameters of the solved hold, for the fingers' other stations.

    A finger has more joints than a touch needs, so samples solved apart may fall into different bends and the finger
    would twitch. Each is followed from one end of the control to the other, from both ends, solved again about a smooth
    path, and the better of the two kept.
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
            finger = _Finger(problem, scene.over(values), number, station, values, pose)
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
    """Solve one finger at a station, from the angles (16, 3) of a hand whose controls there are fully worked."""
    values = values_of(scene, station)
    pose = np.repeat(angles[None], len(values), axis=0)
    finger = _Finger(problem, scene.over(values), number, station, values, pose)
    found, _ = _followed(finger, finger.taken(angles), range(len(values))[::-1])
    if finger.shuts(found):
        found, _ = _followed(finger.opening(), finger.taken(angles), range(len(values))[::-1])
    pose[:, finger.joints, finger.kinds] = found
    return Solved(number, station, values, pose)


def solved_about(
    problem: HandProblem, scene: GripScene, home: Solved, values: FloatArray, angles: FloatArray
) -> Solved:
    """Solve a finger at home again for another wrist, about the angles (16, 3) of a hand that works its controls there
    fully."""
    pose = home.angles[np.searchsorted(home.values, values)].copy()
    pose += angles - pose[-1]
    exacter = LESS_EXACT if home.station.controls else EXACTER
    finger = _Finger(problem, scene.over(values), home.number, home.station, values, pose, exacter)
    usual = np.clip(finger.taken(pose), finger.low, finger.high)
    found, _ = finger.solve(usual, usual, FOLLOW_RAD, np.arange(len(values)))
    pose[:, finger.joints, finger.kinds] = found
    return Solved(home.number, home.station, values, pose)


def missed_m(problem: HandProblem, scene: GripScene, one: Solved) -> float:
    """Return how far a finger stays from its touch points while what it works is fully worked."""
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


def _both_ways(finger: _Finger, first: FloatArray, last: FloatArray) -> FloatArray:
    """Angles (S, n) of a finger followed from whichever end of its values costs less."""
    count = len(finger.values)
    if count == 1:
        return finger.solve(last[None], last[None], WORKED_RAD, np.arange(1))[0]
    ways = [(first, range(count)), (last, range(count)[::-1])]
    return min((_followed(finger, *way) for way in ways), key=lambda one: one[1])[0]


def _followed(finger: _Finger, start: FloatArray, order: Sequence[int]) -> tuple[FloatArray, float]:
    """Angles (S, n) of a finger followed from one sample to the next, then smoothed, and what they cost."""
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


class _Finger:
    """One finger on its touches at some values of the controls, the rest of the hand held."""

    def __init__(
        self,
        problem: HandProblem,
        scene: GripScene,
        number: int,
        station: Station,
        values: FloatArray,
        pose: FloatArray,
        exacter: float = EXACTER,
    ) -> None:
        hand = problem.hand
        self.exacter = exacter
        dofs = [problem.dofs[i] for i in finger_dofs(problem, number)]
        self.problem, self.scene, self.number, self.values, self.pose = problem, scene, number, values, pose
        self.joints, self.kinds = np.array([dof.joint for dof in dofs]), np.array([dof.kind for dof in dofs])
        self.low, self.high = np.array([dof.low for dof in dofs]), np.array([dof.high for dof in dofs])
        self.touches = touches_at(scene, station, values)
        self.points = np.stack([hand.landmarks[t.contact.part] for t in self.touches], axis=2)
        self.normals = np.stack([hand.landmark_normals[t.contact.part] for t in self.touches], axis=2)
        self.kept_open = _kept_open(problem, scene, number, station)
        self.open_m, self.open_spread_m = OPEN_M[0], OPEN_SPREAD_M[0]
        carried = hand.all_points[1 + 3 * number : 4 + 3 * number, 3].sum(axis=0) > CARRIED_SHARE
        self.skin = np.ascontiguousarray(hand.all_points[:, :, carried])
        self.balls = np.flatnonzero(hand.ball_finger == number)
        self.radius = np.concatenate([np.zeros(self.skin.shape[2]), flesh_radius(hand)[self.balls]])
        moved = frozenset(station.controls)
        self.nodes = nodes_at(scene.model, scene.instrument_map, moved, scene.carrier, values)

    def taken(self, angles: FloatArray) -> FloatArray:
        """This finger's angles (..., n) out of those of a hand (..., 16, 3)."""
        return angles[..., self.joints, self.kinds]

    def opening(self) -> _Finger:
        """The same finger that does more to leave holes open."""
        result = copy(self)
        result.open_m, result.open_spread_m = OPEN_M[1], OPEN_SPREAD_M[1]
        return result

    def shuts(self, x: FloatArray) -> bool:
        """Return whether a finger with angles (S, n) shuts a hole, or nearly, that it is to leave open."""
        pose = self.pose.copy()
        pose[:, self.joints, self.kinds] = x
        matrices = wrist_from_mesh(
            self.problem.hand, wrist_from_joint(self.problem.hand, joint_rotations(self.problem.hand, pose))
        )
        for part, hole in self.kept_open:
            at = self.scene.placed(skinned(matrices, self.problem.hand.landmarks[part][:, :, None]))[:, 0]
            if np.linalg.norm(at - hole, axis=1).min() < LEAST_OPEN_M:
                return True
        return False

    def solve(
        self, start: FloatArray, usual: FloatArray, usual_rad: float, which: IndexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Solve some samples about usual angles; both (S, n). Returns the angles and the cost (S,) of each.

        Damped Gauss-Newton (Levenberg-Marquardt, clipped to the limits), all samples at once: they are independent,
        so their normal equations are solved as a batch.
        """
        x = np.clip(start, self.low, self.high)
        damping = np.full(len(which), 1e-3)
        cost, depth, slope = self._cost(x, usual, usual_rad, which)
        for _ in range(ROUNDS):
            jacobian, value = self._linear(x, usual, usual_rad, which, depth, slope)
            new = self._step(x, jacobian, value, damping)
            new_cost, new_depth, new_slope = self._cost(new, usual, usual_rad, which)
            better = new_cost < cost
            settled = np.all(np.where(better, cost - new_cost, 0.0) < 1e-6 * cost)
            x = np.where(better[:, None], new, x)
            depth = np.where(better[:, None], new_depth, depth)
            slope = np.where(better[:, None, None], new_slope, slope)
            cost = np.where(better, new_cost, cost)
            damping = np.where(better, damping * 0.3, damping * 5.0)
            if settled and better.any():
                break
        return x, cost

    def _step(self, x: FloatArray, jacobian: FloatArray, value: FloatArray, damping: FloatArray) -> FloatArray:
        down = np.einsum("smn,sm->sn", jacobian, value)
        # An angle at its limit that would be pushed further stays.
        free = ~(((x <= self.low) & (down > 0.0)) | ((x >= self.high) & (down < 0.0)))
        normal = np.einsum("smn,smk->snk", jacobian, jacobian) * free[:, :, None] * free[:, None, :]
        corner = np.arange(x.shape[1])
        normal[:, corner, corner] += damping[:, None] * np.einsum("sii->si", normal) + ~free + 1e-9
        stepped: FloatArray = x - np.linalg.solve(normal, (down * free)[..., None])[..., 0]
        return np.clip(stepped, self.low, self.high)

    def _cost(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IndexArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        smooth, skin = self._residuals(x[None], usual, usual_rad, which)
        place, turn = self.nodes
        found = [
            inside_proxy(self.problem.proxies, place[s], turn[s], skin[0, k], self.radius) for k, s in enumerate(which)
        ]
        depth, slope = np.stack([depth for depth, _ in found]), np.stack([slope for _, slope in found])
        cost = np.square(smooth[0]).sum(axis=1) + np.square(pressure_cost(depth)[0] / PENETRATION_M).sum(axis=1)
        return cost, depth, slope

    def _linear(
        self,
        x: FloatArray,
        usual: FloatArray,
        usual_rad: float,
        which: IndexArray,
        depth: FloatArray,
        slope: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Jacobian (S, m, n) and residuals (S, m)."""
        count = x.shape[1]
        tried = np.repeat(x[None], count + 1, axis=0)
        step = np.where(x + STEP < self.high, STEP, -STEP).T
        tried[np.arange(1, count + 1), :, np.arange(count)] += step
        smooth, skin = self._residuals(tried, usual, usual_rad, which)
        slant = np.moveaxis((smooth[1:] - smooth[0]) / step[:, :, None], 0, 2)
        change = (skin[1:] - skin[0]) / step[:, :, None, None]
        push, rise = pressure_cost(depth)
        skin_slope = -np.einsum("nsvi,svi->svn", change, slope) * rise[..., None] / PENETRATION_M
        return (np.concatenate([slant, skin_slope], axis=1), np.concatenate([smooth[0], push / PENETRATION_M], axis=1))

    def _residuals(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IndexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Residuals (B, S, m) without the proxy's, and skin (B, S, V, 3), for angles (B, S, n)."""
        hand = self.problem.hand
        pose = np.repeat(self.pose[None, which], len(x), axis=0)
        pose[:, :, self.joints, self.kinds] = x
        transforms = wrist_from_joint(hand, joint_rotations(hand, pose.reshape(-1, 16, 3)))
        matrices = wrist_from_mesh(hand, transforms)
        scene, shape = self.scene.only(which), (len(x), len(which), -1, 3)
        flesh = np.concatenate([skinned(matrices, self.skin), ball_centres(hand, transforms)[:, self.balls]], axis=1)
        at = scene.placed(skinned(matrices, self.points).reshape(shape))
        facing = scene.turned(turned(matrices, self.normals).reshape(shape))
        parts = [(x - usual) / usual_rad]
        if self.number:
            parts.append(((x[..., 3] - 0.67 * x[..., 2]) / COUPLING_RAD)[..., None])
        for k, touch in enumerate(self.touches):
            active = touch.active[which, None].astype(np.float64)
            off = (at[:, :, k] - touch.positions[which]) / touch.spread_m[which, None]
            parts.append(off / self.exacter * active)
            turn = (facing[:, :, k] + touch.normals[which]) / touch.spread_normal[which, None]
            parts.append(turn * active)
        for part, hole in self.kept_open:
            near = scene.placed(skinned(matrices, hand.landmarks[part][:, :, None]).reshape(shape))[:, :, 0] - hole
            gap = np.sqrt(np.einsum("nsi,nsi->ns", near, near))
            parts.append((np.maximum(self.open_m - gap, 0.0) / self.open_spread_m)[..., None])
        return np.concatenate(parts, axis=2), scene.placed(flesh.reshape(shape))


def _kept_open(problem: HandProblem, scene: GripScene, number: int, station: Station) -> list[tuple[str, FloatArray]]:
    """Holes that a finger closes elsewhere and must leave open here: the part that would, and where they are."""
    instrument, found = scene.instrument_map, []
    for place in problem.stations[number]:
        for contact in (instrument.contacts[index] for index in place.contacts):
            hole = None if contact.control in (None, *station.controls) else instrument.control(contact.control or "")
            if hole is not None and hole.kind == "hole":
                at, _ = contact_at(scene.model, instrument, contact, frozenset(), None, np.zeros(1))
                found.append((contact.part, at[0]))
    return found


def touches_at(scene: GripScene, station: Station, values: FloatArray) -> list[TouchTarget]:
    """The touches of a finger at a station over values of what it works there."""
    instrument, moved = scene.instrument_map, frozenset(station.controls)
    return [
        touch_at(scene.model, instrument, instrument.contacts[index], moved, scene.carrier, values)
        for index in station.contacts
    ]


def finger_tables(problem: HandProblem, scene: GripScene, solved: Sequence[Solved]) -> tuple[FingerTable, ...]:
    """The solved angles as rotations, finger by finger."""
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
    """The joint of a finger that carries what touches at a station, and where that is in its frame."""
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
