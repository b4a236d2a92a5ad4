"""From a player's plan to motion: controls, face and body as curves, then the contacts, all vectorised over frames."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import msgspec
import numpy as np
import numpy.typing as npt

from app.motion.body import BodyMotion, body_motion
from app.motion.contact import carry, reach_turn, solve_arms
from app.motion.controls import control_curves
from app.motion.curve import FloatArray, frame_times
from app.motion.face import breath_opening, face_morphs
from app.motion.gaze import plan_gaze
from app.motion.model import Motion
from app.motion.posture import Stance, Trunk, hips_path, solve_legs, stance, trunk
from app.plan.model import PlayerParameters, PlayerPlan, TimeFrame
from app.rig import quaternion
from app.rig.hold import Hold, finger_rotations
from app.rig.model import Character, Skeleton
from instrument_maps.model import Carriage, InstrumentMap, Lowered
from metadata.load import load_expressions
from metadata.model import Body, Expression, Posture

CHUNK = 4096
"""Frames solved at once: few enough to stay in the processor's cache."""
HEAD_FOLLOWS = 0.4
"""Share of the instrument's pitch the head goes along with, up to the posture's limit."""
REACH_TURN_SHARES = {"spine": 0.25, "chest": 0.40, "upperChest": 0.35}
NECK_BACK_SHARES = {"neck": 0.5, "head": 0.5}


def frame_count(time_frame: TimeFrame, fps: Fraction) -> int:
    """Number of frames of a performance: those in ``[first_frame_s, end_s)``."""
    exact = (time_frame.end_s - time_frame.first_frame_s) * fps.numerator / fps.denominator
    return max(1, math.ceil(exact - 1e-9))


@dataclass(frozen=True)
class _Player:
    """Everything about a player that does not change with time."""

    skeleton: Skeleton
    hold: Hold
    place: Stance
    carriage: Carriage
    lowered: Lowered
    base: Trunk


def perform(
    plan: PlayerPlan,
    parameters: PlayerParameters,
    instrument_map: InstrumentMap,
    character: Character,
    hold: Hold,
    body: Body,
    *,
    beat_ticks: int,
    fps: Fraction,
    frames: int | None = None,
    first_frame: int = 0,
    expressions: Mapping[str, Expression] | None = None,
) -> Motion:
    """Make one player's motion.

    Parameters
    ----------
    plan : PlayerPlan
    parameters : PlayerParameters
        Amplitude, posture, seed and the sizes of single layers.
    instrument_map : InstrumentMap
    character : Character
    hold : Hold
        Fitted for this character and instrument.
    body : Body
        Sizes, limits and postures.
    beat_ticks : int
        Ticks of a beat; a rest as long brings controls back to rest.
    fps : Fraction
    frames : int, optional
        How many; to the end of the performance without it.
    first_frame : int
        Index of the first frame wanted. A part is identical to the same frames of the whole.
    expressions : mapping of str to Expression, optional
        The bundled ones without it.

    Returns
    -------
    Motion
        ``first_frame_s`` is the time of its first frame.
    """
    if frames is None:
        frames = max(0, frame_count(plan.time_frame, fps) - first_frame)
    times_s = frame_times(plan.time_frame.first_frame_s, fps, first_frame, frames)
    curves = control_curves(plan.fingerings, instrument_map.controls, beat_ticks)
    controls = {name: curve.sample(times_s) for name, curve in curves.items()}
    gaze = plan_gaze(plan, parameters.seed)
    mouth_open = breath_opening(plan).sample(times_s)
    known = load_expressions() if expressions is None else expressions
    morphs = face_morphs(plan, parameters, body, known, gaze, mouth_open, times_s)

    seated = parameters.posture == "seated"
    carriage = instrument_map.hold.seated if seated else instrument_map.hold.standing
    posture = _with_head(body.postures[parameters.posture], carriage)
    motion = body_motion(plan, parameters, body, posture, gaze, times_s)
    _turn_towards(motion, reach_turn(hold, character.skeleton, controls, frames))
    place = stance(character.skeleton, posture)
    still = BodyMotion.still(posture)
    player = _Player(
        skeleton=character.skeleton,
        hold=hold,
        place=place,
        carriage=carriage,
        lowered=instrument_map.hold.lowered_seated if seated else instrument_map.hold.lowered_standing,
        base=trunk(character.skeleton, *hips_path(place, character.skeleton, still), still),
    )
    return _solved(player, motion, controls, morphs, mouth_open, fps, float(times_s[0]) if frames else 0.0)


def _with_head(posture: Posture, carriage: Carriage) -> Posture:
    """The posture with the head bent after the instrument's pitch, as far as the posture allows."""
    down_deg = min(posture.head_down_deg, HEAD_FOLLOWS * max(carriage.pitch_down_deg[1], 0.0))
    spine_deg = dict(posture.spine_deg)
    spine_deg["head"] = spine_deg.get("head", 0.0) + down_deg
    return msgspec.structs.replace(posture, spine_deg=spine_deg)


def _turn_towards(motion: BodyMotion, turn_rad: FloatArray) -> None:
    """Turn the trunk for a far hand, and neck and head back, so that the lips stay where they are."""
    if not np.any(turn_rad):
        return
    for joint, share in REACH_TURN_SHARES.items():
        motion.turn_rad[joint] = motion.turn_rad[joint] + share * turn_rad
    for joint, share in NECK_BACK_SHARES.items():
        motion.turn_rad[joint] = motion.turn_rad[joint] - share * turn_rad


def _solved(
    player: _Player,
    motion: BodyMotion,
    controls: Mapping[str, FloatArray],
    morphs: Mapping[str, FloatArray],
    mouth_open: FloatArray,
    fps: Fraction,
    first_frame_s: float,
) -> Motion:
    frames, joints = len(mouth_open), len(player.skeleton.names)
    rotations = np.zeros((frames, joints, 4), dtype=np.float32)
    rotations[..., 3] = 1.0
    hips_m = np.empty((frames, 3), dtype=np.float32)
    position_m = np.empty((frames, 3), dtype=np.float32)
    instrument = np.empty((frames, 4), dtype=np.float32)
    for start in range(0, frames, CHUNK):
        part = slice(start, min(start + CHUNK, frames))
        chunk = _solve_chunk(
            player,
            motion[part],
            {name: values[part] for name, values in controls.items()},
            {name: values[part] for name, values in morphs.items()},
            mouth_open[part],
        )
        hips_m[part], position_m[part], instrument[part] = chunk.hips_m, chunk.position_m, chunk.instrument
        for joint, values in chunk.rotations.items():
            rotations[part, joint] = values
        rotations[part, list(player.hold.finger_joints)] = chunk.fingers
    return Motion(
        fps=fps,
        first_frame_s=first_frame_s,
        rotations=rotations,
        hips_m=hips_m,
        morphs={name: values.astype(np.float32) for name, values in morphs.items()},
        controls={name: values.astype(np.float32) for name, values in controls.items()},
        instrument_position_m=position_m,
        instrument_rotation=instrument,
    )


@dataclass(frozen=True)
class _Chunk:
    rotations: dict[int, FloatArray]
    fingers: npt.NDArray[np.float64]
    hips_m: FloatArray
    position_m: FloatArray
    instrument: FloatArray


def _solve_chunk(
    player: _Player,
    motion: BodyMotion,
    controls: dict[str, FloatArray],
    morphs: dict[str, FloatArray],
    mouth_open: FloatArray,
) -> _Chunk:
    skeleton = player.skeleton
    hips_m, hips = hips_path(player.place, skeleton, motion)
    upper = trunk(skeleton, hips_m, hips, motion)
    carried = carry(
        player.hold, player.carriage, player.lowered, upper, player.base, motion, morphs, mouth_open, motion.lowered
    )
    arms, _ = solve_arms(skeleton, player.hold, upper, player.base, motion, carried, controls)
    rotations = {skeleton.index("hips"): hips} | upper.local | arms | solve_legs(player.place, skeleton, hips_m, hips)
    looking = np.stack([motion.eyes_pitch_rad, motion.eyes_yaw_rad, np.zeros_like(mouth_open)], axis=-1)
    for name in ("leftEye", "rightEye"):
        if name in skeleton.names:
            rotations[skeleton.index(name)] = quaternion.from_rotation_vector(looking)
    fingers = finger_rotations(player.hold, controls, len(mouth_open))
    return _Chunk(rotations, fingers, hips_m, carried.position_m, carried.rotation)
