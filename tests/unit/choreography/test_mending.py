"""Damage in captures is repaired or excluded, and genuine motion is unchanged to the bit."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import BoolArray, FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import angle
from app.choreography.clip import MotionClip
from app.choreography.damage import FASTEST_HIPS_RAD_S, FASTEST_RAD_S, Damage, damage
from app.choreography.mending import LONGEST_S, mended
from app.rig import quaternion
from tests.support.damaged import KINDS, damaged
from tests.support.dances import stepping

AXES = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0.0, 0.6, 0.8))
MOVED = ("hips", "spine", "head", "leftUpperArm", "rightUpperArm", "leftUpperLeg", "rightLowerLeg")


@cache
def dancing(fps: int = 60, length_s: int = 8) -> MotionClip:
    """A body that steps, sways, turns a little and moves all parts continuously."""
    clip = stepping(2 * length_s, fps=fps)
    times = np.arange(len(clip)) / fps
    rotations = clip.rotations.copy()
    for at in range(len(SEGMENTS)):
        phase, axis = 0.7 * at, np.roll((1.0, 0.0, 0.0), at)
        sway = (0.25 if at else 0.5) * np.sin(2.0 * np.pi * (0.4 + 0.05 * at) * times + phase)
        rotations[:, at] = quaternion.multiply(rotations[:, at], quaternion.from_axis_angle(axis, sway))
    way = np.stack([0.3 * np.sin(times), 0.02 * np.sin(5.0 * times), 0.2 * np.cos(0.7 * times)], axis=1)
    return replace(clip, hips_m=clip.hips_m + way, rotations=quaternion.continuous(rotations))


def turning(clip: MotionClip, part: str, angles: FloatArray, axis: tuple[float, float, float]) -> MotionClip:
    """Clip with an additional rotation of a segment."""
    rotations, at = clip.rotations.copy(), SEGMENTS.index(part)
    rotations[:, at] = quaternion.multiply(quaternion.from_axis_angle(axis, angles), rotations[:, at])
    return replace(clip, rotations=quaternion.continuous(rotations))


def outside(clip: MotionClip, left_out: tuple[Damage, ...]) -> BoolArray:
    """Mask (F,) of the frames that are not excluded."""
    kept = np.ones(len(clip), bool)
    for one in left_out:
        kept[one.start : one.stop + 1] = False
    return kept


@settings(max_examples=40, deadline=None)
@given(
    kind=st.sampled_from(KINDS), part=st.sampled_from(MOVED), axis=st.sampled_from(AXES),
    fps=st.sampled_from((30, 60, 120)), start=st.floats(0.5, 5.0), length=st.sampled_from((1, 2, 3, 4, 6, 12, 60)),
)  # fmt: skip
def test_no_damage_is_danced(
    kind: str, part: str, axis: tuple[float, float, float], fps: int, start: float, length: int
) -> None:
    """All that is kept is near to what was captured; little is left out beside damage.

    A lost frame of a fast limb at 30 frames a second leaves up to half a radian: less than bodies turn meanwhile.
    """
    clip, first = dancing(fps), round(start * fps)
    if kind == "bump":
        length = min(length, int(0.12 * fps) - 1)  # A slower one is a motion.
    spoilt = damaged(clip, kind, part, first, length, np.array(axis))
    found = mended(spoilt)
    kept = outside(clip, found.left_out)
    assert (~kept).sum() / fps <= length / fps + 0.45
    assert angle(found.clip.rotations[kept, 1:], clip.rotations[kept, 1:]).max() < 0.6
    both = kept[1:] & kept[:-1]
    turned = angle(found.clip.rotations[:-1], found.clip.rotations[1:])[both] * fps
    assert turned[:, 0].max() < 0.8 * FASTEST_HIPS_RAD_S
    assert np.linalg.norm(np.diff(found.clip.hips_m, axis=0), axis=1)[both].max() * fps < 1.5
    assert np.linalg.norm(found.clip.rotations, axis=-1) == pytest.approx(1.0)


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_clean_motion_is_the_same_value(fps: int) -> None:
    clip = dancing(fps)
    assert mended(clip).clip is clip
    assert mended(stepping(12, fps=fps)).left_out == ()


@given(fps=st.sampled_from((24, 30, 60, 120, 240)), rate=st.floats(2.0, 20.0), turns=st.integers(1, 6))
@settings(max_examples=25, deadline=None)
def test_a_spin_stays(fps: int, rate: float, turns: int) -> None:
    """Whole turns at up to three a second, begun and ended as smoothly as a body can."""
    clip, times = dancing(fps), np.arange(len(dancing(fps))) / fps
    last_s = 2.0 * np.pi * turns / rate
    share = np.clip((times - 1.0) / max(2.0 * last_s, 0.5), 0.0, 1.0)
    angles = 2.0 * np.pi * turns * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    spun = turning(clip, "hips", angles, (0.0, 1.0, 0.0))
    assert mended(spun).clip is spun


def test_a_spin_of_even_speed_stays() -> None:
    clip = dancing(60)
    angles = np.clip((np.arange(len(clip)) - 100) / 60.0 * 25.0, 0.0, 4.0 * np.pi)
    spun = turning(clip, "hips", angles, (0.0, 1.0, 0.0))
    assert mended(spun).left_out == ()
    assert angle(mended(spun).clip.rotations, spun.rotations).max() < 0.3


def test_a_punch_and_a_waving_hand_stay() -> None:
    """An elbow extended at 30 rad/s, and a hand that waves five times a second by 45 degrees to each side."""
    clip, times = dancing(60), np.arange(480) / 60.0
    share = np.clip((times - 2.0) / 0.18, 0.0, 1.0) - np.clip((times - 3.0) / 0.5, 0.0, 1.0)
    elbow = 2.2 * share**2 * (3.0 - 2.0 * share)
    fast = turning(clip.span(0, 480), "rightLowerArm", elbow, (0.0, 1.0, 0.0))
    fades = np.clip(np.minimum(times - 4.0, 7.0 - times) / 0.3, 0.0, 1.0)
    fast = turning(fast, "leftHand", 0.78 * fades * np.sin(10.0 * np.pi * times), (0.0, 0.0, 1.0))
    assert mended(fast).clip is fast


@pytest.mark.parametrize("part", ["rightLowerLeg", "leftUpperLeg"])
def test_a_marker_lost_where_the_limb_is_near_its_rest_is_left_out(part: str) -> None:
    """A moving segment stops within one frame, without a jump, and is motionless for a second."""
    clip, at = dancing(60), SEGMENTS.index(part)
    near = angle(clip.rotations[:, at], quaternion.IDENTITY)
    first = 60 + int(near[60:300].argmin())
    found = mended(damaged(clip, "zero", part, first, 60, np.array(AXES[0])))
    assert len(found.left_out) == 1
    assert found.left_out[0].start < first
    assert found.left_out[0].stop >= first + 60


@pytest.mark.parametrize("length", range(1, 7))
def test_short_damage_is_mended_and_nothing_else_changes(length: int) -> None:
    clip = dancing(60)
    spoilt = damaged(clip, "flip", "leftUpperArm", 200, length, np.array(AXES[0]))
    found = mended(spoilt)
    assert found.left_out == ()
    assert found.mended == (Damage(199, 200 + length, ("leftUpperArm",)),)
    arm = SEGMENTS.index("leftUpperArm")
    assert angle(found.clip.rotations[:, arm], clip.rotations[:, arm]).max() < 0.06
    changed = found.clip.rotations != spoilt.rotations
    assert not np.delete(changed, slice(200, 200 + length), axis=0).any()
    assert not np.delete(changed, arm, axis=1).any()


@pytest.mark.parametrize("fps", [30, 60, 120])
@pytest.mark.parametrize("part", ["hips", "chest"])
def test_a_trunk_that_goes_far_and_back_in_six_frames_is_damage(part: str, fps: int) -> None:
    """Filtered captures contain such damage without a jump between frames."""
    clip, at = dancing(fps), SEGMENTS.index(part)
    way = np.zeros(len(clip))
    way[3 * fps : 3 * fps + 8] = np.radians(40.0) * np.sin(np.linspace(0.0, np.pi, 8))
    rotations = clip.rotations.copy()
    rotations[:, at] = quaternion.multiply(rotations[:, at], quaternion.from_axis_angle(AXES[0], way))
    found = mended(replace(clip, rotations=rotations))
    assert len(found.mended) + len(found.left_out) == 1
    for one in found.mended:
        assert angle(found.clip.rotations[:, at], clip.rotations[:, at]).max() < 0.15, one
    for one in found.left_out:
        assert one.start <= 3 * fps + 1 < 3 * fps + 5 < one.stop


@pytest.mark.parametrize("first", [130, 150, 170, 190])
def test_nothing_changes_after_damage_that_returns_by_itself(first: int) -> None:
    """For six frames the hips of a body that turns to and fro quickly are turned by 40 degrees."""
    clip = dancing(60)
    clip = turning(clip, "hips", 0.5 * np.sin(2.0 * np.pi * 2.2 * np.arange(len(clip)) / 60.0), (0.0, 1.0, 0.0))
    extra = np.zeros(len(clip))
    extra[first : first + 6] = np.radians(40.0)
    spoilt = turning(clip, "hips", extra, (0.0, 1.0, 0.0))
    found = mended(spoilt)
    assert found.left_out == ()
    assert found.mended
    sound = np.r_[0 : first - 2, first + 8 : len(clip)]
    assert angle(found.clip.rotations[sound, 0], clip.rotations[sound, 0]).max() < 1e-6
    assert np.array_equal(found.clip.hips_m[sound], clip.hips_m[sound])


def test_long_damage_is_left_out_with_both_its_ends() -> None:
    """A flip of a second, exchanged arms for two, and a lost marker for three are excluded from start to end."""
    clip = dancing(60, 16)
    spoilt = damaged(clip, "flip", "rightUpperLeg", 120, 60, np.array(AXES[3]))
    spoilt = damaged(spoilt, "zero", "head", 660, 180, np.array(AXES[0]))
    rotations = spoilt.rotations.copy()
    left, right = ([SEGMENTS.index(f"{side}{part}") for part in ("UpperArm", "LowerArm")] for side in ("left", "right"))
    turned = quaternion.from_axis_angle(np.array((0.0, 0.0, 1.0)), 2.0)
    for at in (*left, *right):
        rotations[300:420, at] = quaternion.multiply(turned, rotations[300:420, at])
    found = mended(replace(spoilt, rotations=quaternion.continuous(rotations)))
    assert len(found.left_out) == 3
    for one, (start, stop) in zip(found.left_out, ((119, 180), (299, 420), (659, 840)), strict=True):
        assert one.start <= start <= one.start + 8
        assert one.stop - 8 <= stop <= one.stop
    # What stays in place of it moves slowly: no filter sees the damage.
    speeds = angle(found.clip.rotations[:-1], found.clip.rotations[1:]) * 60.0
    assert speeds.max() < 12.0


@pytest.mark.parametrize("fps", [30, 60])
def test_a_body_goes_on_where_frames_are_missing(fps: int) -> None:
    clip = dancing(fps)
    # At 5 s all turns by 0.6 rad about a place beside the body, and leans a little.
    at, about = 5 * fps, np.array((0.5, 0.0, 0.2))
    yaw, lean = (quaternion.from_axis_angle(axis, turn) for axis, turn in (((0, 1.0, 0), 0.6), ((1.0, 0, 0), 0.05)))
    spoilt, hips = clip.rotations.copy(), clip.hips_m.copy()
    spoilt[at:, 0] = quaternion.multiply(quaternion.multiply(yaw, lean), spoilt[at:, 0])
    hips[at:] = quaternion.rotate(yaw, hips[at:] - about) + about + (0.0, 0.02, 0.0)
    found = mended(replace(clip, rotations=spoilt, hips_m=hips))
    assert found.left_out == ()
    assert found.mended[0].start == at - 1
    assert found.clip.hips_m[:, [0, 2]] == pytest.approx(clip.hips_m[:, [0, 2]], abs=0.03)
    assert angle(found.clip.rotations[:at], clip.rotations[:at]).max() < 1e-6
    steps = angle(found.clip.rotations[:-1, 0], found.clip.rotations[1:, 0])
    assert steps.max() < 1.5 * angle(clip.rotations[:-1, 0], clip.rotations[1:, 0]).max() + 0.01


def test_a_root_that_is_elsewhere_for_good_is_taken_back() -> None:
    """Only the place jumps, without any rotation."""
    clip = dancing(60)
    hips = clip.hips_m.copy()
    hips[200:] += (1.0, 0.0, -2.0)
    found = mended(replace(clip, hips_m=hips))
    assert found.left_out == ()
    assert found.clip.hips_m[:, [0, 2]] == pytest.approx(clip.hips_m[:, [0, 2]], abs=0.02)


def test_many_jumps_cost_what_they_change() -> None:
    """A walking body with repeated jumps of its direction keeps walking forward; each jump is undone once."""
    clip = stepping(24)
    way = np.arange(len(clip))[:, None] / 60 * (0.0, 0.0, 0.3)
    clip = replace(clip, hips_m=clip.hips_m + way)
    spoilt, hips = clip.rotations.copy(), clip.hips_m.copy()
    steps = list(range(10, len(clip) - 10, 30))
    for number, at in enumerate(steps):
        yaw = quaternion.from_axis_angle((0.0, 1.0, 0.0), 0.5 + 0.1 * (number % 3))
        spoilt[at:, 0] = quaternion.multiply(yaw, spoilt[at:, 0])
        hips[at:] = quaternion.rotate(yaw, hips[at:])
    found = mended(replace(clip, rotations=spoilt, hips_m=hips))
    assert [one.stop for one in found.mended] == steps
    assert found.clip.hips_m == pytest.approx(clip.hips_m, abs=1e-3)


def test_nothing_faster_than_a_body_is_left() -> None:
    """Under noise of all kinds, everything kept is within the stated bounds."""
    clip, random = dancing(60, 16), np.random.default_rng(4)
    spoilt = clip
    for start in range(40, 900, 43):
        kind, part = KINDS[int(random.integers(len(KINDS)))], MOVED[int(random.integers(len(MOVED)))]
        spoilt = damaged(spoilt, kind, part, start, int(random.integers(1, 12)), np.array(AXES[start % 4]))
    found = mended(spoilt)
    kept = outside(clip, found.left_out)
    both = kept[1:] & kept[:-1]
    speeds = angle(found.clip.rotations[:-1], found.clip.rotations[1:])[both] * 60.0
    assert speeds[:, 0].max() < FASTEST_HIPS_RAD_S
    assert speeds.max() < FASTEST_RAD_S
    inside = [one for one in damage(found.clip) if kept[one.start] and kept[one.stop]]
    assert inside == []
    assert all((one.stop - one.start) / 60.0 <= LONGEST_S for one in found.mended)


def test_a_clip_of_no_length_has_no_damage() -> None:
    for frames in range(6):
        few = dancing(60).span(0, frames)
        assert mended(replace(few, fps=Fraction(60))).clip is not None


@pytest.mark.parametrize("axis", AXES[:3])
def test_a_head_that_slowly_goes_upside_down_is_left_out(axis: tuple[float, float, float]) -> None:
    """Two seconds down, two hanging, two back: nothing is sudden, but no neck bends that far."""
    clip = dancing()
    share = np.interp(np.arange(len(clip)) / 60.0, [1.0, 3.0, 5.0, 7.0], [0.0, 1.0, 1.0, 0.0])
    for most_deg, wrong in ((160.0, True), (70.0, False)):
        bent = turning(clip, "head", np.radians(most_deg) * share, axis)
        done = mended(bent)
        assert bool(done.left_out) is wrong
        if wrong:
            (one,) = done.left_out
            assert one.parts == ("head",)
            assert 1.0 < one.start / 60.0 < 3.0 < 5.0 < one.stop / 60.0 < 7.0
    # Where a body is so for most of its time, that is how it was read.
    assert not mended(turning(clip, "head", np.full(len(clip), np.radians(160.0)), axis)).left_out


@pytest.mark.parametrize(("most_deg", "left_out"), [(95.0, False), (165.0, True)])
def test_a_foot_turned_farther_than_ankles_go_is_left_out(most_deg: float, left_out: bool) -> None:
    """Toes and heel of a capture are exchanged, so slowly that nothing jumps; a pointed foot stays."""
    clip = dancing()
    share = np.interp(np.arange(len(clip)) / 60.0, [1.0, 2.0, 4.0, 5.0], [0.0, 1.0, 1.0, 0.0])
    found = mended(turning(clip, "leftFoot", np.radians(most_deg) * share, (1.0, 0.0, 0.0))).left_out
    assert bool(found) is left_out
    if left_out:
        (one,) = found
        assert one.parts == ("leftFoot",)
        assert 1.0 < one.start / 60.0 < 2.0 < 4.0 < one.stop / 60.0 < 5.0


def test_clean_motion_between_two_held_places_stays() -> None:
    """A body held twice, a few seconds apart, did not jump out and back."""
    clip = dancing(60, 12)
    rotations, hips_m = clip.rotations.copy(), clip.hips_m.copy()
    held = np.zeros(len(clip), bool)
    for start, stop in ((150, 180), (430, 460)):
        rotations[start:stop], hips_m[start:stop] = rotations[start], hips_m[start]
        held[start:stop] = True
    found = mended(replace(clip, rotations=rotations, hips_m=hips_m))
    out = outside(clip, found.left_out)
    assert not out[held].any()
    assert out[200:410].all()
