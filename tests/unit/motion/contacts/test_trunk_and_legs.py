"""Hips above stationary feet: no leg exceeds its length, and the shorter reach limits the hips."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.trunk_and_legs import SIDES, STRAIGHTEST, hips_path, stance
from app.rig import quaternion
from metadata.load import load_body
from tests.unit.motion.figure import skeleton

FRAMES = 400


class _Hips:
    """The part of a body's motion that moves the hips."""

    knee_rad: FloatArray

    def __init__(self, **moved: Any) -> None:
        still = np.zeros(FRAMES)
        lengths, angles = ("side_m", "ahead_m", "bob_m"), ("roll_rad", "turn_rad", "forward_rad")
        for name in (*(f"hips_{one}" for one in (*lengths, *angles)), "knee_rad"):
            setattr(self, name, moved.get(name, still))
        self.hips_danced: dict[str, Any] = {}
        self.feet: dict[str, Any] = {}


def test_legs_reach_their_feet_bent_as_the_knees_say() -> None:
    rng = np.random.default_rng(2)
    body, joints = load_body(), skeleton()
    place = stance(joints, body.postures["standing"])
    motion = _Hips(
        hips_side_m=rng.uniform(-0.08, 0.08, FRAMES),
        hips_roll_rad=rng.uniform(-0.1, 0.1, FRAMES),
        hips_turn_rad=rng.uniform(-0.4, 0.4, FRAMES),
        knee_rad=rng.uniform(0.0, 0.3, FRAMES),
    )
    hips_m, rotation = hips_path(place, joints, cast(BodyMotion, motion))
    slack_m = []
    for side in SIDES:
        limb = place.legs[side]
        a, b = np.linalg.norm(limb.upper_vector_m), np.linalg.norm(limb.lower_vector_m)
        joint_m = hips_m + quaternion.rotate(rotation, joints.offsets_m[limb.upper])
        reach_m = np.linalg.norm(joint_m - place.ankles_m[side], axis=1)
        bent_m = np.sqrt(a * a + b * b + 2.0 * a * b * np.cos(place.knee_rad + motion.knee_rad))
        slack_m.append(np.minimum(bent_m, STRAIGHTEST * (a + b)) - reach_m)
    # Rounding the hand-over from leg to leg lowers the hips by less than 2 mm.
    assert np.min(slack_m) >= -1e-9
    assert np.max(np.minimum(*slack_m)) < 0.0022


def test_what_lowers_the_hips_lowers_them_by_as_much() -> None:
    joints = skeleton()
    place = stance(joints, load_body().postures["standing"])
    level_m, _ = hips_path(place, joints, cast(BodyMotion, _Hips()))
    lower_m, _ = hips_path(place, joints, cast(BodyMotion, _Hips(hips_bob_m=np.full(FRAMES, 0.03))))
    assert level_m[0, 1] - lower_m[0, 1] == pytest.approx(0.03)
