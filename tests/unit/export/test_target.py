"""Motion on other skeletons: joints and skin are where they are on the default skeleton, also when read back."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.export.character import character_scene
from app.export.check_skeleton import check_skeleton
from app.export.joint_playback import JointPlayback
from app.export.mannequin import MANNEQUIN, MannequinAxes, mannequin_target
from app.export.own_skeleton import own_target, own_weights
from app.export.playback import ScenePlayback, Surface
from app.export.target import TargetSkeleton, bone_motion
from app.formats.scene import check_scene
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.characters.bone_placements import world_placements
from app.rig.characters.character_library import character_named
from app.rig.model import Character
from app.rig.skeleton import forward
from tests.support.foreign import PREFIX, foreign

MM = 1e-3
CHARACTER = "woman_adult"


@cache
def ours() -> Character:
    return character_named(CHARACTER)


def random_motion(seed: int, frames: int = 5, reach_rad: float = 1.0) -> Motion:
    """Motion with every joint rotated by up to a radian about any axis and the hips displaced."""
    random = np.random.default_rng(seed)
    count = len(ours().skeleton.names)
    vectors = random.uniform(-1.0, 1.0, (frames, count, 3)) * reach_rad / np.sqrt(3.0)
    vectors[:, 0] = 0.0
    zeros = np.zeros((frames, 3), np.float32)
    return Motion(
        fps=Fraction(30),
        first_frame_s=0.0,
        rotations=Rotation.from_rotvec(vectors.reshape(-1, 3)).as_quat().reshape(frames, count, 4).astype(np.float32),
        hips_m=random.uniform(-0.3, 1.2, (frames, 3)).astype(np.float32),
        morphs={"jawOpen": random.uniform(0, 1, frames).astype(np.float32)},
        controls={},
        instrument_position_m=zeros,
        instrument_rotation=np.tile(np.float32([0, 0, 0, 1]), (frames, 1)),
    )


def played(character: Character, motion: Motion, target: TargetSkeleton) -> ScenePlayback:
    scene = character_scene(character, motion, "x", "test", target)
    check_scene(scene)
    assert scene.clip is not None
    return ScenePlayback(scene, scene.clip)


def assert_joints_agree(character: Character, motion: Motion, target: TargetSkeleton, playback: ScenePlayback) -> None:
    world = playback.world(0, motion.frames)
    joints = forward(character.skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))
    for joint, bone in target.bone_of_joint.items():
        place = playback.bone_names.index(target.names[bone])
        off_mm = np.linalg.norm(world[:, place, :3, 3] - joints.positions_m[:, joint], axis=1).max() / MM
        assert off_mm < 0.01, (target.names[bone], off_mm)
        expected = Rotation.from_quat(joints.rotations[:, joint]) * Rotation.from_quat(target.joint_from_bone[bone])
        turned = Rotation.from_matrix(world[:, place, :3, :3]) * expected.inv()
        assert np.degrees(turned.magnitude()).max() < 0.01, target.names[bone]


def surfaces_m(playback: ScenePlayback) -> np.ndarray:
    frames = playback.clip.frames
    world = playback.world(0, frames)
    every = [np.arange(0, len(mesh.vertices_cm), 7) for mesh in playback.scene.meshes]
    found = [
        Surface(playback, mesh, rows).positions_m(world, 0, frames)
        for mesh, rows in zip(playback.scene.meshes, every, strict=True)
    ]
    return np.concatenate(found, axis=1)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from([1, 3]), st.sampled_from(["", "leftHand", "neck", "rightLowerLeg"]))
def test_joints_are_where_they_are_on_ours(seed: int, roots: int, in_chain: str) -> None:
    character = foreign(ours(), seed, roots=roots, in_chain=in_chain)
    motion = random_motion(seed + 1)
    target = own_target(character)
    assert_joints_agree(character, motion, target, played(character, motion, target))


def test_names_hierarchy_and_rest_are_the_files() -> None:
    character = foreign(ours())
    figure = character.own.figure
    scene = character_scene(character, random_motion(1), "x", "test", own_target(character))
    assert tuple(bone.name for bone in scene.bones) == figure.bone_names
    assert tuple(bone.parent for bone in scene.bones) == figure.parents
    np.testing.assert_allclose([bone.translation_cm for bone in scene.bones], figure.translations_m * 100.0)
    np.testing.assert_allclose([bone.rotation_xyzw for bone in scene.bones], figure.rotations)
    assert [mesh.name for mesh in scene.meshes] == [f"x_{mesh.name}" for mesh in figure.meshes]
    assert scene.clip is not None
    # Only the hips are moved: every other bone keeps its place on its parent exactly.
    assert [scene.bones[bone].name for bone in scene.clip.translations_cm] == [PREFIX + "hips"]


def test_skin_is_where_it_is_on_ours() -> None:
    """Bound in the A-pose of the file, the same vertices are at the same places (twist bones have no skin here)."""
    character = foreign(ours())
    motion = random_motion(3)
    own = surfaces_m(played(character, motion, own_target(character)))
    normal = character_scene(character, motion, "x", "test")
    assert normal.clip is not None
    playback, world = ScenePlayback(normal, normal.clip), None
    world = playback.world(0, motion.frames)
    starts = np.cumsum([0, *(len(mesh.positions_m) for mesh in character.meshes)])
    rows = np.concatenate(
        [start + np.arange(0, len(mesh.positions_m), 7) for start, mesh in zip(starts, character.meshes, strict=False)]
    )
    expected = Surface(playback, normal.meshes[0], rows).positions_m(world, 0, motion.frames)
    assert np.linalg.norm(own - expected, axis=-1).max() / MM < 0.01
    assert np.ptp(expected, axis=0).max() > 0.1


def test_a_missing_upper_chest_leaves_arms_where_they_were() -> None:
    """A bone below a missing joint is moved relative to its parent: contacts matter more than constant bones."""
    character = foreign(ours(), lacking=("upperChest", "leftToes", "jaw"))
    motion = random_motion(5)
    target = own_target(character)
    playback = played(character, motion, target)
    assert_joints_agree(character, motion, target, playback)
    moved = {target.names[bone] for bone in playback.clip.translations_cm}
    assert moved == {PREFIX + name for name in ("hips", "neck", "leftShoulder", "rightShoulder")}


def test_several_roots_become_one_and_it_is_said() -> None:
    character = foreign(ours(), roots=3)
    target = own_target(character)
    assert target.names[0] == "root"
    assert target.parents.count(-1) == 1
    (message,) = target.messages
    assert message.id == "skeleton.root_added"
    assert message.arguments["bones"] == "Reference, prop_1, prop_2"
    assert own_target(foreign(ours())).messages == ()


def test_blenders_armature_is_no_bone() -> None:
    """Unreal omits the armature when importing the character, so the animation must not begin with it."""
    character = foreign(ours(), root="Armature")
    motion = random_motion(11)
    target = own_target(character)
    assert target.names[0] == PREFIX + "hips"
    assert target.messages[0].id == "skeleton.armature_left_out"
    assert check_skeleton(target, character.own.figure) == ()
    playback = played(character, motion, target)
    assert_joints_agree(character, motion, target, playback)
    whole = surfaces_m(played(foreign(ours()), motion, own_target(foreign(ours()))))
    assert np.linalg.norm(surfaces_m(playback) - whole, axis=-1).max() / MM < 0.01


def test_a_twist_bone_has_its_share() -> None:
    """A forearm's twist bone at 60 % of its length takes 60 % of the hand's twist; an upper arm's takes 40 % less than
    the whole.
    """
    character = foreign(ours())
    skeleton = character.skeleton
    still = random_motion(0, frames=3, reach_rad=0.0)
    rotations = still.rotations.astype(np.float64)
    twist_rad = np.radians([0.0, 40.0, -70.0])
    for joint, end in (("leftHand", "leftMiddleProximal"), ("rightUpperArm", "rightLowerArm")):
        parent = "leftLowerArm" if joint == "leftHand" else "rightUpperArm"
        tip = "leftHand" if joint == "leftHand" else end
        way = skeleton.offsets_m[skeleton.index(tip)]
        assert parent in skeleton.names
        rotations[:, skeleton.index(joint)] = quaternion.from_axis_angle(way / np.linalg.norm(way), twist_rad)
    motion = replace(still, rotations=rotations.astype(np.float32))
    target = own_target(character)
    turned = bone_motion(target, skeleton, motion).rotations
    for name, share in (("leftLowerArm_Twist1", 0.6), ("rightUpperArm_Twist1", -0.4)):
        bone = target.names.index(PREFIX + name)
        change = Rotation.from_quat(turned[:, bone]) * Rotation.from_quat(target.t_pose[bone]).inv()
        np.testing.assert_allclose(change.magnitude(), np.abs(share * twist_rad), atol=1e-5)
    other = target.names.index(PREFIX + "rightLowerArm_Twist1")
    np.testing.assert_allclose(np.abs(turned[:, other] @ target.t_pose[other]), 1.0, atol=1e-6)


def test_own_morphs_are_sums_of_arkit() -> None:
    character = foreign(ours())
    assert character.own is not None
    parts = {"jawOpen": {"Face.jawOpen": 0.8, "Face.mouthPucker": 0.1, "gone": 1.0}, "cheekPuff": {"Face.jawOpen": 0.5}}
    own = replace(character.own, morphs=parts)
    curves = {"jawOpen": np.float32([0.0, 0.5, 1.0]), "cheekPuff": np.float32([1.0, 1.0, 1.0]), "other": np.ones(3)}
    found = own_weights(curves, own)
    assert sorted(found) == ["Face.jawOpen", "Face.mouthPucker"]
    np.testing.assert_allclose(found["Face.jawOpen"], [0.5, 0.9, 1.0], atol=1e-6)
    np.testing.assert_allclose(found["Face.mouthPucker"], [0.0, 0.05, 0.1], atol=1e-6)


def test_the_judge_reads_joints_back_from_any_skeleton() -> None:
    character = foreign(ours(), in_chain="leftHand")
    motion = random_motion(9)
    for target in (own_target(character), mannequin_target(character.skeleton)):
        joints = JointPlayback(played(character, motion, target), target, character)
        rotations = joints.rotations(0, motion.frames)
        for joint in target.bone_of_joint:
            alike = np.abs(np.einsum("fi,fi->f", rotations[:, joint], motion.rotations[:, joint]))
            assert np.degrees(2 * np.arccos(np.clip(alike, -1, 1))).max() < 0.05, character.skeleton.names[joint]
        np.testing.assert_allclose(joints.curve("jawOpen"), motion.morphs["jawOpen"], atol=1e-6)


PUBLISHED = """
root pelvis spine_01 spine_02 spine_03 spine_04 spine_05 neck_01 neck_02 head
ik_foot_root ik_foot_l ik_foot_r ik_hand_root ik_hand_gun ik_hand_l ik_hand_r interaction center_of_mass
"""
PUBLISHED_SIDES = """
clavicle upperarm upperarm_twist_01 upperarm_twist_02 lowerarm lowerarm_twist_01 lowerarm_twist_02 hand
thumb_01 thumb_02 thumb_03 index_metacarpal index_01 index_02 index_03 middle_metacarpal middle_01 middle_02 middle_03
ring_metacarpal ring_01 ring_02 ring_03 pinky_metacarpal pinky_01 pinky_02 pinky_03
thigh thigh_twist_01 thigh_twist_02 calf calf_twist_01 calf_twist_02 foot ball
"""
PUBLISHED_PARENTS = {
    "pelvis": "root", "spine_01": "pelvis", "spine_05": "spine_04", "neck_01": "spine_05", "head": "neck_02",
    "clavicle_l": "spine_05", "upperarm_r": "clavicle_r", "upperarm_twist_02_l": "upperarm_l",
    "lowerarm_twist_01_r": "lowerarm_r", "hand_l": "lowerarm_l", "thumb_01_l": "hand_l", "thumb_03_l": "thumb_02_l",
    "index_metacarpal_r": "hand_r", "index_01_r": "index_metacarpal_r", "pinky_03_l": "pinky_02_l",
    "thigh_l": "pelvis", "calf_twist_02_l": "calf_l", "ball_r": "foot_r", "ik_foot_l": "ik_foot_root",
    "ik_hand_gun": "ik_hand_root", "ik_hand_l": "ik_hand_gun", "ik_hand_r": "ik_hand_gun", "ik_foot_root": "root",
    "interaction": "root", "center_of_mass": "root",
}  # fmt: skip


def test_the_mannequin_has_the_published_bones() -> None:
    sides = {f"{name}_{side}" for name in PUBLISHED_SIDES.split() for side in "lr"}
    assert set(MANNEQUIN) == set(PUBLISHED.split()) | sides
    assert len(MANNEQUIN) == 89
    assert {name: MANNEQUIN[name] for name in PUBLISHED_PARENTS} == PUBLISHED_PARENTS


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10_000))
def test_the_mannequin_moves_as_ours(seed: int) -> None:
    motion = random_motion(seed)
    target = mannequin_target(ours().skeleton)
    playback = played(ours(), motion, target)
    assert_joints_agree(ours(), motion, target, playback)
    world = playback.world(0, motion.frames)
    names = playback.bone_names
    for tied, to in (
        ("ik_hand_gun", "hand_r"),
        ("ik_hand_l", "hand_l"),
        ("ik_hand_r", "hand_r"),
        ("ik_foot_l", "foot_l"),
    ):
        np.testing.assert_allclose(world[:, names.index(tied)], world[:, names.index(to)], atol=1e-6)
    np.testing.assert_allclose(world[:, names.index("root"), :3, 3], 0.0, atol=1e-9)


def test_the_mannequins_skin_is_ours() -> None:
    """The eyes look straight ahead, since the mannequin has no bones for them."""
    motion = random_motion(4)
    eyes = [ours().skeleton.index(name) for name in ("leftEye", "rightEye")]
    motion.rotations[:, eyes] = quaternion.IDENTITY
    normal = character_scene(ours(), motion, "x", "test")
    assert normal.clip is not None
    expected = surfaces_m(ScenePlayback(normal, normal.clip))
    found = surfaces_m(played(ours(), motion, mannequin_target(ours().skeleton)))
    assert np.linalg.norm(expected - found, axis=-1).max() / MM < 0.01


def test_an_assets_rest_rotations_are_taken() -> None:
    """A rotation has the same effect on the exported file and on the asset if both have the same axes."""
    plain = mannequin_target(ours().skeleton)
    _, turned = world_placements(plain.parents, plain.offsets_m, plain.t_pose)
    random = Rotation.random(len(plain.names), random_state=3)
    t_pose = dict(zip(plain.names, (Rotation.from_quat(turned) * random).as_quat(), strict=True))
    rest = dict(zip(plain.names, Rotation.random(len(plain.names), random_state=4).as_quat(), strict=True))
    target = mannequin_target(ours().skeleton, MannequinAxes(rest, t_pose))
    np.testing.assert_allclose(target.rest, np.array(list(rest.values())))
    _, found = world_placements(target.parents, target.offsets_m, target.t_pose)
    for bone, name in enumerate(target.names):
        if bone not in target.tied:
            assert abs(found[bone] @ t_pose[name]) == pytest.approx(1.0, abs=1e-9)
    motion = random_motion(8)
    assert_joints_agree(ours(), motion, target, played(ours(), motion, target))
