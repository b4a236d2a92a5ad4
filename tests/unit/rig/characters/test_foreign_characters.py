"""Characters of other makers: their files are read and their bones recognised, with expected bones
determined by hand.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from app.rig.characters.joint_mapping import map_joints
from app.rig.characters.read_figure import read_figure
from app.rig.figure import Figure
from tests.support import wooden
from tests.support.skeletons import listed

FOLDER = Path(__file__).parents[3] / "data" / "characters"
OURS = sorted((Path(__file__).parents[4] / "resources" / "characters").glob("*.glb"))
FINGERS = ("Index", "Middle", "Ring", "Little")
PARTS = ("Proximal", "Intermediate", "Distal")
THUMB = ("ThumbMetacarpal", "ThumbProximal", "ThumbDistal")


def as_listed(name: str) -> dict[str, str]:
    return {bone.joint: bone.name for bone in listed(name) if bone.joint}


def fingers(name: Callable[[str, int, int], str]) -> dict[str, str]:
    """Expected finger bones by a function of side, finger 1..5 and bone 1..3."""
    found = {}
    for side in ("left", "right"):
        for number, part in enumerate(THUMB, 1):
            found[f"{side}{part}"] = name(side, 1, number)
        for finger, label in enumerate(FINGERS, 2):
            for number, part in enumerate(PARTS, 1):
                found[f"{side}{label}{part}"] = name(side, finger, number)
    return found


def both(left: dict[str, str]) -> dict[str, str]:
    """Joints of the left side, and of the right side with ``.R`` or ``R_`` instead of ``.L`` and ``L_``."""
    right = {joint: bone.replace(".L", ".R").replace("L_", "R_") for joint, bone in left.items()}
    return {f"left{joint}": bone for joint, bone in left.items()} | {
        f"right{joint}": bone for joint, bone in right.items()
    }


MAKEHUMAN = both(
    {
        "Eye": "eye.L",
        "Shoulder": "clavicle.L",
        "UpperArm": "upperarm01.L",
        "LowerArm": "lowerarm01.L",
        "Hand": "wrist.L",
        "UpperLeg": "upperleg01.L",
        "LowerLeg": "lowerleg01.L",
        "Foot": "foot.L",
    }
) | fingers(lambda side, finger, bone: f"finger{finger}-{bone}.{side[0].upper()}")
EXPECTED = {
    "child_mixamo.fbx": ("mixamo", as_listed("mixamo")),
    "woman_game_engine.glb": ("unreal", as_listed("game_engine")),
    "man_cmu.fbx": ("cmu", as_listed("cmu")),
    "toddler_vrm1.vrm": (
        "vrm1",
        MAKEHUMAN
        | {"hips": "root", "spine": "spine04", "chest": "spine03", "upperChest": "spine01"}
        | {"neck": "neck01", "head": "head", "jaw": "jaw"},
    ),
    "elder_vrm0.vrm": (
        "vrm0",
        MAKEHUMAN | {"hips": "root", "spine": "spine04", "chest": "spine02", "neck": "neck01", "head": "head"},
    ),
}
WOODEN = (
    both(
        {
            "Shoulder": "L_Thorax",
            "UpperArm": "L_Shoulder",
            "LowerArm": "L_Elbow",
            "Hand": "L_Wrist",
            "UpperLeg": "L_Hip",
            "LowerLeg": "L_Knee",
            "Foot": "L_Ankle",
            "Toes": "L_Toe",
        }
    )
    | fingers(
        lambda side, finger, bone: (
            f"{side[0].upper()}_{('Thumb', 'Index', 'Middle', 'Ring', 'Pinky')[finger - 1]}{bone}"
        )
    )
    | {"hips": "Pelvis", "spine": "Torso", "chest": "Spine", "upperChest": "Chest", "neck": "Neck", "head": "Head"}
)


def check(figure: Figure, profile: str, expected: dict[str, str]) -> None:
    mapping = map_joints(figure)
    assert {joint: figure.bone_names[bone] for joint, bone in mapping.bones.items()} == expected
    assert mapping.profile == profile
    assert mapping.doubtful == ()


@pytest.mark.parametrize("name", EXPECTED)
def test_every_bone_of_a_foreign_character_is_known(name: str) -> None:
    check(read_figure(FOLDER / name), *EXPECTED[name])


@pytest.mark.parametrize("path", [*(FOLDER / name for name in EXPECTED), *OURS], ids=lambda path: path.name)
def test_limbs_hands_and_head_are_known_by_shape_where_names_say_nothing(path: Path) -> None:
    figure = read_figure(path)
    mapping = map_joints(figure)
    nameless = replace(figure, bone_names=tuple(f"n{bone}" for bone in range(len(figure.bone_names))), humanoid={})
    found = map_joints(nameless)
    # A file may leave spine bones out, or say that it has no toes; one lone finger is a mitten's.
    reported = {
        joint: bone
        for joint, bone in mapping.bones.items()
        if not re.search("spine|chest|Eye|jaw", joint, re.IGNORECASE)
        and (path.name != "man_cmu.fbx" or "Thumb" not in joint)
    }
    assert {joint: found.bones.get(joint) for joint in reported} == reported
    assert found.profile == ""
    assert set(found.doubtful) == set(found.bones)


def test_a_wooden_mannequin_is_known_though_its_names_mislead(tmp_path: Path) -> None:
    """Its shoulder is named upper arm, and each wrist has a second hand."""
    arrays = wooden.source()
    if arrays is None:
        pytest.skip("mannequin-x is not installed (./test installs it)")
    wooden.write_wooden(arrays, tmp_path / "wooden.glb")
    check(read_figure(tmp_path / "wooden.glb"), "smpl_humanoid", WOODEN)
