"""Hands that would penetrate the body move around it, and other hands stay where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.hands_out_of_body import ELBOW, depths_m, out_of_body
from app.choreography.limbs import bend
from app.rig import quaternion
from tests.support.dance_measures import angular_jumps
from tests.support.dances import stepping, still


def inwards(angle_rad: float) -> MotionClip:
    """A slightly bent left arm that hangs beside the body and swings inwards and back."""
    clip = still(120)
    share = 0.5 - 0.5 * np.cos(np.arange(120) / 119.0 * 2.0 * np.pi)
    rotations = clip.rotations.copy()
    rotations[:, SEGMENTS.index("leftUpperArm")] = quaternion.from_axis_angle(
        np.array([0.0, 0.0, -1.0]), 1.4 + angle_rad * share
    )
    rotations[:, SEGMENTS.index("leftLowerArm")] = quaternion.from_axis_angle(np.array([0.0, -1.0, 0.0]), 0.2)
    return replace(clip, rotations=rotations)


def test_a_hand_in_the_body_comes_out_of_it_and_does_not_snap() -> None:
    clip = inwards(0.55)
    assert depths_m(clip)[:, 0].max() > 0.03
    found = out_of_body(clip)
    assert depths_m(found).max() < 0.005
    assert angular_jumps(found).max() < 1.0
    # Only that arm is changed.
    others = [at for at, name in enumerate(SEGMENTS) if name not in ("leftUpperArm", "leftLowerArm", "leftHand")]
    assert np.array_equal(found.rotations[:, others], clip.rotations[:, others])
    # The hand keeps its turn in the world.
    hand = 1 + SEGMENTS.index("leftHand")
    assert np.allclose(
        np.abs(np.einsum("fi,fi->f", found.world().rotations[:, hand], clip.world().rotations[:, hand])), 1.0
    )


@pytest.mark.parametrize("ahead_m", [-0.03, 0.0])
def test_a_hand_that_goes_through_the_body_is_not_thrown_to_its_other_side(ahead_m: float) -> None:
    clip = still(120)
    world, share = clip.world(), 0.5 - 0.5 * np.cos(np.arange(120) / 119.0 * 2.0 * np.pi)
    way = np.stack([0.3 - 0.35 * share, np.full(120, -0.1), np.full(120, ahead_m)], axis=1)
    wrist = world.positions_m[:, 1 + SEGMENTS.index("chest")] + way
    rotations = clip.rotations.copy()
    bend(clip, world, ("chest", "leftUpperArm", "leftLowerArm", "leftHand"), wrist, ELBOW, rotations)
    clip = replace(clip, rotations=rotations)
    assert depths_m(clip)[:, 0].max() > 0.07
    found = out_of_body(clip)
    assert depths_m(found).max() < 0.005
    assert angular_jumps(found).max() < 0.4


def test_hands_outside_stay_where_they_are() -> None:
    for clip in (stepping(8), inwards(-0.4)):
        assert depths_m(clip).max() == 0.0
        assert out_of_body(clip) is clip
