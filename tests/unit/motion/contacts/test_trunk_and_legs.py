"""Hips above stationary feet: no leg exceeds its length, and the shorter reach limits the hips."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from app.arrays import FloatArray
from app.motion.body_motion import BodyMotion
from app.motion.contacts.trunk_and_legs import SIDES, STRAIGHTEST, Side, Stance, hips_path, solve_legs, stance
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
    place = stance(joints, body.postures["standing"], body.limits["foot"])
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
    joints, body = skeleton(), load_body()
    place = stance(joints, body.postures["standing"], body.limits["foot"])
    level_m, _ = hips_path(place, joints, cast(BodyMotion, _Hips()))
    lower_m, _ = hips_path(place, joints, cast(BodyMotion, _Hips(hips_bob_m=np.full(FRAMES, 0.03))))
    assert level_m[0, 1] - lower_m[0, 1] == pytest.approx(0.03)


def _bent_deg(place: Stance, solved: dict[int, FloatArray], side: Side) -> FloatArray:
    turned = solved[place.legs[side].end]
    return np.rad2deg(-2.0 * np.arctan2(turned[:, 0], turned[:, 3]))


def test_a_dance_lowers_the_hips_as_far_as_the_ankles_of_flat_feet_bend() -> None:
    joints, body = skeleton(), load_body()
    place = stance(joints, body.postures["standing"], body.limits["foot"])
    most_deg = body.limits["foot"].flexion_deg[1]
    ahead_m, zero = np.repeat(np.linspace(0.0, 0.08, 8), FRAMES // 8), np.zeros(FRAMES)
    danced = _Hips(hips_bob_m=np.tile(np.linspace(0.0, 0.16, FRAMES // 8), 8), hips_ahead_m=ahead_m)
    free_m, free = hips_path(place, joints, cast(BodyMotion, danced))
    danced.hips_danced = {"ahead_m": zero, "forward_rad": zero, "ease_m": zero}
    feet = {"right_heel": np.full(FRAMES, np.deg2rad(12.0)), "left_toes": np.full(FRAMES, np.deg2rad(6.0))}
    for moved in ({}, feet):
        danced.feet = moved
        hips_m, rotation = hips_path(place, joints, cast(BodyMotion, danced))
        bent = {side: _bent_deg(place, solve_legs(place, joints, hips_m, rotation, moved), side) for side in SIDES}
        assert most_deg - 3.0 < max(one.max() for one in bent.values()) < most_deg
        # Where the ankles have room, the hips are where the dance puts them.
        easy = np.maximum(bent["left"], bent["right"]) < most_deg - 8.0
        assert easy.any()
        if not moved:
            assert np.abs(hips_m - free_m)[easy].max() < 0.005
            free_deg = [_bent_deg(place, solve_legs(place, joints, free_m, free, {}), side).max() for side in SIDES]
            assert max(free_deg) > most_deg + 2.0


def test_toes_are_raised_as_far_as_the_ankle_lets_them() -> None:
    joints, body = skeleton(), load_body()
    place = stance(joints, body.postures["standing"], body.limits["foot"])
    # The lower the hips, the farther the shanks lean forward over the feet.
    hips_m, rotation = hips_path(place, joints, cast(BodyMotion, _Hips(hips_bob_m=np.linspace(0.0, 0.12, FRAMES))))
    toes_rad = np.full(FRAMES, np.deg2rad(14.0))
    flat, raised = (solve_legs(place, joints, hips_m, rotation, feet) for feet in ({}, {"left_toes": toes_rad}))
    ankle = place.legs["left"].end
    bent_deg, raised_deg = (np.rad2deg(-2.0 * np.arctan2(one[ankle][:, 0], one[ankle][:, 3])) for one in (flat, raised))
    most_deg = body.limits["foot"].flexion_deg[1]
    assert (bent_deg + 14.0).max() > most_deg > raised_deg.max()
    easy = bent_deg < most_deg - 20.0
    assert easy.any()
    assert (raised_deg - bent_deg)[easy].min() > 13.0
    assert (raised_deg - bent_deg).min() >= -1e-9
