"""Flips are mended and true motion is not; a rest pose before the motion is found."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.flips import Flip, lead_in, mend_flips, mend_steps
from app.rig import quaternion


def arm_swings(fps: int, length_s: float = 12.0, swings_s: float = 1.5) -> MotionClip:
    """An arm that turns by 1.2 rad every so often, and rests between."""
    times = np.arange(round(length_s * fps) + 1) / fps
    rotations = np.zeros((len(times), len(SEGMENTS), 4))
    rotations[..., 3] = 1.0
    # Minimum-jerk moves of 0.5 s, out and back.
    count = np.floor(times / swings_s)
    share = np.clip((times % swings_s) / 0.5, 0.0, 1.0)
    moved = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    angle = 1.2 * np.where(count % 2 == 0, moved, 1.0 - moved)
    rotations[:, SEGMENTS.index("leftUpperArm")] = quaternion.from_axis_angle((0.0, 0.0, 1.0), angle)
    hips = np.tile((0.0, 0.9, 0.0), (len(times), 1))
    return MotionClip(BodyShape.of(np.zeros((16, 3)), np.zeros((5, 3))), Fraction(fps), hips, rotations)


@pytest.mark.parametrize("length", [1, 2])
def test_a_flip_is_mended_and_nothing_else(length: int) -> None:
    clip = arm_swings(60)
    spoilt = clip.rotations.copy()
    arm = SEGMENTS.index("leftUpperArm")
    spoilt[200 : 200 + length, arm] = quaternion.multiply(
        spoilt[200 : 200 + length, arm], quaternion.from_axis_angle((1.0, 0.0, 0.0), 2.5)
    )
    mended, found = mend_flips(replace(clip, rotations=spoilt))
    assert found == (Flip("leftUpperArm", 200, 200 + length),)
    assert mended.rotations[200 : 200 + length, arm] == pytest.approx(clip.rotations[200 : 200 + length, arm], abs=0.02)
    spoilt[200 : 200 + length, arm] = mended.rotations[200 : 200 + length, arm]
    assert np.array_equal(mended.rotations, spoilt)


def test_a_fast_turn_is_no_flip() -> None:
    """A whole turn in a quarter of a second, and a throw of 30 rad/s that comes back within 0.15 s."""
    clip = arm_swings(60)
    turns = clip.rotations.copy()
    angle = np.clip((np.arange(len(clip)) - 100) / 60.0 * 25.0, 0.0, 2.0 * np.pi)
    turns[:, SEGMENTS.index("hips")] = quaternion.from_axis_angle((0.0, 1.0, 0.0), angle)
    throw = 1.5 * np.sin(np.pi * np.clip((np.arange(len(clip)) - 300) / 9.0, 0.0, 1.0))
    turns[:, SEGMENTS.index("rightHand")] = quaternion.from_axis_angle((1.0, 0.0, 0.0), throw)
    fast = replace(clip, rotations=turns)
    assert mend_flips(fast) == (fast, ())


def test_a_rest_pose_before_the_motion_is_no_part_of_it() -> None:
    clip = arm_swings(60)
    assert lead_in(clip) == 0
    turned = quaternion.multiply(quaternion.from_axis_angle((0.0, 1.0, 0.0), 2.0), clip.rotations[:, 0])
    turned[0] = quaternion.IDENTITY
    rotations = clip.rotations.copy()
    rotations[:, 0] = turned
    assert lead_in(replace(clip, rotations=rotations)) == 1


def test_the_way_from_a_rest_pose_to_the_motion_is_no_part_of_it() -> None:
    clip = arm_swings(60)
    # Turned ever less over five frames, as by a filter, while the motion goes on.
    turns = np.zeros(len(clip))
    turns[:5] = (2.0, 0.8, 0.3, 0.08, 0.015)
    rotations = clip.rotations.copy()
    rotations[:, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), turns)
    assert 4 <= lead_in(replace(clip, rotations=rotations)) <= 9
    # Something quick at the start of a motion is none.
    assert lead_in(clip.span(14, 300)) == 0


@pytest.mark.parametrize("fps", [30, 60])
def test_a_body_goes_on_where_frames_are_missing(fps: int) -> None:
    clip = arm_swings(fps)
    turn = 0.3 * np.sin(np.arange(len(clip)) / fps)
    rotations = clip.rotations.copy()
    rotations[:, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), turn)
    way = np.arange(len(clip))[:, None] / fps * (0.2, 0.0, 0.3)
    clip = replace(clip, rotations=rotations, hips_m=clip.hips_m + way)
    # At 5 s all turns by 0.6 rad about a place beside the body, and leans a little.
    at, about = 5 * fps, np.array((0.5, 0.0, 0.2))
    yaw, lean = (quaternion.from_axis_angle(axis, angle) for axis, angle in (((0, 1.0, 0), 0.6), ((1.0, 0, 0), 0.05)))
    spoilt = clip.rotations.copy()
    spoilt[at:, 0] = quaternion.multiply(quaternion.multiply(yaw, lean), spoilt[at:, 0])
    hips = clip.hips_m.copy()
    hips[at:] = quaternion.rotate(yaw, hips[at:] - about) + about + (0.0, 0.02, 0.0)
    mended, found = mend_steps(replace(clip, rotations=spoilt, hips_m=hips))
    assert found == (Flip("hips", at, at + round(0.4 * fps)),)
    assert mended.hips_m[:, [0, 2]] == pytest.approx(clip.hips_m[:, [0, 2]], abs=0.02)
    assert mended.rotations[:at] == pytest.approx(clip.rotations[:at])
    steps = np.abs(np.diff(mended.rotations[:, 0], axis=0)).max(axis=1)
    assert steps.max() < 1.5 * np.abs(np.diff(clip.rotations[:, 0], axis=0)).max() + 0.005
    assert np.abs(np.diff(mended.hips_m[:, 1])).max() < 0.005
    assert mend_steps(clip) == (clip, ())


def test_many_steps_are_each_mended() -> None:
    """A body that walks on, cut by turns again and again, goes on ahead; each step is turned back once."""
    clip = arm_swings(60)
    way = np.arange(len(clip))[:, None] / 60 * (0.0, 0.0, 0.3)
    clip = replace(clip, hips_m=clip.hips_m + way)
    spoilt, hips = clip.rotations.copy(), clip.hips_m.copy()
    steps = list(range(10, len(clip) - 10, 15))
    for number, at in enumerate(steps):
        yaw = quaternion.from_axis_angle((0.0, 1.0, 0.0), 0.5 + 0.1 * (number % 3))
        spoilt[at:, 0] = quaternion.multiply(yaw, spoilt[at:, 0])
        hips[at:] = quaternion.rotate(yaw, hips[at:])
    mended, found = mend_steps(replace(clip, rotations=spoilt, hips_m=hips))
    assert [flip.start for flip in found] == steps
    assert mended.hips_m == pytest.approx(clip.hips_m, abs=1e-6)
    assert np.abs(np.einsum("fi,fi->f", mended.rotations[:, 0], clip.rotations[:, 0])) == pytest.approx(1.0)


def test_a_body_that_turns_by_steps_all_the_time_moves_so() -> None:
    """Frames are not missing five times a second: such a file took a repair of half a second for every other frame."""
    clip = arm_swings(240)
    angles = 0.15 * (np.arange(len(clip)) // 4)
    rotations = clip.rotations.copy()
    rotations[:, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), angles)
    _, found = mend_steps(replace(clip, rotations=rotations))
    assert np.diff([flip.start for flip in found]).min() >= 0.2 * 240
