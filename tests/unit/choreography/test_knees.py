"""Knees of a dance bend about their hinges, measured in the exported file."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip, write_motion
from app.choreography.dance import Manner
from app.choreography.generate import Choreographer
from app.choreography.limbs import hinged
from app.choreography.model_file import read_model
from app.choreography.sudden_ends import within_limits
from app.formats.bvh.read import read_bvh
from app.project.choreography_files import choreography_path
from tests.support.dances import beaten, stepping


def sideways_deg(file: Path) -> FloatArray:
    """Angle of each shank (2 F,) from the plane in which its thigh's knee bends, read from a BVH file."""
    read = read_bvh(file)
    found = []
    for side in ("left", "right"):
        knee, foot = (read.names.index(side + name) for name in ("LowerLeg", "Foot"))
        shank = Rotation.from_quat(read.rotations_xyzw[:, knee]).apply(read.offsets_cm[foot])
        found.append(np.degrees(np.arcsin(shank[:, 0] / np.linalg.norm(read.offsets_cm[foot]))))
    return np.abs(np.concatenate(found))


def twisted(clip: MotionClip, angle_rad: float) -> MotionClip:
    """Rotate thighs about their length, with shanks and feet in place."""
    rotations, about = clip.rotations.copy(), Rotation.from_rotvec((0.0, angle_rad, 0.0))
    for side in ("left", "right"):
        thigh, shank = (SEGMENTS.index(side + name) for name in ("UpperLeg", "LowerLeg"))
        rotations[:, thigh] = (Rotation.from_quat(rotations[:, thigh]) * about).as_quat()
        rotations[:, shank] = (about.inv() * Rotation.from_quat(rotations[:, shank])).as_quat()
    return replace(clip, rotations=rotations)


@pytest.mark.parametrize("angle_rad", [0.6, -0.6])
def test_thighs_follow_knees_that_were_placed_beside_them(tmp_path: Path, angle_rad: float) -> None:
    clip = twisted(stepping(6), angle_rad)
    write_motion(tmp_path / "twisted.bvh", clip)
    assert sideways_deg(tmp_path / "twisted.bvh").max() > 20.0
    mended = hinged(clip)
    write_motion(tmp_path / "mended.bvh", mended)
    assert sideways_deg(tmp_path / "mended.bvh").max() < 7.0
    was, now = clip.world(), mended.world()
    assert now.positions_m == pytest.approx(was.positions_m, abs=1e-9)
    feet = [1 + SEGMENTS.index(f"{side}Foot") for side in ("left", "right")]
    turned = Rotation.from_quat(was.rotations[:, feet].reshape(-1, 4)).inv() * Rotation.from_quat(
        now.rotations[:, feet].reshape(-1, 4)
    )
    assert turned.magnitude().max() < 1e-6


def test_knees_that_bend_as_captured_stay_as_they_are() -> None:
    clip = twisted(stepping(6), 0.04)
    assert hinged(clip).rotations == pytest.approx(clip.rotations, abs=1e-9)


def test_no_knee_of_an_exported_dance_bends_sideways(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    limited = []

    def recorded(clip: MotionClip, *arguments: Any) -> MotionClip:
        limited.append(clip)
        return within_limits(clip, *arguments)

    monkeypatch.setattr("app.choreography.generate.within_limits", recorded)
    dance = Choreographer(read_model(choreography_path("salsa"))).dance(beaten(24, 0.4), Manner(seed=3), Fraction(60))
    # Thighs turned only after the limits would turn as suddenly as knees had swung from side to side.
    for clip in (*limited, dance.clip):
        write_motion(tmp_path / "dance.bvh", clip)
        assert sideways_deg(tmp_path / "dance.bvh").max() < 7.0


def test_thighs_follow_bent_knees_that_swing_past_the_side_without_a_jump() -> None:
    """A folded leg that was swung around the other one points its knee ahead for a few frames."""
    still = stepping(1)
    count, thigh, shank = 41, SEGMENTS.index("rightUpperLeg"), SEGMENTS.index("rightLowerLeg")
    rotations = np.repeat(still.rotations[:1], count, axis=0)
    swung = Rotation.from_rotvec(np.outer(2.0 * np.sin(np.linspace(0.0, np.pi, count)), (0.0, 1.0, 0.0)))
    rotations[:, thigh] = Rotation.from_euler("x", -1.2).as_quat()
    rotations[:, shank] = (swung * Rotation.from_euler("x", 2.2)).as_quat()
    clip = MotionClip(still.shape, still.fps, np.repeat(still.hips_m[:1], count, axis=0), rotations)
    mended = hinged(clip)
    turns = Rotation.from_quat(mended.rotations[:, thigh])
    steps = np.degrees((turns[1:] * turns[:-1].inv()).magnitude())
    assert steps.max() < 1.5 * np.degrees(np.diff(swung.as_rotvec()[:, 1])).max()
    way = Rotation.from_quat(mended.rotations[:, shank]).apply(still.shape.offsets_m[SEGMENTS.index("rightFoot")])
    assert np.degrees(np.arcsin(np.abs(way[:, 0]) / np.linalg.norm(way, axis=1))).max() < 7.0
    assert (way[:, 2] < 0.0).all()
    assert mended.world().positions_m == pytest.approx(clip.world().positions_m, abs=1e-9)
