"""Adds optional bones to a target skeleton: root motion, IK targets, sockets, twist bones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.export.own_skeleton import LIMBS, limb_twist
from app.export.rig import Rig
from app.export.rig_options import DEFAULT_RIG
from app.export.target import TargetSkeleton, Twist
from app.formats.unique_names import numbered
from app.rig import quaternion
from app.rig.characters.bone_placements import local_placements, world_placements
from app.rig.model import Character, Skeleton
from app.rig.skeleton import rest_positions

IK_BONES: Final[Mapping[str, tuple[str, str]]] = {
    "ik_foot_root": ("", ""),
    "ik_foot_l": ("ik_foot_root", "leftFoot"),
    "ik_foot_r": ("ik_foot_root", "rightFoot"),
    "ik_hand_root": ("", ""),
    "ik_hand_gun": ("ik_hand_root", "rightHand"),
    "ik_hand_l": ("ik_hand_gun", "leftHand"),
    "ik_hand_r": ("ik_hand_gun", "rightHand"),
}
"""Parent and joint of each IK bone, as in Unreal's mannequin; bones without parent are children of the root."""
TWIST: Final = "Twist"
_KEPT: Final = {
    "root_bone": "skeleton.kept_root",
    "rest_pose": "skeleton.kept_rest_pose",
    "twist_bones": "skeleton.kept_twist_bones",
}


@dataclass
class _Growing:
    """A target skeleton to which bones are added; positions and rotations are in world space, at rest and in the
    T-pose.
    """

    target: TargetSkeleton
    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    rest: list[tuple[FloatArray, FloatArray]] = field(default_factory=list)
    t_pose: list[FloatArray] = field(default_factory=list)
    joint_from_bone: list[FloatArray] = field(default_factory=list)
    tied: dict[int, int] = field(default_factory=dict)
    twists: dict[int, Twist] = field(default_factory=dict)
    sockets: dict[int, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        target = self.target
        positions, turned = world_placements(target.parents, target.offsets_m, target.rest)
        _, t_pose = world_placements(target.parents, target.offsets_m, target.t_pose)
        self.names += target.names
        self.parents += target.parents
        self.rest += zip(positions, turned, strict=True)
        self.t_pose += list(t_pose)
        self.joint_from_bone += list(target.joint_from_bone)

    def add(
        self, name: str, parent: int, position: FloatArray, turn: FloatArray, in_t: FloatArray, own: FloatArray
    ) -> int:
        """Add a bone with a world position (3,) and rotation (4,) at rest, and rotation ``in_t`` in the T-pose; return
        its index.

        ``own`` is the bone's rotation relative to the joint that it follows.
        """
        self.names += numbered([name], self.names)
        self.parents.append(parent)
        self.rest.append((position, turn))
        self.t_pose.append(in_t)
        self.joint_from_bone.append(own)
        return len(self.names) - 1

    def grown(self) -> TargetSkeleton:
        """Return the target skeleton with all bones that were added."""
        target, before = self.target, len(self.target.names)
        positions, turned = (np.stack(part) for part in zip(*self.rest, strict=True))
        offsets, rest = local_placements(self.parents, positions, turned)
        _, t_pose = local_placements(self.parents, positions, np.stack(self.t_pose))
        return replace(
            target,
            names=tuple(self.names),
            parents=tuple(self.parents),
            offsets_m=np.concatenate([target.offsets_m, offsets[before:]]),
            rest=np.concatenate([target.rest, rest[before:]]),
            t_pose=np.concatenate([target.t_pose, t_pose[before:]]),
            joint_of_bone=(*target.joint_of_bone, *[-1] * (len(self.names) - before)),
            joint_from_bone=np.stack(self.joint_from_bone),
            twists={**target.twists, **self.twists},
            tied={**target.tied, **self.tied},
            sockets=dict(self.sockets),
            added=target.added | frozenset(range(before, len(self.names))),
        )


def equipped(target: TargetSkeleton, character: Character, rig: Rig) -> TargetSkeleton:
    """Return a target skeleton with the requested optional bones.

    The skeleton of a character's own file keeps its rest pose, its twist bones and, if the root is a joint of the body,
    its root bone; messages report this.
    """
    if rig.options == DEFAULT_RIG:
        return target
    options, skeleton = rig.options, character.skeleton
    root, rest_pose, twisted = options.root_bone, options.rest_pose, options.twist_bones
    kept = []
    if target.choice == "own":
        kept += ["rest_pose"] if rest_pose != "model" else []
        kept += ["twist_bones"] if twisted else []
        rest_pose, twisted = "model", False
    if root != "origin" and skeleton.parents[max(target.joint_of_bone[0], 0)] >= 0:
        kept.append("root_bone")
        root = "origin"
    growing = _Growing(target)
    if twisted and target.choice == "suisou":
        _add_twists(growing, skeleton)
    hands = {side: target.bone_of_joint[skeleton.index(f"{side}Hand")] for side in ("left", "right")}
    if options.instrument == "ik":
        targets = _add_ik_targets(growing, skeleton)
        hands = {"left": targets["ik_hand_l"], "right": targets["ik_hand_r"]}
    _add_sockets(growing, skeleton, rig, hands)
    target = growing.grown()
    if root != "origin":
        target = replace(target, joint_of_bone=(-1, *target.joint_of_bone[1:]), root_bone=root, place=rig.place)
    return replace(
        target,
        rest_pose=rest_pose,
        twisted_skin=twisted,
        eyes=options.eyes,
        messages=(*target.messages, *(Message(_KEPT[what], {"character": character.id}) for what in kept)),
    )


def _add_twists(growing: _Growing, skeleton: Skeleton) -> None:
    """Add a bone half-way along each upper and lower arm, which receives a part of the arm's twist."""
    target, joints = growing.target, rest_positions(skeleton)
    for base_name, end_name in LIMBS.items():
        if "Arm" not in base_name:
            continue
        base, end = skeleton.index(base_name), skeleton.index(end_name)
        bone, way = target.bone_of_joint[base], joints[end] - joints[base]
        place, turn = growing.rest[bone]
        half_m = quaternion.rotate(turn, 0.5 * way)
        own = target.joint_from_bone[bone]
        number = growing.add(base_name + TWIST, bone, place + half_m, turn, growing.t_pose[bone], own)
        growing.twists[number] = limb_twist(skeleton, base, end, way / np.linalg.norm(way), 0.5)


def _add_ik_targets(growing: _Growing, skeleton: Skeleton) -> dict[str, int]:
    """Add missing IK targets, and return all of them by name."""
    target = growing.target
    found: dict[str, int] = {}
    for name, (parent, joint) in IK_BONES.items():
        bone = target.bone_of_joint[skeleton.index(joint)] if joint else 0
        if name in target.names:
            found[name] = target.names.index(name)
        else:
            own = target.joint_from_bone[bone] if joint else quaternion.IDENTITY
            found[name] = growing.add(name, found.get(parent, 0), *growing.rest[bone], growing.t_pose[bone], own)
        if joint and found[name] not in target.bone_of_joint.values():
            growing.tied[found[name]] = bone
    return found


def _add_sockets(growing: _Growing, skeleton: Skeleton, rig: Rig, hands: Mapping[str, int]) -> None:
    """Add a socket for each instrument to the hand that holds it, at the place of the instrument in the hand."""
    for number, grip in enumerate(rig.grips):
        hand = growing.target.bone_of_joint[skeleton.index(f"{grip.side}Hand")]
        parent = hands[grip.side]
        back = quaternion.conjugate(growing.target.joint_from_bone[hand])
        offset_m, turn = quaternion.rotate(back, grip.position_m), quaternion.multiply(back, grip.rotation)
        place, turned = growing.rest[parent]
        bone = growing.add(
            f"{growing.names[parent]}_socket",
            parent,
            place + quaternion.rotate(turned, offset_m),
            quaternion.multiply(turned, turn),
            quaternion.multiply(growing.t_pose[parent], turn),
            turn,
        )
        growing.sockets[bone] = number


def socket_names(target: TargetSkeleton) -> Sequence[str]:
    """Return the names of the sockets, one for each instrument of the musician; empty if instruments are not
    attached.
    """
    return [target.names[bone] for bone, _ in sorted(target.sockets.items(), key=lambda item: item[1])]
