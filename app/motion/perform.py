"""From a player's plan to motion: controls, face and body as curves, then the contacts, all vectorised over frames."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

import numpy as np

from app.motion.body import BodyMotion, body_motion
from app.motion.controls import control_curves
from app.motion.curve import FloatArray, frame_times
from app.motion.face import breath_opening, face_morphs
from app.motion.gaze import plan_gaze
from app.motion.model import Motion
from app.motion.posture import hips_path, stance, trunk
from app.motion.solve import Curves, Player, padding, solve
from app.plan.model import PlayerParameters, PlayerPlan, TimeFrame
from app.rig.carriage import with_head
from app.rig.hold import Hold
from app.rig.model import Character
from instrument_maps.model import InstrumentMap
from metadata.load import load_expressions
from metadata.model import Body, Expression


def frame_count(time_frame: TimeFrame, fps: Fraction) -> int:
    """Number of frames of a performance: those in ``[first_frame_s, end_s)``."""
    exact = (time_frame.end_s - time_frame.first_frame_s) * fps.numerator / fps.denominator
    return max(1, math.ceil(exact - 1e-9))


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
    start_s = plan.time_frame.first_frame_s
    pad = padding(fps)
    times_s = frame_times(start_s, fps, first_frame - pad, frames + 2 * pad)
    seated = parameters.posture == "seated"
    carriage = instrument_map.hold.seated if seated else instrument_map.hold.standing
    posture = with_head(body.postures[parameters.posture], carriage)

    gaze = plan_gaze(plan, parameters.seed)
    mouth_open = breath_opening(plan).sample(times_s)
    known = load_expressions() if expressions is None else expressions
    controls = control_curves(plan.fingerings, instrument_map.controls, beat_ticks)
    curves = Curves(
        body=body_motion(plan, parameters, body, posture, gaze, beat_ticks, times_s),
        controls={name: curve.sample(times_s) for name, curve in controls.items()},
        morphs=face_morphs(plan, parameters, body, known, gaze, mouth_open, times_s),
        mouth_open=mouth_open,
    )
    skeleton = character.skeleton
    place = stance(skeleton, posture)
    still = BodyMotion.still(posture)
    player = Player(
        skeleton=skeleton,
        hold=hold,
        place=place,
        carriage=carriage,
        lowered=instrument_map.hold.lowered_seated if seated else instrument_map.hold.lowered_standing,
        still=still,
        base=trunk(skeleton, *hips_path(place, skeleton, still), still),
        grip_of_lips_m=_grip_of_lips(hold, body),
    )
    return solve(player, curves, fps, float(frame_times(start_s, fps, first_frame, 1)[0]))


def _grip_of_lips(hold: Hold, body: Body) -> FloatArray:
    """From where the upper lip alone would carry the rim to where both lips hold it, at a middling embouchure (3,)."""
    shapes = (body.embouchure.relaxed, body.embouchure.tight)
    morphs = {
        name: np.array([sum(shape.get(name, 0.0) for shape in shapes) / len(shapes)])
        for name in sorted({name for shape in shapes for name in shape})
    }
    grip_m: FloatArray = (hold.lips.contact_m(morphs, 1) - hold.lips.upper_m(morphs, 1))[0]
    return grip_m
