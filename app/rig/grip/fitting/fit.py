"""Fitting of a grip: the hands of one body on one instrument.

Each hand is a bounded least-squares problem (`app.rig.grip.fitting.hand_problem`): the wrist's position in the
instrument's frame, the finger joints with every control at rest and with every control fully worked, and the elbow's
swivel. The aims are the map's contacts on the deformed skin, no skin inside the instrument's proxy, fingers that do not
pass through each other, a straight wrist with a natural elbow, and fingers near their relaxed curl
(`app.rig.grip.fitting.residuals`). The working fingers are then solved for values between
(`app.rig.grip.fitting.solved_fingers`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.errors import Progress
from app.rig import quaternion
from app.rig.grip.body_size import sized, sized_character, sized_model
from app.rig.grip.carriage import Upright, upright
from app.rig.grip.finger_stations import asked_together
from app.rig.grip.fitting.fit_terms import GRIP_M, INSIDE_M, TOUCH_M, GripScene, no_progress, require_landmarks
from app.rig.grip.fitting.grip_measures import judge
from app.rig.grip.fitting.hand_problem import HandProblem, grip_problem, joint_angles, wrist_transform
from app.rig.grip.fitting.leaning_hand import Leaning, lean_of, leanings, whole_hand
from app.rig.grip.fitting.search import refined_solution, search_knots, starts
from app.rig.grip.fitting.solved_fingers import MOVED_VALUES, STILL_VALUES, finger_tables, solve_tables
from app.rig.grip.fitting.touch_targets import travel
from app.rig.grip.fitting.two_fingers import leans_beside
from app.rig.grip.fitting.ways_between_stations import lifted_ways
from app.rig.grip.grip_pose import GripPose, HandHold, NodeMotion, StationTable
from app.rig.grip.lips import fit_lips
from app.rig.model import Character, InstrumentModel
from instrument_maps.hold import HandSeed
from instrument_maps.model import Control, InstrumentMap
from instrument_maps.size import scaled
from metadata.model import Body


def fit_hold(
    character: Character,
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    body: Body,
    progress: Progress = no_progress,
) -> GripPose:
    """Fit a character's grip on an instrument; deterministic but slow: `app.rig.grip.fitting.grip_files.hold_for`
    caches results.

    Parameters
    ----------
    body : Body
        Limits of the joints and posture.
    progress : callable
        Called with the completed share 0..1; an exception raised by it stops the work.

    Returns
    -------
    GripPose
        Grip; aims that were not met are in ``contacts`` and ``penetration_m`` of its hands.

    Raises
    ------
    UsageError
        The body lacks a landmark that the instrument touches.
    """
    require_landmarks(character, instrument_map)
    lips = fit_lips(character, instrument_map, body)
    stand = upright(character, instrument_map, body, lips)
    size = instrument_map.size
    if size != 1.0:
        # Tolerances scale with the instrument: both are fitted as if the instrument had its usual size.
        character, model = sized_character(character, 1.0 / size), sized_model(model, 1.0 / size)
        instrument_map = scaled(instrument_map, 1.0 / size)
        stand = Upright(stand.joints_m / size, stand.instrument_m / size, stand.instrument_rotation)
    fitted = []
    for number, seed in enumerate(instrument_map.hands):
        part = _part(progress, number / len(instrument_map.hands), (number + 1) / len(instrument_map.hands))
        problem, carrier = grip_problem(character, model, instrument_map, body, seed, stand)
        scene = GripScene(model, instrument_map, carrier, np.zeros((1, 3)), np.eye(3)[None])
        fitted.append(_fit_hand(problem, scene, seed, stand, size, part))
    return GripPose(character.id, instrument_map.id, tuple(sized(hand, size) for hand in fitted), lips)


def _part(progress: Progress, first: float, last: float) -> Progress:
    """Return a function that reports the progress of a part of the work as a share of the whole, from ``first`` to
    ``last``.
    """
    return lambda share: progress(first + (last - first) * share)


def _fit_hand(
    problem: HandProblem, scene: GripScene, seed: HandSeed, stand: Upright, size: float, progress: Progress
) -> HandHold:
    """Fit one hand, including its wrist.

    If the best start does not give a good result, the next ones are tried; the best result is used.
    """
    if scene.carrier is not None:
        knots, holds = search_knots(
            problem, scene.model, scene.instrument_map, scene.carrier, _part(progress, 0.0, 0.55)
        )
        from scipy.interpolate import PchipInterpolator  # slow to import; holds are rarely fitted

        # Between knots the wrist follows a smooth curve, for which the fingers are then solved.
        path = PchipInterpolator(knots, holds)(MOVED_VALUES)
        return _held(problem, scene, holds[0], path, seed, stand, _part(progress, 0.55, 1.0))
    best: HandHold | None = None
    for number, start in enumerate(starts(problem, _part(progress, 0.0, 0.4))):
        part = _part(progress, 0.4 + 0.2 * number, 0.6 + 0.2 * number)
        part(0.0)
        whole = refined_solution(problem, start)
        found = _held(problem, scene, whole, whole[None], seed, stand, part)
        if best is None or _missed(found, size) < _missed(best, size):
            best = found
        if _missed(best, size) <= 1.0:
            break
    assert best is not None
    return best


def _missed(hold: HandHold, size: float) -> float:
    """Return the worst error of a hand's grip as a multiple of the tolerances for contacts and for skin inside the
    instrument.
    """
    touches = [one for one in hold.contacts if one.firm]
    off = [one.distance_m / (GRIP_M if one.control is None else TOUCH_M) for one in touches]
    return size * max(*off, hold.penetration_m / INSIDE_M, 0.0)


def _held(
    problem: HandProblem,
    scene: GripScene,
    best: FloatArray,
    path: FloatArray,
    seed: HandSeed,
    stand: Upright,
    progress: Progress,
) -> HandHold:
    """Return the grip of a solved hand: fingers at all stations, wrist offsets for them, and accuracy of all contacts.

    ``best`` (n,) are the solved parameters, ``path`` (S, n) those at S values of the control that moves the hand.
    """
    hand, carrier = problem.hand, scene.carrier
    values = MOVED_VALUES if carrier is not None or problem.worked else STILL_VALUES
    position, turn = wrist_transform(problem, path)
    scene = replace(scene, position_m=position, basis=quaternion.to_matrix(turn))
    solved = solve_tables(problem, scene, joint_angles(problem, path), best, _part(progress, 0.0, 0.3))
    leant = leanings(problem, scene, best, solved, _part(progress, 0.3, 0.9))
    leans = tuple(lean_of(problem, scene, one) for one in leant)
    at_leans = {(one.solved.number, one.solved.station): one.solved for one in leant}
    solved = tuple(at_leans.get((one.number, one.station), one) for one in solved)
    wrists = {(one.solved.number, one.index): one.scene for one in leant}
    fingers = lifted_ways(problem, scene, finger_tables(problem, scene, solved), wrists)
    contacts, depth = judge(problem, scene, fingers, values, _leant_tables(problem, leant))
    motion = None if carrier is None else _node_motion(carrier)
    pole = quaternion.rotate(
        stand.instrument_rotation, np.cos(best[6]) * problem.swivel_frame[0] + np.sin(best[6]) * problem.swivel_frame[1]
    )
    grip = HandHold(
        side=hand.side,
        node=seed.node,
        motion=motion,
        values=values if carrier is not None else np.zeros(1),
        instrument_from_hand_m=position,
        instrument_from_hand_rotation=turn,
        fingers=fingers,
        elbow_direction=pole,
        contacts=contacts,
        penetration_m=depth,
        leans=leans,
    )
    if leans:
        whole = [touch.positions[0] for touch in problem.touches if touch.contact.part in whole_hand(hand.side)]
        more = leans_beside(grip, np.reshape(whole, (-1, 3)), asked_together(scene.instrument_map))
        grip = replace(grip, leans=leans + more)
    return grip


def _leant_tables(
    problem: HandProblem, leant: Sequence[Leaning]
) -> dict[tuple[int, int], tuple[GripScene, dict[int, StationTable]]]:
    """Return the solved wrist and the tables of all fingers for each wrist offset, by (finger, station)."""
    result = {}
    for one in leant:
        tables = {
            number: table.stations[0]
            for number, table in enumerate(finger_tables(problem, one.scene, one.others))
            if table.stations
        }
        result[one.solved.number, one.index] = (one.scene, tables)
    return result


def _node_motion(control: Control) -> NodeMotion | None:
    motion = control.motion
    if motion is None:
        return None
    return NodeMotion(
        control=control.name,
        travel_m=travel(control),
        axis=np.asarray(motion.axis, dtype=np.float64),
        angle_rad=motion.angle_rad or 0.0,
        pivot_m=np.asarray(motion.pivot_m or (0.0, 0.0, 0.0), dtype=np.float64),
    )
