"""Hands that leave the lowered instrument, in computed motion: their destinations and their return."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from app.arrays import FloatArray
from app.export.joints import anatomical_angles
from app.motion.contacts.hand_destinations import USUAL_ARM_M, page_m
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import AddGesture, RemoveEvent
from app.project.edit.corrections import with_corrections
from app.rig import quaternion
from app.rig.grip.empty_hand_shapes import PAD_M, TIP_SHARE, finger_joints
from app.rig.grip.grip_pose import hand_targets
from app.rig.ik import arm
from app.rig.skeleton import forward
from metadata.library import bundled_gestures
from metadata.load import load_body, load_skeleton
from metadata.model import Body
from metadata.skeleton_profile import JointAxes
from tests.support.live import performance_of
from tests.support.performed import performance_curves

FPS = 60
QUARTER_S, QUARTER = 0.5, 480
NOTES_S, REST_S = 8.0, 14.0
NEXT_S = NOTES_S + REST_S
PLACED_S = 11.0


def resting(instrument_id: str, *gestures: tuple[str, float]) -> Performance:
    """Sixteen quarters, a rest and four more, with gestures placed by the test and none by rules."""
    bare = performance_of(instrument_id, [(QUARTER * step, QUARTER - 40, _pitch(instrument_id)) for step in _steps()])
    project, player = bare.project, bare.project.players[0]
    ruled = [event.id for event in bare.plans[player.id].gestures if event.kind == "named"]
    corrections = [RemoveEvent(event_id) for event_id in ruled]
    added = [
        AddGesture(f"a{index}", "named", _tick(start_s), _tick(start_s + bundled_gestures()[name].length_s), 1.0, name)
        for index, (name, start_s) in enumerate(gestures)
    ]
    return Performance(with_corrections(project, player.id, [*corrections, *added]))


def _steps() -> list[int]:
    return [*range(16), *range(16 + round(REST_S / QUARTER_S), 20 + round(REST_S / QUARTER_S))]


def _pitch(instrument_id: str) -> int:
    own = performance_of(instrument_id, [(0, QUARTER, 60)])
    limits = own.parts[0].instrument_map.range
    return (limits.easy_low + limits.easy_high) // 2


def _tick(at_s: float) -> int:
    return round(at_s / QUARTER_S * QUARTER)


def made(performance: Performance, from_s: float, to_s: float) -> tuple[PerformanceCurves, Motion, FloatArray]:
    """Curves of a player, some of the motion, and the times of its frames."""
    playing = performance_curves(performance, performance.project.players[0])
    first = round((from_s - playing.start_s) * FPS)
    motion = playing.motion(Fraction(FPS), first, round((to_s - from_s) * FPS))
    return playing, motion, motion.first_frame_s + np.arange(motion.frames) / FPS


def fingertip_m(playing: PerformanceCurves, motion: Motion, side: str, finger: str) -> FloatArray:
    """World position of a finger's pad from the joints of the motion."""
    skeleton = playing.player.skeleton
    last = finger_joints(skeleton, side, finger)[-1]
    place_m, turned = forward(skeleton, motion.rotations, motion.hips_m, [last]).of(last)
    pad_m = TIP_SHARE * skeleton.offsets_m[last] + np.array([0.0, -PAD_M, 0.0])
    return np.asarray(place_m + quaternion.rotate(turned, pad_m))


TURNS_PAGES = ["trumpet_Bb", "clarinet_Bb", "flute", "trombone_tenor_F_attachment", "bassoon", "horn_double_F_Bb"]


@pytest.mark.parametrize("instrument_id", TURNS_PAGES)
def test_the_page_is_taken_and_the_hand_is_back_for_the_next_note(instrument_id: str) -> None:
    gesture = bundled_gestures()["page_turn"]
    performance = resting(instrument_id, ("page_turn", PLACED_S))
    assert not performance.plans["1.1.1"].problems
    playing, motion, times_s = made(performance, PLACED_S - 0.5, NEXT_S + 0.5)
    without = made(resting(instrument_id), PLACED_S - 0.5, NEXT_S + 0.5)[1]
    side = playing.instrument_map.hold.leaving_hand
    assert side is not None
    assert gesture.hand is not None
    corner = next(key for key in gesture.hand.keys if key.shape == "pinch")
    scale = arm(playing.player.skeleton, side).length_m / USUAL_ARM_M
    page = page_m(playing.player.skeleton, playing.player.base) + scale * np.array(corner.m)
    frame = round((0.5 + corner.at * gesture.length_s) * FPS)
    taking = np.mean([fingertip_m(playing, motion, side, finger)[frame] for finger in ("Index", "Thumb")], axis=0)
    assert np.linalg.norm(taking - page) < 0.004
    # Thumb and forefinger have the paper between them.
    tips = [fingertip_m(playing, motion, side, finger)[frame] for finger in ("Index", "Thumb")]
    assert np.linalg.norm(tips[0] - tips[1]) < 0.06
    _back_on_the_grip(playing, motion, times_s)
    after = times_s >= PLACED_S + gesture.length_s + 0.2
    fingers = list(playing.player.grip.finger_joints)
    assert np.array_equal(motion.rotations[after][:, fingers], without.rotations[after][:, fingers])
    _other_hand_and_feet_stay(playing, motion, side)
    _within_bounds(motion, without, playing)


def test_the_forefinger_is_on_the_water_key_while_lips_blow() -> None:
    gesture = bundled_gestures()["press_water_key"]
    playing, motion, times_s = made(resting("trumpet_Bb", ("press_water_key", PLACED_S)), PLACED_S, NEXT_S)
    without = made(resting("trumpet_Bb"), PLACED_S, NEXT_S)[1]
    pressing = slice(round(0.4 * gesture.length_s * FPS), round(0.64 * gesture.length_s * FPS))
    water = playing.instrument_map.water
    assert water is not None
    assert water.position_m is not None
    place_m, turned = motion.instrument_position_m.astype(float), motion.instrument_rotation.astype(float)
    key_m = place_m + quaternion.rotate(turned, np.array(water.position_m))
    off_m = np.linalg.norm(fingertip_m(playing, motion, "right", "Index") - key_m, axis=1)
    assert off_m[pressing].max() < 0.002
    # It points down, and its mouthpiece is at the face.
    head = playing.player.skeleton.index("head")
    ((head_m, _),) = [forward(playing.player.skeleton, motion.rotations, motion.hips_m, [head]).of(head)]
    assert np.linalg.norm(place_m - head_m, axis=1)[pressing].max() < np.linalg.norm(place_m[0] - head_m[0]) - 0.08
    down = -quaternion.rotate(turned, np.array([0.0, 0.0, 1.0]))[:, 1]
    assert down[pressing].min() > np.sin(np.deg2rad(30.0))
    _back_on_the_grip(playing, motion, times_s)
    _within_bounds(motion, without, playing)


def test_neither_hand_leaves_a_tuba() -> None:
    performance = resting("tuba_CC", ("page_turn", PLACED_S))
    assert [problem.message.id for problem in performance.plans["1.1.1"].problems] == ["gesture.hand_holds"]
    playing, motion, _ = made(performance, PLACED_S, PLACED_S + 4.0)
    _on_the_grip(playing, motion)


@pytest.mark.parametrize(("start_s", "said"), [(3.0, "gesture.not_here"), (NEXT_S - 4.0, "gesture.not_here")])
def test_a_hand_that_is_needed_stays(start_s: float, said: str) -> None:
    # While something is played, and where it would not be back in time.
    performance = resting("clarinet_Bb", ("page_turn", start_s))
    assert [problem.message.id for problem in performance.plans["1.1.1"].problems] == [said]
    playing, motion, _ = made(performance, start_s, start_s + 4.0)
    _on_the_grip(playing, motion)


def test_one_hand_does_one_thing_at_a_time() -> None:
    performance = resting("clarinet_Bb", ("page_turn", PLACED_S), ("flex_fingers", PLACED_S + 1.0))
    assert [problem.message.id for problem in performance.plans["1.1.1"].problems] == ["gesture.hand_busy"]


def _on_the_grip(playing: PerformanceCurves, motion: Motion) -> None:
    skeleton = playing.player.skeleton
    place = motion.instrument_position_m.astype(float), motion.instrument_rotation.astype(float)
    placed = playing.placed(motion.first_frame_s + np.arange(motion.frames) / FPS)
    for hand in playing.player.grip.hands:
        wrist = skeleton.index(f"{hand.side}Hand")
        asked_m, _ = hand_targets(hand, *place, motion.controls, placed)
        there_m, _ = forward(skeleton, motion.rotations, motion.hips_m, [wrist]).of(wrist)
        assert np.linalg.norm(there_m - asked_m, axis=1).max() < 1e-3, hand.side


def _back_on_the_grip(playing: PerformanceCurves, motion: Motion, times_s: FloatArray) -> None:
    """Check that both hands are back on the instrument half a second before the next note."""
    first = int(np.searchsorted(times_s, NEXT_S - 0.5))
    playing_again = playing.motion(Fraction(FPS), round((times_s[first] - playing.start_s) * FPS), 30)
    _on_the_grip(playing, playing_again)


def _other_hand_and_feet_stay(playing: PerformanceCurves, motion: Motion, side: str) -> None:
    skeleton = playing.player.skeleton
    place = motion.instrument_position_m.astype(float), motion.instrument_rotation.astype(float)
    for hand in playing.player.grip.hands:
        if hand.side != side:
            wrist = skeleton.index(f"{hand.side}Hand")
            asked_m, _ = hand_targets(hand, *place, motion.controls)
            there_m, _ = forward(skeleton, motion.rotations, motion.hips_m, [wrist]).of(wrist)
            assert np.linalg.norm(there_m - asked_m, axis=1).max() < 2e-3
    meant = playing.footings(motion.first_frame_s + np.arange(motion.frames) / FPS)
    for foot in ("left", "right"):
        ankle = skeleton.index(f"{foot}Foot")
        there_m, _ = forward(skeleton, motion.rotations, motion.hips_m, [ankle]).of(ankle)
        assert np.linalg.norm(there_m - meant[foot].ankle_m, axis=1).max() < 1e-3


def _within_bounds(motion: Motion, without: Motion, playing: PerformanceCurves) -> None:
    """Check that wrists are within their ranges (or those of the grip) and that no joint moves too fast."""
    body, profile, skeleton = load_body(), load_skeleton(), playing.player.skeleton
    for wrist in ("leftHand", "rightHand"):
        beyond_deg = [
            _beyond_deg(one, skeleton.index(wrist), profile.joint_axes(wrist), body) for one in (motion, without)
        ]
        assert beyond_deg[0] < beyond_deg[1] + 1.0, wrist
    for name in skeleton.names[1:]:
        local = motion.rotations[:, skeleton.index(name)].astype(np.float64)
        turned = quaternion.multiply(quaternion.conjugate(local[:-1]), local[1:])
        velocity = quaternion.to_rotation_vector(turned) * FPS
        acceleration = np.linalg.norm(np.diff(velocity, axis=0), axis=1) * FPS
        assert acceleration.max() < body.limits[profile.joint(name).kind].acceleration_rad_s2, name


def _beyond_deg(motion: Motion, wrist: int, axes: JointAxes, body: Body) -> float:
    """Greatest angle in degrees by which a wrist exceeds its range."""
    local = motion.rotations[:, wrist].astype(np.float64)
    turns, of_axes = local.T[:, None], np.array([[axes.flexion, axes.sideways, axes.twist]])
    degrees = np.degrees(anatomical_angles(turns, of_axes))[:, 0].T
    low, high = np.array([getattr(body.limits["hand"], f"{name}_deg") for name in ("flexion", "sideways", "twist")]).T
    return float(np.maximum(np.maximum(low - degrees, degrees - high), 0.0).max())
