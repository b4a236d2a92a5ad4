"""Fitting a hold: how one body's hands lie on one instrument.

For each hand a bounded least-squares problem: the wrist's place in the instrument's frame, the finger joints with
every control at rest and again with every control fully worked, and the elbow's swivel. Wanted are the map's
contacts on the deformed skin, no skin inside the instrument's proxy, fingers that do not pass through each other, a
straight wrist under a natural elbow, and fingers near their relaxed curl. The fingers that work a control are then
solved for values between.

All perturbed poses of a Jacobian go through one vectorised call; the proxy is measured exactly at the current
pose and linearised by its gradient.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator
from scipy.optimize import least_squares
from threadpoolctl import threadpool_limits

from app.rig import quaternion
from app.rig.hand import (
    FINGERS,
    HandModel,
    ball_centres,
    flesh_radius,
    hand_model,
    joint_rotations,
    skinned,
    turned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.hold import ContactFit, FingerTable, HandHold, Hold, Lips, NodeMotion, Reach, Side, interpolated
from app.rig.ik import TWIST_SHARE
from app.rig.instrument import control_transform, node_transforms
from app.rig.model import Character, InstrumentModel
from app.rig.proxy import Bodies, bodies, gradient, inside, near
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import landmark_positions, landmark_set, skin_matrices
from instrument_maps.model import ROOT, Contact, Control, HandSeed, InstrumentMap
from metadata.load import load_skeleton
from metadata.model import Body

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]

# What a deviation of one unit of residual is.
FIRM_M, RESTING_M = 0.0003, 0.0012
FIRM_NORMAL, RESTING_NORMAL = 0.35, 0.6
PENETRATION_M, FOREARM_M = 0.0005, 0.003
GIVE_M, STIFFENING = 0.0018, 5.0
BALL_M = 0.001
CURL_RAD, SIDEWAYS_RAD, THUMB_RAD, COUPLING_RAD = 0.4, 0.12, 0.4, 0.18
WORKED_RAD, SMOOTH_RAD = 0.5, 0.04
SMOOTH_DEGREE = 3
FLEXION_RAD, DEVIATION_RAD, PRONATION_RAD, SWIVEL_RAD = 0.3, 0.16, 0.8, 0.25
LIMIT_RAD, LIMIT_SHARE = 0.025, 0.8
SEED_M, SEED_RAD = 0.03, 0.4
PRONATION_MOST_RAD = 1.3
SWIVEL_RANGE_RAD = (0.2, 0.9)
"""The elbow hangs, off the ribs: its swing from straight down to the outside."""
REACH_M = 0.03
"""Of an arm that is too short: the shoulder's help is dear, but a finger tip's grip does not bridge half a metre."""
ANCHOR = (0.25, 0.4, 0.5)
"""How far the wrist's place (in 0.1 m), its turn and the fingers (rad) wander from one knot of a slide to the next."""
TABLE_VALUES = 17
KNOTS = (0.25, 0.0, 0.5, 0.75, 1.0)
"""Values of the control that carries a hand at which its hold is solved: the first from the seed, the others each from
its solved neighbour. The grip turns in the fingers as the arm stretches."""
_METRES = 0.1
"""The wrist's place is solved in units of this many metres, to weigh like radians."""
_STEP = 1e-6


@dataclass(frozen=True, eq=False)
class _Dof:
    """One angle of a finger joint: where it stands, its range and its relaxed value."""

    joint: int
    kind: int
    low: float
    high: float
    relaxed: float
    spread: float


@dataclass(frozen=True, eq=False)
class _Touch:
    """A contact in the instrument's frame, at both ends of its control."""

    contact: Contact
    positions: FloatArray
    normals: FloatArray
    active: tuple[bool, bool]
    spread_m: float
    spread_normal: float


@dataclass(frozen=True, eq=False)
class _Problem:
    """Everything that is fixed while one hand is solved."""

    hand: HandModel
    seed_m: FloatArray
    seed_rotation: FloatArray
    dofs: tuple[_Dof, ...]
    worked: tuple[int, ...]
    touches: tuple[_Touch, ...]
    touch_points: FloatArray
    touch_normals: FloatArray
    node_place: FloatArray
    node_turn: FloatArray
    proxies: Bodies
    shoulder_m: FloatArray
    upper_m: float
    lower_m: float
    swivel_frame: FloatArray
    swivel_usual: float
    reference_shift_m: FloatArray
    configs: int
    wrist_limits: FloatArray
    anchor: FloatArray | None = None
    low: FloatArray = field(default_factory=lambda: np.zeros(0))
    high: FloatArray = field(default_factory=lambda: np.zeros(0))


FIT_VERSION = 4
"""Part of the digest of stored holds (`app.rig.hold_file`): raise it when a fit comes out differently."""


def fit_hold(character: Character, model: InstrumentModel, instrument_map: InstrumentMap, body: Body) -> Hold:
    """Fit how a character holds an instrument; deterministic, and slow: `app.rig.hold_file.hold_for` keeps the results.

    Parameters
    ----------
    character : Character
    model : InstrumentModel
    instrument_map : InstrumentMap
    body : Body
        Limits of the joints and posture.

    Returns
    -------
    Hold
        What could not be met stands in its ``contacts``, ``penetration_m`` and ``reach``.
    """
    lips = fit_lips(character)
    # The matrices are small: more threads make it no faster, far slower on a busy machine, and change the last bits.
    with threadpool_limits(limits=1, user_api="blas"):
        fitted = [_fit_hand(character, model, instrument_map, body, seed, lips) for seed in instrument_map.hands]
    hands, reach = zip(*fitted, strict=True)
    return Hold(character.id, instrument_map.id, hands, lips, reach)


@lru_cache(maxsize=32)
def fit_lips(character: Character) -> Lips:
    """Find the lips of a character in its head's frame, and how each morph moves them."""
    skeleton = character.skeleton
    names = ("lips.contact", "lips.upper")
    marks = landmark_set(character, names)
    rest = forward(skeleton, np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1)))
    head, _ = rest.of(skeleton.index("head"))
    places = landmark_positions(character, names, rest)[0] - head[0]
    matrices = skin_matrices(marks.joints, marks.joint_from_mesh, rest)[0, ..., :3]
    moved = {name: np.einsum("jab,jbl->la", matrices, deltas) for name, deltas in marks.morphs.items()}
    return Lips(
        contact_rest_m=places[0],
        contact_deltas_m={name: delta[0] for name, delta in moved.items() if np.abs(delta[0]).max() > 1e-6},
        upper_rest_m=places[1],
        upper_deltas_m={name: delta[1] for name, delta in moved.items() if np.abs(delta[1]).max() > 1e-6},
    )


def usual_instrument(character: Character, instrument_map: InstrumentMap, lips: Lips) -> tuple[FloatArray, FloatArray]:
    """Place (3,) and rotation (4,) of the instrument at the lips of the upright rest pose, carried as usual."""
    rest = rest_positions(character.skeleton)
    mouth = rest[character.skeleton.index("head")] + lips.contact_rest_m
    turn = carriage_rotation(*(getattr(instrument_map.hold.standing, name)[1] for name in _ANGLES))
    return mouth - quaternion.rotate(turn, np.asarray(instrument_map.mouthpiece.position_m)), turn


_ANGLES = ("pitch_down_deg", "yaw_left_deg", "roll_left_deg")


def carriage_rotation(pitch_down_deg: float, yaw_left_deg: float, roll_left_deg: float) -> FloatArray:
    """Rotation (4,) of an instrument in the player's frame for the angles of a `Carriage`."""
    # Left is +X: the bell (+Z) goes left about +Y, down about +X, and up (+Y) leans left about -Z.
    yaw = quaternion.from_axis_angle([0.0, 1.0, 0.0], np.radians(yaw_left_deg))
    pitch = quaternion.from_axis_angle([1.0, 0.0, 0.0], np.radians(pitch_down_deg))
    roll = quaternion.from_axis_angle([0.0, 0.0, -1.0], np.radians(roll_left_deg))
    return quaternion.multiply(quaternion.multiply(yaw, pitch), roll)


def _fit_hand(
    character: Character,
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    body: Body,
    seed: HandSeed,
    lips: Lips,
) -> tuple[HandHold, Reach]:
    problem, carrier = _problem(character, model, instrument_map, body, seed, lips)
    hand = problem.hand
    if carrier is None:
        values = np.linspace(0.0, 1.0, TABLE_VALUES if problem.worked else 1)
        best = _search(problem)
        knots, holds = np.zeros(1), best[None]
    else:
        values = np.linspace(0.0, 1.0, TABLE_VALUES)
        knots, holds = _search_knots(problem, model, instrument_map, carrier)
        best = holds[0]
    # A wrist between knots follows a smooth curve; the fingers are then solved for it.
    along = PchipInterpolator(knots, holds) if len(knots) > 1 else None
    path = np.repeat(best[None], len(values), axis=0) if along is None else along(values)
    position, turn = _wrist(problem, path)
    scene = _Scene(model, instrument_map, carrier, position, quaternion.to_matrix(turn))
    angles = _angles(problem, path)
    solved = _solve_table(problem, scene, angles, values)
    rotations = joint_rotations(hand, solved)
    fingers = tuple(_finger_table(problem, scene, rotations, values, number) for number in range(5))
    contacts, depth = _judge(problem, scene, fingers, values)
    motion = None if carrier is None else _node_motion(carrier)
    _, instrument_rotation = usual_instrument(character, instrument_map, lips)
    pole = quaternion.rotate(
        instrument_rotation, np.cos(best[6]) * problem.swivel_frame[0] + np.sin(best[6]) * problem.swivel_frame[1]
    )
    hold = HandHold(
        side=hand.side,
        node=seed.node,
        motion=motion,
        values=values if carrier is not None else np.zeros(1),
        instrument_from_hand_m=position if carrier is not None else position[:1],
        instrument_from_hand_rotation=turn if carrier is not None else turn[:1],
        fingers=fingers,
        elbow_direction=pole,
        contacts=contacts,
        penetration_m=depth,
    )
    return hold, _reach(problem, values, position, carrier, instrument_rotation)


# --- The problem


def _problem(
    character: Character,
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    body: Body,
    seed: HandSeed,
    lips: Lips,
) -> tuple[_Problem, Control | None]:
    side = seed.hand
    hand = hand_model(character, side, body, load_skeleton(body.skeleton))
    carrier = next((c for c in instrument_map.controls if seed.node != ROOT and c.node == seed.node), None)
    worked = tuple(
        number
        for number, finger in enumerate(FINGERS)
        if any(c.finger == f"{side}.{finger}" for c in instrument_map.controls)
    )
    names = tuple(model.node_names)
    moved_by = {c.node: c for c in instrument_map.controls if c is not carrier}
    touches = []
    for contact in instrument_map.contacts:
        if not contact.part.startswith(f"{side}."):
            continue
        ends = _contact_at(model, contact, moved_by.get(contact.node), np.array([0.0, 1.0]))
        finger = contact.part.split(".")[1]
        driven = finger in FINGERS and FINGERS.index(finger) in worked
        active = (contact.when != "pressed", contact.when != "released" and driven)
        firm = contact.grip == "firm"
        touches.append(
            _Touch(contact, *ends, active, FIRM_M if firm else RESTING_M, FIRM_NORMAL if firm else RESTING_NORMAL)
        )
    palm = skinned(_rest_matrices(hand), hand.landmarks[f"{side}.palm"][:, :, None])[0, 0]
    outward = -1.0 if side == "left" else 1.0
    direction, normal = np.asarray(seed.finger_direction), np.asarray(seed.palm_normal)
    direction = direction - normal * float(direction @ normal) / float(normal @ normal)
    x_axis = -outward * direction / np.linalg.norm(direction)
    turn = quaternion.from_frames(x_axis, -normal / np.linalg.norm(normal))
    seed_place = model.node_positions_m[names.index(seed.node)] + seed.palm_position_m
    seed_m = seed_place - quaternion.rotate(turn, palm)
    mouth_m, instrument_rotation = usual_instrument(character, instrument_map, lips)
    back = quaternion.conjugate(instrument_rotation)
    rest = rest_positions(character.skeleton)
    joint = [character.skeleton.index(f"{side}{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    shoulder = quaternion.rotate(back, rest[joint[0]] - mouth_m)
    # The elbow hangs: its swivel is counted from straight down towards the outside.
    down = quaternion.rotate(back, [0.0, -1.0, 0.0])
    aside = quaternion.rotate(back, [-outward, 0.0, 0.0])
    place, node_turn = _nodes_at(model, instrument_map, side, carrier, np.array([0.0, 1.0]))
    near_hand = near(
        bodies(instrument_map.proxy, names), model.node_positions_m, seed_m + quaternion.rotate(turn, palm), 0.28
    )
    problem = _Problem(
        hand=hand,
        seed_m=seed_m,
        seed_rotation=turn,
        dofs=_dofs(hand, seed.curl),
        worked=worked,
        touches=tuple(touches),
        touch_points=np.stack([hand.landmarks[t.contact.part] for t in touches], axis=2),
        touch_normals=np.stack([hand.landmark_normals[t.contact.part] for t in touches], axis=2),
        node_place=place,
        node_turn=node_turn,
        proxies=near_hand,
        shoulder_m=shoulder,
        upper_m=float(np.linalg.norm(rest[joint[1]] - rest[joint[0]])),
        lower_m=float(np.linalg.norm(rest[joint[2]] - rest[joint[1]])),
        swivel_frame=np.stack([down, aside]),
        swivel_usual=np.radians(body.postures["standing"].elbow_off_ribs_deg),
        reference_shift_m=np.zeros(3),
        configs=2 if worked else 1,
        wrist_limits=hand.limits[0] * LIMIT_SHARE,
    )
    low, high = _bounds(problem)
    return replace(problem, low=low, high=high), carrier


def _dofs(hand: HandModel, curl: tuple[float, ...]) -> tuple[_Dof, ...]:
    """The angles that are solved, thumb first; relaxed values follow the seed's curl (1 is a fist)."""
    found = []

    def add(joint: int, kind: int, relaxed_deg: float, spread: float, share: float = 1.0) -> None:
        low, high = hand.limits[joint, kind] * share
        found.append(_Dof(joint, kind, low, high, float(np.radians(relaxed_deg)), spread))

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


def _finger_dofs(problem: _Problem, number: int) -> list[int]:
    return [i for i, dof in enumerate(problem.dofs) if (dof.joint - 1) // 3 == number]


def _worked_dofs(problem: _Problem) -> list[int]:
    return [i for number in problem.worked for i in _finger_dofs(problem, number)]


def _bounds(problem: _Problem) -> tuple[FloatArray, FloatArray]:
    """Parameters: wrist place (3), wrist turn (3), swivel, angles at rest, angles of working fingers fully worked."""
    order = [*range(len(problem.dofs)), *_worked_dofs(problem)]
    low = [-np.inf] * 6 + [SWIVEL_RANGE_RAD[0]] + [problem.dofs[i].low for i in order]
    high = [np.inf] * 6 + [SWIVEL_RANGE_RAD[1]] + [problem.dofs[i].high for i in order]
    return np.array(low), np.array(high)


def _start(problem: _Problem, turn: FloatArray) -> FloatArray:
    order = [*range(len(problem.dofs)), *_worked_dofs(problem)]
    angles = [np.clip(problem.dofs[i].relaxed, problem.dofs[i].low, problem.dofs[i].high) for i in order]
    start = np.array([0.0, 0.0, 0.0, *turn, problem.swivel_usual, *angles])
    clipped: FloatArray = np.clip(start, problem.low + 1e-6, problem.high - 1e-6)
    return clipped


def _wrist(problem: _Problem, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Wrist in the instrument's frame: positions (B, 3) and rotations (B, 4)."""
    turn = quaternion.multiply(quaternion.from_rotation_vector(x[:, 3:6]), problem.seed_rotation)
    return problem.seed_m + _METRES * x[:, :3], turn


def _angles(problem: _Problem, x: FloatArray) -> FloatArray:
    """Joint angles (B, configs, 16, 3)."""
    result = np.zeros((len(x), problem.configs, 16, 3))
    count = len(problem.dofs)
    for i, dof in enumerate(problem.dofs):
        result[:, :, dof.joint, dof.kind] = x[:, 7 + i, None]
    for k, i in enumerate(_worked_dofs(problem)):
        result[:, 1, problem.dofs[i].joint, problem.dofs[i].kind] = x[:, 7 + count + k]
    return result


# --- Residuals


class _Residuals:
    """Residuals and their Jacobian; keeps the last pose's distances to the proxy, which both need."""

    def __init__(self, problem: _Problem, soft: float) -> None:
        self.problem = problem
        self.soft = soft
        hand = problem.hand
        counts = [hand.skin_points.shape[2], len(hand.balls), len(hand.forearm_balls)]
        self.radius = flesh_radius(hand)
        self.spread = soft * np.repeat([PENETRATION_M, PENETRATION_M, FOREARM_M], counts)

    def __call__(self, x: FloatArray) -> FloatArray:
        smooth, skin = self._parts(x[None])
        depth, _ = self._depth(skin[0])
        return np.concatenate([smooth[0], (depth / self.spread).ravel()])

    def jacobian(self, x: FloatArray) -> FloatArray:
        tried = np.repeat(x[None], len(x) + 1, axis=0)
        step = np.where(x + _STEP < self.problem.high, _STEP, -_STEP)
        tried[np.arange(1, len(tried)), np.arange(len(x))] += step
        smooth, skin = self._parts(tried)
        depth, slope = self._depth(skin[0])
        change = (skin[1:] - skin[0]) / step[:, None, None, None]
        inside = depth > 0.0
        moved = -np.einsum("xcvi,cvi->xcv", change, slope) * inside / self.spread
        return np.concatenate([(smooth[1:] - smooth[0]) / step[:, None], moved.reshape(len(x), -1)], axis=1).T

    def _depth(self, skin: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Depth (configs, V) of skin below the proxy's surface, and the gradient of the distance."""
        depth, slope = np.zeros(skin.shape[:2]), np.zeros(skin.shape)
        for config in range(len(skin)):
            depth[config], slope[config] = _inside(
                self.problem.proxies,
                self.problem.node_place[config],
                self.problem.node_turn[config],
                skin[config],
                self.radius,
            )
        return depth, slope

    def _parts(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals but the proxy's (B, m), and skin and balls (B, configs, V, 3) in the instrument's frame."""
        problem, hand = self.problem, self.problem.hand
        place, turn = _wrist(problem, x)
        angles = _angles(problem, x)
        count = len(x)
        transforms = wrist_from_joint(hand, joint_rotations(hand, angles.reshape(-1, 16, 3)))
        matrices = wrist_from_mesh(hand, transforms)
        basis = quaternion.to_matrix(turn)

        def placed(points: FloatArray) -> FloatArray:
            local = points.reshape(count, problem.configs, -1, 3)
            moved: FloatArray = np.einsum("bij,bcvj->bcvi", basis, local) + place[:, None, None]
            return moved

        skin = placed(skinned(matrices, hand.skin_points))
        touching = placed(skinned(matrices, problem.touch_points))
        facing = np.einsum(
            "bij,bcvj->bcvi", basis, turned(matrices, problem.touch_normals).reshape(count, problem.configs, -1, 3)
        )
        parts = []
        for number, touch in enumerate(problem.touches):
            for config in range(problem.configs):
                if touch.active[config]:
                    off = touching[:, config, number] - touch.positions[config]
                    parts.append(off / (touch.spread_m * self.soft))
                    parts.append((facing[:, config, number] + touch.normals[config]) / touch.spread_normal)
        balls = ball_centres(hand, transforms)
        skin = np.concatenate([skin, placed(balls), self._forearm(x, place)], axis=2)
        pairs = balls[:, hand.ball_pairs[:, 0]] - balls[:, hand.ball_pairs[:, 1]]
        gap = np.sqrt(np.einsum("bki,bki->bk", pairs, pairs))
        parts.append((np.maximum(hand.ball_gaps_m - gap, 0.0) / (BALL_M * self.soft)).reshape(count, -1))
        parts.append(self._natural(angles))
        parts.append(self._arm(x, place, turn))
        parts.append(self._anchored(x))
        return np.concatenate(parts, axis=1), skin

    def _forearm(self, x: FloatArray, place: FloatArray) -> FloatArray:
        """Balls (B, configs, C, 3) of the forearm."""
        wrist = place + self.problem.reference_shift_m
        behind = _elbow_place(self.problem, wrist, x[:, 6]) - wrist
        behind /= np.linalg.norm(behind, axis=1)[:, None]
        balls = place[:, None] + behind[:, None] * self.problem.hand.forearm_balls[:, :1]
        return np.repeat(balls[:, None], self.problem.configs, axis=1)

    def _natural(self, angles: FloatArray) -> FloatArray:
        problem = self.problem
        parts = []
        for config in range(problem.configs):
            order = range(len(problem.dofs)) if config == 0 else _worked_dofs(problem)
            for i in order:
                dof = problem.dofs[i]
                now = angles[:, config, dof.joint, dof.kind]
                parts.append((now - dof.relaxed) / dof.spread)
                if config:
                    parts.append((now - angles[:, 0, dof.joint, dof.kind]) / WORKED_RAD)
            for number in range(1, 5) if config == 0 else [n for n in problem.worked if n]:
                # The last two joints of a finger bend together (about 2 to 3).
                middle, last = angles[:, config, 2 + 3 * number, 0], angles[:, config, 3 + 3 * number, 0]
                parts.append((last - 0.67 * middle) / COUPLING_RAD)
        return np.stack(parts, axis=1)

    def _arm(self, x: FloatArray, place: FloatArray, turn: FloatArray) -> FloatArray:
        """Straight wrist: how the forearm enters the hand, how far it is turned, where the elbow is."""
        problem = self.problem
        wrist = place + problem.reference_shift_m
        elbow = _elbow_place(problem, wrist, x[:, 6])
        forearm = wrist - elbow
        forearm /= np.linalg.norm(forearm, axis=1)[:, None]
        sign = 1.0 if problem.hand.side == "left" else -1.0
        back = quaternion.conjugate(turn)
        local = quaternion.rotate(back, forearm)
        flexion = np.arctan2(sign * local[:, 1], np.maximum(sign * local[:, 0], 1e-3))
        deviation = np.arctan2(-local[:, 2], np.maximum(sign * local[:, 0], 1e-3))
        # The elbow's hinge, seen from the hand: along the palm's normal where the forearm is neither turned in nor out.
        hinge = np.cross(elbow - problem.shoulder_m, forearm)
        hinge /= np.maximum(np.linalg.norm(hinge, axis=1), 1e-9)[:, None]
        hinge = quaternion.rotate(back, hinge) * sign
        pronation = np.arctan2(hinge[:, 2], -hinge[:, 1])
        bent = np.stack([flexion, deviation, pronation], axis=1)
        low, high = problem.wrist_limits[:, 0], problem.wrist_limits[:, 1]
        low, high = np.array([low[0], low[1], -PRONATION_MOST_RAD]), np.array([high[0], high[1], PRONATION_MOST_RAD])
        over = np.maximum(bent - high, 0.0) + np.minimum(bent - low, 0.0)
        shared = self._shared(forearm, np.cross(elbow - problem.shoulder_m, forearm), turn)
        over = np.concatenate(
            [
                over,
                np.maximum(shared - problem.wrist_limits[:2, 1], 0.0)
                + np.minimum(shared - problem.wrist_limits[:2, 0], 0.0),
            ],
            axis=1,
        )
        far = np.linalg.norm(wrist - problem.shoulder_m, axis=1) - 0.97 * (problem.upper_m + problem.lower_m)
        return np.concatenate(
            [
                bent / (FLEXION_RAD, DEVIATION_RAD, PRONATION_RAD),
                over / LIMIT_RAD,
                ((x[:, 6] - problem.swivel_usual) / SWIVEL_RAD)[:, None],
                (np.maximum(far, 0.0) / REACH_M)[:, None],
            ],
            axis=1,
        )

    def _shared(self, forearm: FloatArray, hinge: FloatArray, turn: FloatArray) -> FloatArray:
        """Flexion and deviation (B, 2) as the hand joint has them when the forearm takes its share of the twist."""
        hand = self.problem.hand
        sign = 1.0 if hand.side == "left" else -1.0
        hinge = hinge / np.maximum(np.linalg.norm(hinge, axis=1), 1e-9)[:, None]
        frame = quaternion.from_frames(sign * forearm, -sign * hinge)
        local = quaternion.multiply(quaternion.conjugate(frame), turn)
        axis = np.array([1.0, 0.0, 0.0])
        taken = quaternion.from_axis_angle(axis, TWIST_SHARE * quaternion.twist_angle(local, axis))
        swing, _ = quaternion.swing_twist(quaternion.multiply(quaternion.conjugate(taken), local), axis)
        return quaternion.to_rotation_vector(swing) @ hand.axes[0, :2].T

    def _anchored(self, x: FloatArray) -> FloatArray:
        """The hand stays about its seed; holds of neighbouring knots stay alike, with one swivel of the elbow."""
        if self.problem.anchor is None:
            off: FloatArray = x[:, :6] / np.repeat([SEED_M / _METRES, SEED_RAD], 3)
        else:
            place, turn, finger = ANCHOR
            off = (x - self.problem.anchor) / ([place] * 3 + [turn] * 3 + [0.01] + [finger] * (x.shape[1] - 7))
        return off


def _elbow_place(problem: _Problem, wrist: FloatArray, swivel: FloatArray) -> FloatArray:
    """Elbow (B, 3) for a wrist (B, 3) and swivel (B,) from straight down to the outside."""
    a, b = problem.upper_m, problem.lower_m
    line = wrist - problem.shoulder_m
    reach = np.clip(np.linalg.norm(line, axis=1), abs(a - b) + 1e-4, (a + b) * 0.9999)
    direction = line / np.linalg.norm(line, axis=1)[:, None]
    along = (a * a - b * b + reach * reach) / (2.0 * reach)
    aside = np.sqrt(np.maximum(a * a - along * along, 0.0))
    pole = _pole(problem, direction, swivel)
    elbow: FloatArray = problem.shoulder_m + direction * along[:, None] + pole * aside[:, None]
    return elbow


def _pole(problem: _Problem, direction: FloatArray, swivel: FloatArray) -> FloatArray:
    down, out = problem.swivel_frame
    pole = np.cos(swivel)[:, None] * down + np.sin(swivel)[:, None] * out
    pole = pole - direction * np.einsum("bi,bi->b", pole, direction)[:, None]
    result: FloatArray = pole / np.maximum(np.linalg.norm(pole, axis=1), 1e-9)[:, None]
    return result


def _pressed(depth: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What a depth counts, and its slope: flesh gives way a little, then resists."""
    deep = depth > GIVE_M
    return depth + (STIFFENING - 1.0) * np.maximum(depth - GIVE_M, 0.0), np.where(deep, STIFFENING, depth > 0.0)


def _inside(
    proxies: Bodies, node_place: FloatArray, node_turn: FloatArray, skin: FloatArray, radius: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Depth (V,) of balls at (V, 3) below the proxy's surface, 0 outside, and the gradient (V, 3) of the distance."""
    local = np.einsum("nji,vnj->vni", node_turn, skin[:, None] - node_place)
    depth, owner = inside(proxies, local, radius)
    hit = np.flatnonzero(owner >= 0)
    slope = np.zeros(skin.shape)
    if len(hit):
        turn = node_turn[proxies.nodes[owner[hit]]]
        slope[hit] = np.einsum("vij,vj->vi", turn, gradient(proxies, local[hit], owner[hit]))
    return depth, slope


# --- Solving

_TILTS = (
    (0.0, 0.0, 0.0),
    (0.3, 0.0, 0.0),
    (-0.3, 0.0, 0.0),
    (0.0, 0.3, 0.0),
    (0.0, -0.3, 0.0),
    (0.0, 0.0, 0.3),
    (0.0, 0.0, -0.3),
    (0.25, 0.25, 0.0),
    (-0.25, -0.25, 0.0),
    (0.0, 0.25, 0.25),
    (0.0, -0.25, -0.25),
)
"""Turns of the seed (rotation vectors in the instrument's frame) that are tried."""


def _search(problem: _Problem) -> FloatArray:
    """Start from the seed and from tilts of it with soft contacts; the best few go on with harder ones."""
    loose = [_solve(_Residuals(problem, 6.0), _start(problem, np.array(tilt)), 8) for tilt in _TILTS]
    loose.sort(key=lambda found: float(found.cost))
    middle = [_solve(_Residuals(problem, 2.0), found.x, 10) for found in loose[:3]]
    best = min(middle, key=lambda found: float(found.cost))
    return np.asarray(_solve(_Residuals(problem, 1.0), best.x, 25).x)


def _search_knots(
    problem: _Problem, model: InstrumentModel, instrument_map: InstrumentMap, carrier: Control
) -> tuple[FloatArray, FloatArray]:
    """Solve the hold of a carried hand at `KNOTS`: values ascending (K,) and parameters (K, n)."""
    found: dict[float, FloatArray] = {}
    for value in KNOTS:
        place, turn = _nodes_at(model, instrument_map, problem.hand.side, carrier, np.array([value]))
        here = replace(
            problem,
            node_place=place,
            node_turn=turn,
            reference_shift_m=value * _travel(carrier),
            anchor=found[min(found, key=lambda other: abs(other - value))] if found else None,
        )
        if here.anchor is None:
            found[value] = _search(here)
        else:
            found[value] = np.asarray(_solve(_Residuals(here, 1.0), here.anchor, 20).x)
    knots = np.array(sorted(found))
    return knots, np.stack([found[value] for value in knots])


def _solve(residuals: _Residuals, start: FloatArray, rounds: int) -> Any:
    problem = residuals.problem
    return least_squares(
        residuals,
        np.clip(start, problem.low + 1e-9, problem.high - 1e-9),
        jac=residuals.jacobian,
        bounds=(problem.low, problem.high),
        max_nfev=rounds,
        xtol=1e-7,
        ftol=1e-6,
        gtol=1e-8,
    )


# --- The fingers between the ends of their controls


@dataclass(frozen=True, eq=False)
class _Scene:
    """A solved wrist on its instrument."""

    model: InstrumentModel
    instrument_map: InstrumentMap
    carrier: Control | None
    position_m: FloatArray
    basis: FloatArray

    def placed(self, points: FloatArray) -> FloatArray:
        """Take points (..., S, V, 3) of the wrist's frame to the instrument's, sample by sample."""
        return points @ self.basis.transpose(0, 2, 1) + self.position_m[:, None]

    def turned(self, vectors: FloatArray) -> FloatArray:
        """Likewise for directions."""
        return vectors @ self.basis.transpose(0, 2, 1)

    def mover(self, contact: Contact) -> Control | None:
        """The control that moves a contact against the wrist."""
        for control in self.instrument_map.controls:
            if control.node == contact.node and control is not self.carrier:
                return control
        return None


def _solve_table(problem: _Problem, scene: _Scene, angles: FloatArray, values: FloatArray) -> FloatArray:
    """Solve the fingers at each value of their controls, the wrist held: angles (S, 16, 3), from (S, configs, 16, 3).

    One damped Gauss-Newton iteration (Levenberg-Marquardt, clipped to the limits) for all values at once: the
    samples are independent, their normal equations are solved as a batch.
    """
    first, last = angles[:, 0], angles[:, -1]
    usual = first + (last - first) * values[:, None, None]
    solved = usual.copy()
    place, turn = _nodes_at(scene.model, scene.instrument_map, problem.hand.side, scene.carrier, values)
    for number in range(5):
        mine = [t for t in problem.touches if t.contact.part.split(".")[1] == FINGERS[number]]
        if not mine:
            continue
        _solve_finger(problem, scene, solved, usual, WORKED_RAD, values, number, mine, place, turn)
        # Samples that fell into different bends of one finger would make it twitch: solve again about a smooth path.
        for _ in range(2 if len(values) > SMOOTH_DEGREE + 1 else 0):
            flat = solved.reshape(len(values), -1)
            powers = np.vander(values, SMOOTH_DEGREE + 1)
            usual = (powers @ np.linalg.lstsq(powers, flat, rcond=None)[0]).reshape(solved.shape)
            solved[:, 1 + 3 * number : 4 + 3 * number] = usual[:, 1 + 3 * number : 4 + 3 * number]
            _solve_finger(problem, scene, solved, usual, SMOOTH_RAD, values, number, mine, place, turn)
    return solved


def _solve_finger(
    problem: _Problem,
    scene: _Scene,
    solved: FloatArray,
    usual: FloatArray,
    usual_rad: float,
    values: FloatArray,
    number: int,
    touches: list[_Touch],
    node_place: FloatArray,
    node_turn: FloatArray,
) -> None:
    hand = problem.hand
    dofs = [problem.dofs[i] for i in _finger_dofs(problem, number)]
    joints, kinds = np.array([dof.joint for dof in dofs]), np.array([dof.kind for dof in dofs])
    low, high = np.array([dof.low for dof in dofs]), np.array([dof.high for dof in dofs])
    ends = [_contact_at(scene.model, t.contact, scene.mover(t.contact), values) for t in touches]
    active = [
        np.where(
            (t.contact.when == "pressed") & (values == 0.0) | (t.contact.when == "released") & (values > 0.0), 0.0, 1.0
        )
        for t in touches
    ]
    points = np.stack([hand.landmarks[t.contact.part] for t in touches], axis=2)
    normals = np.stack([hand.landmark_normals[t.contact.part] for t in touches], axis=2)
    skin_points = np.ascontiguousarray(hand.skin_points[:, :, hand.skin_finger == number])
    own = np.flatnonzero(hand.ball_finger == number)
    radius = np.concatenate([np.zeros(skin_points.shape[2]), flesh_radius(hand)[hand.skin_points.shape[2] + own]])
    samples, count = len(values), len(dofs)

    def residuals(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals (B, S, m) without the proxy's, and skin (B, S, V, 3), for angles (B, S, n)."""
        pose = np.repeat(solved[None], len(x), axis=0)
        pose[:, :, joints, kinds] = x
        transforms = wrist_from_joint(hand, joint_rotations(hand, pose.reshape(-1, 16, 3)))
        matrices = wrist_from_mesh(hand, transforms)
        shape = (len(x), samples, -1, 3)
        flesh = np.concatenate([skinned(matrices, skin_points), ball_centres(hand, transforms)[:, own]], axis=1)
        skin = scene.placed(flesh.reshape(shape))
        at = scene.placed(skinned(matrices, points).reshape(shape))
        facing = scene.turned(turned(matrices, normals).reshape(shape))
        parts = [(x - usual[:, joints, kinds]) / usual_rad]
        if number:
            parts.append(((x[..., 3] - 0.67 * x[..., 2]) / COUPLING_RAD)[..., None])
        for k, touch in enumerate(touches):
            parts.append((at[:, :, k] - ends[k][0]) / (touch.spread_m * 0.3) * active[k][:, None])
            parts.append((facing[:, :, k] + ends[k][1]) / touch.spread_normal * active[k][:, None])
        return np.concatenate(parts, axis=2), skin

    def depths(skin: FloatArray) -> tuple[FloatArray, FloatArray]:
        found = [_inside(problem.proxies, node_place[s], node_turn[s], skin[s], radius) for s in range(samples)]
        return np.stack([depth for depth, _ in found]), np.stack([slope for _, slope in found])

    x = np.clip(solved[:, joints, kinds], low, high)
    damping = np.full(samples, 1e-3)
    smooth, skin = residuals(x[None])
    depth, slope = depths(skin[0])
    cost = (smooth[0] ** 2).sum(axis=1) + ((_pressed(depth)[0] / PENETRATION_M) ** 2).sum(axis=1)
    for _ in range(12):
        tried = np.repeat(x[None], count + 1, axis=0)
        step = np.where(x + _STEP < high, _STEP, -_STEP)
        for i in range(count):
            tried[i + 1, :, i] += step[:, i]
        smooth, skin = residuals(tried)
        slant = np.moveaxis((smooth[1:] - smooth[0]) / step.T[:, :, None], 0, 2)
        change = (skin[1:] - skin[0]) / step.T[:, :, None, None]
        push, rise = _pressed(depth)
        pressed = -np.einsum("nsvi,svi->svn", change, slope) * rise[..., None] / PENETRATION_M
        jacobian = np.concatenate([slant, pressed], axis=1)
        value = np.concatenate([smooth[0], push / PENETRATION_M], axis=1)
        down = np.einsum("smn,sm->sn", jacobian, value)
        # An angle at its limit that would be pushed further stays.
        free = ~(((x <= low) & (down > 0.0)) | ((x >= high) & (down < 0.0)))
        normal = np.einsum("smn,smk->snk", jacobian, jacobian) * free[:, :, None] * free[:, None, :]
        diagonal = np.einsum("sii->si", normal)
        normal[:, np.arange(count), np.arange(count)] += damping[:, None] * diagonal + ~free + 1e-9
        new = np.clip(x - np.linalg.solve(normal, (down * free)[..., None])[..., 0], low, high)
        smooth, skin = residuals(new[None])
        new_depth, new_slope = depths(skin[0])
        new_cost = (smooth[0] ** 2).sum(axis=1) + ((_pressed(new_depth)[0] / PENETRATION_M) ** 2).sum(axis=1)
        better = new_cost < cost
        x = np.where(better[:, None], new, x)
        depth = np.where(better[:, None], new_depth, depth)
        slope = np.where(better[:, None, None], new_slope, slope)
        settled = np.all(np.abs(np.where(better, cost - new_cost, 0.0)) < 1e-6 * cost)
        cost = np.where(better, new_cost, cost)
        damping = np.where(better, damping * 0.3, damping * 5.0)
        if settled and better.any():
            break
    solved[:, joints, kinds] = x


def _finger_table(
    problem: _Problem, scene: _Scene, rotations: FloatArray, values: FloatArray, number: int
) -> FingerTable:
    name = f"{problem.hand.side}.{FINGERS[number]}"
    places = slice(1 + 3 * number, 4 + 3 * number)
    control = next((c.name for c in scene.instrument_map.controls if c.finger == name), None)
    if control is None and scene.carrier is not None:
        control = scene.carrier.name
    rows = rotations[:, places] if control is not None else rotations[:1, places]
    return FingerTable(name, control, values if control is not None else np.zeros(1), problem.hand.joints[places], rows)


def _judge(
    problem: _Problem, scene: _Scene, fingers: tuple[FingerTable, ...], values: FloatArray
) -> tuple[tuple[ContactFit, ...], float]:
    """Measure the hold over all its samples and half way between them, on the whole skin of the hand."""
    hand = problem.hand
    fine = np.linspace(0.0, 1.0, 2 * len(values) - 1) if len(values) > 1 else values
    rotations = np.tile(quaternion.IDENTITY, (len(fine), 16, 1))
    for number, table in enumerate(fingers):
        rotations[:, 1 + 3 * number : 4 + 3 * number] = interpolated(table.values, table.rotations, fine)
    between = np.interp(fine, values, np.arange(len(values), dtype=np.float64))
    low = np.minimum(between.astype(np.intp), max(len(values) - 2, 0))
    high, share = np.minimum(low + 1, len(values) - 1), (between - low)[:, None]
    turn = quaternion.to_matrix(interpolated(values, quaternion.from_matrix(scene.basis)[:, None], fine)[:, 0])
    scene = replace(
        scene, position_m=scene.position_m[low] * (1.0 - share) + scene.position_m[high] * share, basis=turn
    )
    transforms = wrist_from_joint(hand, rotations)
    matrices = wrist_from_mesh(hand, transforms)
    touching = scene.placed(skinned(matrices, problem.touch_points))
    facing = scene.turned(turned(matrices, problem.touch_normals))
    contacts = []
    for number, touch in enumerate(problem.touches):
        at, normal = _contact_at(scene.model, touch.contact, scene.mover(touch.contact), fine)
        off = np.linalg.norm(touching[:, number] - at, axis=1)
        angle = np.arccos(np.clip(-np.einsum("si,si->s", facing[:, number], normal), -1.0, 1.0))
        counts = (
            fine > 0.0
            if touch.contact.when == "pressed"
            else fine == 0.0
            if touch.contact.when == "released"
            else fine >= 0.0
        )
        contact = touch.contact
        contacts.append(
            ContactFit(
                contact.part, contact.node, contact.control, contact.grip == "firm",
                float(off[counts].max(initial=0.0)), float(angle[counts].max(initial=0.0)),
            )
        )  # fmt: skip
    place, turn = _nodes_at(scene.model, scene.instrument_map, hand.side, scene.carrier, fine)
    flesh = np.concatenate([skinned(matrices, hand.all_points), ball_centres(hand, transforms)], axis=1)
    skin = scene.placed(flesh)
    radius = np.concatenate(
        [np.zeros(hand.all_points.shape[2]), flesh_radius(hand)[hand.skin_points.shape[2] :][: len(hand.balls)]]
    )
    depth = max(float(_inside(problem.proxies, place[s], turn[s], skin[s], radius)[0].max()) for s in range(len(fine)))
    return tuple(contacts), depth


# --- Moving parts


def _contact_at(
    model: InstrumentModel, contact: Contact, control: Control | None, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Place (S, 3) and normal (S, 3) of a contact in the instrument's frame for values of the control that moves it."""
    place = model.node_positions_m[model.node_names.index(contact.node)] + contact.position_m
    normal = np.asarray(contact.normal, dtype=np.float64)
    if control is None:
        return np.tile(place, (len(values), 1)), np.tile(normal, (len(values), 1))
    moved, turn = control_transform(control, values)
    return quaternion.rotate(turn, place) + moved, quaternion.rotate(turn, normal)


def _nodes_at(
    model: InstrumentModel, instrument_map: InstrumentMap, side: Side, carrier: Control | None, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Places (S, N, 3) and bases (S, N, 3, 3) of the nodes while all this hand's fingers work their controls alike.

    A hand that is carried sees its own node stay and all others go the other way.
    """
    worked = {
        control.name: values
        for control in instrument_map.controls
        if control is not carrier and control.finger.startswith(f"{side}.")
    }
    place, turn = node_transforms(model, instrument_map, worked, len(values))
    if carrier is not None:
        others = np.arange(len(model.node_names)) != model.node_names.index(carrier.node)
        place[:, others] -= np.multiply.outer(values, _travel(carrier))[:, None]
    return place, quaternion.to_matrix(turn)


def _travel(control: Control) -> FloatArray:
    return np.asarray(control.motion.axis, dtype=np.float64) * (control.motion.travel_m or 0.0)


def _node_motion(control: Control) -> NodeMotion:
    motion = control.motion
    return NodeMotion(
        control=control.name,
        travel_m=_travel(control),
        axis=np.asarray(motion.axis, dtype=np.float64),
        angle_rad=motion.angle_rad or 0.0,
        pivot_m=np.asarray(motion.pivot_m or (0.0, 0.0, 0.0), dtype=np.float64),
    )


def _reach(
    problem: _Problem,
    values: FloatArray,
    position: FloatArray,
    carrier: Control | None,
    instrument_rotation: FloatArray,
) -> Reach:
    if carrier is None:
        values, position = np.zeros(1), position[:1]
    travel = _travel(carrier) if carrier is not None else np.zeros(3)
    line = position + np.multiply.outer(values, travel) - problem.shoulder_m
    length = np.linalg.norm(line, axis=1)
    arm = problem.upper_m + problem.lower_m
    # Where the length crosses the arm's, between samples.
    fine = np.linspace(0.0, 1.0, 201)
    reached = fine[np.interp(fine, values, length) <= arm]
    return Reach(
        side=problem.hand.side,
        control=None if carrier is None else carrier.name,
        values=values,
        shortfall_m=length - arm,
        direction=quaternion.rotate(instrument_rotation, line[-1] / length[-1]),
        arm_m=arm,
        max_value=float(reached.max(initial=0.0)),
    )


def _rest_matrices(hand: HandModel) -> FloatArray:
    return wrist_from_mesh(hand, wrist_from_joint(hand, np.tile(quaternion.IDENTITY, (1, 16, 1))))
