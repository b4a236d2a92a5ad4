"""Wrists of players who raise and lower their bells to the limits."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.errors import Message
from app.export.joints import anatomical_angles
from app.motion.contacts.arms import solve_arms
from app.motion.contacts.solve import body_with_help, needs
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import Side
from app.motion.contacts.upper_body import upper_body
from app.motion.contacts.wrists import wrists_of
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves, prepare
from app.plan.model import GestureEvent
from app.plan.parameters import PlayerParameters
from app.rig.characters.character_library import character_named
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import hand_targets
from app.rig.ik import arm
from app.rig.skeleton import forward
from app.steps import StepRuns
from instrument_maps.load import bundled_maps
from instrument_maps.map_table import Posture
from metadata.load import load_body, load_skeleton
from tests.support.models import bundled_instrument
from tests.unit.motion.events import cue, fingerings, plan_of

FPS = Fraction(30)
END_S = 16.0
BEYOND_DEG = 2.0
"""Degrees by which a wrist may exceed its range if the grip itself is within."""


def _shown(instrument_id: str, character_id: str, posture: Posture) -> tuple[PerformanceCurves, Motion]:
    instrument, character, body = bundled_maps()[instrument_id], character_named(character_id), load_body()
    hold = hold_for(character, bundled_instrument(instrument), instrument, body)
    heights = tuple(
        GestureEvent(f"b{k}", "bell_height", k, k + 1, 2.0 * k, 2.0 * k + 2.0, (-1.0) ** k, Message("test.reason"))
        for k in range(int(END_S / 2.0))
    )
    notes = fingerings([(0.5 * k, 0.5 * k + 0.5, {}) for k in range(int(2 * END_S))])
    plan = plan_of(notes, first_frame_s=0.0, cues=(cue(5.0), cue(11.0)), gestures=heights)
    parameters = PlayerParameters(amplitude=1.0, posture=posture)
    curves = prepare(StepRuns(), plan, parameters, instrument, character, hold, body, felt_beats=((0, 480),))
    return curves, curves.motion(FPS, 0, round(END_S * FPS))


@pytest.mark.parametrize("posture", ["standing", "seated"])
@pytest.mark.parametrize("character_id", ["man_adult", "woman_adult"])
@pytest.mark.parametrize("instrument_id", ["trumpet_Bb", "clarinet_Eb", "trombone_tenor_F_attachment"])
def test_bells_lift_and_dip_no_further_than_wrists_follow(
    instrument_id: str, character_id: str, posture: Posture
) -> None:
    curves, motion = _shown(instrument_id, character_id, posture)
    skeleton, limits = curves.player.skeleton, load_body().limits["hand"]
    joints = forward(skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))
    for hand in curves.player.grip.hands:
        axes, joint = load_skeleton().joint_axes(f"{hand.side}Hand"), skeleton.index(f"{hand.side}Hand")
        rotations = motion.rotations[:, joint].astype(np.float64)
        degrees = np.degrees(
            anatomical_angles(rotations.T[:, None], np.array([[axes.flexion, axes.sideways, axes.twist]]))
        )[:, 0]
        for angles, (low, high) in zip(degrees[:2], (limits.flexion_deg, limits.sideways_deg), strict=True):
            assert low - BEYOND_DEG < angles.min() <= angles.max() < high + BEYOND_DEG, hand.side
        place = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
        requested_m, _ = hand_targets(hand, *place, {})
        assert np.linalg.norm(joints.of(joint)[0] - requested_m, axis=1).max() < 0.001


def test_a_bell_still_rises_and_sinks() -> None:
    _, motion = _shown("trumpet_Bb", "woman_adult", "standing")
    bell = motion.instrument_rotation.astype(np.float64)
    up_deg = np.degrees(np.arcsin(2.0 * (bell[:, 1] * bell[:, 2] - bell[:, 3] * bell[:, 0])))
    assert np.ptp(up_deg) > 15.0


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_angle_aside_is_the_anatomical_one(side: Side) -> None:
    wrist, axes = wrists_of(load_body(), load_skeleton())[side], load_skeleton().joint_axes(f"{side}Hand")
    rotations = np.random.default_rng(1).normal((0.0, 0.0, 0.0, 4.0), 1.0, (200, 4))
    rotations /= np.linalg.norm(rotations, axis=1)[:, None]
    known = anatomical_angles(rotations.T[:, None], np.array([[axes.flexion, axes.sideways, axes.twist]]))
    assert np.abs(wrist.aside_rad(rotations) - known[1, 0]).max() < 1e-9


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_wrist_well_within_its_range_is_left_alone(side: Side) -> None:
    wrist = wrists_of(load_body(), load_skeleton())[side]
    assert not wrist.beyond_rad(np.deg2rad(np.linspace(-26.0, 16.0, 50))).any()
    out = np.deg2rad(np.linspace(21.0, 36.0, 50))
    assert np.allclose(out - wrist.beyond_rad(out), np.minimum(out, np.deg2rad(20.0)), atol=np.deg2rad(0.5))


def test_an_elbow_that_hardly_moves_the_wrist_is_not_flung_to_the_other_side() -> None:
    wrist = wrists_of(load_body(), load_skeleton())["right"]
    # Two frames of a slide on its way: the angle aside by the elbow's turn rises with it, then falls.
    aside_rad, by_turn = np.deg2rad(np.array([-34.0, -34.0, -34.0])), np.array([0.09, -0.04, 0.25])
    turn_deg = np.degrees(
        wrist.relief_rad(aside_rad, wrist.beyond_rad(aside_rad), lambda turn_rad: aside_rad + by_turn * turn_rad)
    )
    assert abs(turn_deg[0] - turn_deg[1]) < 10.0
    assert turn_deg[2] > 10.0, "where it helps, it goes"


@pytest.mark.parametrize("character_id", ["man_adult", "woman_adult"])
@pytest.mark.parametrize(
    "instrument_id", ["sax_baritone_Eb", "clarinet_bass_Bb", "english_horn", "sax_soprano_Bb", "sax_tenor_Bb"]
)
def test_seated_players_rest_with_wrists_within_their_range(instrument_id: str, character_id: str) -> None:
    curves, _ = _shown(instrument_id, character_id, "seated")
    player = curves.player
    usual = ContactCurves(player.still, {}, {}, np.zeros(1))
    helped_curves = replace(usual, body=body_with_help(player, player.still, needs(player, usual)))
    arms = solve_arms(player, helped_curves, upper_body(player, helped_curves))
    for side, wrist in player.wrists.items():
        assert wrist.outside_rad(arms[arm(player.skeleton, side).end]).max() < np.deg2rad(0.5), side


def test_no_elbow_is_flung_up_by_a_nod() -> None:
    curves, motion = _shown("horn_double_F_Bb", "man_adult", "standing")
    skeleton = curves.player.skeleton
    joints = forward(skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))
    along_m = joints.of(skeleton.index("rightLowerArm"))[0] - joints.of(skeleton.index("rightUpperArm"))[0]
    up_deg = np.degrees(np.arcsin(along_m[:, 1] / np.linalg.norm(along_m, axis=1)))
    assert up_deg.max() < -18.0
