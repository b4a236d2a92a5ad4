"""Cuts are minima and maxima of the acceleration curve, stable under noise and changes of the frame rate."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.cuts import FLOOR_RAD_S2, Cut, segment
from app.choreography.read_motion import read_motion
from app.rig import quaternion
from tests.support.dance_measures import SHARED
from tests.unit.choreography.test_features import shape

CLIPS = SHARED / "mocap"


def arm_swings(fps: int, swings_s: tuple[float, ...] = (1.0, 2.5, 4.0, 5.5, 7.0), length_s: float = 8.5) -> MotionClip:
    """Motion in which both arms rotate by 1.6 rad at given times, within 0.5 s (minimum jerk), out and back, and rest
    between.
    """
    times = np.arange(round(length_s * fps) + 1) / fps
    angle = np.zeros(len(times))
    for number, start_s in enumerate(swings_s):
        share = np.clip((times - start_s) / 0.5, 0.0, 1.0)
        angle += 1.6 * (-1) ** number * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    rotations = np.zeros((len(times), len(SEGMENTS), 4))
    rotations[..., 3] = 1.0
    for name, sign in (("leftUpperArm", 1.0), ("rightUpperArm", -1.0)):
        rotations[:, SEGMENTS.index(name)] = quaternion.from_axis_angle((0.0, 0.0, sign), angle)
    hips = np.tile((0.0, 0.9, 0.0), (len(times), 1))
    return MotionClip(shape(), Fraction(fps), hips, rotations)


def noisy(clip: MotionClip, seed: int) -> MotionClip:
    """Motion with 0.5 degrees (root mean square) of white noise on every segment."""
    spread = np.radians(0.5) / np.sqrt(3.0)
    noise = spread * np.random.default_rng(seed).standard_normal((*clip.rotations.shape[:2], 3))
    return replace(clip, rotations=quaternion.multiply(clip.rotations, quaternion.from_rotation_vector(noise)))


def bounds_s(cuts: tuple[Cut, ...], fps: Fraction) -> np.ndarray:
    return np.array(sorted({frame for cut in cuts for frame in (cut.start, cut.end)})) / float(fps)


@pytest.mark.parametrize("frames", [1, 2, 3, 20, 300])
def test_a_still_body_has_no_cuts(frames: int) -> None:
    clip = arm_swings(60)
    still = replace(clip, rotations=np.repeat(clip.rotations[:1], frames, axis=0), hips_m=clip.hips_m[:frames])
    assert segment(still).cuts == ()
    assert len(segment(still).curve_rad_s2) == frames
    assert segment(noisy(still, 0)).cuts == ()


@pytest.mark.parametrize("fps", [24, 30, 60, 120])
def test_setting_off_and_arriving_are_a_motion_each(fps: int) -> None:
    cuts = segment(arm_swings(fps)).cuts
    starts_s = np.array([1.0, 2.5, 4.0, 5.5, 7.0])
    # The acceleration of a minimum-jerk move is greatest at these parts of its time, and zero at half of it.
    accents_s = (starts_s[:, None] + 0.5 * (0.5 + np.array([-1.0, 1.0]) * np.sqrt(3.0) / 6.0)).ravel()
    assert np.array([cut.accent for cut in cuts]) / fps == pytest.approx(accents_s, abs=1.0 / 30.0)
    assert np.array([cut.end for cut in cuts[::2]]) / fps == pytest.approx(starts_s + 0.25, abs=1.0 / 30.0)
    assert all(cut.end == after.start for cut, after in pairwise(cuts))


def test_a_long_rest_belongs_to_no_motion() -> None:
    _, before, after, _ = segment(arm_swings(60, (1.0, 9.0), 11.0)).cuts
    assert 1.5 < before.end / 60 < 2.3
    assert 8.2 < after.start / 60 < 9.0


def test_what_is_far_away_moves_no_cut() -> None:
    alone = segment(arm_swings(60)).cuts
    clip = arm_swings(60)
    wild = clip.rotations.copy()
    wild[:] = quaternion.multiply(
        wild, quaternion.from_axis_angle((1.0, 0.0, 0.0), 2.0 * np.sin(np.arange(len(clip)) / 8.0)[:, None])
    )
    rotations = np.concatenate([clip.rotations, wild])
    joined = replace(clip, rotations=rotations, hips_m=np.tile(clip.hips_m, (2, 1)))
    assert segment(joined).cuts[:9] == alone[:9]


@pytest.mark.skipif(not CLIPS.exists(), reason="no clips")
def test_captured_dance_is_cut_at_extrema_that_noise_does_not_move() -> None:
    clip = read_motion(CLIPS / "cmu_salsa_01.bvh", Fraction(60)).clip
    found = segment(clip)
    lengths_s = np.array([cut.end - cut.start for cut in found.cuts]) / 60.0
    assert 0.5 < np.median(lengths_s) < 1.5
    assert lengths_s.min() > 0.2
    assert lengths_s.max() < 4.0
    for cut in found.cuts:
        assert cut.start < cut.accent < cut.end
        curve = np.maximum(found.curve_rad_s2[cut.start : cut.end + 1], FLOOR_RAD_S2)
        assert curve.argmax() == cut.accent - cut.start
        assert curve.min() == min(curve[0], curve[-1])
    true_s = bounds_s(found.cuts, clip.fps)
    kept = []
    for seed in range(3):
        others_s = bounds_s(segment(noisy(clip, seed)).cuts, clip.fps)
        apart_s = np.abs(true_s[:, None] - others_s)
        kept += [(apart_s.min(axis=axis) < 2.5 / 60.0).mean() for axis in (0, 1)]
    assert min(kept) >= 0.9
