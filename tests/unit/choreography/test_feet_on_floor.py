"""Soles stay on or above the floor, and feet within the range of human ankles."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.dance import Manner
from app.choreography.feet_on_floor import ANKLE_RAD, SINKS_M, foot_paths, grounded, legs_along, legs_to, soles_m
from app.choreography.foot_plants import FootPlant
from app.choreography.generate import Choreographer
from app.choreography.limbs import STRETCHED_RAD
from app.choreography.standing_feet import planted
from app.rig import quaternion
from tests.support.dance_measures import angular_jumps
from tests.support.dances import beaten, model, still

X = np.array([1.0, 0.0, 0.0])


def swinging(deep_m: float) -> MotionClip:
    """A left foot that swings through the floor within half a second, and a standing right foot."""
    clip = still(90)
    dip = np.exp(-np.square((np.arange(90) - 45) / 8.0))
    bend = np.arccos(1.0 - (0.06 - (deep_m + 0.06) * dip + deep_m * dip.min()).clip(0.0) / 0.83)
    rotations = clip.rotations.copy()
    for name, share in (("UpperLeg", -1.0), ("LowerLeg", 2.0), ("Foot", -1.0)):
        rotations[:, SEGMENTS.index(f"left{name}")] = quaternion.from_axis_angle(X, share * bend)
    hips = clip.hips_m - np.array((0.0, 1.0, 0.0)) * deep_m * dip[:, None]
    return replace(clip, hips_m=hips, rotations=rotations)


def test_a_foot_under_the_floor_is_lifted_smoothly_and_a_standing_one_stays() -> None:
    clip = swinging(0.2)
    assert soles_m(clip, clip.world()).min() < -0.15
    standing = (FootPlant(1, 0, 90, (-0.1, 0.0, 0.2)),)
    found = planted(clip, standing)
    assert soles_m(found, found.world()).min() >= -SINKS_M - 1e-9
    assert np.abs(tips_m(found)[:, 1] - standing[0].place_m).max() < 1e-6
    # No toe is pushed out of the floor within a frame or two.
    assert angular_jumps(found).max() < 3.0


def test_a_standing_foot_with_raised_toes_stands_on_its_heel_not_under_the_floor() -> None:
    clip = still(60)
    clip.rotations[:, SEGMENTS.index("leftFoot")] = quaternion.from_axis_angle(X, -np.linspace(0.0, 0.5, 60))
    plants = (FootPlant(0, 0, 60, (0.1, 0.0, 0.2)),)
    found = planted(replace(clip, hips_m=clip.hips_m - np.array((0.0, 0.1, 0.0))), plants)
    soles = soles_m(found, found.world())
    assert soles[:, 0, 1].min() >= -SINKS_M
    assert np.abs(tips_m(found)[:, 0] - plants[0].place_m).max() < 1e-6


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("foot", range(2))
def test_a_foot_is_turned_about_its_ankle_no_farther_than_ankles_go(axis: int, foot: int) -> None:
    clip = still(60)
    name = ("leftFoot", "rightFoot")[foot]
    turn = np.eye(3)[axis] * np.linspace(-2.6, 2.6, 60)[:, None]
    clip.rotations[:, SEGMENTS.index(name)] = quaternion.from_rotation_vector(turn)
    lifted = replace(clip, hips_m=clip.hips_m + np.array((0.0, 1.0, 0.0)))
    found = legs_to(lifted, lifted.world(), tips_m(lifted), np.zeros((60, 2), bool))
    angles = quaternion.to_rotation_vector(found.rotations[:, SEGMENTS.index(name)])[:, axis]
    least, most = sorted((-1.0 if foot and axis else 1.0) * np.array(ANKLE_RAD[axis]))
    assert least - STRETCHED_RAD - 1e-6 <= angles.min() < least
    assert most < angles.max() <= most + STRETCHED_RAD + 1e-6
    ankles = [one.world().positions_m[:, 1 + SEGMENTS.index(name)] for one in (found, lifted)]
    assert np.abs(ankles[0] - ankles[1]).max() < 0.02


def test_a_foot_that_was_turned_back_is_not_turned_again_when_the_other_is_lifted_from_the_floor() -> None:
    """A foot turned beyond the range of its ankle would be turned a little farther back each time, and jerk."""
    clip = still(60)
    left, right = (SEGMENTS.index(name) for name in ("leftFoot", "rightFoot"))
    turned_rad = 1.3 * np.clip((np.arange(60) - 20) / 10.0, 0.0, 1.0)
    clip.rotations[:, left] = quaternion.from_rotation_vector(np.array([0.0, 1.0, 0.0]) * turned_rad[:, None])
    in_air, plants = replace(clip, hips_m=clip.hips_m + np.array((0.0, 0.05, 0.0))), np.zeros((60, 2), bool)
    clip = legs_to(in_air, in_air.world(), tips_m(in_air), plants)
    clip.rotations[:, right] = quaternion.from_axis_angle(X, np.full(60, 1.0))
    assert soles_m(clip, clip.world())[:, 1].min() < -0.02
    found = grounded(clip, plants)
    assert soles_m(found, found.world()).min() >= -SINKS_M - 1e-9
    assert np.abs(found.rotations[:, left] - clip.rotations[:, left]).max() < 1e-6


def test_what_is_above_the_floor_is_left_as_it_is() -> None:
    clip = still(30)
    assert grounded(clip, np.ones((30, 2), bool)) is clip


@pytest.mark.parametrize("manner", [Manner(1), Manner(2, size=1.5, weight=1.0), Manner(3, size=0.5, weight=-1.0)])
def test_no_sole_of_a_dance_is_under_the_floor(manner: Manner) -> None:
    clip = Choreographer(model(16)).dance(beaten(24), manner, Fraction(30)).clip
    heights: FloatArray = soles_m(clip, clip.world())
    assert heights.min() >= -0.01


def test_legs_that_are_bent_in_some_frames_are_those_that_are_bent_in_all() -> None:
    clip = swinging(0.2)
    tips, some = tips_m(clip) + np.array((0.05, 0.02, -0.03)), np.array([3, 4, 30, 44, 45, 46, 80])
    stand = np.arange(90)[:, None] < np.array([20, 90])
    paths, part = foot_paths(clip, tips, stand), clip.at(some)
    every = legs_to(clip, clip.world(), tips, stand).rotations
    assert np.abs(every - clip.rotations)[some].max() > 0.05
    found = legs_along(part, part.world(), paths.at(some)).rotations
    assert quaternion.dot(found, every[some]) == pytest.approx(1.0, abs=1e-9)
