"""The floor is under what is danced, even if it drifts: not under a skipped rest pose, nor above knees that rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.captured_floor import floor_of_danced, floors_m
from app.choreography.cleaning import CleanedClip
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.read_motion import ReadMotion, guesses, motion_of
from app.formats.bvh.clip import BvhClip
from tests.support.dances import HIPS_M, THIGH_M, stepping, still
from tests.unit.choreography.test_cleaning import behind


def read(clip: MotionClip) -> ReadMotion:
    parents = tuple(SEGMENTS.index(parent) if parent in SEGMENTS else -1 for parent in PARENT_OF.values())
    ends_cm = {SEGMENTS.index(name): 100.0 * end for name, end in zip(ENDS, clip.shape.ends_m, strict=True)}
    offsets_cm, root_cm = 100.0 * clip.shape.offsets_m, 100.0 * clip.hips_m
    return motion_of(BvhClip(SEGMENTS, parents, offsets_cm, ends_cm, clip.fps, root_cm, clip.rotations), "a.bvh")


def lowered(clip: MotionClip, by_m: float) -> MotionClip:
    return replace(clip, hips_m=clip.hips_m - (0.0, by_m, 0.0))


def kneeling(frames: int, under_m: float) -> MotionClip:
    """A body that kneels with its knees ``under_m`` under the floor and its feet over it."""
    clip = still(frames)
    rotations = clip.rotations.copy()
    for side in ("left", "right"):
        rotations[:, SEGMENTS.index(f"{side}LowerLeg")] = Rotation.from_rotvec((np.radians(120.0), 0.0, 0.0)).as_quat()
    return replace(clip, rotations=rotations, hips_m=clip.hips_m * 0.0 + (0.0, THIGH_M + 0.04 - under_m, 0.0))


def test_a_skipped_t_pose_under_the_floor_does_not_lower_it() -> None:
    found = read(behind(lowered(still(20), 0.05), stepping(12)))
    assert found.cleaned.lead_in >= 20
    assert tips_m(found.clip)[..., 1].min() == pytest.approx(0.0, abs=0.005)


def test_resting_knees_are_on_the_floor() -> None:
    clip = kneeling(120, 0.05)
    assert floor_of_danced(CleanedClip(clip)) == pytest.approx(-0.05, abs=1e-6)


def test_a_dance_on_the_floor_keeps_it() -> None:
    clip = stepping(8)
    once = replace(
        clip, hips_m=clip.hips_m - np.where(np.arange(len(clip)) == 100, 0.5, 0.0)[:, None] * (0.0, 1.0, 0.0)
    )
    for one in (clip, lowered(clip, 0.01), once):
        assert floor_of_danced(CleanedClip(one)) == 0.0
    assert read(clip).clip.hips_m[:, 1] == pytest.approx(np.full(len(clip), HIPS_M), abs=0.002)


def over_m(clip: MotionClip, heights_m: FloatArray | float) -> MotionClip:
    return replace(clip, hips_m=clip.hips_m + np.multiply.outer(heights_m, (0.0, 1.0, 0.0)))


def hopping(seconds: int, fps: int = 60) -> MotionClip:
    """A stiff body that jumps once a second: 0.5 s in free fall, 31 cm high, and 0.5 s on the floor."""
    times_s = (np.arange(seconds * fps) / fps) % 1.0
    return over_m(still(seconds * fps, fps), np.maximum(0.0, 0.5 * 9.81 * times_s * (0.5 - times_s)))


def test_a_floor_that_drifts_is_levelled_also_under_jumps() -> None:
    for clip in (stepping(24), hopping(12)):
        frames = np.arange(len(clip))
        found = read(over_m(clip, 0.07 * np.sin(frames / 90.0) + 0.0001 * frames))
        assert found.clip.hips_m[:, 1] == pytest.approx(clip.hips_m[:, 1], abs=0.012)
        assert found.floor_moved_m > 0.12
        assert "motion.floor_moved" in {one.id for one in guesses(found)}


def test_a_floor_that_stays_is_left_alone_under_whatever_rests_or_flies() -> None:
    lying = over_m(still(240), 0.1 - HIPS_M)
    back = Rotation.from_rotvec((-0.5 * np.pi, 0.0, 0.0)).as_quat()
    lying.rotations[:, 0] = back
    upside_down = over_m(still(240), 0.2)
    upside_down.rotations[:, 0] = Rotation.from_rotvec((0.0, 0.0, np.pi)).as_quat()
    turned = [SEGMENTS.index(f"{side}UpperArm") for side in ("left", "right")]
    for arm, sign in zip(turned, (1.0, -1.0), strict=True):
        upside_down.rotations[:, arm] = Rotation.from_rotvec((0.0, 0.0, sign * 0.5 * np.pi)).as_quat()
    for clip in (stepping(12), hopping(6), kneeling(240, 0.0), lying, upside_down):
        whole = replace(
            clip,
            hips_m=np.concatenate([still(240).hips_m, clip.hips_m]),
            rotations=np.concatenate([still(240).rotations, clip.rotations]),
        )
        assert not floors_m(CleanedClip(whole)).any()
