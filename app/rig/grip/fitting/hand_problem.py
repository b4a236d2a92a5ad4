"""The least-squares problem of one hand on one instrument: constants, and meaning of the parameters.

The parameters of a hand form a row ``x``: the wrist's position (3, in units of 0.1 m from the seed), its rotation (3,
rotation vector from the seed), the elbow's swivel, the finger angles with every control at rest, those of working
fingers with the controls of their home stations fully worked, and those of every finger at each of its other stations.
``configs`` is 2 if any finger works a control at home.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.carriage import Upright
from app.rig.grip.finger_stations import Station, stations
from app.rig.grip.fitting.arm_problem import ArmProblem, arm_problem, carrier_of
from app.rig.grip.fitting.hand_model import FINGERS, HandModel, hand_model, rest_landmark
from app.rig.grip.fitting.touch_targets import TouchTarget, nodes_at, touch_at
from app.rig.grip.grip_pose import Side
from app.rig.grip.instrument_proxy import Bodies, bodies, near
from app.rig.model import Character, InstrumentModel
from instrument_maps.hold import Contact, HandSeed
from instrument_maps.model import Control, InstrumentMap
from metadata.load import load_skeleton
from metadata.model import Body

# Deviations that give a residual of one.
CURL_RAD, SIDEWAYS_RAD, THUMB_RAD, COUPLING_RAD = 0.4, 0.12, 0.4, 0.18
ANCHOR = (0.25, 0.7, 0.5)
"""Standard deviations of the wrist's position (in 0.1 m), its rotation and the fingers (rad) between knots of a
slide.
"""
METRES = 0.1
"""Unit of the wrist's position in metres, so that it has the weight of radians."""
NEAR_M = 0.28
"""Distance from the palm in metres beyond which bodies of the proxy are ignored."""


@dataclass(frozen=True, eq=False)
class Dof:
    """One angle of a finger joint that the solver changes: present value, range and relaxed value."""

    joint: int
    kind: int
    low: float
    high: float
    relaxed: float
    spread: float


@dataclass(frozen=True, eq=False)
class Elsewhere:
    """A finger at a station other than home, with its control fully worked.

    ``points`` and ``normals`` are those of the landmarks that touch, ``angles`` the slice of the finger's angles in the
    parameters.
    """

    number: int
    station: Station
    touches: tuple[TouchTarget, ...]
    points: FloatArray
    normals: FloatArray
    angles: slice


@dataclass(frozen=True, eq=False)
class HandProblem(ArmProblem):
    """Constants of the least-squares problem of one hand on its instrument."""

    hand: HandModel
    seed_m: FloatArray
    seed_rotation: FloatArray
    dofs: tuple[Dof, ...]
    stations: tuple[tuple[Station, ...], ...]
    worked: tuple[int, ...]
    touches: tuple[TouchTarget, ...]
    touch_points: FloatArray
    touch_normals: FloatArray
    node_place: FloatArray
    node_turn: FloatArray
    proxies: Bodies
    configs: int
    elsewhere: tuple[Elsewhere, ...] = ()
    anchor: FloatArray | None = None
    anchor_spread: tuple[float, float, float] = ANCHOR
    low: FloatArray = field(default_factory=lambda: np.zeros(0))
    high: FloatArray = field(default_factory=lambda: np.zeros(0))


def grip_problem(
    character: Character,
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    body: Body,
    seed: HandSeed,
    stand: Upright,
) -> tuple[HandProblem, Control | None]:
    side = seed.hand
    hand = hand_model(character, side, body, load_skeleton(body.skeleton))
    carrier = carrier_of(instrument_map, seed)
    names = tuple(model.node_names)
    places = stations(instrument_map)
    of_finger = tuple(places.get(f"{side}.{finger}", ()) for finger in FINGERS)
    worked = tuple(number for number, found in enumerate(of_finger) if found and found[0].controls)
    home = home_controls(of_finger)
    touches = []
    for contact, number in _contacts_at_home(instrument_map, side, of_finger):
        touch = touch_at(model, instrument_map, contact, home, carrier, np.array([0.0, 1.0]))
        touches.append(replace(touch, active=touch.active & np.array([True, number in worked])))
    palm = rest_landmark(hand, f"{side}.palm")
    turn = seed_turn(seed)
    seed_m = model.node_positions_m[names.index(seed.node)] + seed.palm_position_m - quaternion.rotate(turn, palm)
    place, node_turn = nodes_at(model, instrument_map, home, carrier, np.array([0.0, 1.0]))
    near_hand = near(
        bodies(instrument_map.proxy, names), model.node_positions_m, seed_m + quaternion.rotate(turn, palm), NEAR_M
    )
    problem = HandProblem(
        **vars(arm_problem(character, instrument_map, body, seed, stand)),
        hand=hand,
        seed_m=seed_m,
        seed_rotation=turn,
        dofs=_dofs(hand, seed.curl),
        stations=of_finger,
        worked=worked,
        touches=tuple(touches),
        touch_points=np.stack([hand.landmarks[t.contact.part] for t in touches], axis=2),
        touch_normals=np.stack([hand.landmark_normals[t.contact.part] for t in touches], axis=2),
        node_place=place,
        node_turn=node_turn,
        proxies=near_hand,
        configs=2 if worked else 1,
    )
    problem = replace(problem, elsewhere=_elsewhere(problem, model, instrument_map, carrier))
    low, high = _bounds(problem)
    return replace(problem, low=low, high=high), carrier


def _contacts_at_home(
    instrument_map: InstrumentMap, side: Side, stations: tuple[tuple[Station, ...], ...]
) -> Iterator[tuple[Contact, int]]:
    """Yield each contact that a hand has with its fingers at their home stations, with the finger's index, or -1 for
    the palm.
    """
    for index, contact in enumerate(instrument_map.contacts):
        if contact.part.startswith(f"{side}."):
            finger = contact.part.split(".")[1]
            number = FINGERS.index(finger) if finger in FINGERS else -1
            if number < 0 or index in stations[number][0].contacts:
                yield contact, number


def seed_turn(seed: HandSeed) -> FloatArray:
    """Return the wrist's rotation (4,) in the instrument's frame that the map suggests as a start."""
    outward = -1.0 if seed.hand == "left" else 1.0
    direction, normal = np.asarray(seed.finger_direction), np.asarray(seed.palm_normal)
    direction = direction - normal * float(direction @ normal) / float(normal @ normal)
    x_axis = -outward * direction / np.linalg.norm(direction)
    return quaternion.from_frames(x_axis, -normal / np.linalg.norm(normal))


def home_controls(of_finger: Sequence[Sequence[Station]]) -> frozenset[str]:
    """Return the controls that the fingers of a hand work at their home stations."""
    return frozenset(name for places in of_finger if places for name in places[0].controls)


def _elsewhere(
    problem: HandProblem, model: InstrumentModel, instrument_map: InstrumentMap, carrier: Control | None
) -> tuple[Elsewhere, ...]:
    """Return each finger at each station other than home; empty for a hand that a control moves."""
    found = []
    start = 7 + len(problem.dofs) + len(worked_dofs(problem))
    for number, places in enumerate(problem.stations if carrier is None else ()):
        for station in places[1:]:
            contacts = [instrument_map.contacts[index] for index in station.contacts]
            at = (frozenset(station.controls), None, np.ones(1))
            stop = start + len(finger_dofs(problem, number))
            touches = tuple(touch_at(model, instrument_map, contact, *at) for contact in contacts)
            points = np.stack([problem.hand.landmarks[contact.part] for contact in contacts], axis=2)
            normals = np.stack([problem.hand.landmark_normals[contact.part] for contact in contacts], axis=2)
            found.append(Elsewhere(number, station, touches, points, normals, slice(start, stop)))
            start = stop
    return tuple(found)


def _dofs(hand: HandModel, curl: tuple[float, ...]) -> tuple[Dof, ...]:
    """Return the angles to solve, thumb first, with relaxed values from ``curl`` of each finger (1 is a fist)."""
    found = []

    def add(joint: int, kind: int, relaxed_deg: float, spread: float, share: float = 1.0) -> None:
        low, high = hand.limits[joint, kind] * share
        found.append(Dof(joint, kind, low, high, float(np.radians(relaxed_deg)), spread))

    add(1, 0, 8.0, THUMB_RAD)
    add(1, 1, 20.0, THUMB_RAD)
    add(1, 2, 0.0, THUMB_RAD * 0.5)
    add(2, 0, 12.0, THUMB_RAD)
    add(3, 0, 15.0, THUMB_RAD)
    for number, bend in zip(range(1, 5), curl, strict=True):
        first = 1 + 3 * number
        add(first, 0, 80.0 * bend, CURL_RAD)
        add(first, 1, 0.0, SIDEWAYS_RAD)
        add(first + 1, 0, 100.0 * bend, CURL_RAD)
        add(first + 2, 0, 66.0 * bend, CURL_RAD)
    return tuple(found)


def finger_dofs(problem: HandProblem, number: int) -> list[int]:
    return [i for i, dof in enumerate(problem.dofs) if (dof.joint - 1) // 3 == number]


def worked_dofs(problem: HandProblem) -> list[int]:
    return [i for number in problem.worked for i in finger_dofs(problem, number)]


def _bounds(problem: HandProblem) -> tuple[FloatArray, FloatArray]:
    """Return the lower and upper bounds (n,) of all n parameters, in the order described for the module."""
    order = _order(problem)
    low = [-np.inf] * 6 + [problem.swivel_range[0]] + [problem.dofs[i].low for i in order]
    high = [np.inf] * 6 + [problem.swivel_range[1]] + [problem.dofs[i].high for i in order]
    return np.array(low), np.array(high)


def _order(problem: HandProblem) -> list[int]:
    """Return for each parameter from the eighth on the index in ``problem.dofs`` of the angle it stands for."""
    elsewhere = [i for one in problem.elsewhere for i in finger_dofs(problem, one.number)]
    return [*range(len(problem.dofs)), *worked_dofs(problem), *elsewhere]


def start_at(problem: HandProblem, turn: FloatArray) -> FloatArray:
    order = _order(problem)
    angles = [np.clip(problem.dofs[i].relaxed, problem.dofs[i].low, problem.dofs[i].high) for i in order]
    start = np.array([0.0, 0.0, 0.0, *turn, problem.swivel_usual, *angles])
    clipped: FloatArray = np.clip(start, problem.low + 1e-6, problem.high - 1e-6)
    return clipped


def wrist_transform(problem: HandProblem, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return position (B, 3) and rotation (B, 4) of the wrist in the instrument's frame for parameters ``x`` of B
    candidates.
    """
    turn = quaternion.multiply(quaternion.from_rotation_vector(x[:, 3:6]), problem.seed_rotation)
    return problem.seed_m + METRES * x[:, :3], turn


def joint_angles(problem: HandProblem, x: FloatArray) -> FloatArray:
    """Return the joint angles (B, configs, 16, 3) for parameters ``x`` of B candidates."""
    result = np.zeros((len(x), problem.configs, 16, 3))
    count = len(problem.dofs)
    for i, dof in enumerate(problem.dofs):
        result[:, :, dof.joint, dof.kind] = x[:, 7 + i, None]
    for k, i in enumerate(worked_dofs(problem)):
        result[:, 1, problem.dofs[i].joint, problem.dofs[i].kind] = x[:, 7 + count + k]
    return result
