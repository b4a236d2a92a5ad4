"""Target skeleton from a character's own file: its names, hierarchy and rest pose."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

import numpy as np

from app.arrays import FloatArray, SingleArray
from app.errors import Message
from app.export.target import HIPS, TargetSkeleton, Twist
from app.rig import quaternion
from app.rig.characters.bone_placements import world_placements
from app.rig.figure import Figure, OwnSkeleton
from app.rig.model import Character, Skeleton

TWIST_NAME: Final = re.compile(r"twist|roll(?!er)", re.IGNORECASE)
"""Names of bones that share the twist of a limb: "twist" in Unreal, MetaHuman and Character Creator
(``lowerarm_twist_01_l``, ``CC_Base_L_ForearmTwist01``), "roll" in HumanIK and MotionBuilder (``LeftForeArmRoll``).
"""
LIMBS: Final = {
    f"{side}{bone}": f"{side}{end}"
    for side in ("left", "right")
    for bone, end in (
        ("UpperArm", "LowerArm"),
        ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"),
        ("LowerLeg", "Foot"),
    )
}
"""Joint at the end of each long bone."""
ARMATURE: Final = "armature"
_TWISTS_AT_ITS_END: Final = ("LowerArm", "LowerLeg")
"""Limbs whose twist comes from the joint at their end, such as a forearm's from the hand; an upper arm's comes from the
shoulder.
"""


def own_target(character: Character) -> TargetSkeleton:
    """Return the skeleton of a character's own file as a target; the character must have one.

    Unreal requires a single root: if the file has several, a bone ``root`` at the origin is added. Blender's armature
    object is left out, as in Unreal's importer. Messages report both.
    """
    own = character.own
    if own is None:
        raise ValueError(f"character {character.id!r} has no skeleton of another file")
    figure = own.figure
    _, t_turned = world_placements(figure.parents, figure.translations_m, own.t_pose)
    joint_of_bone = [-1] * len(figure.bone_names)
    joint_from_bone = np.tile(quaternion.IDENTITY, (len(figure.bone_names), 1))
    for joint, bone in enumerate(own.bone_of_joint):
        if bone >= 0:
            joint_of_bone[bone] = joint
            joint_from_bone[bone] = own.joint_from_bone[joint]
    for bone, joint in own.beside.items():
        joint_of_bone[bone] = joint
        joint_from_bone[bone] = t_turned[bone]
    twists = _twists(own, character.skeleton, joint_of_bone)
    for bone in twists:
        joint_from_bone[bone] = t_turned[bone]
    target = TargetSkeleton(
        "own",
        figure.bone_names,
        figure.parents,
        figure.translations_m,
        figure.rotations,
        own.t_pose,
        tuple(joint_of_bone),
        joint_from_bone,
        twists,
        hips=own.bone_of_joint[character.skeleton.index(HIPS)],
    )
    if has_armature(figure):
        return _without_armature(target, figure)
    return target if figure.parents.count(-1) == 1 else _with_root(target, figure)


def has_armature(figure: Figure) -> bool:
    """Return whether the figure's root is Blender's armature object, which Unreal does not import as a bone.

    It is named Armature, holds no vertices and has the only root bone below it.
    """
    if figure.bone_names[0].casefold() != ARMATURE or figure.parents.count(-1) != 1 or figure.parents.count(0) != 1:
        return False
    return not any((mesh.weights[mesh.joints == 0] > 0.0).any() for mesh in figure.meshes)


def own_weights(morphs: Mapping[str, SingleArray], own: OwnSkeleton) -> dict[str, SingleArray]:
    """Return the weights, 0..1, of a figure's own morphs for weights of ARKit shapes."""
    sums: dict[str, SingleArray] = {}
    there = set(own.figure.morph_names)
    for name, curve in morphs.items():
        for morph, factor in own.morphs.get(name, {}).items():
            if morph in there:
                sums[morph] = sums.get(morph, np.zeros(len(curve), np.float32)) + np.float32(factor) * curve
    return {morph: np.clip(curve, 0.0, 1.0) for morph, curve in sums.items()}


def _twists(own: OwnSkeleton, skeleton: Skeleton, joint_of_bone: list[int]) -> dict[int, Twist]:
    """Return the twist bones of the figure's limbs by bone index; each takes the share of the twist that corresponds to
    its position along the limb.
    """
    figure = own.figure
    positions, _ = world_placements(figure.parents, figure.translations_m, own.t_pose)
    found = {}
    for bone, name in enumerate(figure.bone_names):
        if joint_of_bone[bone] >= 0 or not TWIST_NAME.search(name):
            continue
        above = figure.parents[bone]
        while above >= 0 and joint_of_bone[above] < 0:
            above = figure.parents[above]
        if above < 0 or skeleton.names[joint_of_bone[above]] not in LIMBS:
            continue
        base = joint_of_bone[above]
        end = skeleton.index(LIMBS[skeleton.names[base]])
        if own.bone_of_joint[end] < 0:
            continue
        way = positions[own.bone_of_joint[end]] - positions[above]
        length = float(np.linalg.norm(way))
        if length < 1e-4:
            continue
        axis = way / length
        along = float(np.clip((positions[bone] - positions[above]) @ axis / length, 0.0, 1.0))
        found[bone] = limb_twist(skeleton, base, end, axis, along)
    return found


def limb_twist(skeleton: Skeleton, base: int, end: int, axis: FloatArray, along: float) -> Twist:
    """Return the twist of a bone at the position ``along`` (0..1) of a limb from joint ``base`` to joint ``end``."""
    if skeleton.names[base].endswith(_TWISTS_AT_ITS_END):
        return Twist(base, end, axis, along)
    return Twist(base, base, axis, along - 1.0)


def _without_armature(target: TargetSkeleton, figure: Figure) -> TargetSkeleton:
    if target.joint_of_bone[0] >= 0:
        return target
    # The bone below becomes the root and keeps its position in the world.
    offsets, rest, t_pose = target.offsets_m[1:].copy(), target.rest[1:].copy(), target.t_pose[1:].copy()
    offsets[0] = target.offsets_m[0] + quaternion.rotate(target.rest[0], offsets[0])
    rest[0] = quaternion.multiply(target.rest[0], rest[0])
    t_pose[0] = quaternion.multiply(target.t_pose[0], t_pose[0])
    return TargetSkeleton(
        "own",
        target.names[1:],
        tuple(parent - 1 for parent in target.parents[1:]),
        offsets,
        rest,
        t_pose,
        target.joint_of_bone[1:],
        target.joint_from_bone[1:],
        {bone - 1: twist for bone, twist in target.twists.items()},
        hips=target.hips - 1,
        messages=(
            Message(
                "skeleton.armature_left_out",
                {"file": figure.file, "armature": target.names[0], "root": target.names[1]},
            ),
        ),
    )


def _with_root(target: TargetSkeleton, figure: Figure) -> TargetSkeleton:
    name = "root"
    while name in target.names:
        name += "_"
    unturned = quaternion.IDENTITY[None]
    tops = ", ".join(bone for bone, parent in zip(target.names, target.parents, strict=True) if parent < 0)
    return TargetSkeleton(
        "own",
        (name, *target.names),
        (-1, *(parent + 1 for parent in target.parents)),
        np.concatenate([np.zeros((1, 3)), target.offsets_m]),
        np.concatenate([unturned, target.rest]),
        np.concatenate([unturned, target.t_pose]),
        (-1, *target.joint_of_bone),
        np.concatenate([unturned, target.joint_from_bone]),
        {bone + 1: twist for bone, twist in target.twists.items()},
        hips=target.hips + 1,
        messages=(Message("skeleton.root_added", {"file": figure.file, "root": name, "bones": tops}),),
    )
