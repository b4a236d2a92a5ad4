"""Spins danced too fast are slowed down and arrive at the same time, without other changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.joint_changes import hips_within_changes
from app.choreography.spins import hips_rad, hips_within, without_haste
from app.rig import quaternion
from tests.support.dance_measures import angular_jumps
from tests.support.dances import stepping


def spinning(fps: int, peak_rad_s: float, turn_rad: float, tilt_rad: float = 0.1) -> MotionClip:
    """Slightly tilted body that turns by an angle in the middle, at up to a given speed."""
    clip = stepping(8, fps=fps)
    lasts_s = 2.0 * turn_rad / peak_rad_s
    share = np.clip((np.arange(len(clip)) / fps - 2.0) / lasts_s + 0.5, 0.0, 1.0)
    angles = turn_rad * (share - np.sin(2.0 * np.pi * share) / (2.0 * np.pi))
    rotations = clip.rotations.copy()
    tilted = quaternion.from_axis_angle((1.0, 0.0, 0.0), tilt_rad)
    rotations[:, 0] = quaternion.multiply(quaternion.from_axis_angle((0.0, 1.0, 0.0), angles), tilted)
    return replace(clip, rotations=quaternion.continuous(rotations))


@settings(max_examples=12, deadline=None)
@given(fps=st.sampled_from((30, 60, 120)), peak=st.floats(15.5, 26.0), turn=st.floats(1.5, 7.0))
def test_no_spin_is_faster_than_a_bodys(fps: int, peak: float, turn: float) -> None:
    clip = spinning(fps, peak, turn)
    calm = without_haste(clip)
    assert hips_rad(calm).max() * fps <= 15.0
    assert calm.rotations[:, 1:] == pytest.approx(clip.rotations[:, 1:])
    assert np.array_equal(calm.hips_m, clip.hips_m)
    # The body faces where it did before and after, and leans as it did throughout.
    ends = np.abs(np.einsum("fi,fi->f", calm.rotations[:, 0], clip.rotations[:, 0]))[[0, -1]]
    assert ends == pytest.approx(1.0, abs=1e-3)
    up = [quaternion.rotate(one.rotations[:, SEGMENTS.index("hips")], (0.0, 1.0, 0.0))[:, 1] for one in (calm, clip)]
    assert up[0] == pytest.approx(up[1], abs=1e-6)


def test_a_spin_that_begins_at_once_keeps_within_both_limits() -> None:
    clip = spinning(60, 26.0, 3.0)
    # Bending the sudden beginning of a spin makes its middle faster.
    assert hips_rad(hips_within_changes(without_haste(clip), 2.0)).max() * 60.0 > 15.0
    calm = hips_within(clip, 15.0, 2.0)
    assert hips_rad(calm).max() * 60.0 <= 15.0
    assert angular_jumps(calm)[:, 0].max() <= 2.2
    ends = np.abs(np.einsum("fi,fi->f", calm.rotations[:, 0], clip.rotations[:, 0]))[[0, -1]]
    assert ends == pytest.approx(1.0, abs=1e-3)
    usual = spinning(60, 13.0, 6.0)
    assert hips_within(usual, 15.0, 100.0) is usual


def test_an_ordinary_dance_is_the_same_value() -> None:
    clip = spinning(60, 13.0, 6.0)
    assert without_haste(clip) is clip
    fast = spinning(60, 22.0, 6.0)
    assert without_haste(fast, 30.0) is fast
