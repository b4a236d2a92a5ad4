"""Help for far hands is zero where arms reach, sufficient where they do not, and never pushes into a near hand."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.motion.contacts.help_for_far_hands import TURNS_ALONG_RAD
from app.motion.curves.soft_bounds import softly_capped, softly_over
from app.motion.model import Motion
from app.plan.parameters import PlayerParameters
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from app.rig.skeleton import forward
from metadata.load import load_body
from tests.support.performed import perform
from tests.unit.motion import figure
from tests.unit.motion.events import TICKS, fingerings, plan_of, press, slide

CHARACTER = figure.character()
PLACES = (0.0, 1.0, 0.0, 0.5, 1.0, 0.2)


def played(slide_m: float, note_s: float, sliding: str = "right", amplitude: float = 0.0) -> Motion:
    rows = [(i * note_s, (i + 1) * note_s, {"slide": place}) for i, place in enumerate(PLACES)]
    instrument = figure.instrument_map(press(), slide())
    hold = figure.hold(CHARACTER.skeleton, slide_m, sliding)
    return perform(
        plan_of(fingerings(rows)), PlayerParameters(amplitude=amplitude), instrument, CHARACTER, hold, load_body(),
        felt_beats=((0, TICKS),), fps=Fraction(60),
    )  # fmt: skip


def chest_yaw_rad(motion: Motion) -> np.ndarray:
    joint = CHARACTER.skeleton.index("upperChest")
    turned = forward(CHARACTER.skeleton, motion.rotations, motion.hips_m, [joint]).of(joint)[1]
    return quaternion.twist_angle(turned, np.array([0.0, 1.0, 0.0]))


@given(st.lists(st.floats(-1.0, 1.0), min_size=1), st.floats(0.001, 0.5))
def test_soft_bounds_are_the_hard_ones_away_from_the_bend(values: list[float], ease: float) -> None:
    x = np.array(values)
    soft, hard = softly_over(x, ease), np.maximum(x, 0.0)
    np.testing.assert_array_equal(soft[np.abs(x) >= ease], hard[np.abs(x) >= ease])
    assert np.all((soft >= hard - 1e-12) & (soft <= hard + ease / 4 + 1e-12))
    assert np.all(softly_capped(x, 0.3, ease) <= np.minimum(x, 0.3) + 1e-12)


@pytest.mark.parametrize("note_s", [0.6, 2.0])
@pytest.mark.parametrize("slide_m", [0.2, 0.35, 0.42])
def test_far_places_are_reached(slide_m: float, note_s: float) -> None:
    motion = played(slide_m, note_s)
    hand = figure.hold(CHARACTER.skeleton, slide_m).hands[1]
    instrument = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
    target_m, _ = hand_targets(hand, *instrument, motion.controls)
    joint = CHARACTER.skeleton.index("rightHand")
    hand_m = forward(CHARACTER.skeleton, motion.rotations, motion.hips_m, [joint]).of(joint)[0]
    assert np.linalg.norm(hand_m - target_m, axis=1).max() < 1e-3


def test_a_body_that_reaches_follows_the_hand_a_little_and_one_that_does_not_turns_towards_it() -> None:
    assert 0.5 * TURNS_ALONG_RAD < np.ptp(chest_yaw_rad(played(0.2, 2.0))) < 1.4 * TURNS_ALONG_RAD
    yaw = chest_yaw_rad(played(0.42, 2.0))
    frames = [round((2.0 + 2.0 * i + 1.0) * 60) for i in range(len(PLACES))]
    assert yaw[frames[1]] > yaw[frames[0]] + 0.1
    assert abs(yaw[frames[2]] - yaw[frames[0]]) < 0.02


def test_a_far_left_hand_turns_the_trunk_as_far_the_other_way() -> None:
    at = [round((2.0 + 2.0 * i + 1.0) * 60) for i in range(2)]
    near, far = chest_yaw_rad(played(0.42, 2.0, "left"))[at]
    usual_near, usual_far = chest_yaw_rad(played(0.42, 2.0))[at]
    assert near - far == pytest.approx(usual_far - usual_near, rel=0.1)
    assert far < near - 0.1


def test_the_lips_hardly_move_when_the_trunk_turns() -> None:
    motion = played(0.42, 2.0)
    assert np.ptp(motion.instrument_position_m, axis=0).max() < 0.12
    turn = quaternion.to_rotation_vector(motion.instrument_rotation.astype(np.float64))
    assert np.ptp(turn[:, 1]) < np.radians(4.0)


def test_the_head_of_who_keeps_still_stays_over_its_place() -> None:
    ranges_m = []
    for amplitude in (0.0, 0.5):
        motion = played(0.42, 2.0, amplitude=amplitude)
        head_m = forward(CHARACTER.skeleton, motion.rotations, motion.hips_m, [CHARACTER.skeleton.index("head")])
        ranges_m.append(float(np.ptp(head_m.of(CHARACTER.skeleton.index("head"))[0][:, 0])))
    assert ranges_m[0] < 0.012
    assert ranges_m[1] > 2.0 * ranges_m[0]


def test_help_that_is_early_does_not_fold_the_elbow() -> None:
    motion = played(0.42, 0.3)
    elbow = motion.rotations[:, CHARACTER.skeleton.index("rightLowerArm")].astype(np.float64)
    bend_deg = np.degrees(np.linalg.norm(quaternion.to_rotation_vector(elbow), axis=1))
    assert bend_deg.max() < 150.0


def test_the_trunk_does_not_lean_for_a_far_hand() -> None:
    motion = played(0.42, 2.0)
    skeleton = CHARACTER.skeleton
    joints = [skeleton.index("hips"), skeleton.index("neck")]
    low_m, high_m = (forward(skeleton, motion.rotations, motion.hips_m, joints).of(joint)[0] for joint in joints)
    upright = high_m - low_m
    assert np.ptp(np.degrees(np.arctan2(upright[:, 2], upright[:, 1]))) < 4.0
