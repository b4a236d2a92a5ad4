"""The floor is under what is danced: not under a rest pose that is skipped, nor above knees that rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.captured_floor import floor_of_danced
from app.choreography.cleaning import CleanedClip
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.read_motion import ReadMotion, motion_of
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
