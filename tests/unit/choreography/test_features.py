"""Similar motions have similar features, regardless of place and size."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.cuts import Cut
from app.choreography.features import facing, features, height_m, joint_points_m, points_m, size_m
from app.rig import quaternion

SIDE = {"left": 1.0, "right": -1.0}
CUTS = (Cut(0, 12, 30), Cut(30, 41, 60))


def shape(size: float = 1.0) -> BodyShape:
    """Ordinary body of 1.7 m."""
    offsets = {"hips": (0.0, 0.9, 0.0), "spine": (0.0, 0.1, 0.0), "chest": (0.0, 0.2, 0.0), "head": (0.0, 0.3, 0.0)}
    for side, sign in SIDE.items():
        offsets |= {
            f"{side}UpperArm": (sign * 0.2, 0.2, 0.0),
            f"{side}LowerArm": (sign * 0.3, 0.0, 0.0),
            f"{side}Hand": (sign * 0.25, 0.0, 0.0),
            f"{side}UpperLeg": (sign * 0.1, 0.0, 0.0),
            f"{side}LowerLeg": (0.0, -0.42, 0.0),
            f"{side}Foot": (0.0, -0.42, 0.0),
        }
    ends = [(0.0, 0.2, 0.0), (0.18, 0.0, 0.0), (-0.18, 0.0, 0.0), (0.0, -0.06, 0.2), (0.0, -0.06, 0.2)]
    return BodyShape.of(size * np.array([offsets[name] for name in SEGMENTS]), size * np.array(ends))


def random_clip(seed: int, frames: int = 61, size: float = 1.0) -> MotionClip:
    """Smooth rotations of all segments."""
    generator = np.random.default_rng(seed)
    times = np.arange(frames)[:, None, None] / 60.0
    phases, rates = generator.uniform(0.0, 6.0, (2, 1, len(SEGMENTS), 3))
    rotations = quaternion.from_rotation_vector(0.6 * np.sin(phases + rates * times))
    hips = size * np.array((0.0, 0.9, 0.0)) + size * 0.3 * np.sin(times[:, 0] * (1.0, 2.0, 3.0))
    return MotionClip(shape(size), Fraction(60), hips, rotations)


def test_place_facing_and_size_do_not_matter() -> None:
    clip = random_clip(1)
    turn = quaternion.from_axis_angle((0.0, 1.0, 0.0), 2.5)
    rotations = clip.rotations.copy()
    rotations[:, 0] = -quaternion.multiply(turn, rotations[:, 0])
    hips = quaternion.rotate(turn, clip.hips_m) + np.array((3.0, 0.0, -4.0))
    elsewhere = replace(clip, rotations=rotations, hips_m=hips)
    assert features(elsewhere, CUTS) == pytest.approx(features(clip, CUTS), abs=1e-9)
    assert features(random_clip(1, size=1.3), CUTS) == pytest.approx(features(clip, CUTS), abs=1e-9)


def test_height_pose_and_turn_do_matter() -> None:
    clip = random_clip(1)
    jump = replace(clip, hips_m=clip.hips_m + np.array((0.0, 0.17, 0.0)))
    change = (features(jump, CUTS) - features(clip, CUTS)).reshape(2, 3, 21, 3)
    assert change == pytest.approx(np.broadcast_to((0.0, 0.17 / size_m(clip), 0.0), change.shape), abs=1e-9)
    turning = clip.rotations.copy()
    turning[:, 0] = quaternion.multiply(
        quaternion.from_axis_angle((0.0, 1.0, 0.0), np.linspace(0.0, 1.5, len(clip))), turning[:, 0]
    )
    assert np.abs(features(replace(clip, rotations=turning), CUTS) - features(clip, CUTS)).max() > 0.1


def test_a_pose_in_numbers() -> None:
    still = np.zeros((61, len(SEGMENTS), 4))
    still[..., 3] = 1.0
    # The whole body turned to face +X.
    still[:, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), np.pi / 2.0)
    clip = MotionClip(shape(), Fraction(60), np.tile((5.0, 0.9, 2.0), (61, 1)), still)
    assert height_m(clip) == pytest.approx(1.7)
    assert size_m(clip) == pytest.approx(1.7, abs=0.01)
    toes = points_m(clip)[0, len(SEGMENTS) + ENDS.index("leftFoot")]
    assert toes == pytest.approx((5.2, 0.0, 1.9))
    seen = features(clip, CUTS).reshape(2, 3, 21, 3)[1, 2, len(SEGMENTS) + ENDS.index("leftFoot")]
    assert seen * size_m(clip) == pytest.approx((0.1, 0.0, 0.2))
    assert quaternion.rotate(facing(clip), (0.0, 0.0, 1.0))[0] == pytest.approx((1.0, 0.0, 0.0))


def test_turned_hands_and_heads_do_not_matter() -> None:
    """Files without eyes and fingers do not define the rotation of heads and hands, so that dances must not depend on
    it.
    """
    clip = random_clip(1)
    turned, ends = clip.rotations.copy(), clip.shape.ends_m.copy()
    for end, name in enumerate(("head", "leftHand", "rightHand")):
        turn = quaternion.from_axis_angle((0.6, 0.0, 0.8), 0.5)
        at = SEGMENTS.index(name)
        turned[:, at] = quaternion.multiply(turned[:, at], turn)
        ends[end] = quaternion.rotate(turn, ends[end])
    other = replace(clip, rotations=turned, shape=BodyShape.of(clip.shape.offsets_m, ends))
    assert features(other, CUTS) == pytest.approx(features(clip, CUTS), abs=1e-9)
    # A straight arm's fingertips are where they are.
    straight = replace(clip, rotations=np.tile(quaternion.IDENTITY, (len(clip), len(SEGMENTS), 1)))
    assert joint_points_m(straight) == pytest.approx(points_m(straight), abs=1e-9)


def test_no_motions_have_no_features() -> None:
    assert features(random_clip(1), ()).shape == (0, 189)
