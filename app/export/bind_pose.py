"""Bind pose of an exported skin: as modelled, or with the arms level or down; and the weights of twist bones.

Only the arms are posed differently; parts rigidly attached to a hand, head or foot move as before, up to rounding. Skin
shared by several arm bones changes slightly, due to linear blending.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray, SingleArray
from app.export.own_skeleton import LIMBS
from app.export.rig_options import RestPose
from app.export.target import TargetSkeleton, matrices
from app.rig import quaternion
from app.rig.mesh import Mesh, Morph
from app.rig.model import Character

CENTIMETRES: Final = 100.0
ARM: Final = ("UpperArm", "LowerArm", "Hand")
_DOWN_RAD: Final[Mapping[RestPose, float]] = {"t": 0.0, "a": np.pi / 4.0}


def bind_transforms(character: Character, target: TargetSkeleton) -> AnyFloatArray:
    """Return the transforms ``world_from_bone`` (B, 4, 4) of B bones in the modelled pose, in centimetres.

    A bone of a joint is at that joint; other bones are placed relative to their parents.
    """
    return _of_bones(character, target, _modelled(character))


def rest_transforms(character: Character, target: TargetSkeleton) -> AnyFloatArray:
    """Return the transforms of the bones in the target's rest pose, in the same form as `bind_transforms`."""
    if target.rest_pose == "model":
        return bind_transforms(character, target)
    return _of_bones(character, target, _posed(character, _DOWN_RAD[target.rest_pose]))


def _modelled(character: Character) -> AnyFloatArray:
    world_from_joint = np.linalg.inv(character.joint_from_mesh)
    world_from_joint[:, :3, 3] *= CENTIMETRES
    return world_from_joint


def _posed(character: Character, down_rad: float) -> AnyFloatArray:
    """Return ``world_from_joint`` of all joints with both arms straight to the side, lowered by an angle; fingers keep
    their pose relative to the hand.
    """
    skeleton, before = character.skeleton, _modelled(character)
    world = before.copy()
    for joint, (name, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        if parent < 0:
            continue
        world[joint] = world[parent] @ np.linalg.inv(before[parent]) @ before[joint]
        side = name.removesuffix(next((part for part in ARM if name.endswith(part)), name))
        if side in ("left", "right"):
            turn = quaternion.from_axis_angle([0.0, 0.0, 1.0], -down_rad if side == "left" else down_rad)
            world[joint, :3, :3] = quaternion.to_matrix(turn)
    return world


def _of_bones(character: Character, target: TargetSkeleton, world_from_joint: AnyFloatArray) -> AnyFloatArray:
    if target.normalised:
        return world_from_joint
    steady = matrices(target.offsets_m * CENTIMETRES, target.t_pose)
    turned = matrices(np.zeros((len(target.names), 3)), target.joint_from_bone)
    result = np.empty((len(target.names), 4, 4))
    for bone, (parent, joint) in enumerate(zip(target.parents, target.joint_of_bone, strict=True)):
        if joint >= 0:
            result[bone] = world_from_joint[joint] @ turned[bone]
        elif bone in target.tied:
            other = target.tied[bone]
            result[bone] = world_from_joint[target.joint_of_bone[other]] @ turned[other]
        else:
            result[bone] = result[parent] @ steady[bone] if parent >= 0 else steady[bone]
        if target.twisted_skin and bone in target.twists:
            result[bone, :3, :3] = _twisted(character, target, world_from_joint, bone) @ turned[bone, :3, :3]
    return result


def _twisted(character: Character, target: TargetSkeleton, world_from_joint: AnyFloatArray, bone: int) -> FloatArray:
    """Return the world rotation (3, 3) of a twist bone in a pose: that of its base joint, with the bone's share of the
    twist.
    """
    twist = target.twists[bone]
    parent = character.skeleton.parents[twist.joint]
    local = world_from_joint[parent, :3, :3].T @ world_from_joint[twist.joint, :3, :3]
    _, turn = quaternion.swing_twist(quaternion.from_matrix(local), twist.axis)
    part = quaternion.from_axis_angle(twist.axis, twist.share * quaternion.twist_angle(turn, twist.axis))
    result: FloatArray = world_from_joint[twist.base, :3, :3] @ quaternion.to_matrix(part)
    return result


# Skin


def bound_meshes(character: Character, target: TargetSkeleton) -> tuple[Mesh, ...]:
    """Return the meshes of a character in the target's rest pose, bound to its bones; a joint without a bone is merged
    with its parent."""
    bone_of_joint = np.zeros(len(character.skeleton.names), np.int32)
    for joint, parent in enumerate(character.skeleton.parents):
        above = int(bone_of_joint[parent]) if parent >= 0 else 0
        bone_of_joint[joint] = target.bone_of_joint.get(joint, above)
    meshes = [replace(mesh, joints=bone_of_joint[mesh.joints]) for mesh in character.meshes]
    if target.twisted_skin:
        meshes = [_with_twists(character, target, mesh) for mesh in meshes]
    if target.rest_pose != "model":
        moved = rest_transforms(character, target) @ np.linalg.inv(bind_transforms(character, target))
        moved[:, :3, 3] /= CENTIMETRES
        meshes = [_moved(mesh, moved) for mesh in meshes]
    return tuple(meshes)


def _with_twists(character: Character, target: TargetSkeleton, mesh: Mesh) -> Mesh:
    """Distribute the weights of upper and lower arms to their twist bones, by a vertex's position along the limb."""
    joints_m = np.linalg.inv(character.joint_from_mesh)[:, :3, 3]
    bones = mesh.joints
    columns, weights = [bones], [mesh.weights.astype(np.float64)]
    for base_name, end_name in LIMBS.items():
        base, end = character.skeleton.index(base_name), character.skeleton.index(end_name)
        own = target.bone_of_joint[base]
        knots = [bone for bone, twist in target.twists.items() if twist.base == base]
        if "Arm" not in base_name or not knots:
            continue
        # The bone at the start of a forearm takes none of the hand's twist; that of an upper arm takes all of its own.
        at = {bone: _along(target, bone) for bone in knots} | {own: float(base_name.endswith("UpperArm"))}
        order = sorted(at, key=lambda bone: at[bone])
        way = joints_m[end] - joints_m[base]
        along = (mesh.positions_m - joints_m[base]) @ way / (way @ way)
        limb = np.where(bones == own, weights[0], 0.0).sum(axis=1)
        for index, bone in enumerate(order):
            share = limb * np.interp(along, [at[one] for one in order], np.eye(len(order))[index])
            columns.append(np.full((len(limb), 1), bone, np.int32))
            weights.append(share[:, None])
        weights[0] = np.where(bones == own, 0.0, weights[0])
    joints, shares = np.concatenate(columns, axis=1), np.concatenate(weights, axis=1)
    # Sorted by weight; empty columns are dropped.
    by_weight = np.argsort(-shares, axis=1, kind="stable")[:, : max(int((shares > 0.0).sum(axis=1).max(initial=1)), 1)]
    return replace(
        mesh,
        joints=np.take_along_axis(joints, by_weight, axis=1),
        weights=np.take_along_axis(shares, by_weight, axis=1).astype(np.float32),
    )


def _along(target: TargetSkeleton, bone: int) -> float:
    """Return the position of a twist bone along its limb, 0..1."""
    share = target.twists[bone].share
    return share if share >= 0.0 else 1.0 + share


def _moved(mesh: Mesh, moved: AnyFloatArray) -> Mesh:
    """Return a mesh deformed by the transforms ``moved`` (B, 4, 4) of B bones, in metres, and bound in that pose."""
    blended = np.einsum("vk,vkij->vij", mesh.weights.astype(np.float64), moved[mesh.joints])
    turned = blended[:, :3, :3]
    positions_m = np.einsum("vij,vj->vi", turned, mesh.positions_m) + blended[:, :3, 3]
    return replace(
        mesh,
        positions_m=positions_m.astype(np.float32),
        normals=_unit(np.einsum("vij,vj->vi", np.linalg.inv(turned).transpose(0, 2, 1), mesh.normals)),
        morphs=tuple(_turned(morph, turned) for morph in mesh.morphs),
    )


def _turned(morph: Morph, turned: FloatArray) -> Morph:
    own = turned[morph.vertices]
    normals = morph.normal_deltas
    return Morph(
        morph.name,
        morph.vertices,
        np.einsum("vij,vj->vi", own, morph.deltas_m).astype(np.float32),
        None if normals is None else np.einsum("vij,vj->vi", own, normals).astype(np.float32),
    )


def _unit(vectors: FloatArray) -> SingleArray:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return (vectors / np.where(lengths > 0.0, lengths, 1.0)).astype(np.float32)
