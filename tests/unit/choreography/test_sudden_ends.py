"""Feet and hands of dances move no more suddenly than captured ones."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.choreography.body import ENDS, SEGMENTS
from app.choreography.body_speeds import part_speeds
from app.choreography.clip import MotionClip
from app.choreography.contacts import foot_contacts, tips_m
from app.choreography.damage import FASTEST
from app.choreography.dance_flaws import JERKS
from app.choreography.features import height_m, points_m
from app.choreography.feet_on_floor import legs_to
from app.choreography.foot_plants import FootPlant, planted_frames, stands
from app.choreography.joint_speeds import within_speeds
from app.choreography.standing_feet import planted
from app.choreography.sudden_ends import (
    MOST,
    UsualAccelerations,
    usual_accelerations,
    within_limits,
    without_twitches,
)
from tests.support.dance_measures import angular_jumps
from tests.support.dances import stepping, still

FPS = Fraction(60)
CLIP = stepping(16)


def accelerations(clip: MotionClip, name: str) -> np.ndarray:
    """Accelerations (F - 2, 2) of a joint and its end in m/s^2."""
    at = [SEGMENTS.index(name), len(SEGMENTS) + ENDS.index(name)]
    change = np.diff(points_m(clip)[:, at], 2, axis=0)
    return np.linalg.norm(change, axis=-1) * float(clip.fps) ** 2


def twitching(name: str, frame: int) -> MotionClip:
    """Steps in which a limb bends by 15 degrees more in one frame."""
    rotations = CLIP.rotations.copy()
    part = SEGMENTS.index(name)
    twitch = Rotation.from_rotvec(np.radians(15.0) * np.array((0.0, 1.0, 0.0) if "Arm" in name else (1.0, 0.0, 0.0)))
    rotations[frame, part] = (twitch * Rotation.from_quat(rotations[frame, part])).as_quat()
    return replace(CLIP, rotations=rotations)


@pytest.mark.parametrize(("limb", "end"), [("leftLowerArm", "leftHand"), ("leftUpperLeg", "leftFoot")])
def test_a_twitch_is_taken_away_and_all_else_stays(limb: str, end: str) -> None:
    # The left foot is in the air in the first half second.
    sudden = twitching(limb, 15)
    usual = usual_accelerations([CLIP], FPS)
    most = (
        MOST * np.concatenate([usual.feet, usual.hands])[slice(0, 2) if "Foot" in end else slice(2, 4)] * height_m(CLIP)
    )
    assert (accelerations(sudden, end).max(axis=0) > 2.0 * most).all()
    calm = without_twitches(sudden, (), usual)
    assert (accelerations(calm, end).max(axis=0) < 1.1 * most).all()
    assert np.abs(points_m(calm) - points_m(CLIP))[60:].max() < 1e-9
    assert np.linalg.norm(points_m(calm) - points_m(CLIP), axis=-1).max() < 0.1


def test_a_wrist_that_darts_along_its_hand_is_calmed_too() -> None:
    """A hand points along the path of its wrist, which can be calmed only together with the fingertip."""
    clip = still(60, int(FPS))
    bent_rad = 0.8 + 0.2 * np.exp(-np.square((np.arange(60) - 30) / 2.0))
    for part, share in (("leftUpperArm", 1.0), ("leftLowerArm", -2.0), ("leftHand", 1.0)):
        turns = Rotation.from_rotvec(share * bent_rad[:, None] * np.array((0.0, 1.0, 0.0)))
        clip.rotations[:, SEGMENTS.index(part)] = turns.as_quat()
    before = accelerations(clip, "leftHand").max(axis=0)
    usual = UsualAccelerations(np.full(2, 1e6), np.array([0.4, 1.0]) * before / height_m(clip))
    after = accelerations(without_twitches(clip, (), usual), "leftHand").max(axis=0)
    assert (after <= MOST * usual.hands * height_m(clip)).all()


def test_a_straight_leg_is_calmed_within_its_reach() -> None:
    """The smoothed path of a kick with a straight leg exceeds the leg's reach and must be corrected again."""
    clip = still(90, int(FPS))
    kick_rad = 0.3 * np.exp(-np.square((np.arange(90) - 45) / 3.0))
    turns = Rotation.from_rotvec(-kick_rad[:, None] * np.array((1.0, 0.0, 0.0)))
    clip.rotations[:, SEGMENTS.index("leftUpperLeg")] = turns.as_quat()
    usual = UsualAccelerations(0.25 * accelerations(clip, "leftFoot").max(axis=0) / height_m(clip), np.full(2, 1e6))
    after = accelerations(without_twitches(clip, (), usual), "leftFoot").max(axis=0)
    assert (after <= MOST * usual.feet * height_m(clip)).all()


def test_a_kick_keeps_the_limits_of_acceleration_and_of_its_joints() -> None:
    """A calmed kick turns the thigh faster than joints may, and slowing the thigh down jerks the foot again."""
    clip = still(90, int(FPS))
    kick_rad = 1.3 * (1.0 + np.tanh((np.arange(90) - 45) / 2.0))
    thigh = SEGMENTS.index("leftUpperLeg")
    turns = Rotation.from_rotvec(-kick_rad[:, None] * np.array((1.0, 0.0, 0.0)))
    clip.rotations[:, thigh] = turns.as_quat()
    slower = within_speeds(clip, np.zeros((90, 2), bool))
    usual = UsualAccelerations(0.35 * accelerations(slower, "leftFoot").max(axis=0) / height_m(clip), np.full(2, 1e6))
    found = within_limits(clip, (), usual, 1e6)
    assert (accelerations(found, "leftFoot").max(axis=0) <= MOST * usual.feet * height_m(clip)).all()
    assert part_speeds(found)[:, thigh].max() <= FASTEST[thigh]


def opening(opens: int, swings: int) -> MotionClip:
    """A left arm whose elbow opens within frames while its shoulder swings."""
    frames, across = np.arange(90), np.array((0.0, -1.0, 0.0))
    elbow_rad = 1.7 - 1.64 * np.clip((frames - 45) / opens, 0.0, 1.0)
    clip = still(90, int(FPS))
    for part, turned in (("leftLowerArm", elbow_rad), ("leftUpperArm", 1.2 * np.tanh((frames - 47) / swings))):
        clip.rotations[:, SEGMENTS.index(part)] = Rotation.from_rotvec(turned[:, None] * across).as_quat()
    return clip


@pytest.mark.parametrize(("opens", "swings", "share"), [(5, 6, 0.5), (8, 6, 0.3)])
def test_an_arm_that_swings_through_straight_snaps_no_more_than_usual(opens: int, swings: int, share: float) -> None:
    """A calmed hand snaps the elbow of an arm that is about to be straight, and a calmed elbow jerks the hand."""
    clip, usual_change_rad_s = opening(opens, swings), 3.1
    usual = UsualAccelerations(np.full(2, 1e6), share * np.array([51.0, 67.0]))
    found = within_limits(clip, (), usual, usual_change_rad_s)
    assert angular_jumps(found).max() < 0.93 * usual_change_rad_s
    assert (accelerations(found, "leftHand").max(axis=0) <= MOST * usual.hands * height_m(clip)).all()


def kicking(opens: int, swings: int) -> MotionClip:
    """A left leg in the air whose knee opens within frames while its thigh swings."""
    frames, across = np.arange(90), np.array((1.0, 0.0, 0.0))
    knee_rad = 1.7 - 1.64 * np.clip((frames - 45) / opens, 0.0, 1.0)
    clip = still(90, int(FPS))
    for part, turned in (("leftLowerLeg", knee_rad), ("leftUpperLeg", -1.2 - 0.9 * np.tanh((frames - 47) / swings))):
        clip.rotations[:, SEGMENTS.index(part)] = Rotation.from_rotvec(turned[:, None] * across).as_quat()
    return clip


@pytest.mark.parametrize(("opens", "swings", "share"), [(5, 9, 0.8), (11, 4, 0.5)])
def test_a_leg_that_kicks_through_straight_snaps_no_more_than_usual(opens: int, swings: int, share: float) -> None:
    """A calmed foot snaps the knee of a leg that is about to be straight."""
    clip, usual_change_rad_s = kicking(opens, swings), 3.1
    usual = UsualAccelerations(share * np.array([51.0, 67.0]), np.full(2, 1e6))
    found = within_limits(clip, (), usual, usual_change_rad_s)
    assert angular_jumps(found).max() < JERKS * usual_change_rad_s
    assert (accelerations(found, "leftFoot").max(axis=0) <= MOST * usual.feet * height_m(clip)).all()


def test_a_hand_is_calm_also_after_its_arm_was_slowed_down() -> None:
    clip, usual = opening(11, 6), UsualAccelerations(np.full(2, 1e6), 0.2 * np.array([51.0, 67.0]))
    found = within_limits(clip, (), usual, 3.1, np.full(len(SEGMENTS), 5.5))
    assert (accelerations(found, "leftHand").max(axis=0) <= MOST * usual.hands * height_m(clip)).all()


def test_an_arm_folded_to_the_shoulder_does_not_turn_with_its_wrist() -> None:
    """A wrist 3 cm from the shoulder that is moved as suddenly as it may would turn the whole arm."""
    frames, clip = np.arange(90), still(90, int(FPS))
    elbow_rad, shoulder_rad = 3.05 - 0.7 * (1.0 + np.tanh((frames - 48) / 6.0)), 0.6 * np.tanh((frames - 45) / 14.0)
    for part, turned, axis in (
        ("leftLowerArm", elbow_rad, (0.0, -1.0, 0.0)),
        ("leftUpperArm", shoulder_rad, (1.0, 0.0, 0.0)),
    ):
        turns = Rotation.from_rotvec(turned[:, None] * np.array(axis))
        clip.rotations[:, SEGMENTS.index(part)] = turns.as_quat()
    usual = UsualAccelerations(np.full(2, 1e6), 0.3 * accelerations(clip, "leftHand").max(axis=0) / height_m(clip))
    assert angular_jumps(without_twitches(clip, (), usual)).max() < 1.1 * angular_jumps(clip).max()


def test_what_is_as_sudden_as_the_capture_is_left_as_it_is() -> None:
    usual = usual_accelerations([CLIP], FPS)
    assert without_twitches(CLIP, (), usual) is CLIP
    assert within_limits(CLIP, (), usual, angular_jumps(CLIP).max() * 2.0) is CLIP


def test_standing_feet_stay_where_they_stand() -> None:
    sudden = twitching("leftUpperLeg", 29)
    standing = stands(sudden, foot_contacts(CLIP))
    calm = without_twitches(planted(sudden, standing), standing, usual_accelerations([CLIP], FPS))
    for stand in standing:
        slid = tips_m(calm)[stand.start : stand.stop, stand.foot] - stand.place_m
        assert np.abs(slid).max() < 1e-3


def test_a_foot_that_was_slowed_down_near_the_floor_does_not_skid() -> None:
    """A calmed path of a foot may be lower than the one that was raised above the floor."""
    clip, sways = still(90, int(FPS)), np.sin(np.pi * np.clip((np.arange(90) - 29) / 31.0, 0.0, 1.0)) ** 2
    places = tips_m(clip)[0]
    plants = ((0, 0, 30), (1, 0, 90), (0, 60, 90))
    standing = tuple(FootPlant(foot, start, stop, tuple(places[foot].tolist())) for foot, start, stop in plants)
    on_floor, tips = planted_frames(standing, 90), tips_m(clip).copy()
    tips[:, 0, 2] += 0.3 * sways
    low = legs_to(clip, clip.world(), tips, on_floor)
    usual = UsualAccelerations(np.full(2, 1e6), np.full(2, 1e6))
    found = tips_m(within_limits(low, standing, usual, 3.0))
    near_floor = found[:-1, 0, 1] < places[0, 1] + 0.006
    way_m = np.linalg.norm(np.diff(found[:, 0][:, [0, 2]], axis=0), axis=-1)
    assert (way_m * near_floor).sum() < 0.05 < 0.5 * way_m.sum()
    assert np.abs((found - places)[on_floor]).max() < 1e-3
    assert np.abs(np.diff(found[..., 1], 2, axis=0)).max() < 0.004
