"""Frozen limbs, twitching feet and sinking bodies are reported from start to end; genuine rests are kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.body_speeds import angle
from app.choreography.clip import MotionClip
from app.choreography.features import points_m
from app.choreography.mending import mended
from app.rig import quaternion
from tests.support.dances import stepping
from tests.unit.choreography.test_mending import dancing, outside, turning

ARM = ("rightUpperArm", "rightLowerArm", "rightHand")
LEG = ("leftUpperLeg", "leftLowerLeg", "leftFoot")


def rounded(clip: MotionClip) -> MotionClip:
    """Clip with rounding errors like those of a file, different in every frame."""
    random = np.random.default_rng(5)
    noise = random.normal(0.0, 1e-13, clip.rotations.shape)
    return replace(clip, rotations=quaternion.normalize(clip.rotations + noise))


def frozen(clip: MotionClip, parts: tuple[str, ...], start: int, stop: int) -> MotionClip:
    """Clip with a limb that does not move after a frame."""
    rotations = clip.rotations.copy()
    for part in parts:
        rotations[start:stop, SEGMENTS.index(part)] = rotations[start, SEGMENTS.index(part)]
    return replace(clip, rotations=quaternion.continuous(rotations))


def delayed(clip: MotionClip, parts: tuple[str, ...], start: int, frames: int) -> MotionClip:
    """Clip with a limb that stops and later continues from the same pose."""
    rotations = clip.rotations.copy()
    for at in map(SEGMENTS.index, parts):
        rotations[start + frames :, at] = clip.rotations[start:-frames, at]
        rotations[start : start + frames, at] = clip.rotations[start, at]
    return replace(clip, rotations=rotations)


@pytest.mark.parametrize("parts", [ARM, LEG, ARM[:2], LEG[1:]], ids="-".join)
@pytest.mark.parametrize("fps", [30, 60, 120])
def test_a_limb_that_is_frozen_is_left_out_from_its_freeze_to_its_release(parts: tuple[str, ...], fps: int) -> None:
    start, stop = 3 * fps, 5 * fps
    found = mended(rounded(frozen(dancing(fps), parts, start, stop)))
    (one,) = found.left_out
    assert set(parts) <= set(one.parts) <= {*ARM, *LEG}
    assert start - 0.1 * fps <= one.start <= start
    assert stop - 1 <= one.stop <= stop + 0.2 * fps


@pytest.mark.parametrize("parts", [ARM, LEG], ids="-".join)
def test_a_limb_that_stops_and_goes_on_later_is_left_out(parts: tuple[str, ...]) -> None:
    """There is no jump at either end; the limb only stops faster than in any rest."""
    clip = dancing(60)
    (one,) = mended(rounded(delayed(clip, parts, 200, 90))).left_out
    assert one.start <= 200 < 289 <= one.stop


@pytest.mark.parametrize("parts", [ARM, LEG], ids="-".join)
def test_a_limb_that_comes_to_rest_stays(parts: tuple[str, ...]) -> None:
    """An arm that is lowered, held exactly still for a second and lifted, as in keyframe animation."""
    clip = dancing(60)
    share = np.clip(np.arange(len(clip)) / 60.0 - 2.0, 0.0, 1.0) - np.clip(np.arange(len(clip)) / 60.0 - 4.0, 0.0, 1.0)
    share = (share * share * (3.0 - 2.0 * share))[:, None]
    rotations = clip.rotations.copy()
    for at in map(SEGMENTS.index, parts):
        rest = np.broadcast_to(clip.rotations[150, at], (len(clip), 4))
        rotations[:, at] = quaternion.slerp(clip.rotations[:, at], rest, share[:, 0])
    assert mended(rounded(replace(clip, rotations=quaternion.continuous(rotations)))).left_out == ()


def test_an_elbow_that_is_stretched_as_far_as_it_goes_stays() -> None:
    """Rigs stop there within a frame, and few decimals make the elbow nearly constant."""
    clip = dancing(60)
    bend = 0.6 - 0.9 * np.sin(np.arange(len(clip)) / 25.0)
    at = SEGMENTS.index("leftLowerArm")
    rotations = clip.rotations.copy()
    rotations[:, at] = quaternion.from_axis_angle((0.0, 1.0, 0.0), -np.maximum(bend, 0.05))
    noise = np.random.default_rng(2).normal(0.0, 1e-6, rotations[:, at].shape)
    rotations[:, at] = quaternion.normalize(rotations[:, at] + noise)
    assert mended(replace(clip, rotations=quaternion.continuous(rotations))).left_out == ()


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_a_knee_that_is_straight_in_exactly_its_rest_pose_stays_unless_it_leaps_there(fps: int) -> None:
    """The limit of CMU's knees is the rest pose, and a lost marker puts a limb there within a frame."""
    clip = dancing(fps)
    at, times_s = SEGMENTS.index("leftLowerLeg"), np.arange(len(clip)) / fps
    # As in CMU 12_01: straight for 0.2 s in each step.
    bend = 0.6 - 0.72 * np.cos(2.0 * np.pi * times_s / 1.2)
    rotations = clip.rotations.copy()
    rotations[:, at] = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.maximum(bend, 0.0))
    assert (bend < 0.0).mean() > 0.1
    found = mended(replace(clip, rotations=rotations))
    assert (found.left_out, found.mended) == ((), ())
    start = int(np.argmax(bend > 1.0))
    rotations[start : start + fps // 4, at] = quaternion.IDENTITY
    found = mended(replace(clip, rotations=rotations))
    assert any(one.start <= start and "leftLowerLeg" in one.parts for one in (*found.left_out, *found.mended))


def accelerations(clip: MotionClip) -> FloatArray:
    """Accelerations (F - 2, 2) of the ends of the feet in m/s^2."""
    ends = points_m(clip)[:, [len(SEGMENTS) + ENDS.index(name) for name in ("leftFoot", "rightFoot")]]
    return np.asarray(np.linalg.norm(np.diff(ends, 2, axis=0), axis=-1) * float(clip.fps) ** 2)


@pytest.mark.parametrize("parts", [("hips",), ("leftUpperLeg", "leftLowerLeg")], ids="-".join)
def test_a_twitch_that_only_the_feet_show_is_mended_and_named(parts: tuple[str, ...]) -> None:
    """Rotations for one frame below the joints' own bounds move feet by 6 cm: 200 m/s^2 and more."""
    clip = dancing(60)
    spoilt, turned = clip, np.zeros(len(clip))
    turned[240] = np.radians(4.0 if parts == ("hips",) else 5.0)
    for part in parts:
        spoilt = turning(spoilt, part, turned, (0.0, 0.0, 1.0) if part == "hips" else (1.0, 0.0, 0.0))
    assert accelerations(spoilt).max() > 200.0
    found = mended(spoilt)
    assert accelerations(found.clip).max() < 1.2 * accelerations(clip).max()
    named = {part for one in (*found.mended, *found.left_out) for part in one.parts}
    assert set(parts) <= named
    assert all(one.start < 240 < one.stop for one in (*found.mended, *found.left_out))


@pytest.mark.parametrize("frames", [12, 20, 30])
def test_a_body_that_sinks_into_the_floor_is_left_out(frames: int) -> None:
    """Four dips of 20 cm: the floor is where the feet stand and not where they sink to."""
    clip = stepping(16)
    hips = clip.hips_m.copy()
    for start in (60, 160, 260, 360):
        hips[start : start + frames, 1] -= 0.2 * np.sin(np.linspace(0.0, np.pi, frames)) ** 2
    found = mended(replace(clip, hips_m=hips))
    kept = outside(clip, found.left_out)
    assert np.abs(found.clip.hips_m[kept, 1] - clip.hips_m[kept, 1]).max() < 0.06
    assert kept.mean() > 0.3
    assert all({"hips", "place"} & set(one.parts) for one in found.left_out)


def test_knees_that_bend_deeply_are_no_damage() -> None:
    clip = dancing(60)
    down = 0.25 * np.sin(np.linspace(0.0, np.pi, 60)) ** 2
    hips, rotations = clip.hips_m.copy(), clip.rotations.copy()
    hips[200:260, 1] -= down
    bend = np.zeros(len(clip))
    bend[200:260] = np.arccos(np.clip(1.0 - down / 0.83, -1.0, 1.0))
    for side in ("left", "right"):
        for part, sign in (("UpperLeg", -1.0), ("LowerLeg", 2.0), ("Foot", -1.0)):
            at = SEGMENTS.index(side + part)
            turn = quaternion.from_axis_angle((1.0, 0.0, 0.0), sign * bend)
            rotations[:, at] = quaternion.multiply(turn, rotations[:, at])
    bent = replace(clip, hips_m=hips, rotations=quaternion.continuous(rotations))
    assert mended(bent).left_out == ()
    assert angle(mended(bent).clip.rotations, bent.rotations).max() < 0.1
