"""Bones of foreign skeletons become joints: by the file's word, by names, by shape, and as a person corrects them."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import FileError
from app.messages import TEMPLATES
from app.rig.humanoid import REQUIRED, JointMapping, map_joints
from metadata.load import load_bone_names, load_skeleton
from tests.support.skeletons import FOLDER, ListedBone, figure_of, listed

LISTS = sorted(path.stem for path in FOLDER.glob("*.tsv"))
TABLE = {
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


@pytest.mark.parametrize("name", [name for name in LISTS if name != "cmu"])
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
def test_every_table_maps_all_its_joints_on_both_sides(table) -> None:
    """A skeleton with the first name of each of the table's joints, on a body of another maker."""
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
    assert set(REQUIRED) <= set(mapping.bones)


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
    """Another order, a parent still before its children."""
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
def test_case_and_separators_do_not_matter(name: str, rename) -> None:
    bones = listed(name)
    assert by_name(bones, map_joints(figure_of(bones, rename=rename))) == known(bones)


def test_numbers_that_a_program_added_to_every_name_are_no_part_of_it() -> None:
    bones = listed("mixamo")
    number = {bone.name: index for index, bone in enumerate(bones)}
    mapping = map_joints(figure_of(bones, rename=lambda bone: f"{bone}_{number[bone]:02d}"))
    assert by_name(bones, mapping) == known(bones)


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


def test_a_thumb_of_two_bones_is_told_by_where_it_begins() -> None:
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
    own = {joint: at[bone] for joint, bone in known(bones).items() if joint in REQUIRED}
    own["spine"] = at["spine04"]
    mapping = map_joints(figure_of(bones, humanoid=own))
    names = by_name(bones, mapping)
    assert mapping.profile == "vrm1"
    assert names["spine"] == "spine04"
    # Of the trunk nothing is added that the file leaves out; fingers and eyes are.
    assert "upperChest" in mapping.missing
    assert names["leftIndexProximal"] == "finger2-1.L"
    assert names["rightEye"] == "eye.R"


def test_a_person_has_the_last_word() -> None:
    bones = listed("unreal5")
    wanted = {"chest": "spine_02", "leftThumbDistal": "", "jaw": "neck_02"}
    mapping = map_joints(figure_of(bones), wanted)
    names = by_name(bones, mapping)
    assert names["chest"] == "spine_02"
    assert names["jaw"] == "neck_02"
    assert "leftThumbDistal" in mapping.missing
    # A bone is one joint.
    names = by_name(bones, map_joints(figure_of(bones), {"chest": "spine_01"}))
    assert names["chest"] == "spine_01"
    assert "spine" not in names


@pytest.mark.parametrize(
    ("wanted", "message", "named"),
    [
        ({"chest": "spine_99"}, "figure.no_bone", {"bone": "spine_99", "joint": "chest"}),
        ({"breast": "spine_02"}, "figure.no_joint", {"joint": "breast"}),
    ],
)
def test_a_correction_that_names_nothing_is_refused(
    wanted: dict[str, str], message: str, named: dict[str, str]
) -> None:
    with pytest.raises(FileError) as caught:
        map_joints(figure_of(listed("unreal5")), wanted)
    assert caught.value.message.id == message
    assert named.items() <= caught.value.message.arguments.items()
    assert TEMPLATES[message].format(**caught.value.message.arguments)


def test_a_skeleton_that_is_no_body_has_no_joints() -> None:
    chain = [ListedBone(f"link{i}", f"link{i - 1}" if i else "", (0.0, 0.1 * i, 0.0), "") for i in range(12)]
    mapping = map_joints(figure_of(chain))
    assert mapping.bones == {}
    assert set(mapping.missing) == set(JOINTS)
