"""Joints of dances do not rotate faster than human ones, also in enlarged dances."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import part_speeds
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST, FASTEST_RAD_S
from app.choreography.dance import Manner
from app.choreography.generate import Choreographer
from app.choreography.joint_speeds import turns_within_speeds, within_speeds
from app.choreography.limbs import HINGES, STRETCHED_RAD, WRIST_RAD, hinge_ranges, wrists_within
from app.choreography.shortest_times import turns_rad_s
from app.choreography.sized import sized
from app.rig import quaternion
from tests.support.dances import beaten, model, moving, still


def flipping(name: str) -> MotionClip:
    """A joint that rotates by 160 degrees between two frames."""
    clip = still(60)
    turns = np.where(np.arange(60) < 30, -1.4, 1.4)[:, None] * (1.0, 0.0, 0.0)
    clip.rotations[:, SEGMENTS.index(name)] = quaternion.from_rotation_vector(turns)
    return clip


@pytest.mark.parametrize("name", ["leftHand", "rightUpperLeg", "spine"])
def test_a_flip_becomes_a_turn_that_people_can_do_and_all_else_stays(name: str) -> None:
    clip, free = flipping(name), np.zeros((60, 2), bool)
    found = within_speeds(clip, free)
    part = SEGMENTS.index(name)
    assert (part_speeds(found)[:, part] <= FASTEST[part]).all()
    assert found.rotations[:, np.arange(len(SEGMENTS)) != part] == pytest.approx(
        clip.rotations[:, np.arange(len(SEGMENTS)) != part]
    )
    assert found.rotations[[0, 5, 55, 59], part] == pytest.approx(clip.rotations[[0, 5, 55, 59], part], abs=1e-4)


def test_the_leg_of_a_standing_foot_stays() -> None:
    clip = flipping("rightUpperLeg")
    planted = np.zeros((60, 2), bool)
    planted[31:, 1] = True
    found = within_speeds(clip, planted)
    assert found.rotations[31:] == pytest.approx(clip.rotations[31:])


def test_what_is_slow_enough_is_left_as_it_is() -> None:
    clip = moving(60)
    assert within_speeds(clip, np.zeros((60, 2), bool)) is clip


def test_joints_of_an_arm_that_turn_together_do_not_add_up_to_a_faster_hand() -> None:
    clip, most = still(90), np.full(len(SEGMENTS), 10.0)
    angles = 0.5 * np.tanh((np.arange(90) - 45) / 4.0)
    arm = [SEGMENTS.index(f"left{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    for part in arm:
        clip.rotations[:, part] = quaternion.from_axis_angle((0.0, 1.0, 0.0), angles)
    before = turns_rad_s(clip)
    assert before[:, arm[0]].max() < 10.0 < 20.0 < before[:, arm[2]].max()
    found = turns_within_speeds(clip, np.zeros((90, 2), bool), most)
    assert turns_rad_s(found).max() <= 10.0
    assert found.rotations[:, : arm[0] + 1] == pytest.approx(clip.rotations[:, : arm[0] + 1])
    assert found.rotations[[0, -1]] == pytest.approx(clip.rotations[[0, -1]], abs=2e-3)
    assert turns_within_speeds(found, np.zeros((90, 2), bool), most) is found


def test_standing_legs_stay_however_fast_they_turn() -> None:
    clip, planted = flipping("rightUpperLeg"), np.ones((60, 2), bool)
    found = turns_within_speeds(clip, planted, np.full(len(SEGMENTS), 10.0))
    assert found.rotations == pytest.approx(clip.rotations)


def test_a_leg_beside_a_stand_is_not_bent_for_a_turn_within_it() -> None:
    clip, planted = still(90), np.zeros((90, 2), bool)
    planted[36:54, 1] = True
    angles = 0.5 * np.tanh((np.arange(90) - 45) / 3.0)
    clip.rotations[:, SEGMENTS.index("rightUpperLeg")] = quaternion.from_axis_angle((1.0, 0.0, 0.0), angles)
    most = np.full(len(SEGMENTS), 9.0)
    assert turns_rad_s(clip).max() > 9.0
    found = turns_within_speeds(clip, planted, most)
    assert found.rotations == pytest.approx(clip.rotations, abs=1e-6)


def test_wrists_turn_no_farther_than_those_of_people() -> None:
    clip = waving(2.2)
    part = SEGMENTS.index("leftHand")
    found = wrists_within(clip)
    angles = np.linalg.norm(quaternion.to_rotation_vector(found.rotations[:, part]), axis=-1)
    assert WRIST_RAD < angles.max() <= WRIST_RAD + STRETCHED_RAD
    inside = np.linalg.norm(quaternion.to_rotation_vector(clip.rotations[:, part]), axis=-1) < WRIST_RAD
    assert found.rotations[inside, part] == pytest.approx(clip.rotations[inside, part])
    usual = waving(1.2)
    assert wrists_within(usual) is usual


def waving(reach_rad: float) -> MotionClip:
    """An upper arm and a hand that swing to both sides of their mean pose."""
    clip = still(120)
    swing = reach_rad * np.sin(np.arange(120) / 8.0)[:, None] * (0.0, 1.0, 0.0)
    for name in ("leftUpperArm", "leftHand"):
        clip.rotations[:, SEGMENTS.index(name)] = quaternion.from_rotation_vector(swing)
    return clip


def test_a_larger_dance_moves_farther_where_joints_have_room() -> None:
    clip = waving(0.4)
    found = sized(clip, 1.5, hinge_ranges([clip]))
    for name in ("leftUpperArm", "leftHand"):
        turned = quaternion.to_rotation_vector(found.rotations[:, SEGMENTS.index(name)])
        assert 0.5 < np.abs(turned).max() <= 0.61


def test_a_larger_dance_does_not_flip_what_is_turned_far_already() -> None:
    # Half as far again would be more than half a turn.
    clip = waving(2.4)
    found = sized(clip, 1.5, hinge_ranges([clip]))
    part = SEGMENTS.index("leftUpperArm")
    assert np.abs(quaternion.to_rotation_vector(found.rotations[:, part])).max() <= 2.7
    assert part_speeds(found)[:, part].max() < 1.5 * part_speeds(clip)[:, part].max() + 1e-6


def test_elbows_of_a_larger_dance_bend_forwards() -> None:
    clip = still(120)
    at, axis = SEGMENTS.index("leftLowerArm"), HINGES["leftLowerArm"]
    bent = 0.7 + 0.7 * np.sin(np.arange(120) / 8.0)
    clip.rotations[:, at] = quaternion.from_rotation_vector(bent[:, None] * np.array(axis))
    found = sized(clip, 1.5, hinge_ranges([clip]))
    angles = quaternion.twist_angle(found.rotations[:, at], axis)
    assert angles.min() > -0.15
    assert np.ptp(angles) > np.ptp(bent)


@pytest.mark.parametrize("size", [0.0, 1.0, 1.5])
def test_no_joint_of_a_dance_turns_faster_than_those_of_people(size: float) -> None:
    clips = [replace(clip, fps=Fraction(100)) for clip in model(16).clips]
    # Captured arms near the bound, danced faster and larger.
    rotations = clips[0].rotations.copy()
    swing = 1.2 * np.sin(0.3 * np.arange(len(rotations)))[:, None] * (0.0, 0.0, 1.0)
    rotations[:, SEGMENTS.index("leftHand")] = quaternion.from_rotation_vector(swing)
    library = replace(model(16), clips=(replace(clips[0], rotations=rotations), clips[1]))
    clip = Choreographer(library).dance(beaten(24, 0.3), Manner(1, size=size), Fraction(60)).clip
    assert part_speeds(clip)[:, SEGMENTS.index("leftHand")].max() <= FASTEST_RAD_S
