"""The skeleton a file is written on: its bones, and how each of them follows the joints of the normalised character.

Whatever the skeleton, one rule holds in every pose: ``world_from_bone = world_from_joint * joint_from_bone`` for a bone
that is a joint, where the bone stands where the joint stands. All other bones follow: a twist bone has its share of a
limb's twist, a bone that is tied to another is where that one is, the rest keep their place on their parent.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from app.errors import Message
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.model import Skeleton
from app.rig.skeleton import forward

FloatArray = npt.NDArray[np.float64]
SkeletonChoice: TypeAlias = Literal["suisou", "own", "ue5"]
"""Our normalised skeleton, the one of the character's own file, the mannequin of Unreal Engine 5."""

STEADY_M = 5e-6
"""A bone that leaves its place on its parent by no more than this is not moved: that much is rounding."""
_CHUNK = 4096
HIPS = "hips"
"""The joint whose translation a motion gives."""


@dataclass(frozen=True, eq=False)
class Twist:
    """A bone beside a limb that turns with a share of a joint's twist.

    Attributes
    ----------
    base : int
        Joint the bone goes along with.
    joint : int
        Joint whose twist it shares: the next one of the limb, or ``base`` itself.
    axis : (3,) float64
        Along the limb in the T-pose, unit.
    share : float
        Added to the base's rotation; negative where the base's own twist is taken back.
    """

    base: int
    joint: int
    axis: FloatArray
    share: float


@dataclass(frozen=True, eq=False)
class TargetSkeleton:
    """A skeleton to write on.

    Attributes
    ----------
    choice : SkeletonChoice
    names : tuple of str
    parents : tuple of int
        A parent before its children; -1 for the one root, the first.
    offsets_m : (B, 3) float64
        At rest, in the parent's frame.
    rest : (B, 4) float64
        ``parent_from_bone`` at rest: of the asset, where one is known. What a file says can be where its mesh is bound.
    t_pose : (B, 4) float64
        ``parent_from_bone`` where all joints are unturned: what a bone that nothing moves keeps.
    joint_of_bone : tuple of int
        -1: no joint.
    joint_from_bone : (B, 4) float64
        Of the bones that are joints; of a twist bone: from its base.
    twists : mapping of int to Twist
        By bone.
    tied : mapping of int to int
        Bones that are where another, earlier one is.
    hips : int
        The bone that a motion moves.
    messages : tuple of Message
        What had to be changed.
    """

    choice: SkeletonChoice
    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_m: FloatArray
    rest: FloatArray
    t_pose: FloatArray
    joint_of_bone: tuple[int, ...]
    joint_from_bone: FloatArray
    twists: Mapping[int, Twist] = field(default_factory=dict)
    tied: Mapping[int, int] = field(default_factory=dict)
    hips: int = 0
    messages: tuple[Message, ...] = ()

    @cached_property
    def bone_of_joint(self) -> Mapping[int, int]:
        """The bone of each joint that has one."""
        return {joint: bone for bone, joint in enumerate(self.joint_of_bone) if joint >= 0}

    @cached_property
    def moved(self) -> frozenset[int]:
        """Bones that a motion turns or moves."""
        return frozenset({*self.bone_of_joint.values(), *self.twists, *self.tied})


def matrices(positions: FloatArray, turned: FloatArray) -> FloatArray:
    """Transforms (B, 4, 4) of positions and rotations."""
    result = np.zeros((len(positions), 4, 4))
    result[:, :3, :3] = quaternion.to_matrix(turned)
    result[:, :3, 3] = positions
    result[:, 3, 3] = 1.0
    return result


@dataclass(frozen=True, eq=False)
class BoneMotion:
    """A motion on the bones of a target.

    Attributes
    ----------
    rotations : (F, B, 4) float32
        ``parent_from_bone``.
    translations_m : mapping of int to (F, 3) float64
        Of the bones that leave their place on their parent.
    """

    rotations: npt.NDArray[np.float32]
    translations_m: Mapping[int, FloatArray]


def bone_motion(target: TargetSkeleton, skeleton: Skeleton, motion: Motion) -> BoneMotion:
    """What the bones of a target do where the joints of a skeleton do what a motion says."""
    frames, bones = motion.frames, len(target.names)
    rotations = np.empty((frames, bones, 4), np.float32)
    translations = {bone: np.empty((frames, 3)) for bone in sorted(target.moved)}
    wanders = dict.fromkeys(translations, False)
    for first in range(0, frames, _CHUNK):
        span = slice(first, min(first + _CHUNK, frames))
        for bone, rotation, translation_m in _bones(target, skeleton, motion, span):
            rotations[span, bone] = rotation
            if bone in translations:
                translations[bone][span] = translation_m
                wanders[bone] |= bool(np.abs(translation_m - target.offsets_m[bone]).max(initial=0.0) > STEADY_M)
    return BoneMotion(
        rotations, {bone: values for bone, values in translations.items() if wanders[bone] or bone == target.hips}
    )


def _bones(
    target: TargetSkeleton, skeleton: Skeleton, motion: Motion, span: slice
) -> list[tuple[int, FloatArray, FloatArray]]:
    """Every bone's rotation (n, 4) and translation (n, 3) on its parent, at the frames of a span."""
    turns = quaternion.normalize(motion.rotations[span])
    joints = forward(skeleton, turns, motion.hips_m[span].astype(np.float64))
    frames = len(turns)
    placed: list[tuple[FloatArray, FloatArray]] = []
    result = []
    for bone, (parent, joint) in enumerate(zip(target.parents, target.joint_of_bone, strict=True)):
        above = placed[parent] if parent >= 0 else (np.zeros((frames, 3)), np.tile(quaternion.IDENTITY, (frames, 1)))
        steady_m = above[0] + quaternion.rotate(above[1], target.offsets_m[bone])
        if joint >= 0:
            turned = quaternion.multiply(joints.rotations[:, joint], target.joint_from_bone[bone])
            place = joints.positions_m[:, joint], turned
        elif bone in target.tied:
            place = placed[target.tied[bone]]
        elif bone in target.twists:
            twist = target.twists[bone]
            _, turn = quaternion.swing_twist(turns[:, twist.joint], twist.axis)
            part = quaternion.from_axis_angle(twist.axis, twist.share * quaternion.twist_angle(turn, twist.axis))
            base = quaternion.multiply(joints.rotations[:, twist.base], part)
            place = steady_m, quaternion.multiply(base, target.joint_from_bone[bone])
        else:
            place = steady_m, quaternion.multiply(above[1], target.t_pose[bone])
        placed.append(place)
        back = quaternion.conjugate(above[1])
        result.append((bone, quaternion.multiply(back, place[1]), quaternion.rotate(back, place[0] - above[0])))
    return result


def normalised_target(skeleton: Skeleton) -> TargetSkeleton:
    """Our own skeleton: every bone is a joint."""
    count = len(skeleton.names)
    unturned = np.tile(quaternion.IDENTITY, (count, 1))
    return TargetSkeleton(
        "suisou",
        skeleton.names,
        skeleton.parents,
        np.asarray(skeleton.offsets_m, np.float64),
        unturned,
        unturned,
        tuple(range(count)),
        unturned,
        hips=skeleton.index(HIPS),
    )
