"""Joints of dances start and stop rotating no more suddenly than captured ones."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.choreography.body import FEET, SEGMENTS
from app.choreography.body_speeds import changes_rad, sudden, turns_rad
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.dance import Manner
from app.choreography.feet_on_floor import legs_to
from app.choreography.generate import Choreographer
from app.choreography.joint_changes import (
    HANDS,
    feet_within_changes,
    hands_within_changes,
    hips_within_changes,
    within_changes,
)
from app.rig import quaternion
from tests.support.dance_measures import angular_jumps
from tests.support.dances import beaten, model, moving, still

MOST_RAD_S = 3.0
FREE = np.zeros((60, 2), bool)


def snapping(name: str, rad_s: float = 8.0) -> MotionClip:
    """A joint that starts to rotate within a frame, and stops half a second later as suddenly."""
    clip = still(60)
    bent_rad = np.clip((np.arange(60) - 15) / 60.0, 0.0, 0.5) * rad_s
    turns = quaternion.from_rotation_vector(bent_rad[:, None] * (0.3, 0.0, 0.0))
    clip.rotations[:, SEGMENTS.index(name)] = turns
    return clip


@pytest.mark.parametrize("name", ["leftLowerLeg", "rightUpperArm", "chest"])
def test_a_joint_that_snaps_starts_gradually_and_all_else_stays(name: str) -> None:
    clip, part = snapping(name, 24.0), SEGMENTS.index(name)
    assert angular_jumps(clip).max() > 2.0 * MOST_RAD_S
    found = within_changes(clip, FREE, MOST_RAD_S)
    assert angular_jumps(found).max() <= MOST_RAD_S
    others = np.arange(len(SEGMENTS)) != part
    assert found.rotations[:, others] == pytest.approx(clip.rotations[:, others])
    away = [0, 6, 24, 30, 36, 54, 59]
    assert found.rotations[away, part] == pytest.approx(clip.rotations[away, part], abs=1e-9)
    assert np.degrees(np.abs(found.rotations - clip.rotations)).max() < 3.0


def test_a_hand_starts_gradually_although_all_joints_of_its_arm_snap_at_once() -> None:
    clip = still(60)
    arm = [SEGMENTS.index(f"left{part}") for part in ("UpperArm", "LowerArm", "Hand")]
    clip.rotations[:, arm] = snapping("leftHand").rotations[:, arm[2:]]
    upper = list(range(arm[2]))
    assert angular_jumps(clip).max() < MOST_RAD_S < HANDS * MOST_RAD_S < 6.0 < hand_jumps(clip).max()
    found = hands_within_changes(clip, MOST_RAD_S)
    assert hand_jumps(found).max() <= HANDS * MOST_RAD_S
    assert found.rotations[:, upper] == pytest.approx(clip.rotations[:, upper])
    assert hands_within_changes(found, MOST_RAD_S) is found


def test_a_wrist_does_not_snap_in_place_of_its_hand() -> None:
    clip, wrist = snapping("leftUpperArm", 24.0), SEGMENTS.index("leftHand")
    assert hand_jumps(clip).max() > 2.0 * MOST_RAD_S
    found = hands_within_changes(clip, MOST_RAD_S)
    assert 0.5 * MOST_RAD_S < angular_jumps(found)[:, wrist].max() <= HANDS * MOST_RAD_S
    assert hand_jumps(found).max() < 0.8 * hand_jumps(clip).max()


def hand_jumps(clip: MotionClip) -> np.ndarray:
    """Change (F - 2,) of the left hand's angular velocity in the world in rad/s."""
    turns = clip.world().rotations[:, 1 + SEGMENTS.index("leftHand")]
    steps = quaternion.to_rotation_vector(quaternion.multiply(turns[1:], quaternion.conjugate(turns[:-1])))
    return np.linalg.norm(np.diff(steps, axis=0), axis=-1) * float(clip.fps)


def test_the_leg_of_a_standing_foot_stays() -> None:
    clip, planted = snapping("rightUpperLeg", 24.0), FREE.copy()
    planted[10:20, 1] = True
    found = within_changes(clip, planted, MOST_RAD_S)
    assert found.rotations[10:20] == pytest.approx(clip.rotations[10:20])
    assert angular_jumps(found)[40:].max() <= MOST_RAD_S


def test_a_leg_is_bent_up_to_its_landing_only_if_asked() -> None:
    clip, planted = snapping("rightUpperLeg", 24.0), FREE.copy()
    planted[17:22, 1] = True
    before = angular_jumps(clip)[15:18, SEGMENTS.index("rightUpperLeg")].max()
    held = within_changes(clip, planted, MOST_RAD_S)
    assert held.rotations[14:22] == pytest.approx(clip.rotations[14:22])
    found = within_changes(clip, planted, MOST_RAD_S, lands_s=0.0)
    assert angular_jumps(found)[14:18].max() < 0.8 * before
    assert found.rotations[17:22] == pytest.approx(clip.rotations[17:22])


def test_only_legs_are_bent_if_asked() -> None:
    clip, leg = snapping("leftUpperArm", 24.0), SEGMENTS.index("rightUpperLeg")
    clip.rotations[:, leg] = snapping("rightUpperLeg", 24.0).rotations[:, leg]
    found = within_changes(clip, FREE, MOST_RAD_S, legs_only=True)
    assert angular_jumps(found)[:, leg].max() <= MOST_RAD_S < 2.0 * MOST_RAD_S < angular_jumps(clip)[:, leg].max()
    others = np.arange(len(SEGMENTS)) != leg
    assert found.rotations[:, others] == pytest.approx(clip.rotations[:, others])


def test_hips_that_snap_start_gradually_and_all_else_stays() -> None:
    clip = snapping("hips", 24.0)
    found = hips_within_changes(clip, MOST_RAD_S)
    assert angular_jumps(found).max() <= MOST_RAD_S
    assert found.rotations[:, 1:] == pytest.approx(clip.rotations[:, 1:])
    assert hips_within_changes(found, 2.0 * MOST_RAD_S) is found


def world_jumps_rad_s(clip: MotionClip, name: str) -> np.ndarray:
    """Changes (F - 2,) of a segment's angular velocity in the world."""
    turned = clip.world().rotations[:, 1 + SEGMENTS.index(name)]
    steps = quaternion.multiply(turned[1:], quaternion.conjugate(turned[:-1]))
    return np.linalg.norm(np.diff(quaternion.to_rotation_vector(steps), axis=0), axis=-1) * float(clip.fps)


@pytest.mark.parametrize("foot", [0, 1])
def test_a_standing_foot_rolls_about_its_tip_without_a_jerk(foot: int) -> None:
    upright, planted = still(60), FREE.copy()
    planted[:, foot] = True
    clip = replace(upright, hips_m=upright.hips_m - (0.0, 0.15, 0.0))
    world = clip.world()
    # The heel starts to rise within a frame.
    risen_rad = np.clip((np.arange(60) - 28) / 60.0, 0.0, 0.07) * 8.0
    world.rotations[:, 1 + SEGMENTS.index(FEET[foot])] = quaternion.from_rotation_vector(
        risen_rad[:, None] * (1.0, 0.0, 0.0)
    )
    clip = legs_to(clip, world, tips_m(upright), planted)
    assert world_jumps_rad_s(clip, FEET[foot]).max() > 2.0 * MOST_RAD_S
    found = feet_within_changes(clip, planted, MOST_RAD_S)
    assert world_jumps_rad_s(found, FEET[foot]).max() <= MOST_RAD_S
    assert np.abs(tips_m(found) - tips_m(upright)).max() < 1e-3


def test_a_standing_foot_does_not_turn_against_a_body_that_spins_about_its_tip() -> None:
    upright, planted = still(60), FREE.copy()
    planted[20:40, 0] = True
    spun_rad = np.clip((np.arange(60) - 28) / 60.0, 0.0, 0.3) * 6.0
    spun = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), spun_rad)
    tip, rotations = tips_m(upright)[:, 0], upright.rotations.copy()
    rotations[:, 0] = quaternion.multiply(spun, rotations[:, 0])
    clip = replace(upright, hips_m=tip + quaternion.rotate(spun, upright.hips_m - tip), rotations=rotations)
    assert world_jumps_rad_s(clip, FEET[0]).max() > 1.9 * MOST_RAD_S
    found = feet_within_changes(clip, planted, MOST_RAD_S)
    ankle = SEGMENTS.index(FEET[0])
    assert angular_jumps(found)[20:40, ankle].max() <= 1.1 * MOST_RAD_S
    assert np.abs(tips_m(found) - tips_m(clip))[20:40, 0].max() < 1e-3


@pytest.mark.parametrize("rad", [0.01, 0.3, 1.5])
def test_sudden_frames_are_those_whose_turns_change_too_much(rad: float) -> None:
    """Also where joints turn by more than half a turn between frames, or the sign of a quaternion changes."""
    random = np.random.default_rng(3)
    turns = np.cumsum(random.normal(scale=rad, size=(400, 5, 3)) * random.random((400, 5, 1)) ** 3, axis=0)
    rotations = quaternion.from_rotation_vector(turns) * random.choice((-1.0, 1.0), (400, 1, 1))
    changes = changes_rad(turns_rad(rotations))
    for most_rad in np.quantile(changes, (0.1, 0.5, 0.9, 0.99)).tolist():
        assert np.array_equal(sudden(rotations, most_rad), changes > most_rad)
    assert not sudden(rotations[:2], 0.0).any()


def test_what_is_calm_enough_is_left_as_it_is() -> None:
    clip = moving(60)
    most = 2.0 * angular_jumps(clip).max()
    assert within_changes(clip, FREE, most) is clip
    assert feet_within_changes(clip, FREE, 3.0 * most) is clip


def test_a_dance_is_no_more_sudden_than_its_captures() -> None:
    """Feet that land on the beat instead of as captured would jerk their legs."""
    choreographer = Choreographer(model())
    dance = choreographer.dance(beaten(40, 0.43), Manner(seed=0), Fraction(60))
    assert angular_jumps(dance.clip).max() <= choreographer.usual_change_rad_s(Fraction(60))
