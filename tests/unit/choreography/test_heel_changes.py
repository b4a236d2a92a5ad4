"""Legs of feet that land stop no more suddenly than captured ones, and the feet stay where they land."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import legs_to
from app.choreography.heel_changes import MOST_RAD, heels_within_changes, knees_within_changes
from app.choreography.legs_apart import knees_turned
from app.rig import quaternion
from tests.support.dance_measures import angular_jumps
from tests.support.dances import still

MOST_RAD_S = 3.0
MOST_M_S2 = 100.0
LANDS = 30


def landing(foot: int, m_s: float = 1.1) -> tuple[MotionClip, np.ndarray]:
    """A foot that steps ahead and stops within a frame, where it stands."""
    upright, planted = still(60), np.zeros((60, 2), bool)
    planted[LANDS:, foot] = True
    clip = replace(upright, hips_m=upright.hips_m - (0.0, 0.05, 0.0))
    tips = tips_m(upright)
    left_s = np.maximum(LANDS - np.arange(60), 0) / 60.0
    tips[:, foot] += left_s[:, None] * np.array([0.0, 0.5, -0.6]) * m_s
    return legs_to(clip, clip.world(), tips, planted), planted


@pytest.mark.parametrize("foot", [0, 1])
def test_the_heel_of_a_foot_that_lands_follows_its_tip_a_moment_later(foot: int) -> None:
    clip, planted = landing(foot)
    assert angular_jumps(clip).max() > 1.2 * MOST_RAD_S
    found = heels_within_changes(clip, planted, MOST_RAD_S, MOST_M_S2)
    assert angular_jumps(found).max() <= MOST_RAD_S
    assert np.abs(tips_m(found) - tips_m(clip)).max() < 1e-4
    at = 1 + SEGMENTS.index(("leftFoot", "rightFoot")[foot])
    was, now = clip.world().rotations[:, at], found.world().rotations[:, at]
    turned = np.linalg.norm(quaternion.to_rotation_vector(quaternion.multiply(now, quaternion.conjugate(was))), axis=1)
    assert 0.01 < turned.max() < MOST_RAD
    away = [*range(LANDS - 9), *range(LANDS + 10, 60)]
    assert turned[away] == pytest.approx(0.0, abs=1e-6)
    others = np.setdiff1d(np.arange(len(SEGMENTS)), np.arange(at - 3, at))
    assert found.rotations[:, others] == pytest.approx(clip.rotations[:, others])


@pytest.mark.parametrize("foot", [0, 1])
def test_a_knee_that_swings_aside_over_a_standing_foot_starts_gradually_and_the_foot_stays(foot: int) -> None:
    upright, planted = still(60), np.ones((60, 2), bool)
    low = replace(upright, hips_m=upright.hips_m - (0.0, 0.15, 0.0))
    low = legs_to(low, low.world(), tips_m(upright), planted)
    angles = np.zeros((2, 60))
    angles[foot] = 0.09 * np.clip(np.arange(60) - 28.0, 0.0, 4.0)
    clip = knees_turned(low, low.world(), angles)
    assert angular_jumps(clip).max() > 1.5 * MOST_RAD_S
    found = knees_within_changes(clip, planted, MOST_RAD_S)
    assert angular_jumps(found).max() <= MOST_RAD_S
    at, places, was = 1 + SEGMENTS.index(("leftFoot", "rightFoot")[foot]), found.world(), clip.world()
    assert places.positions_m[:, at] == pytest.approx(was.positions_m[:, at], abs=1e-9)
    turned = quaternion.multiply(places.rotations[:, at], quaternion.conjugate(was.rotations[:, at]))
    assert np.abs(quaternion.to_rotation_vector(turned)).max() < 1e-9
    assert knees_within_changes(found, planted, MOST_RAD_S) is found


def test_heels_stay_where_no_leg_is_sudden() -> None:
    clip, planted = landing(0, 0.2)
    assert heels_within_changes(clip, planted, 4.0 * MOST_RAD_S, MOST_M_S2) is clip


def test_a_clip_of_a_frame_or_two_has_nothing_sudden() -> None:
    for frames in (1, 2):
        assert len(heels_within_changes(still(frames), np.zeros((frames, 2), bool), MOST_RAD_S, MOST_M_S2)) == frames
