"""Solves poses from curves: trunk, instrument, arms, legs and fingers of one player, in chunks of frames."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.arms import solve_arms
from app.motion.contacts.arms_off_trunk import outward
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.controls_within_reach import controls_within_reach
from app.motion.contacts.endpin import EndpinStand
from app.motion.contacts.hand_destinations import with_shapes
from app.motion.contacts.hand_in_bell import STOPPING, with_fingers_kept
from app.motion.contacts.help_for_far_hands import TURN_RAD, Help, needed_help, shoulder_distance_m
from app.motion.contacts.instrument_put_aside import AsidePlace
from app.motion.contacts.shares_of_help import (
    HELP_EASE_S,
    OUT_EASE_S,
    SHOULDER_EASE_S,
    leaned_to_far_hand,
    smoothed_help,
    turned_to_far_hand,
    with_room,
)
from app.motion.contacts.smooth_elbows import seen_every, with_elbows_along, with_elbows_off_trunk
from app.motion.contacts.still_player import ContactCurves, StillPlayer
from app.motion.contacts.trunk_and_legs import hips_path, solve_legs, trunk
from app.motion.contacts.upper_body import UpperBody, joined, upper_body
from app.motion.curves.soft_bounds import softly_capped
from app.motion.faces.eyes import (
    EYE_SHAPES,
    EYE_SIDES,
    EyeSide,
    directions_to,
    eye_joint,
    eye_turn,
    eyes_from_head_m,
    point,
    sight_by,
    weights_for,
)
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.grip.finger_poses import finger_rotations
from app.rig.grip.grip_pose import hand_targets
from instrument_maps.model import Endpin

CHUNK = 4096
"""Number of frames solved at a time, so that they fit the processor's cache."""
LEAST_DRAWN_M = 0.01
"""Least divisor in metres for the effect of the help, if the help has hardly any."""
LEAST_LEANT_M = 0.005
"""Least divisor in metres for the sideways displacement of the head by a small lean."""
LEAST_NEAR_PER_M = 1e-3
"""Least reciprocal distance in 1/m of an object that the eyes look at: a kilometre."""


@dataclass(frozen=True)
class PlayerBody(StillPlayer):
    """A player's body with instrument and posture: the data for solving contacts that do not change over time."""

    def standing_on(self, endpin: Endpin | None) -> PlayerBody:
        """Return the player with the instrument standing on its endpin, if its usual placement is low enough; else
        unchanged.
        """
        if endpin is None:
            return self
        usual = upper_body(self, ContactCurves(self.still, {}, {}, np.zeros(1))).carried
        return replace(self, stand=EndpinStand.of(endpin, self.carriage, usual))

    @cached_property
    def put_aside(self) -> AsidePlace | None:
        """Placement of the instrument while another one is used; None if the musician has only one."""
        if self.aside is None:
            return None
        low = replace(self.still, lowered=np.ones(1))
        carried = upper_body(replace(self, aside=None, stand=None), ContactCurves(low, {}, {}, np.zeros(1))).carried
        return AsidePlace.of(self.aside, self.skeleton, self.grip, self.base, carried)

    @cached_property
    def drawn_m(self) -> float:
        """Distance in metres by which a far hand comes nearer when head and instrument move towards it."""
        return _drawn_m(self)

    @cached_property
    def aside_per_turn(self) -> float:
        """Return the lean of the trunk to the right per turn to the left (radians) that keeps the head in place."""
        return _aside_per_turn(self)

    @cached_property
    def eyes_m(self) -> dict[EyeSide, FloatArray]:
        """Position (3,) of each eye in the head's frame, metres, by side."""
        return eyes_from_head_m(self.skeleton)

    @cached_property
    def eyes_from_m(self) -> FloatArray:
        """Midpoint (3,) between the eyes before any motion, in metres."""
        middle_m = 0.5 * (self.eyes_m["left"] + self.eyes_m["right"])
        place_m: FloatArray = self.base.head_m[0] + quaternion.rotate(self.base.head[0], middle_m)
        return place_m

    @cached_property
    def bowed_rad(self) -> float:
        """Downward angle in radians of the head in the player's posture."""
        ahead = quaternion.rotate(self.base.head[0], np.array([0.0, 0.0, 1.0]))
        return -math.asin(min(max(float(ahead[1]), -1.0), 1.0))

    @cached_property
    def farthest(self) -> dict[str, float]:
        """For each control that a hand moves along, the largest value that the hand can reach with all help of a still
        body; 1 if it reaches all. Motion slows down before this limit.
        """
        return _farthest(self)


def padding_frames(fps: Fraction) -> int:
    """Number of additional frames that `solve` needs before and after the requested ones."""
    smoothed = max(math.ceil(HELP_EASE_S * fps), math.ceil(OUT_EASE_S * fps))
    # Between the frames seen, both neighbours are needed.
    wrists = 2 * math.ceil(SHOULDER_EASE_S * fps) + seen_every(fps) - 1
    return 2 * smoothed + wrists + 2 * math.ceil(OUT_EASE_S * fps) + seen_every(fps) - 1


def solve(
    player: PlayerBody, curves: ContactCurves, fps: Fraction, first_frame_s: float, every: int = 1, first_frame: int = 0
) -> Motion:
    """Compute all poses of a player from curves, including contacts.

    Parameters
    ----------
    curves : ContactCurves
        Curves with `padding_frames` additional frames at both ends.
    first_frame_s : float
        Time of the first requested frame.
    every : int
        Compute poses only for every n-th frame; smoothing still uses all frames.
    first_frame : int
        Number of the first requested frame.
    """
    pad = padding_frames(fps)
    uppers = [upper_body(player, curves[part]) for part in _parts(len(curves))]
    needed = [needed_by(player, curves[part], upper) for part, upper in zip(_parts(len(curves)), uppers, strict=True)]
    given = smoothed_help(needed, math.ceil(HELP_EASE_S * fps))
    curves = replace(curves, body=body_with_help(player, curves.body, given))
    if given.moves_trunk:
        uppers = [upper_body(player, curves[part]) for part in _parts(len(curves))]
    curves = replace(curves, body=with_elbows_along(player, curves, joined(uppers), needed, fps, first_frame - pad))
    if player.shape is not None:
        curves = replace(
            curves, body=with_elbows_off_trunk(player, curves, joined(uppers), fps, first_frame - pad, player.put_aside)
        )
    asked = slice(pad, len(curves) - pad, every)
    return poses(player, curves[asked], fps / every, first_frame_s, joined(uppers)[asked])


def poses(
    player: PlayerBody, curves: ContactCurves, fps: Fraction, first_frame_s: float, upper: UpperBody | None = None
) -> Motion:
    """Compute the poses of a body in whose motion help for far hands is already included; each frame is independent.

    ``upper`` is its upper body if already computed.
    """
    frames, joints = len(curves), len(player.skeleton.names)
    # Contiguous by component, as rotations are computed and written to files.
    rotations = np.zeros((joints, 4, frames), dtype=np.float32).transpose(2, 0, 1)
    rotations[..., 3] = 1.0
    hips_m = np.empty((frames, 3), dtype=np.float32)
    instrument_m = np.empty((frames, 3), dtype=np.float32)
    instrument = np.empty((frames, 4), dtype=np.float32)
    controls = {name: np.empty(frames, dtype=np.float32) for name in curves.controls}
    turned = {name: np.empty(frames, dtype=np.float32) for name in EYE_SHAPES}
    for part in _parts(frames):
        chunk = curves[part]
        known = upper_body(player, chunk) if upper is None else upper[part]
        chunk_hips_m, local, carried, stops = _pose(player, chunk, known)
        chunk = replace(chunk, controls=stops)
        hips_m[part], instrument_m[part], instrument[part] = chunk_hips_m, carried.position_m, carried.rotation
        for joint, values in local.items():
            rotations[part, joint] = values
        posed = finger_rotations(player.grip, chunk.controls, len(chunk), chunk.placed, chunk.raised)
        if chunk.body.hands:
            posed = with_shapes(player.skeleton, chunk.body.hands, list(player.grip.finger_joints), posed)
        if player.stopped is not None and STOPPING in chunk.body.hands:
            posed = with_fingers_kept(player.skeleton, player.grip, player.stopped, chunk.body.hands[STOPPING], posed)
        # One joint at a time, which is three times as fast as all at once.
        for column, joint in enumerate(player.grip.finger_joints):
            rotations[part, joint] = posed[:, column]
        for name, values in stops.items():
            controls[name][part] = values
        for name, weights in _look(player, chunk, known.trunk.head, known.trunk.head_m).items():
            turned[name][part] = weights
    for side in EYE_SIDES:
        if eye_joint(side) in player.skeleton.names:
            joint = player.skeleton.index(eye_joint(side))
            rotations[:, joint] = eye_turn(sight_by(side, turned, frames))
    if player.stand is not None:
        drawn_out = player.stand.drawn_out(instrument_m, instrument)
        controls[player.stand.endpin.node] = drawn_out.astype(np.float32)
    return Motion(
        fps=fps,
        first_frame_s=first_frame_s,
        rotations=rotations,
        hips_m=hips_m,
        morphs={name: values.astype(np.float32) for name, values in curves.morphs.items()} | turned,
        controls=controls,
        instrument_position_m=instrument_m,
        instrument_rotation=instrument,
    )


def _parts(frames: int) -> Iterator[slice]:
    for start in range(0, frames, CHUNK):
        yield slice(start, min(start + CHUNK, frames))


def _pose(
    player: PlayerBody, curves: ContactCurves, known: UpperBody
) -> tuple[FloatArray, dict[int, FloatArray], InstrumentTransform, dict[str, FloatArray]]:
    """Solve one stretch of frames: position and rotation of the hips, rotations by joint (without fingers), placement
    of the instrument, and controls limited to the reach of the hands.
    """
    skeleton, motion = player.skeleton, curves.body
    local = {skeleton.index("hips"): known.hips} | known.trunk.local
    curves = replace(curves, controls=controls_within_reach(player, curves, known))
    late, carried = _late(motion), known.carried
    arms = solve_arms(player, curves, known, late, player.away(motion, carried))
    if player.put_aside is not None and curves.stowed is not None and np.any(curves.stowed):
        # The free hand lets go where the instrument was lowered and does not follow it.
        letting_go = player.put_aside.let_go(skeleton, player.grip, arms, curves.stowed)
        carried = player.put_aside.put(carried, curves.stowed)
        swung = player.put_aside.turned(curves.stowed)
        if late is not None:
            swung = quaternion.multiply(swung, late)
        arms = solve_arms(player, curves, replace(known, carried=carried), swung) | letting_go
    local |= arms
    local |= solve_legs(player.place, skeleton, known.hips_m, known.hips, motion.feet)
    return known.hips_m, local, carried, curves.controls


def _look(player: PlayerBody, curves: ContactCurves, head: FloatArray, head_m: FloatArray) -> dict[str, FloatArray]:
    """Return the weights (F,), by morph name, that turn the eyes to their target, combined with eye motion by hand."""
    motion, eyes_m = curves.body, player.eyes_m
    left_rad, down_rad = motion.eyes_yaw_rad, motion.eyes_pitch_rad
    if motion.looks:
        own = motion.looks["own"]
        target_m = point(
            left_rad + motion.looks["left_rad"],
            down_rad + motion.looks["down_rad"] + own * player.bowed_rad,
            1.0 / np.maximum(motion.looks["near_per_m"], LEAST_NEAR_PER_M),
        )
        target_m += player.eyes_from_m * np.stack([own, np.ones(len(own)), own], axis=-1)
        sights = directions_to(target_m, head, head_m, eyes_m)
    else:
        ahead = point(left_rad, down_rad, np.ones(len(left_rad)))
        sights = dict.fromkeys(EYE_SIDES, ahead)
    turned: dict[str, FloatArray] = {}
    for side, sight in sights.items():
        turned |= weights_for(side, sight)
    return {name: np.clip(weight + curves.morphs.get(name, 0.0), 0.0, 1.0) for name, weight in turned.items()}


def _late(motion: BodyMotion) -> FloatArray | None:
    """Return the rotation (F, 4) of elbows that lag behind the chest; None without lag."""
    late = motion.elbows_late_rad
    if not late:
        return None
    return quaternion.from_rotation_vector(quaternion.columns(late["forward"], late["turn"], -late["left"]))


def needs(player: PlayerBody, curves: ContactCurves) -> Help:
    """Compute frame by frame the help of trunk and shoulders that far hands need."""
    return needed_by(player, curves, upper_body(player, curves))


def needed_by(player: PlayerBody, curves: ContactCurves, upper: UpperBody) -> Help:
    free = player.away(curves.body, upper.carried)
    needed = needed_help(player.skeleton, player.grip, upper.trunk, upper.carried, curves.controls, curves.placed, free)
    # The chest carries a lowered instrument along: turning it would not bring a hand nearer.
    turning = 1.0 - curves.body.lowered
    return replace(needed, turn_rad=needed.turn_rad * turning, short_m=needed.short_m * turning)


def body_with_help(player: PlayerBody, motion: BodyMotion, help_given: Help) -> BodyMotion:
    """Add help to a body's motion: trunk and shoulders move towards far hands, and neck and head turn back so that the
    lips stay in place.
    """
    asked, most, short_m = help_given.turn_rad, help_given.most_turn_rad, help_given.short_m
    turn = np.zeros(len(asked))
    if np.any(asked):
        turn += with_room(np.maximum(asked, 0.0), most["right"])
        turn -= with_room(np.maximum(-asked, 0.0), most["left"])
    if np.any(short_m):
        draw = softly_capped(short_m / player.drawn_m, 1.0, 0.1) * np.abs(turn) / np.maximum(np.abs(asked), 1e-6)
        motion = leaned_to_far_hand(motion, draw, np.sign(asked))
    protraction = {
        side: with_room(needed, help_given.most_protraction_rad[side]) if np.any(needed) else needed
        for side, needed in help_given.protraction_rad.items()
    }
    if np.any(turn):
        motion = turned_to_far_hand(motion, turn, player.aside_per_turn)
    return replace(motion, protraction_rad=protraction)


def with_elbows_out(player: PlayerBody, curves: ContactCurves) -> BodyMotion:
    """Body motion with elbows turned out of the trunk's way, each frame by itself; parameters as in `outward`."""
    needed = outward(player, curves, upper_body(player, curves))
    if needed is None:
        return curves.body
    turns_rad: dict[str, FloatArray] = {
        side: np.minimum(turn, needed.most_rad[side]) for side, turn in needed.needed_rad.items()
    }
    return replace(curves.body, elbow_out_rad=turns_rad)


def _drawn_m(player: PlayerBody) -> float:
    """Distance in metres by which a far hand comes nearer to its shoulder when head and instrument move towards it
    fully.
    """
    one, nothing = np.ones(1), np.zeros(1)
    nearer = []
    for hand in player.grip.hands:
        if hand.motion is None:
            continue
        right = 1.0 if hand.side == "right" else -1.0
        far = turned_to_far_hand(player.still, right * TURN_RAD * one, player.aside_per_turn)
        farthest = {hand.motion.control: one}
        distances_m = []
        for draw in (0.0, 1.0):
            motion = leaned_to_far_hand(far, draw * one, right * one)
            upper = upper_body(player, ContactCurves(motion, farthest, {}, nothing))
            carried = upper.carried
            target_m, _ = hand_targets(hand, carried.position_m, carried.rotation, farthest)
            distances_m.append(shoulder_distance_m(player.skeleton, hand.side, upper.trunk, target_m))
        nearer.append(float(distances_m[0] - distances_m[1]))
    return max([*nearer, LEAST_DRAWN_M])


def _aside_per_turn(player: PlayerBody) -> float:
    """Sideways lean per turn of the trunk, both in radians, that keeps the head in place; computed for a small turn and
    lean.
    """
    still, small = replace(player.still, steadied=np.ones(1)), np.array([0.1])
    without, leaning = turned_to_far_hand(still, small, 0.0), turned_to_far_hand(still, small, 1.0)
    at_m = [
        float(trunk(player.skeleton, *hips_path(player.place, player.skeleton, motion), motion).head_m[0, 0])
        for motion in (still, without, leaning)
    ]
    return (at_m[1] - at_m[0]) / max(at_m[1] - at_m[2], LEAST_LEANT_M)


def _farthest(player: PlayerBody) -> dict[str, float]:
    one = np.ones(1)
    result: dict[str, float] = {}
    for hand in player.grip.hands:
        if hand.motion is None:
            continue
        curves = ContactCurves(player.still, {hand.motion.control: one}, {}, np.zeros(1))
        curves = replace(curves, body=body_with_help(player, player.still, needs(player, curves)))
        reached = controls_within_reach(player, curves, upper_body(player, curves))
        result[hand.motion.control] = float(reached[hand.motion.control][0])
    return result
