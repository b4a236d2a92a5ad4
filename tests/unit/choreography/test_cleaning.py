"""Rest poses and idle time at the ends of a clip and repeated frames are recognised, and motion is not mistaken for
them.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.choreography.cleaning import cleaned, remarks
from app.choreography.clip import MotionClip
from app.choreography.held_frames import held_frames
from app.choreography.learn import Pair, analyse
from app.messages import text
from app.rig import quaternion
from tests.support.damaged import damaged
from tests.support.dances import beaten, stepping, still
from tests.unit.choreography.test_mending import dancing


def backwards(clip: MotionClip) -> MotionClip:
    return replace(clip, hips_m=clip.hips_m[::-1], rotations=clip.rotations[::-1])


def behind(pose: MotionClip, clip: MotionClip, fade_s: float = 0.0) -> MotionClip:
    """Put a pose before a clip, with a transition."""
    fade = round(fade_s * float(clip.fps))
    shares = (np.arange(1, fade + 1) / (fade + 1))[:, None]
    shares = shares**2 * (3.0 - 2.0 * shares)
    between = quaternion.slerp(np.repeat(pose.rotations[-1:], fade, 0), np.repeat(clip.rotations[:1], fade, 0), shares)
    hips = pose.hips_m[-1] * (1.0 - shares) + clip.hips_m[0] * shares
    return replace(
        clip,
        hips_m=np.concatenate([pose.hips_m, hips, clip.hips_m]),
        rotations=quaternion.continuous(np.concatenate([pose.rotations, between, clip.rotations])),
    )


@settings(max_examples=20, deadline=None)
@given(
    frames=st.sampled_from((1, 2, 18, 60, 600)), fps=st.sampled_from((30, 60, 120)), at_end=st.booleans(),
    turned=st.floats(-3.0, 3.0),
)  # fmt: skip
def test_a_t_pose_of_any_length_is_no_part_of_the_motion(frames: int, fps: int, at_end: bool, turned: float) -> None:
    """Put before or behind it, facing anywhere, elsewhere, without any way between."""
    clip, pose = dancing(fps), still(frames, fps)
    rotations = pose.rotations.copy()
    rotations[:, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), turned)
    arms_up = clip.rotations.copy()
    arms_up[:, [4, 7]] = quaternion.multiply(quaternion.from_axis_angle((0.0, 0.0, 1.0), 1.2), arms_up[:, [4, 7]])
    clip = replace(clip, rotations=arms_up)
    whole = behind(replace(pose, rotations=rotations), clip)
    done = cleaned(backwards(whole) if at_end else whole)
    taken = (done.trail, done.lead_in) if at_end else (done.lead_in, done.trail)
    assert frames <= taken[0] <= frames + 0.2 * fps
    assert taken[1] == 0
    assert done.left_out == ()


@pytest.mark.parametrize("length_s", [0.02, 0.1, 0.3, 1.0, 10.0])
@pytest.mark.parametrize(("at_end", "rolled"), [(False, 0.0), (True, 0.0), (False, 0.9)])
def test_arms_lowered_from_a_t_pose_are_no_dance(length_s: float, at_end: bool, rolled: float) -> None:
    """The arms are removed from the motion also if a straight arm does not reveal its twist in the T-pose."""
    clip = dancing(60)
    lowered = clip.rotations.copy()
    for at, turn in ((4, -1.3), (7, 1.3)):
        lowered[:, at] = quaternion.multiply(quaternion.from_axis_angle((0.0, 0.0, 1.0), turn), lowered[:, at])
    frames = round(60 * length_s)
    whole = behind(still(frames), replace(clip, rotations=lowered), 0.6)
    arms = whole.rotations.copy()
    arms[:, [4, 7]] = quaternion.multiply(arms[:, [4, 7]], quaternion.from_axis_angle((1.0, 0.0, 0.0), rolled))
    whole = replace(whole, rotations=arms)
    done = cleaned(backwards(whole) if at_end else whole)
    taken = done.trail if at_end else done.lead_in
    assert frames + 15 <= taken <= frames + 60
    assert done.mended == done.left_out == ()


def test_a_t_pose_with_an_arm_a_little_low_is_no_dance() -> None:
    """Actors cannot hold the pose exactly."""
    clip, pose = dancing(60), still(120)
    lowered, low = clip.rotations.copy(), pose.rotations.copy()
    for at, turn in ((4, -1.0), (7, 1.0)):
        down = [quaternion.from_axis_angle((0.0, 0.0, 1.0), angle * turn) for angle in (1.3, 0.45)]
        lowered[:, at] = quaternion.multiply(down[0], lowered[:, at])
        low[:, at] = quaternion.multiply(down[1], low[:, at])
    whole = behind(replace(pose, rotations=low), replace(clip, rotations=lowered), 0.6)
    assert 120 + 10 <= cleaned(whole).lead_in <= 120 + 60


@pytest.mark.parametrize("kind", ["root_zero", "all_zero", "root"])
@pytest.mark.parametrize("frames", [1, 2])
@pytest.mark.parametrize("at_end", [False, True])
def test_bad_first_and_last_frames_are_no_part_of_the_motion(kind: str, frames: int, at_end: bool) -> None:
    clip = dancing(60)
    spoilt = damaged(clip, kind, "hips", len(clip) - frames if at_end else 0, frames, np.array((0.6, 0.0, 0.8)))
    done = cleaned(spoilt)
    taken = (done.trail, done.lead_in) if at_end else (done.lead_in, done.trail)
    assert frames <= taken[0] <= frames + 10
    assert taken[1] == 0
    assert done.left_out == ()


def test_a_dance_is_no_rest_pose() -> None:
    for fps in (30, 60, 120):
        for clip in (dancing(fps), backwards(dancing(fps)), stepping(16, fps=fps)):
            done = cleaned(clip)
            assert (done.lead_in, done.trail, done.held) == (0, 0, 1)
            assert np.array_equal(done.clip.rotations, clip.rotations)
            assert remarks(done) == ()


def test_a_clip_that_only_stands_stays() -> None:
    clip = still(200)
    assert len(cleaned(clip).clip) == 200


@pytest.mark.parametrize(("count", "phase"), [(2, 0), (4, 0), (4, 3), (5, 2)])
def test_held_frames_are_one(count: int, phase: int) -> None:
    """A capture at 60 frames a second is stored in a file of 240."""
    clip = dancing(60)
    every = np.repeat(np.arange(len(clip)), count)[phase:]
    held = MotionClip(clip.shape, Fraction(60 * count), clip.hips_m[every], clip.rotations[every])
    done = cleaned(held)
    assert (done.held, done.clip.fps) == (count, 60)
    assert len(done.clip) == len(clip)
    assert np.array_equal(done.clip.rotations, clip.rotations)
    assert "60 frames/s" in text(remarks(done)[0])


@pytest.mark.parametrize(("rate", "file_rate"), [(60, 100), (24, 30), (25, 60), (48, 120)])
@pytest.mark.parametrize("phase", [0, 1, 3])
def test_unevenly_held_frames_are_one(rate: int, file_rate: int, phase: int) -> None:
    """A converter repeats every frame as often as another rate needs."""
    clip = dancing(rate)
    every = (np.arange(len(clip) * file_rate // rate) * rate // file_rate)[phase:]
    every -= every[0]
    done = cleaned(MotionClip(clip.shape, Fraction(file_rate), clip.hips_m[every], clip.rotations[every]))
    assert (done.held, done.clip.fps) == (Fraction(file_rate, rate), rate)
    assert np.array_equal(done.clip.rotations, clip.rotations[: every[-1] + 1])
    assert done.mended == done.left_out == ()
    assert f"{rate} frames/s" in text(remarks(done)[0])


def test_a_motion_with_pauses_or_irregular_repetitions_is_not_held() -> None:
    """Pauses in one place, or frames lost by chance, are no pattern."""
    for seed in range(20):
        random = np.random.default_rng(seed)
        for changes in (random.random(400) < 0.7, random.random(400) < 0.95, np.arange(400) % 100 < 90):
            assert held_frames(changes).length == 1


def test_idle_ends_are_kept_and_not_danced() -> None:
    clip = dancing(60)
    arms_down = replace(still(1), rotations=clip.rotations[:1], hips_m=clip.hips_m[:1])
    sways = 0.01 * np.sin(np.arange(180) / 40.0)
    idle = replace(
        arms_down,
        hips_m=np.repeat(arms_down.hips_m, 180, 0),
        rotations=quaternion.multiply(
            np.repeat(arms_down.rotations, 180, 0), quaternion.from_axis_angle((1.0, 0.0, 0.0), sways)[:, None]
        ),
    )
    whole = behind(idle, clip, 0.5)
    done = cleaned(whole)
    assert done.lead_in == 0
    assert 120 <= done.idle[0] <= 170
    assert done.idle[1] == 0
    assert done.unfit == ((0, done.idle[0]),)
    assert len(done.clip) == len(whole)
    ended = cleaned(backwards(whole))
    assert ended.idle == done.idle[::-1]
    assert ended.unfit == ((len(whole) - done.idle[0], len(whole)),)
    cuts = analyse(Pair(done.clip, "a", beaten(20, 0.5), "b", unfit=done.unfit)).segmentation.cuts
    assert min(cut.start for cut in cuts) >= done.idle[0]


def test_nothing_is_learned_from_what_is_left_out() -> None:
    clip = dancing(60, 16)
    spoilt = damaged(clip, "flip", "leftUpperArm", 400, 50, np.array((1.0, 0.0, 0.0)))
    done = cleaned(spoilt)
    assert len(done.left_out) == 1
    pair = Pair(done.clip, "a", beaten(40, 0.5), "b", unfit=done.unfit)
    found, clean = analyse(pair), analyse(replace(pair, motion=clip, unfit=()))
    assert 0 < len(found.segmentation.cuts) < len(clean.segmentation.cuts)
    assert found.unfit == done.unfit
    for cut in found.segmentation.cuts:
        assert cut.end <= 399 or cut.start >= 450
    # Far from the damage the same motions are found.
    far = [cut for cut in clean.segmentation.cuts if cut.end < 340 or cut.start > 510]
    assert set(far) <= set(found.segmentation.cuts)


def test_every_place_is_named_with_its_time_in_the_file() -> None:
    clip, pose = dancing(60), still(60)
    spoilt = behind(pose, damaged(clip, "flip", "leftHand", 240, 2, np.array((1.0, 0.0, 0.0))))
    done = cleaned(spoilt)
    said = " / ".join(text(one) for one in remarks(done))
    assert "rest pose at the start" in said
    assert "4.98-5.03 s (leftHand)" in said
