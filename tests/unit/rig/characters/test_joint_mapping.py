"""Joints for the bones of foreign skeletons: by the file's own data, by names, by shape, and by the user's
corrections.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import FileError
from app.messages import WORDINGS
from app.rig.characters.joint_mapping import JointMapping, map_joints
from metadata.known_names import BoneNames
from metadata.load import load_bone_names, load_skeleton
from metadata.model import REQUIRED_JOINTS
from tests.support.skeletons import FOLDER, ListedBone, figure_of, listed

LISTS = sorted(path.stem for path in FOLDER.glob("*.tsv"))
TABLE = {
    "bvh_biovision": "biovision",
    "bvh_cmu": "cmu",
    "bvh_drawings": "mixamo",
    "bvh_poser": "poser",
    "cmu": "cmu",
    "game_engine": "unreal",
    "makehuman": "makehuman",
    "mixamo": "mixamo",
    "rigify": "rigify",
    "rigify_deform": "rigify",
    "unreal5": "unreal",
}
JOINTS = [joint.name for joint in load_skeleton().joints if joint.name != "root"]
BODY = {joint for joint in JOINTS if joint not in ("jaw", "leftEye", "rightEye")}


def by_name(bones: list[ListedBone], mapping: JointMapping) -> dict[str, str]:
    return {joint: bones[bone].name for joint, bone in mapping.bones.items()}


def known(bones: list[ListedBone]) -> dict[str, str]:
    return {bone.joint: bone.name for bone in bones if bone.joint}


@pytest.mark.parametrize("name", LISTS)
def test_published_skeletons_are_known_by_their_names(name: str) -> None:
    bones = listed(name)
    mapping = map_joints(figure_of(bones))
    assert by_name(bones, mapping) == known(bones)
    assert mapping.profile == TABLE[name]
    assert mapping.doubtful == ()
    assert set(mapping.missing) == set(JOINTS) - set(known(bones))


@pytest.mark.parametrize("name", [name for name in LISTS if name != "cmu" and not name.startswith("bvh")])
def test_a_skeleton_whose_names_say_nothing_is_known_by_its_shape(name: str) -> None:
    bones = listed(name)
    order = {bone.name: f"b{index * 7919 % 1000:03d}x{index}" for index, bone in enumerate(bones)}
    mapping = map_joints(figure_of(bones, rename=order.__getitem__))
    expected = {joint: bone for joint, bone in known(bones).items() if joint in BODY}
    found = {joint: bone for joint, bone in by_name(bones, mapping).items() if joint in expected}
    assert found == expected
    assert mapping.profile == ""
    assert set(mapping.doubtful) == set(mapping.bones)


@pytest.mark.parametrize("table", load_bone_names().values(), ids=lambda table: table.name)
def test_every_table_maps_all_its_joints_on_both_sides(table: BoneNames) -> None:
    """A skeleton with the first name of each of the table's joints on another maker's body."""
    body = {bone.joint: bone for bone in listed("rigify") if bone.joint}
    firsts = {joint: names[0] for joint, names in table.keys().items()}
    for joint, own in zip(("spine", "chest", "upperChest"), (f"spine.{i}" for i in range(3)), strict=True):
        if own in firsts:
            firsts[joint] = firsts[own]
    profile = load_skeleton()
    bones = [ListedBone("xyz", "", (0.0, 0.0, 0.0), "")]
    for joint in JOINTS:
        if joint in firsts:
            parent = profile.joint(joint).parent
            while parent not in firsts and parent:
                parent = profile.joint(parent).parent if parent != "root" else ""
            bones.append(ListedBone(firsts[joint], firsts.get(parent, "xyz"), body[joint].place_m, joint))
    mapping = map_joints(figure_of(bones))
    assert by_name(bones, mapping) == known(bones)
    assert mapping.profile == table.name or mapping.doubtful == ()
    assert set(REQUIRED_JOINTS) <= set(mapping.bones)


@settings(max_examples=25, deadline=None)
@given(
    name=st.sampled_from(LISTS),
    seed=st.integers(0, 2**32 - 1),
    prefix=st.sampled_from(["", "Armature|", "mixamorig1_", "ns:sub:", "Character1_", "DEF-", "chr_body_", "J_Bip_C_"]),
    suffix=st.sampled_from(["", "_jnt", ".x", "_01234"]),
    extra=st.integers(0, 40),
)
def test_order_affixes_and_other_bones_change_nothing(
    name: str, seed: int, prefix: str, suffix: str, extra: int
) -> None:
    dice = random.Random(seed)
    bones = listed(name)
    for index in range(extra):
        near = dice.choice(bones)
        place = tuple(value + dice.uniform(-0.05, 0.05) for value in near.place_m)
        bones.append(ListedBone(f"hair_{index}_strand", near.name, place, ""))
    bones = shuffled(bones, dice)
    mapping = map_joints(figure_of(bones, rename=lambda bone: f"{prefix}{bone}{suffix}"))
    assert by_name(bones, mapping) == known(bones)


def shuffled(bones: list[ListedBone], dice: random.Random) -> list[ListedBone]:
    """Bones in another order, with parents before their children."""
    rest, done, order = list(bones), {""}, []
    while rest:
        bone = dice.choice([bone for bone in rest if bone.parent in done])
        rest.remove(bone)
        done.add(bone.name)
        order.append(bone)
    return order


@pytest.mark.parametrize(
    "rename",
    [
        lambda bone: bone.upper(),
        lambda bone: bone.replace("_", "-"),
        lambda bone: bone.replace("_", " "),
        lambda bone: bone.replace("mixamorig:", "mixamorig_"),
    ],
)
@pytest.mark.parametrize("name", ["unreal5", "mixamo"])
def test_case_and_separators_do_not_matter(name: str, rename: Callable[[str], str]) -> None:
    bones = listed(name)
    assert by_name(bones, map_joints(figure_of(bones, rename=rename))) == known(bones)


def test_numbers_that_a_program_added_to_every_name_are_no_part_of_it() -> None:
    bones = listed("mixamo")
    number = {bone.name: index for index, bone in enumerate(bones)}
    mapping = map_joints(figure_of(bones, rename=lambda bone: f"{bone}_{number[bone]:02d}"))
    assert by_name(bones, mapping) == known(bones)


def test_of_a_rig_the_bones_that_move_the_skin_are_taken() -> None:
    """Controls, mechanisms and original bones have the same names; Rigify's deforming bones are children of the
    originals.
    """
    own = listed("rigify")
    bones = [ListedBone("root", "", (0.0, 0.0, 0.0), "")]
    for bone in own:
        for layer in ("", "ORG-", "MCH-", "DEF-"):
            parent = f"{'ORG-' if layer == 'DEF-' else layer}{bone.parent}" if bone.parent else "root"
            bones.append(replace(bone, name=f"{layer}{bone.name}", parent=parent, joint=""))
    figure = figure_of(bones, skinned=[f"DEF-{bone.name}" for bone in own])
    mapping = map_joints(figure)
    assert by_name(bones, mapping) == {joint: f"DEF-{bone}" for joint, bone in known(own).items()}
    assert mapping.profile == "rigify"
    # The bones are not connected, so the mapping is reported as doubtful.
    assert "leftUpperArm" in mapping.doubtful


SPELLINGS = {
    "side last": ("unity", """
        hips=Hips spine=Spine chest=Chest upperChest=Upper_Chest neck=Neck head=Head Shoulder=Shoulder.L
        UpperArm=Upper_Arm.L LowerArm=Lower_Arm.L Hand=Hand.L UpperLeg=Upper_Leg.L LowerLeg=Lower_Leg.L Foot=Foot.L
        Toes=Toes.L ThumbMetacarpal=Thumb_Proximal.L IndexProximal=Index_Proximal.L
        LittleProximal=Little_Proximal.L"""),
    "side first": ("unity", """
        hips=hips spine=spine chest=chest head=head UpperArm=L_UpperArm LowerArm=L_LowerArm Hand=L_Hand
        UpperLeg=L_UpperLeg LowerLeg=L_LowerLeg Foot=L_Foot Toes=L_Toe"""),
    "cats": ("cats", """
        hips=Hips spine=Spine chest=Chest neck=Neck head=Head Shoulder=Left_shoulder UpperArm=Left_arm
        LowerArm=Left_elbow Hand=Left_wrist UpperLeg=Left_leg LowerLeg=Left_knee Foot=Left_ankle Toes=Left_toe
        ThumbMetacarpal=Thumb0_L
        ThumbProximal=Thumb1_L ThumbDistal=Thumb2_L IndexProximal=IndexFinger1_L"""),
    "mmd tools": ("cats", """
        hips=center spine=upper_body chest=upper_body2 neck=neck head=head Shoulder=shoulder_L UpperArm=arm_L
        LowerArm=elbow_L Hand=wrist_L UpperLeg=leg_L LowerLeg=knee_L Foot=ankle_L Toes=toe_L ThumbMetacarpal=thumb0_L
        IndexProximal=fore1_L RingProximal=third1_L"""),
    "mmd": ("mmd", """
        hips=センター spine=上半身 chest=上半身2 neck=首 head=頭 Shoulder=左肩 UpperArm=左腕 LowerArm=左ひじ Hand=左手首
        UpperLeg=左足 LowerLeg=左ひざ Foot=左足首 Toes=左つま先 ThumbProximal=左親指１ ThumbDistal=左親指２
        IndexProximal=左人指１ MiddleProximal=左中指１ RingProximal=左薬指１ LittleProximal=左小指１ Eye=左目"""),
    "character creator": ("character_creator", """
        hips=CC_Base_Hip spine=CC_Base_Waist chest=CC_Base_Spine01 upperChest=CC_Base_Spine02 neck=CC_Base_NeckTwist01
        head=CC_Base_Head Shoulder=CC_Base_L_Clavicle UpperArm=CC_Base_L_Upperarm LowerArm=CC_Base_L_Forearm
        Hand=CC_Base_L_Hand UpperLeg=CC_Base_L_Thigh LowerLeg=CC_Base_L_Calf Foot=CC_Base_L_Foot Toes=CC_Base_L_ToeBase
        MiddleProximal=CC_Base_L_Mid1"""),
    "biped": ("biped", """
        hips=Bip001_Pelvis spine=Bip001_Spine chest=Bip001_Spine1 neck=Bip001_Neck head=Bip001_Head
        Shoulder=Bip001_L_Clavicle UpperArm=Bip001_L_UpperArm LowerArm=Bip001_L_Forearm Hand=Bip001_L_Hand
        UpperLeg=Bip001_L_Thigh LowerLeg=Bip001_L_Calf Foot=Bip001_L_Foot Toes=Bip001_L_Toe0
        ThumbMetacarpal=Bip001_L_Finger0 ThumbProximal=Bip001_L_Finger01 IndexProximal=Bip001_L_Finger1
        IndexIntermediate=Bip001_L_Finger11 IndexDistal=Bip001_L_Finger12"""),
    "daz": ("daz", """
        hips=hip spine=abdomenLower chest=chestLower upperChest=chestUpper neck=neckLower head=head Shoulder=lCollar
        UpperArm=lShldrBend LowerArm=lForearmBend Hand=lHand UpperLeg=lThighBend LowerLeg=lShin Foot=lFoot Toes=lToe
        ThumbMetacarpal=lThumb1 MiddleProximal=lMid1 LittleProximal=lPinky1"""),
    "vroid": ("vroid", """
        hips=J_Bip_C_Hips spine=J_Bip_C_Spine chest=J_Bip_C_Chest upperChest=J_Bip_C_UpperChest neck=J_Bip_C_Neck
        head=J_Bip_C_Head Shoulder=J_Bip_L_Shoulder UpperArm=J_Bip_L_UpperArm LowerArm=J_Bip_L_LowerArm
        Hand=J_Bip_L_Hand UpperLeg=J_Bip_L_UpperLeg LowerLeg=J_Bip_L_LowerLeg Foot=J_Bip_L_Foot Toes=J_Bip_L_ToeBase
        ThumbMetacarpal=J_Bip_L_Thumb1 LittleProximal=J_Bip_L_Little1 Eye=J_Adj_L_FaceEye"""),
    "unity-chan": ("mixamo", """
        hips=Character1_Hips spine=Character1_Spine chest=Character1_Spine1 upperChest=Character1_Spine2
        neck=Character1_Neck head=Character1_Head Shoulder=Character1_LeftShoulder UpperArm=Character1_LeftArm
        LowerArm=Character1_LeftForeArm Hand=Character1_LeftHand UpperLeg=Character1_LeftUpLeg
        LowerLeg=Character1_LeftLeg Foot=Character1_LeftFoot Toes=Character1_LeftToeBase
        ThumbMetacarpal=Character1_LeftHandThumb1 RingProximal=Character1_LeftHandRing1"""),
}  # fmt: skip
"""Names of joints in the style of various makers, those of the left side for both."""
OTHER_SIDE = (("Left", "Right"), ("左", "右"), ("_L_", "_R_"), (".L", ".R"), ("_L", "_R"))


def other_side(name: str) -> str:
    if name.startswith("L_") or not any(left in name for left, _ in OTHER_SIDE):
        return {"l": "r", "L": "R"}[name[0]] + name[1:]
    left, right = next((left, right) for left, right in OTHER_SIDE if left in name)
    return name.replace(left, right)


def spelt(pairs: str) -> list[ListedBone]:
    """Body with these bone names."""
    body, profile = {bone.joint: bone for bone in listed("rigify") if bone.joint}, load_skeleton()
    names: dict[str, str] = {}
    for joint, name in (pair.split("=") for pair in pairs.split()):
        if joint[0].isupper():
            names |= {f"left{joint}": name, f"right{joint}": other_side(name)}
        else:
            names[joint] = name
    bones = [ListedBone("stage", "", (0.0, 0.0, 0.0), "")]
    for joint in sorted(names, key=JOINTS.index):
        above = profile.joint(joint).parent
        while above not in names and above != "root":
            above = profile.joint(above).parent
        bones.append(ListedBone(names[joint], names.get(above, "stage"), body[joint].place_m, joint))
    return bones


@pytest.mark.parametrize(("profile", "pairs"), SPELLINGS.values(), ids=SPELLINGS)
def test_names_as_other_makers_write_them(profile: str, pairs: str) -> None:
    bones = spelt(pairs)
    mapping = map_joints(figure_of(bones))
    assert by_name(bones, mapping) == known(bones)
    assert mapping.profile == profile
    assert mapping.doubtful == ()


def test_left_is_where_the_body_has_it() -> None:
    bones = listed("mixamo")
    mirrored = [replace(bone, place_m=(-bone.place_m[0], *bone.place_m[1:])) for bone in bones]
    mapping = map_joints(figure_of(mirrored))
    names = by_name(mirrored, mapping)
    assert names["leftHand"] == "mixamorig:RightHand"
    assert names["rightIndexProximal"] == "mixamorig:LeftHandIndex1"
    assert names["leftFoot"] == "mixamorig:RightFoot"
    assert {"leftHand", "rightFoot", "leftThumbDistal"} <= set(mapping.doubtful)
    assert "hips" not in mapping.doubtful


def test_a_figure_that_faces_sideways_keeps_the_sides_it_names() -> None:
    bones = listed("mixamo")
    turned = [
        replace(bone, place_m=(bone.place_m[2] - 0.002 * bone.place_m[0], bone.place_m[1], -bone.place_m[0]))
        for bone in bones
    ]
    assert by_name(turned, map_joints(figure_of(turned))) == known(bones)


@pytest.mark.parametrize(
    ("count", "expected"),
    [
        (1, {"spine": 1}),
        (2, {"spine": 1, "chest": 2}),
        (3, {"spine": 1, "chest": 2, "upperChest": 3}),
        (4, {"spine": 1, "chest": 2, "upperChest": 4}),
        (5, {"spine": 1, "chest": 3, "upperChest": 5}),
    ],
)
def test_a_spine_of_any_length_is_spread(count: int, expected: dict[str, int]) -> None:
    bones = [bone for bone in listed("unreal5") if not bone.name.startswith("spine")]
    top = f"spine_0{count}"
    bones = [replace(bone, parent=top) if bone.parent == "spine_05" else bone for bone in bones]
    at = next(index for index, bone in enumerate(bones) if bone.name == "pelvis") + 1
    spine = [
        ListedBone(f"spine_0{i}", "pelvis" if i == 1 else f"spine_0{i - 1}", (0.0, 0.9 + 0.4 * i / count, 0.0), "")
        for i in range(1, count + 1)
    ]
    bones[at:at] = spine
    names = by_name(bones, map_joints(figure_of(bones)))
    found = {joint: names.get(joint) for joint in ("spine", "chest", "upperChest")}
    assert found == {joint: f"spine_0{expected[joint]}" if joint in expected else None for joint in found}


def test_a_thumb_of_two_bones_is_reported_by_where_it_begins() -> None:
    bones = [bone for bone in listed("mixamo") if bone.name != "mixamorig:LeftHandThumb3"]
    names = by_name(bones, map_joints(figure_of(bones)))
    assert names["leftThumbMetacarpal"] == "mixamorig:LeftHandThumb1"
    assert "leftThumbDistal" not in names
    second = next(bone for bone in bones if bone.name == "mixamorig:LeftHandThumb2")
    bones = [
        replace(bone, place_m=second.place_m) if bone.name == "mixamorig:LeftHandThumb1" else bone for bone in bones
    ]
    names = by_name(bones, map_joints(figure_of(bones)))
    assert names["leftThumbProximal"] == "mixamorig:LeftHandThumb1"
    assert names["leftThumbDistal"] == "mixamorig:LeftHandThumb2"
    assert "leftThumbMetacarpal" not in names


def test_what_the_file_says_wins_over_names() -> None:
    bones = listed("makehuman")
    at = {bone.name: index for index, bone in enumerate(bones)}
    own = {joint: at[bone] for joint, bone in known(bones).items() if joint in REQUIRED_JOINTS}
    own["spine"] = at["spine04"]
    mapping = map_joints(figure_of(bones, humanoid=own))
    names = by_name(bones, mapping)
    assert mapping.profile == "vrm1"
    assert names["spine"] == "spine04"
    # Missing joints of the trunk are not added; those of fingers and eyes are.
    assert "upperChest" in mapping.missing
    assert names["leftIndexProximal"] == "finger2-1.L"
    assert names["rightEye"] == "eye.R"


def test_the_users_choice_wins() -> None:
    bones = listed("unreal5")
    requested = {"chest": "spine_02", "leftThumbDistal": "", "jaw": "neck_02"}
    mapping = map_joints(figure_of(bones), requested)
    names = by_name(bones, mapping)
    assert names["chest"] == "spine_02"
    assert names["jaw"] == "neck_02"
    assert "leftThumbDistal" in mapping.missing
    # A bone is one joint.
    names = by_name(bones, map_joints(figure_of(bones), {"chest": "spine_01"}))
    assert names["chest"] == "spine_01"
    assert "spine" not in names


@pytest.mark.parametrize(
    ("requested", "message", "named"),
    [
        ({"chest": "spine_99"}, "figure.no_bone", {"bone": "spine_99", "joint": "chest"}),
        ({"breast": "spine_02"}, "figure.no_joint", {"joint": "breast"}),
    ],
)
def test_a_correction_that_names_nothing_is_refused(
    requested: dict[str, str], message: str, named: dict[str, str]
) -> None:
    with pytest.raises(FileError) as caught:
        map_joints(figure_of(listed("unreal5")), requested)
    assert caught.value.message.id == message
    assert named.items() <= caught.value.message.arguments.items()
    assert WORDINGS[message][0].format(**caught.value.message.arguments)


def test_a_skeleton_that_is_no_body_has_no_joints() -> None:
    chain = [ListedBone(f"link{i}", f"link{i - 1}" if i else "", (0.0, 0.1 * i, 0.0), "") for i in range(12)]
    mapping = map_joints(figure_of(chain))
    assert mapping.bones == {}
    assert set(mapping.missing) == set(JOINTS)


CASTS = {
    # Trunk upwards; shoulder to hand and thigh to toes with {s} for the side; words for the sides; fingers.
    "Second Life": (
        "mPelvis mTorso mSpine3 mChest mNeck mHead",
        "mCollar{s} mShoulder{s} mElbow{s} mWrist{s} mHip{s} mKnee{s} mAnkle{s} mFoot{s}",
        ("Left", "Right"),
        "mHand{finger}{number}{s}",
    ),
    "OptiTrack": (
        "Hips Ab Spine2 Chest Neck Head",
        "{s}Shoulder {s}UArm {s}FArm {s}Hand {s}Thigh {s}Shin {s}Foot {s}Toe",
        ("L", "R"),
        "{s}{finger}{number}",
    ),
    "Quaternius": (
        "Hips Abdomen Torso Chest Neck Head",
        "Shoulder.{s} UpperArm.{s} LowerArm.{s} Fist.{s} UpperLeg.{s} LowerLeg.{s} Foot.{s} Toes.{s}",
        ("L", "R"),
        "{finger}{number}.{s}",
    ),
    "Perception Neuron": (
        "Hips Spine Spine1 Spine2 Neck Head",
        "{s}Shoulder {s}Arm {s}ForeArm {s}Hand {s}UpLeg {s}Leg {s}Foot {s}Ball",
        ("Left", "Right"),
        "{s}InHand{finger}{number}",
    ),
    "limbs without elbows and knees": (
        "Bauch Ruecken Brust Hals Neck Head",
        "{s}Collar {s}Shoulder bend_{s}_a {s}Hand {s}UpperLeg bend_{s}_b {s}Foot {s}Toes",
        ("Left", "Right"),
        "f{number}{finger}{s}",
    ),
}


def cast(name: str, bones: list[ListedBone]) -> dict[str, str]:
    """New names for a body's bones."""
    trunk, limbs, sides, digits = CASTS[name]
    new = dict(zip(("hips", "spine", "chest", "upperChest", "neck", "head"), trunk.split(), strict=True))
    parts = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")
    for side, word in zip(("left", "right"), sides, strict=True):
        new |= {side + part: limb.replace("{s}", word) for part, limb in zip(parts, limbs.split(), strict=True)}
        for joint in JOINTS:
            for number, part in enumerate(("Proximal", "Intermediate", "Distal"), 1):
                finger = joint.removeprefix(side).removesuffix(part)
                if joint.startswith(side) and joint.endswith(part):
                    place = (1 if part == "Proximal" else 2) + 1 if finger == "Thumb" else number
                    new[joint] = digits.format(s=word, finger=finger.replace("Little", "Pinky"), number=place)
        new[f"{side}ThumbMetacarpal"] = digits.format(s=word, finger="Thumb", number=1)
    return {bone.name: new.get(bone.joint, bone.name) for bone in bones}


def without(bones: list[ListedBone], joints: str) -> list[ListedBone]:
    """Body without some joints, whose children are attached to their parents."""
    above = {bone.name: bone.parent for bone in bones if re.search(joints, bone.joint)}
    left = []
    for bone in bones:
        parent = bone.parent
        while parent in above:
            parent = above[parent]
        if bone.name not in above:
            left.append(replace(bone, parent=parent))
    return left


def hanging(bones: list[ListedBone], joint: str, name: str, step: tuple[float, float, float], count: int) -> None:
    """Attach a chain that is no limb to a joint."""
    parent = next(bone for bone in bones if bone.joint == joint)
    for number in range(count):
        place = tuple(value + step[axis] for axis, value in enumerate(parent.place_m))
        parent = ListedBone(f"{name}_{number}", parent.name, (place[0], place[1], place[2]), "")
        bones.append(parent)


def with_tail_and_wings(bones: list[ListedBone]) -> list[ListedBone]:
    bones = list(bones)
    hanging(bones, "hips", "tail", (0.0, -0.02, -0.12), 6)
    for sign in (1.0, -1.0):
        hanging(bones, "upperChest", f"wing{sign}", (sign * 0.3, 0.06, -0.08), 4)
        hanging(bones, "head", f"plait{sign}", (sign * 0.05, -0.12, -0.03), 8)
        hanging(bones, "hips", f"skirt{sign}", (sign * 0.05, -0.15, 0.03), 5)
    return bones


def with_loose_feet(bones: list[ListedBone]) -> list[ListedBone]:
    """Body with feet attached to the root, as in rigs that pull legs by the feet; each leg ends in a bone
    without skin.
    """
    found = [ListedBone("Rig", "", (0.0, 0.0, 0.0), "")]
    for bone in bones:
        if bone.joint.endswith("Foot"):
            found.append(ListedBone(f"{bone.parent}_end", bone.parent, bone.place_m, ""))
        found.append(replace(bone, parent="Rig") if bone.joint.endswith("Foot") or not bone.parent else bone)
    return found


BODIES: dict[str, Callable[[list[ListedBone]], list[ListedBone]]] = {
    "as it is": list,
    "without toes": lambda bones: without(bones, "Toes"),
    "without fingers": lambda bones: without(bones, "Thumb|Index|Middle|Ring|Little"),
    "with four fingers": lambda bones: without(bones, "Little"),
    "without shoulders": lambda bones: without(bones, "Shoulder"),
    "with a spine of two": lambda bones: without(bones, "upperChest"),
    "tail, wings, plaits, skirt": with_tail_and_wings,
    "loose feet": with_loose_feet,
    "loose feet without toes": lambda bones: with_loose_feet(without(bones, "Toes")),
}


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("name", CASTS)
def test_where_names_leave_joints_out_the_shape_decides(name: str, body: str) -> None:
    bones = BODIES[body](listed("game_engine"))
    names = cast(name, bones)
    mapping = map_joints(
        figure_of(
            bones,
            rename=lambda bone: names[bone],
            skinned=[bone.name for bone in bones if not bone.name.endswith("_end") and bone.name != "Rig"],
        )
    )
    expected = known(bones)
    found = {joint: bone for joint, bone in by_name(bones, mapping).items() if joint in BODY}
    assert found == {joint: bone for joint, bone in expected.items() if joint in BODY}


def test_what_names_and_shape_agree_on_is_no_guess() -> None:
    bones = listed("game_engine")
    names = cast("Second Life", bones)
    mapping = map_joints(figure_of(bones, rename=lambda bone: names[bone]))
    assert {"leftUpperArm", "leftShoulder", "spine", "hips"} <= set(mapping.doubtful)
    assert not {"leftHand", "rightLowerLeg", "head"} & set(mapping.doubtful)


def test_hips_beside_the_legs_are_no_hips() -> None:
    """Quaternius: the bone Body is the parent of both legs and of the bone named Hips, which carries the spine."""
    own = {bone.joint: bone for bone in listed("game_engine")}
    bones = []
    for bone in listed("game_engine"):
        if bone.joint == "hips":
            bones.append(replace(bone, name="Body"))
            bones.append(replace(bone, parent="Body", joint=""))
        else:
            legs = bone.joint.endswith("UpperLeg")
            bones.append(replace(bone, parent="Body") if legs else bone)
    names = cast("Quaternius", list(own.values())) | {"Body": "Body", own["hips"].name: "Hips"}
    figure = figure_of(bones, rename=lambda bone: names.get(bone, bone))
    found = {joint: figure.bone_names[bone] for joint, bone in map_joints(figure).bones.items()}
    assert found["hips"] == "Body"
    assert found["spine"] == "Hips"
    assert found["leftUpperLeg"] == "UpperLeg.L"
