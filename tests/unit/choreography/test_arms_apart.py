"""Arms of dancing characters stay out of body and thighs and apart from each other, and others stay as they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography import retarget as transfer
from app.choreography.arms_apart import depths_m
from app.choreography.body import SEGMENTS
from app.choreography.body_capsules import body_capsules
from app.choreography.clip import MotionClip
from app.choreography.retarget import retarget
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.model import Character
from app.rig.skeleton import JointTransforms, forward, rest_positions
from tests.support.dances import stepping, still

FRAMES = 120
SIGNS = {"left": 1.0, "right": -1.0}


@pytest.fixture(scope="module", params=["man_adult", "woman_adult", "child_hina"])
def character(request: pytest.FixtureRequest) -> Character:
    return character_named(request.param)


def share() -> FloatArray:
    """Rise from 0 to 1 and back (F, 1)."""
    return np.asarray(0.5 - 0.5 * np.cos(np.arange(FRAMES) / (FRAMES - 1.0) * 2.0 * np.pi))[:, None]


def with_arms(down: FloatArray, inwards: FloatArray, bent: FloatArray, sides: tuple[str, ...]) -> MotionClip:
    """A motion with arms lowered by ``down`` (F, 1), then turned forwards and inwards about the vertical, and elbows
    bent, in radians.
    """
    clip = still(FRAMES)
    rotations = clip.rotations.copy()
    for side, sign in SIGNS.items():
        if side in sides:
            lowered = quaternion.from_rotation_vector(down * (0.0, 0.0, -sign))
            turned = quaternion.from_rotation_vector(inwards * (0.0, -sign, 0.0))
            rotations[:, SEGMENTS.index(f"{side}UpperArm")] = quaternion.multiply(turned, lowered)
            elbow = quaternion.from_rotation_vector(bent * (0.0, -sign, 0.0))
            rotations[:, SEGMENTS.index(f"{side}LowerArm")] = elbow
    return replace(clip, rotations=rotations)


def world_of(character: Character, motion: Motion) -> JointTransforms:
    return forward(character.skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))


def depths(character: Character, motion: Motion) -> FloatArray:
    joints = world_of(character, motion)
    world = {at: joints.rotations[:, at] for at, name in enumerate(character.skeleton.names)}
    return depths_m(character, world, motion.hips_m.astype(np.float64))


def jumps_rad_s(motion: Motion) -> float:
    """Greatest change of a joint's angular velocity from frame to frame."""
    turns = motion.rotations.astype(np.float64)
    ways = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(turns[:-1]), turns[1:]))
    return float(np.linalg.norm(np.diff(ways * 60.0, axis=0), axis=-1).max())


def before_and_after(clip: MotionClip, character: Character, monkeypatch: pytest.MonkeyPatch) -> tuple[Motion, Motion]:
    after = retarget(clip, character)
    with monkeypatch.context() as patched:
        patched.setattr(transfer, "arms_apart", lambda _, world, *rest: world)
        return retarget(clip, character), after


def test_a_forearm_that_would_go_through_the_trunk_goes_around_it(
    character: Character, monkeypatch: pytest.MonkeyPatch
) -> None:
    clip = with_arms(np.full((FRAMES, 1), 1.3), 1.7 * share(), 1.6 * share(), ("left",))
    before, after = before_and_after(clip, character, monkeypatch)
    assert depths(character, before)[:, 0].max() > 0.03
    assert depths(character, after).max() < 0.01
    assert jumps_rad_s(after) < jumps_rad_s(before) + 1.0
    names = character.skeleton.names
    moved = np.abs(np.subtract(after.rotations, before.rotations)).max(axis=(0, 2)) > 1e-5
    assert {names[at] for at in np.flatnonzero(moved)} <= {"leftUpperArm", "leftLowerArm", "leftHand"}
    # The hand keeps its rotation in the world.
    turned = [world_of(character, motion).rotations for motion in (before, after)]
    hand = character.skeleton.index("leftHand")
    assert np.allclose(np.abs(quaternion.dot(*(rotations[:, hand] for rotations in turned))), 1.0, atol=1e-5)


def test_a_forearm_stays_out_of_a_raised_thigh(character: Character, monkeypatch: pytest.MonkeyPatch) -> None:
    clip = with_arms(np.full((FRAMES, 1), 1.05), np.full((FRAMES, 1), 1.85), np.full((FRAMES, 1), 0.1), ("left",))
    rotations = clip.rotations.copy()
    for name, angles in (("leftUpperLeg", -1.5 * share()), ("leftLowerLeg", 1.5 * share())):
        rotations[:, SEGMENTS.index(name)] = quaternion.from_rotation_vector(angles * (1.0, 0.0, 0.0))
    clip = replace(clip, rotations=rotations)
    before, after = before_and_after(clip, character, monkeypatch)
    assert depths(character, before)[:, 0].max() > 0.03
    assert depths(character, after)[:, 0].max() < 0.012
    assert jumps_rad_s(after) < jumps_rad_s(before) + 1.5


def test_forearms_do_not_go_through_each_other(character: Character, monkeypatch: pytest.MonkeyPatch) -> None:
    clip = with_arms(np.full((FRAMES, 1), 0.5), 1.0 + 0.3 * share(), 0.5 + 0.6 * share(), ("left", "right"))
    before, after = before_and_after(clip, character, monkeypatch)
    assert depths(character, before).max() > 0.02
    assert depths(character, after).max() < 0.01
    assert jumps_rad_s(after) < 3.0


def test_arms_outside_stay_as_they_are(character: Character, monkeypatch: pytest.MonkeyPatch) -> None:
    for clip in (still(2), stepping(4)):
        before, after = before_and_after(clip, character, monkeypatch)
        assert depths(character, before).max() == 0.0
        assert np.array_equal(before.rotations, after.rotations)


def test_radii_are_those_of_the_body(character: Character) -> None:
    height = float(rest_positions(character.skeleton)[:, 1].max())
    shape = body_capsules(character)
    for bone in shape.body:
        assert 0.035 < bone.radius_m / height < 0.08
    assert np.all(shape.radii_m[1:] < 0.03 * height)
    assert np.all(np.diff(shape.radii_m) < 0.0)
