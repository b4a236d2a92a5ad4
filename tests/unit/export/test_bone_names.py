"""BVH files with the bone names of other programs contain the same motion."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.export.bvh_clip import joint_names, profile_names, scene_bvh
from app.export.character import character_scene
from app.export.joints import world_transforms
from app.export.playback import ScenePlayback
from app.export.target import SkeletonChoice, TargetSkeleton
from app.export.targets import target_skeleton
from app.formats.bvh.clip import BvhClip
from app.formats.bvh.read import read_bvh
from app.formats.scene import Scene
from app.motion.model import Motion
from app.rig.characters.character_library import character_named
from app.rig.characters.joint_mapping import map_joints
from app.rig.model import Character
from metadata.load import load_bone_names, load_skeleton
from tests.support.encoded import encode_bvh
from tests.support.skeletons import ListedBone, figure_of
from tests.unit.formats import scenes

PROFILES = sorted(load_bone_names())


@pytest.mark.parametrize(
    ("profile", "names"),
    [
        ("cmu", {"hips": "Hips", "spine": "LowerBack", "upperChest": "Spine1", "leftUpperLeg": "LeftUpLeg"}),
        ("mixamo", {"chest": "Spine1", "rightLowerArm": "RightForeArm", "leftLittleDistal": "LeftHandPinky3"}),
        ("unreal", {"hips": "pelvis", "upperChest": "spine_03", "leftShoulder": "clavicle_l"}),
        ("rigify", {"hips": "spine", "spine": "spine.001", "leftHand": "hand.L"}),
    ],
)
def test_joints_have_the_names_that_people_know(profile: str, names: dict[str, str]) -> None:
    found = joint_names(load_bone_names()[profile])
    assert {joint: found[joint] for joint in names} == names


@pytest.mark.parametrize("profile", PROFILES)
def test_every_profile_names_joints_of_ours_differently(profile: str) -> None:
    found = joint_names(load_bone_names()[profile])
    assert set(found) <= {joint.name for joint in load_skeleton().joints}
    assert {"hips", "head", "leftHand", "rightFoot"} <= set(found)
    assert len(set(found.values())) == len(found)


def _scene(choice: SkeletonChoice = "suisou") -> tuple[Scene, TargetSkeleton, Character]:
    """Character with random motion for a few frames on a skeleton."""
    character = character_named("woman_adult")
    turns = scenes.rotations(5, 6, len(character.skeleton.names), 0.4).astype(np.float32)
    turns[:, 0] = [0, 0, 0, 1]
    hips_m = np.float32([0.0, 0.95, 0.0] + 0.05 * np.sin(np.arange(6.0))[:, None])
    still = np.zeros((6, 3), np.float32), np.tile(np.float32([0, 0, 0, 1]), (6, 1))
    motion = Motion(Fraction(30), 0.0, turns, hips_m, {}, {}, *still)
    target = target_skeleton(character, choice)
    return character_scene(character, motion, "take", "Suisou", target), target, character


def _listed(clip: BvhClip) -> list[ListedBone]:
    """Bones of a BVH file with their rest positions on the ground."""
    places_m = np.array(clip.offsets_cm) / 100
    for bone, parent in enumerate(clip.parents):
        places_m[bone] += places_m[parent] if parent >= 0 else 0.0
    places_m[:, 1] -= places_m[:, 1].min()
    return [
        ListedBone(name, clip.names[parent] if parent >= 0 else "", (float(x), float(y), float(z)), "")
        for name, parent, (x, y, z) in zip(clip.names, clip.parents, places_m, strict=True)
    ]


@pytest.mark.parametrize("profile", PROFILES)
def test_the_motion_is_the_same_and_the_mapper_knows_the_bones(profile: str, tmp_path: Path) -> None:
    scene, target, character = _scene()
    plain = scene_bvh(scene)
    names = profile_names(profile, target, character.skeleton)
    (tmp_path / "named.bvh").write_bytes(encode_bvh(scene_bvh(scene, names)))
    named = read_bvh(tmp_path / "named.bvh")
    assert named.parents == plain.parents
    np.testing.assert_allclose(named.offsets_cm, plain.offsets_cm, atol=1e-6)
    np.testing.assert_allclose(named.root_translation_cm, plain.root_translation_cm, atol=1e-5)
    same = np.abs(np.einsum("fji,fji->fj", named.rotations_xyzw, plain.rotations_xyzw))
    np.testing.assert_allclose(same, 1.0, atol=1e-6)
    # Mapping that another program derives from the names alone.
    mapping = map_joints(figure_of(_listed(named)))
    meant = {joint: bone for bone, joint in enumerate(plain.names) if joint in joint_names(load_bone_names()[profile])}
    found = {joint: bone for joint, bone in mapping.bones.items() if joint in meant}
    assert {joint: named.names[bone] for joint, bone in found.items()} == {
        joint: named.names[bone] for joint, bone in meant.items()
    }


def test_on_another_skeleton_its_joints_get_the_names_and_the_hips_the_motion() -> None:
    scene, target, character = _scene("ue5")
    assert len(scene.clip.translations_cm) > 1  # hands that props hang on
    clip = scene_bvh(scene)
    assert clip.names[0] == "pelvis"
    named = scene_bvh(scene, profile_names("mixamo", target, character.skeleton))
    assert named.names[0] == "Hips"
    assert {"LeftHandIndex1", "RightForeArm"} <= set(named.names)
    assert "lowerarm_twist_01_l" in named.names
    # The hand has the same position in the world as in the scene.
    hand = clip.names.index("hand_l")
    bone = [bone.name for bone in scene.bones].index("hand_l")
    offsets = np.tile(clip.offsets_cm, (6, 1, 1))
    offsets[:, 0] = clip.root_translation_cm
    world = world_transforms(clip.parents, offsets, np.asarray(clip.rotations_xyzw, np.float64))
    meant = ScenePlayback(scene, scene.clip).world(0, 6)[:, bone, :3, 3] * 100
    np.testing.assert_allclose(world[:, hand, :3, 3], meant, atol=1e-3)


def test_names_that_bvh_cannot_have_are_joined_and_distinguished() -> None:
    scene, _, _ = _scene()
    odd = [replace(bone, name="Bip01 L Thigh" if bone.name == "leftUpperLeg" else bone.name) for bone in scene.bones]
    odd[5] = replace(odd[5], name="bip01_l_thigh")
    clip = scene_bvh(replace(scene, bones=tuple(odd)))
    assert {"Bip01_L_Thigh_2", "bip01_l_thigh"} <= set(clip.names) or {"Bip01_L_Thigh", "bip01_l_thigh_2"} <= set(
        clip.names
    )
    encode_bvh(clip)
