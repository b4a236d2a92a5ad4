"""The measures of dances detect synthetic properties."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.clip import write_motion
from app.rig import quaternion
from tests.support.dance_measures import (
    alignment,
    alignments,
    angular_jumps,
    kinematic_beats_s,
    longest_run,
    nearest_m,
    read_back,
    seam_jumps_rad_s,
    skating_m_s,
    sliding_m_s,
    usual_jump_rad_s,
)
from tests.support.dances import stepping, still


def test_a_joint_that_starts_at_once_is_a_jump_of_its_speed() -> None:
    clip = still(20)
    rotations = clip.rotations.copy()
    angle = 2.0 / 60.0 * np.maximum(np.arange(20) - 9, 0)
    rotations[:, SEGMENTS.index("leftHand")] = quaternion.from_axis_angle(np.array([1.0, 0.0, 0.0]), angle)
    started = replace(clip, rotations=rotations)
    assert angular_jumps(started).max() == pytest.approx(2.0)
    assert seam_jumps_rad_s(started, [10, 16]) == pytest.approx([2.0, 0.0], abs=1e-9)
    assert usual_jump_rad_s([clip], Fraction(60)) == 0.0


def test_a_foot_that_slides_slides_at_its_speed() -> None:
    clip = still(60)
    sliding = replace(clip, hips_m=clip.hips_m + np.arange(60)[:, None] / 60.0 * (0.3, 0.0, 0.4))
    standing = np.zeros((60, 2), bool)
    standing[10:50, 1] = True
    assert sliding_m_s(sliding, standing) == pytest.approx(np.full(38, 0.5))
    assert sliding_m_s(clip, standing) == pytest.approx(np.zeros(38))
    assert skating_m_s(sliding) == pytest.approx(0.5, rel=0.02)
    high = replace(sliding, hips_m=sliding.hips_m + np.where(np.arange(60)[:, None] > 0, (0.0, 0.1, 0.0), 0.0))
    assert skating_m_s(high) < 0.02


def test_beats_that_meet_are_aligned_and_shifted_ones_by_chance() -> None:
    music_s = 0.5 * np.arange(100)
    assert alignment(music_s, music_s) == pytest.approx((1.0, 1.0))
    # A motion's beat on every other beat of the music: all of the motion's meet, half of the music's.
    half = alignment(music_s[::2], music_s)
    assert half[0] == pytest.approx(1.0)
    assert half[1] == pytest.approx(0.5, abs=0.01)
    for found in alignments(music_s[::2], music_s):
        assert found.found > found.chance_95 > found.chance
    # By chance about sqrt(2 pi) sigma of each beat's length.
    assert alignments(music_s, music_s)[0].chance == pytest.approx(7.52 / 30.0, abs=0.03)
    assert alignment(np.zeros(0), music_s) == (0.0, 0.0)


def test_motion_stops_where_its_beats_are() -> None:
    clip = still(241)
    rotations = clip.rotations.copy()
    # Down and up again, a beat each way.
    swung = 0.5 * np.cos(2.0 * np.pi * np.arange(241) / 60.0)
    rotations[:, SEGMENTS.index("leftUpperArm")] = quaternion.from_axis_angle(np.array([0.0, 0.0, 1.0]), swung)
    assert kinematic_beats_s(replace(clip, rotations=rotations)) == pytest.approx(0.5 * np.arange(1, 8))


def test_poses_are_near_to_where_they_are_from_wherever_they_face() -> None:
    clip = stepping(6)
    turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), 1.0)
    rotations = clip.rotations.copy()
    rotations[:, 0] = quaternion.multiply(turn, rotations[:, 0])
    turned = replace(clip, hips_m=clip.hips_m + np.array((3.0, 0.0, 1.0)), rotations=rotations)
    assert nearest_m(turned, [clip]).max() == pytest.approx(0.0, abs=1e-6)
    assert nearest_m(still(2), [clip]).min() > 0.05


def test_a_run_is_as_long_as_it_is() -> None:
    assert [longest_run(values) for values in ([], [1], [1, 2, 2, 2, 1, 1])] == [0, 1, 3]


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    clip = stepping(4)
    write_motion(tmp_path / "a.bvh", clip)
    again = read_back(tmp_path / "a.bvh")
    assert again.fps == 60
    assert len(again) == len(clip)
    assert again.world().positions_m == pytest.approx(clip.world().positions_m, abs=2e-4)
