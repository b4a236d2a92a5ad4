"""Layers of body motion: sway, lean, accents, weight, knees, breath, cue, bell, gaze, feet, and the residual motion of
a still body.

Hips, chest, head and elbows have the same layers with delays (`app.motion.gestures.body_lag`). Every layer is a
function of time in anatomical angles. Layers are independent and added, so each can be omitted; contacts are solved
afterwards. Sizes come from `metadata` at the player's amplitude.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.by_hand.pose_corrections import PoseAngles, hold_body
from app.motion.faces.gaze import GazeFrames, with_instrument
from app.motion.gestures.feet import feet_moved
from app.motion.gestures.hand_gestures import limited_hand_gestures
from app.motion.gestures.idle_gestures import beside_playing
from app.motion.gestures.layers import LayerSamples
from app.motion.gestures.named_gestures import with_gestures
from app.motion.gestures.summed_angles import Angles, Sizes, Sum
from app.plan.by_hand.pose_corrections import BELL_LEFT, BELL_UP, NECK_SHARES, TRUNK_SHARES
from app.plan.events_by_hand import PoseTarget
from metadata.model import Posture

EYES_BACK = 0.6
"""Share of the head's rotation to the instrument that the eyes compensate, to see the music and the others."""
QUIET, QUIET_AIR = 0.45, 0.3
"""Apparent filling of the lungs and use of air by a quiet breath, as shares of a full one."""
LIFT_SHARE = 0.7
FREE_AMPLITUDE = 0.5
"""Amplitude at which the head fully follows a trunk that turns for a far hand."""
ELBOWS: Final[dict[str, PoseTarget]] = {"left": "left_elbow", "right": "right_elbow"}
STEP_IN_HIPS = 0.3
"""Share of a foot's forward displacement that the hips follow."""


class StyleShares(NamedTuple):
    """Factors of layers of body motion in spans with another style: of gestures, of sway and of weight shifts, each
    with its random motion; (F,) or constant.
    """

    gestures: FloatArray | float = 1.0
    sway: FloatArray | float = 1.0
    weight_shift: FloatArray | float = 1.0


def body_motion(
    levels: LayerSamples,
    sizes: Sizes,
    look: GazeFrames,
    times_s: FloatArray,
    shares: StyleShares,
    steps: bool,
) -> BodyMotion:
    """Sum all layers of body motion at ascending ``times_s`` (F,) on top of the posture. ``levels`` has the layers'
    values, ``sizes`` their scale for the player, ``look`` the gaze, and ``shares`` the factors of spans in another
    style; without ``steps`` feet only tap.
    """
    body, acting, amplitude = sizes.body, sizes.acting, sizes.parameters.amplitude
    shown, wandering = acting.gestures * shares.gestures, shares.sway * acting.sway
    uneasy, frames = shares.weight_shift * acting.weight_shift, len(times_s)
    hands, raised = limited_hand_gestures(levels.reached or {}, amplitude, acting.gestures)
    lowered = levels.lowered if raised is None else levels.lowered * (1.0 - raised)
    look, total = with_instrument(look, lowered), Sum(frames)
    aside_rad = _hold_posture(total, sizes.posture, lowered)
    angles = Angles.of(levels, sizes, times_s, wandering)
    angles.add_to(total)
    total.left(NECK_SHARES, _wandering_rad("head_side", sizes, times_s, wandering))
    total.turn(NECK_SHARES, _wandering_rad("head_turn", sizes, times_s, wandering))
    shoulders, elbows = _breathe(total, levels, sizes)
    bell_cue_rad = _give_cue(total, levels, sizes)
    bell_up = _raise_bell(total, levels, sizes)
    total.turn(NECK_SHARES, 0.5 * look.head_yaw_rad)
    total.forward(NECK_SHARES, 0.5 * look.head_pitch_rad)
    total.forward(TRUNK_SHARES, np.deg2rad(body.bell.lowered_trunk_deg) * lowered)
    done = beside_playing(levels.concert, body.concert, amplitude, shown, sizes.seated or not steps)
    total.forward(TRUNK_SHARES, done.trunk_rad)
    total.forward(NECK_SHARES, done.neck_rad)
    total.turn(TRUNK_SHARES, body.concert.look_trunk_share * lowered * 0.5 * look.head_yaw_rad)
    feet = feet_moved(levels.feet, body, amplitude, acting.footwork, steps=steps)
    held = with_gestures(levels.held, levels.gestured, amplitude, shown)
    spine = total.all()
    hold_body(held, body, *spine)
    down = acting.phrase * levels.accent.hips
    return BodyMotion(
        *spine,
        hips_side_m=_aside_m(levels, sizes, steps, times_s, uneasy),
        hips_ahead_m=_ahead_m(levels, sizes, feet, times_s, uneasy) - done.back_m,
        hips_bob_m=sunk(down) * sizes.of(body.sway.bob_m),
        hips_roll_rad=angles.hips_roll_rad,
        hips_turn_rad=angles.hips_turn_rad,
        hips_forward_rad=angles.pelvis + done.hips_rad,
        knee_rad=_bent_rad(levels, sizes, down),
        bell_rad=0.5 * bell_up,
        bell_cue_rad=bell_cue_rad,
        bell_down_rad=np.zeros(frames),
        bell_right_rad=np.zeros(frames),
        bell_held_rad=_turned_bell(held),
        shoulders_rad=shoulders + done.shoulders_rad,
        elbows_rad=elbows + done.elbows_rad,
        eyes_yaw_rad=look.yaw_rad - 0.5 * look.head_yaw_rad - EYES_BACK * aside_rad,
        eyes_pitch_rad=look.pitch_rad - 0.5 * look.head_pitch_rad,
        looks={
            "left_rad": 0.5 * look.head_yaw_rad + (EYES_BACK + (1.0 - EYES_BACK) * look.own) * aside_rad,
            "down_rad": 0.5 * look.head_pitch_rad,
            "near_per_m": look.near_per_m,
            "own": look.own,
        },
        lowered=lowered * (1.0 - done.up_share),
        steadied=np.full(frames, max(0.0, 1.0 - amplitude / FREE_AMPLITUDE)),
        elbow_held_rad={side: held[elbow].up for side, elbow in ELBOWS.items() if elbow in held},
        elbows_late_rad=angles.elbows_late(),
        feet=feet,
        hands=hands,
    )


def _wandering_rad(name: str, sizes: Sizes, times_s: FloatArray, share: FloatArray | float) -> FloatArray:
    """Slow random turn (N,) of the head in radians; ``name`` selects the random sequence, ``share`` scales it."""
    return np.deg2rad(sizes.wander(name, sizes.body.sway.head_deg, times_s, share))


def _breathe(total: Sum, levels: LayerSamples, sizes: Sizes) -> tuple[FloatArray, FloatArray]:
    """Add the breath to trunk and neck in ``total``, and return the lift of the shoulders and the outward turn of the
    elbows in radians (F,)."""
    breath, deg = sizes.body.breath, np.deg2rad
    shown, (with_trunk, with_shoulders) = sizes.acting.breath * sizes.of(breath.shown), sizes.breathing
    inhaled = shown * (levels.full + QUIET * levels.quiet)
    trunk_back = deg(with_trunk * breath.torso_back_deg) * (inhaled + shown * levels.further)
    pushed = deg(breath.push_forward_deg) * shown * levels.push
    breathing = trunk_back - deg(breath.preparation_forward_deg) * levels.leaning - pushed
    total.forward(TRUNK_SHARES, -breathing)
    total.forward(NECK_SHARES, -deg(breath.head_back_deg) * inhaled + 0.4 * breathing)
    return deg(with_shoulders * breath.shoulder_lift_deg) * inhaled, deg(breath.elbow_out_deg) * inhaled


def _give_cue(total: Sum, levels: LayerSamples, sizes: Sizes) -> FloatArray:
    """Add the nods of cues to trunk and neck in ``total``, and return the rise of the bell in radians (F,)."""
    cue = sizes.body.cue
    dip, lift = sizes.acting.cue * levels.dip, sizes.acting.cue * levels.lift
    total.forward(TRUNK_SHARES, sizes.rad(cue.trunk_deg) * (dip - LIFT_SHARE * lift))
    total.forward(NECK_SHARES, sizes.rad(cue.head_deg) * (dip - LIFT_SHARE * lift))
    up_rad: FloatArray = LIFT_SHARE * sizes.rad(cue.bell_lift_deg) * lift - sizes.rad(cue.bell_dip_deg) * dip
    return up_rad


def _raise_bell(total: Sum, levels: LayerSamples, sizes: Sizes) -> FloatArray:
    """Add the rise of the bell with the melody to head and trunk in ``total``, and return it in radians (F,)."""
    bell, height = sizes.body.bell, sizes.acting.bell_height * levels.height
    raised, sunk = np.maximum(height, 0.0), np.minimum(height, 0.0)
    up_rad: FloatArray = raised * sizes.rad(bell.up_deg) + sunk * sizes.rad(bell.down_deg)
    total.forward(NECK_SHARES, -0.35 * up_rad)
    total.forward(TRUNK_SHARES, -0.15 * up_rad)
    return up_rad


def sunk(down: FloatArray) -> FloatArray:
    """Return by how much hips sink (F,), 1 for an accent of depth 1 and 0 where ``down`` (F,) rises above standing; a
    sudden beginning would snap straight knees.
    """
    below = np.maximum(down, 0.0)
    return np.asarray(2.0 * np.square(below) / (1.0 + below))


def _bent_rad(levels: LayerSamples, sizes: Sizes, down: FloatArray) -> FloatArray:
    """Return the bend of the knees in radians (F,) on accents, in nods, and with weight shifts; ``down`` (F,) is the
    depth of the accents."""
    body, acting = sizes.body, sizes.acting
    dipped = acting.cue * levels.dip * sizes.rad(body.cue.knee_deg)
    giving = acting.weight_shift * levels.giving * sizes.rad(body.weight_shift.knee_deg)
    bent_rad: FloatArray = np.maximum(down, -0.3) * sizes.rad(body.sway.knee_deg) + dipped + giving
    return bent_rad


def _turned_bell(held: dict[PoseTarget, PoseAngles]) -> dict[str, FloatArray]:
    """Angles (F,) in radians by which the animator turns the bell: ``"pitch"``, ``"yaw"`` and ``"roll"``; empty if
    there are none.
    """
    if "bell" not in held:
        return {}
    bell = held["bell"]
    return {"pitch": BELL_UP["bell"] * bell.up, "yaw": BELL_LEFT["bell"] * bell.left, "roll": bell.roll}


def _hold_posture(total: Sum, posture: Posture, lowered: FloatArray) -> FloatArray:
    """Add the bends of a posture to ``total``, and return the turn (F,) of the head towards the instrument in radians;
    ``lowered`` is 0 with the instrument at the lips, 1 with it lowered.
    """
    still = np.ones(len(lowered))
    for joint, angle_deg in posture.spine_deg.items():
        total.forward({joint: 1.0}, np.deg2rad(angle_deg) * still)
    for add, angles in ((total.left, posture.spine_left_deg), (total.turn, posture.spine_turn_deg)):
        for joint, angle_deg in angles.items():
            # The head of a player turned to the instrument looks straight ahead when it is lowered; the trunk stays
            # with the hands.
            there = 1.0 - lowered if joint in NECK_SHARES else still
            add({joint: np.deg2rad(angle_deg)}, there)
    aside: FloatArray = sum(np.deg2rad(angle_deg) for angle_deg in posture.spine_turn_deg.values()) * (1.0 - lowered)
    return aside


def _aside_m(
    levels: LayerSamples, sizes: Sizes, steps: bool, times_s: FloatArray, uneasy: FloatArray | float
) -> FloatArray:
    """Sideways motion (F,) of the hips in metres (left positive): with the shifted weight, and over the standing foot
    during a step.
    """
    side_m, acting = sizes.body.weight_shift.side_m, sizes.acting
    aside_m: FloatArray = acting.weight_shift * levels.weight.hips * sizes.of(side_m)
    aside_m = aside_m + sizes.wander("weight", side_m, times_s, uneasy)
    if steps:
        over_m = acting.footwork * sizes.of(sizes.body.footwork.unload_m)
        for side, sign in (("left", -1.0), ("right", 1.0)):
            if f"{side}_unloaded" in levels.feet:
                aside_m = aside_m + sign * over_m * levels.feet[f"{side}_unloaded"]
    return aside_m


def _ahead_m(
    levels: LayerSamples,
    sizes: Sizes,
    feet: dict[str, FloatArray],
    times_s: FloatArray,
    uneasy: FloatArray | float,
) -> FloatArray:
    """Return the forward motion of the hips in metres (F,): back as the trunk leans forward, diagonally with the
    weight, and half as far as a foot that steps ahead."""
    phrase, shift, acting = sizes.body.phrase, sizes.body.weight_shift, sizes.acting
    back = acting.phrase * (levels.lean.hips + 0.5 * levels.accent.hips) * sizes.of(phrase.ahead_m)
    aslant = sizes.aslant * acting.weight_shift * levels.weight.hips * sizes.of(shift.ahead_m)
    ahead_m: FloatArray = aslant - back + sizes.wander("ahead", shift.ahead_m, times_s, uneasy)
    for side in ("left", "right"):
        if f"{side}_ahead" in feet:
            ahead_m = ahead_m + STEP_IN_HIPS * feet[f"{side}_ahead"]
    return ahead_m
