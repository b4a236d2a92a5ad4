"""The arm's part of a grip: how straight the wrist is for a place of the hand and a swivel of the elbow.

It needs the skeleton and ranges of joints, but nothing of the skin, which takes many times as long to prepare.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.carriage import Upright
from app.rig.grip.grip_pose import Side
from app.rig.ik import TWIST_SHARE
from app.rig.model import Character
from instrument_maps.hold import HandSeed
from instrument_maps.model import ROOT, Control, InstrumentMap
from metadata.load import load_skeleton
from metadata.model import Body, Posture

# Deviations that give a residual of one.
FLEXION_RAD, DEVIATION_RAD, PRONATION_RAD, SWIVEL_RAD = 0.3, 0.16, 0.8, 0.25
LIMIT_RAD = 0.02
LIMIT_SHARE, CARRIED_LIMIT_SHARE = 0.47, 0.45
"""Share of the wrist's range that a grip may use; the rest is for the body's motion, which moves a slide hand most."""
SWIVEL_RANGE_RAD = (0.2, 0.9)
"""Range in radians of the elbow's swivel from straight down outwards, clear of the ribs."""
SWIVEL_ABOUT_RAD = 0.35
"""Range in radians of the elbow's swivel around a value given by a map."""
HELP_RAD = 0.44
"""Rotation of the trunk in radians that moves the shoulder towards a far hand, and partly also for nearer positions."""
PRONATION_MOST_RAD = 1.3
REACH_M = 0.03
"""Scale in metres of the cost of an arm that is too short: the shoulder's help is costly, but a fingertip's grip cannot
bridge half a metre.
"""


@dataclass(frozen=True, eq=False)
class ArmProblem:
    """Constants of an arm whose hand holds an instrument.

    Attributes
    ----------
    side : str
        ``left`` or ``right``.
    shoulder_m, helped_m : (3,) float64
        The shoulder joint in the instrument's frame, without and with help by the trunk.
    helped : bool
        Whether the arm must also reach its place from the shoulder with help.
    upper_m, lower_m : float
        Lengths of upper arm and forearm in metres.
    swivel_frame : (2, 3) float64
        Directions straight down and outwards in the instrument's frame, from which the elbow's swivel is measured.
    swivel_usual : float
        Usual swivel of the elbow, in radians.
    swivel_range : (float, float)
        Range of the swivel in radians.
    reference_shift_m : (3,) float64
        Offset of the wrist by the control that moves it.
    wrist_axes : (2, 3) float64
        Flexion and sideways axis of the wrist.
    wrist_limits : (3, 2) float64
        Range of flexion, sideways and twist of the wrist that a grip may use, in radians.
    """

    side: Side
    shoulder_m: FloatArray
    helped_m: FloatArray
    helped: bool
    upper_m: float
    lower_m: float
    swivel_frame: FloatArray
    swivel_usual: float
    swivel_range: tuple[float, float]
    reference_shift_m: FloatArray
    wrist_axes: FloatArray
    wrist_limits: FloatArray


def arm_problem(
    character: Character, instrument_map: InstrumentMap, body: Body, seed: HandSeed, stand: Upright
) -> ArmProblem:
    """Return the constants of the arm of a hand on an instrument."""
    side, skeleton, profile = seed.hand, character.skeleton, load_skeleton(body.skeleton)
    back = quaternion.conjugate(stand.instrument_rotation)
    shoulder_m, helped_m = _shoulders(character, side, stand)
    usual, swivels = _swivels(seed, body.postures[instrument_map.hold.postures[0]])
    wrist = f"{side}Hand"
    axes, bound = profile.joint_axes(wrist), body.limits[profile.joint(wrist).kind]
    limits = np.radians([bound.flexion_deg, bound.sideways_deg, bound.twist_deg])
    return ArmProblem(
        side=side,
        shoulder_m=shoulder_m,
        helped_m=helped_m,
        helped=False,
        upper_m=float(np.linalg.norm(skeleton.offsets_m[skeleton.index(f"{side}LowerArm")])),
        lower_m=float(np.linalg.norm(skeleton.offsets_m[skeleton.index(wrist)])),
        # The elbow hangs: its swivel is measured from straight down, positive outwards.
        swivel_frame=quaternion.rotate(back, [[0.0, -1.0, 0.0], [1.0 if side == "left" else -1.0, 0.0, 0.0]]),
        swivel_usual=usual,
        swivel_range=swivels,
        reference_shift_m=np.zeros(3),
        wrist_axes=np.array([axes.flexion, axes.sideways]),
        wrist_limits=limits * (LIMIT_SHARE if carrier_of(instrument_map, seed) is None else CARRIED_LIMIT_SHARE),
    )


def carrier_of(instrument_map: InstrumentMap, seed: HandSeed) -> Control | None:
    """Return the control that moves a hand, such as a slide; None for a hand on the instrument's body."""
    return next((one for one in instrument_map.controls if seed.node != ROOT and one.node == seed.node), None)


def _shoulders(character: Character, side: Side, stand: Upright) -> tuple[FloatArray, FloatArray]:
    """Return the shoulder joint in the instrument's frame (3,), first without and then with help by the trunk."""
    skeleton, back = character.skeleton, quaternion.conjugate(stand.instrument_rotation)
    joint_m = stand.joints_m[skeleton.index(f"{side}UpperArm")]
    chest = stand.joints_m[skeleton.parents[skeleton.index(f"{side}Shoulder")]]
    help_turn = quaternion.from_axis_angle([0.0, 1.0, 0.0], (-1.0 if side == "left" else 1.0) * HELP_RAD)
    helped_m = chest + quaternion.rotate(help_turn, joint_m - chest)
    own_m, with_help_m = (quaternion.rotate(back, one_m - stand.instrument_m) for one_m in (joint_m, helped_m))
    return own_m, with_help_m


def _swivels(seed: HandSeed, posture: Posture) -> tuple[float, tuple[float, float]]:
    """Return the usual swivel of the elbow about the line from shoulder to wrist, away from the ribs, and its range
    (least, greatest), in radians.
    """
    if seed.elbow_off_ribs_deg is None:
        return float(np.radians(posture.elbow_off_ribs_deg)), SWIVEL_RANGE_RAD
    usual = float(np.radians(seed.elbow_off_ribs_deg))
    return usual, (usual - SWIVEL_ABOUT_RAD, usual + SWIVEL_ABOUT_RAD)


def arm_residuals(problem: ArmProblem, swivel: FloatArray, place: FloatArray, turn: FloatArray) -> FloatArray:
    """Return the residuals that keep the wrist straight: from direction and twist of the forearm and position of
    the elbow.

    Parameters
    ----------
    swivel : (B,)
        Swivels of the elbow of B candidates, in radians.
    place, turn : (B, 3) and (B, 4)
        Their wrists in the instrument's frame.

    Returns
    -------
    (B, m) float64
        The m residuals of each.
    """
    wrist = place + problem.reference_shift_m
    bent, over = _bend(problem, swivel, wrist, turn, problem.shoulder_m)
    far = np.linalg.norm(wrist - problem.shoulder_m, axis=1) - 0.97 * (problem.upper_m + problem.lower_m)
    parts = [
        bent / (FLEXION_RAD, DEVIATION_RAD, PRONATION_RAD),
        over / LIMIT_RAD,
        ((swivel - problem.swivel_usual) / SWIVEL_RAD)[:, None],
        (np.maximum(far, 0.0) / REACH_M)[:, None],
    ]
    if problem.helped:
        parts.append(_bend(problem, swivel, wrist, turn, problem.helped_m)[1] / LIMIT_RAD)
    return np.concatenate(parts, axis=1)


def _bend(
    problem: ArmProblem, swivel: FloatArray, wrist: FloatArray, turn: FloatArray, shoulder_m: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return for B candidates flexion, deviation and pronation of the wrist (B, 3) in radians, and the excess over
    their limits of these and of two further measures (B, 5).
    """
    elbow = elbow_place(problem, wrist, swivel, shoulder_m)
    forearm = wrist - elbow
    forearm /= np.linalg.norm(forearm, axis=1)[:, None]
    sign = 1.0 if problem.side == "left" else -1.0
    back = quaternion.conjugate(turn)
    local = quaternion.rotate(back, forearm)
    flexion = np.arctan2(sign * local[:, 1], np.maximum(sign * local[:, 0], 1e-3))
    deviation = np.arctan2(-local[:, 2], np.maximum(sign * local[:, 0], 1e-3))
    # Hinge of the elbow in the hand's frame: along the palm's normal if the forearm is neither pronated nor
    # supinated.
    hinge = np.cross(elbow - shoulder_m, forearm)
    hinge /= np.maximum(np.linalg.norm(hinge, axis=1), 1e-9)[:, None]
    seen = quaternion.rotate(back, hinge) * sign
    bent = np.stack([flexion, deviation, np.arctan2(seen[:, 2], -seen[:, 1])], axis=1)
    both = np.concatenate([bent, _shared(problem, forearm, hinge, turn)], axis=1)
    low, high = problem.wrist_limits[:2].T
    low, high = np.array([*low, -PRONATION_MOST_RAD, *low]), np.array([*high, PRONATION_MOST_RAD, *high])
    return bent, np.maximum(both - high, 0.0) + np.minimum(both - low, 0.0)


def _shared(problem: ArmProblem, forearm: FloatArray, hinge: FloatArray, turn: FloatArray) -> FloatArray:
    """Return flexion and deviation (B, 2) of the wrist in radians for B candidates, after the forearm has taken its
    share of the twist.
    """
    sign = 1.0 if problem.side == "left" else -1.0
    frame = quaternion.from_frames(sign * forearm, -sign * hinge)
    local = quaternion.multiply(quaternion.conjugate(frame), turn)
    axis = np.array([1.0, 0.0, 0.0])
    taken = quaternion.from_axis_angle(axis, TWIST_SHARE * quaternion.twist_angle(local, axis))
    swing, _ = quaternion.swing_twist(quaternion.multiply(quaternion.conjugate(taken), local), axis)
    return quaternion.to_rotation_vector(swing) @ problem.wrist_axes.T


def elbow_place(problem: ArmProblem, wrist: FloatArray, swivel: FloatArray, shoulder_m: FloatArray) -> FloatArray:
    """Return the elbow's position (B, 3) for B wrists (B, 3) and swivels (B,): 0 is straight down, positive is
    outwards.
    """
    a, b = problem.upper_m, problem.lower_m
    line = wrist - shoulder_m
    reach = np.clip(np.linalg.norm(line, axis=1), abs(a - b) + 1e-4, (a + b) * 0.9999)
    direction = line / np.linalg.norm(line, axis=1)[:, None]
    along = (a * a - b * b + reach * reach) / (2.0 * reach)
    aside = np.sqrt(np.maximum(a * a - along * along, 0.0))
    pole = _pole(problem, direction, swivel)
    elbow: FloatArray = shoulder_m + direction * along[:, None] + pole * aside[:, None]
    return elbow


def _pole(problem: ArmProblem, direction: FloatArray, swivel: FloatArray) -> FloatArray:
    down, out = problem.swivel_frame
    pole = np.cos(swivel)[:, None] * down + np.sin(swivel)[:, None] * out
    pole = pole - direction * np.einsum("bi,bi->b", pole, direction)[:, None]
    result: FloatArray = pole / np.maximum(np.linalg.norm(pole, axis=1), 1e-9)[:, None]
    return result
