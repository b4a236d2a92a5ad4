"""Skeletons of popular free characters: legs beside the hips, arms without a named hand, detached feet."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import pytest

from app.rig.characters.joint_mapping import map_joints
from app.rig.figure import Figure
from metadata.model import REQUIRED_JOINTS

Bones = Mapping[str, tuple[str, float, float, float]]
"""Parent and position of each bone; bones of the left side represent both sides."""

WOMAN: Final[Bones] = {
    "Root": ("", 0.0, 0.0, 0.072),
    "Hips": ("Root", 0.0, 1.002, 0.078),
    "Abdomen": ("Hips", 0.0, 1.107, 0.063),
    "Torso": ("Abdomen", 0.0, 1.247, 0.038),
    "Chest": ("Torso", 0.0, 1.377, 0.041),
    "Neck": ("Chest", 0.0, 1.511, 0.043),
    "Head": ("Neck", 0.0, 1.587, 0.043),
    "Shoulder.L": ("Chest", 0.063, 1.41, 0.064),
    "UpperArm.L": ("Shoulder.L", 0.117, 1.443, 0.06),
    "LowerArm.L": ("UpperArm.L", 0.334, 1.443, 0.056),
    "Hand.L": ("LowerArm.L", 0.595, 1.445, 0.093),
    "UpperLeg.L": ("Root", 0.097, 1.037, 0.045),
    "LowerLeg.L": ("UpperLeg.L", 0.097, 0.557, 0.087),
    "Foot.L": ("LowerLeg.L", 0.097, 0.023, 0.062),
}
"""Figure whose legs are attached to a root on the floor instead of the hips (proportions of Quaternius'
modular women).
"""
KNIGHT: Final[Bones] = {
    "Bone": ("", 0.0, 0.0, -0.195),
    "Foot.L": ("Bone", 0.535, 0.025, -0.138),
    "Body": ("Bone", 0.0, 2.121, 0.113),
    "Hips": ("Body", 0.0, 1.959, 0.0),
    "Abdomen": ("Hips", 0.0, 2.344, -0.078),
    "Torso": ("Abdomen", 0.0, 3.115, -0.081),
    "Neck": ("Torso", 0.0, 3.797, -0.018),
    "Head": ("Neck", 0.0, 4.122, -0.011),
    "Shoulder.L": ("Torso", 0.325, 3.488, -0.129),
    "UpperArm.L": ("Shoulder.L", 0.627, 3.714, -0.129),
    "LowerArm.L": ("UpperArm.L", 1.636, 3.655, -0.222),
    "Palm.L": ("LowerArm.L", 2.731, 3.697, -0.24),
    "MiddleHand.L": ("Palm.L", 2.989, 3.697, -0.228),
    "Fingers.L": ("MiddleHand.L", 3.149, 3.697, -0.228),
    "Thumb.L": ("LowerArm.L", 2.518, 3.63, -0.017),
    "Thumb2.L": ("Thumb.L", 2.617, 3.542, 0.115),
    "UpperLeg.L": ("Body", 0.528, 1.741, -0.07),
    "LowerLeg.L": ("UpperLeg.L", 0.528, 0.802, 0.054),
}
"""Figure with long arms, a hand named palm, a thumb attached to the forearm, and feet attached to the root (Quaternius'
knight).
"""


CROSSED: Final[Bones] = {
    "LowerArm.R": ("UpperArm.R", -1.56, 3.66, -0.21),
    "Palm.R": ("LowerArm.R", -2.74, 3.7, -0.23),
    "Thumb.L": ("LowerArm.R", -2.52, 3.63, -0.02),
    "Thumb.R": ("LowerArm.L", 2.52, 3.63, -0.02),
    "Thumb2.L": ("Thumb.L", -2.62, 3.54, 0.12),
    "Thumb2.R": ("Thumb.R", 2.62, 3.54, 0.12),
}
"""The knight's arms as in its file: thumbs named for the other side, and a shorter right upper arm."""


def figure(bones: Bones, otherwise: Bones | None = None) -> Figure:
    """Figure with both sides, without a mesh and with unrotated bones; ``otherwise`` replaces bones of a side."""
    whole = dict(bones)
    for name, (parent, x, y, z) in bones.items():
        if name.endswith(".L"):
            whole[f"{name[:-1]}R"] = (f"{parent[:-1]}R" if parent.endswith(".L") else parent, -x, y, z)
    whole |= otherwise or {}
    names = list(whole)
    names.sort(key=lambda name: _depth(whole, name))
    places = np.array([whole[name][1:] for name in names], np.float64)
    parents = tuple(names.index(whole[name][0]) if whole[name][0] else -1 for name in names)
    offsets = np.array([places[bone] - (places[parent] if parent >= 0 else 0.0) for bone, parent in enumerate(parents)])
    still = np.tile([0.0, 0.0, 0.0, 1.0], (len(names), 1))
    return Figure("cast.glb", "gltf", tuple(names), parents, offsets, still, ())


def _depth(bones: Bones, name: str) -> int:
    return 0 if not bones[name][0] else 1 + _depth(bones, bones[name][0])


SIDES: Final = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")


@pytest.mark.parametrize("named", [True, False])
@pytest.mark.parametrize(("bones", "hips"), [(WOMAN, "Hips"), (KNIGHT, "Body")])
def test_a_free_cast_is_read_by_its_shape(bones: Bones, hips: str, named: bool) -> None:
    one = figure(bones)
    if not named:
        one = Figure(one.file, one.origin, tuple(f"b{bone}" for bone in range(len(one.parents))), one.parents,
                     one.translations_m, one.rotations, ())  # fmt: skip
    true = figure(bones).bone_names
    found = {joint: true[bone] for joint, bone in map_joints(one).bones.items()}
    assert set(REQUIRED_JOINTS) <= found.keys()
    assert (found["hips"], found["neck"], found["head"]) == (hips, "Neck", "Head")
    for part in SIDES if named else SIDES[2:]:
        # Without a name a shoulder may as well be the upper arm.
        own = part if f"{part}.L" in bones else "Palm"
        assert (found[f"left{part}"], found[f"right{part}"]) == (f"{own}.L", f"{own}.R")


def test_an_arm_without_a_hands_name_is_mapped_like_the_other_one() -> None:
    knight = figure(KNIGHT, CROSSED)
    found = {joint: knight.bone_names[bone] for joint, bone in map_joints(knight).bones.items()}
    for part, own in {"Shoulder": "Shoulder", "UpperArm": "UpperArm", "LowerArm": "LowerArm", "Hand": "Palm"}.items():
        assert (found[f"left{part}"], found[f"right{part}"]) == (f"{own}.L", f"{own}.R")
