"""Target skeleton of a file: its bones, and the relation of each to the joints of the normalised character.

For every skeleton and pose, ``world_from_bone = world_from_joint * joint_from_bone`` holds for a bone that represents a
joint, at the joint's position. Other bones follow: a twist bone has a share of a limb's twist, a tied bone coincides
with another, and all others are fixed to their parents.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from app.arrays import AnyFloatArray, FloatArray, SingleArray
from app.errors import Message
from app.export.rig_options import EyeTurn, RestPose, RootBone
from app.formats.scene import NodePlace
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.model import Skeleton
from app.rig.skeleton import forward

SkeletonChoice: TypeAlias = Literal["suisou", "own", "ue5"]
"""Skeleton of an exported character: the normalised one of Suisou, the character file's own, or Unreal Engine 5's
mannequin.
"""

METRES = 0.01
STEADY_M = 5e-6
"""Distance in metres up to which a bone's change of position relative to its parent is rounding and gets no keys."""
_CHUNK = 4096
HIPS = "hips"
"""Joint whose translation a motion contains."""


@dataclass(frozen=True, eq=False)
class Twist:
    """A bone along a limb that rotates with a share of a joint's twist.

    Attributes
    ----------
    base : int
        Joint that the bone follows.
    joint : int
        Joint whose twist it shares: the next one of the limb, or ``base``.
    axis : (3,) float64
        Unit axis along the limb in the T-pose.
    share : float
        Share added to the base's rotation; negative to reverse part of the base's own twist.
    """

    base: int
    joint: int
    axis: FloatArray
    share: float


@dataclass(frozen=True, eq=False)
class TargetSkeleton:
    """The skeleton on which a character is exported: its bones, and their relation to the character's joints.

    Attributes
    ----------
    choice : SkeletonChoice
        The user's choice that it is made for.
    names : tuple of str
        Names of the B bones.
    parents : tuple of int
        Index of the parent, which comes first; -1 for the only root, the first bone.
    offsets_m : (B, 3) float64
        Rest position in the parent's frame.
    rest : (B, 4) float64
        ``parent_from_bone`` in the rest pose of the asset, if known. The rest pose in a file may be the bind pose
        instead.
    t_pose : (B, 4) float64
        ``parent_from_bone`` in the T-pose; kept by bones that nothing moves.
    joint_of_bone : tuple of int
        Joint of each bone; -1 for none.
    joint_from_bone : (B, 4) float64
        Rotation from each bone to its joint; for a twist bone, to its base joint.
    twists : mapping of int to Twist
        Twist bones by index.
    tied : mapping of int to int
        Bones that coincide with another, earlier one.
    hips : int
        Bone that carries the motion's translation.
    messages : tuple of Message
        Messages about changes to the skeleton.
    sockets : mapping of int to int
        Bones at an instrument, with the instrument's index among the musician's.
    added : frozenset of int
        Bones that were added on request, which an asset made from the skeleton lacks.
    root_bone : RootBone
        Behaviour of the root; a moving root is no joint.
    place : NodePlace or None
        Transform of the root on the stage; None for the origin.
    rest_pose : RestPose
        Rest pose of the file.
    twisted_skin : bool
        Whether twist bones hold skin.
    eyes : EyeTurn
        Whether shapes or bones rotate the eyes (`app.export.eyes`).
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
    sockets: Mapping[int, int] = field(default_factory=dict)
    added: frozenset[int] = frozenset()
    root_bone: RootBone = "origin"
    place: NodePlace | None = None
    rest_pose: RestPose = "model"
    twisted_skin: bool = False
    eyes: EyeTurn = "shapes"

    @cached_property
    def bone_of_joint(self) -> Mapping[int, int]:
        """Index of the bone for each joint that has one, by joint; the first if several bones lie at one joint."""
        found: dict[int, int] = {}
        for bone, joint in enumerate(self.joint_of_bone):
            if joint >= 0:
                found.setdefault(joint, bone)
        return found

    @cached_property
    def moved(self) -> frozenset[int]:
        """Bones that a motion rotates or translates."""
        joints = (bone for bone, joint in enumerate(self.joint_of_bone) if joint >= 0)
        return frozenset({*joints, *self.twists, *self.tied, *self.sockets})

    @property
    def normalised(self) -> bool:
        """True if bones and joints correspond one to one with equal motion."""
        moved = self.added or self.root_bone != "origin"
        return self.choice == "suisou" and not moved and self.joint_of_bone == tuple(range(len(self.names)))

    @property
    def loose(self) -> frozenset[int]:
        """Bones that translate relative to their parents: the hips, constrained bones, and joints not attached to
        another joint's bone, such as feet of a rig whose legs follow them.
        """
        return frozenset({self.hips, *self.tied, *self.sockets, *self._apart})

    @cached_property
    def _apart(self) -> frozenset[int]:
        """Bones of joints, other than the root, with no other joint's bone above them."""
        below: list[bool] = []
        for parent in self.parents:
            below.append(parent >= 0 and (below[parent] or self.joint_of_bone[parent] >= 0))
        joints = self.bone_of_joint.values()
        return frozenset(bone for bone in joints if self.parents[bone] >= 0 and not below[bone])


def matrices(positions: FloatArray, turned: FloatArray) -> FloatArray:
    """Return transforms (B, 4, 4) from positions (B, 3) and rotations (B, 4)."""
    result = np.zeros((len(positions), 4, 4))
    result[:, :3, :3] = quaternion.to_matrix(turned)
    result[:, :3, 3] = positions
    result[:, 3, 3] = 1.0
    return result


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Path of an object in the player's space: positions (F, 3) in metres, and rotations (F, 4), in each frame."""

    positions_m: AnyFloatArray
    rotations: AnyFloatArray


def instrument_path(motion: Motion) -> Trajectory:
    """Return the path of the instrument that a motion carries."""
    return Trajectory(motion.instrument_position_m, motion.instrument_rotation)


def trajectory_at_origin(frames: int) -> Trajectory:
    """Return the trajectory of an object that stays at the origin."""
    return Trajectory(np.zeros((frames, 3)), np.tile(quaternion.IDENTITY, (frames, 1)))


def placed_trajectory(path: Trajectory, place: NodePlace | None) -> Trajectory:
    """Return a trajectory moved and rotated to a place on the stage; unchanged if the place is None."""
    if place is None:
        return path
    positions_m = quaternion.rotate(place.rotation_xyzw, path.positions_m) + METRES * place.translation_cm
    return Trajectory(positions_m, quaternion.multiply(place.rotation_xyzw, path.rotations))


@dataclass(frozen=True, eq=False)
class BoneMotion:
    """A motion on the bones of a target.

    Attributes
    ----------
    rotations : (F, B, 4) float32
        ``parent_from_bone``.
    translations_m : mapping of int to (F, 3) float64
        Translations of bones that move relative to their parent.
    """

    rotations: SingleArray
    translations_m: Mapping[int, FloatArray]


def bone_motion(
    target: TargetSkeleton, skeleton: Skeleton, motion: Motion, held: Sequence[Trajectory] = ()
) -> BoneMotion:
    """Return the motion of a target's bones, from the motion of a skeleton's joints.

    Parameters
    ----------
    target : TargetSkeleton
        The bones.
    skeleton : Skeleton
        Skeleton of the character.
    motion : Motion
        Motion of its joints.
    held : sequence of Trajectory
        Trajectories of the musician's instruments, one for each socket; empty for the motion's only instrument.
    """
    held = held or (instrument_path(motion),)
    frames, bones = motion.frames, len(target.names)
    rotations = np.empty((frames, bones, 4), np.float32)
    movable = target.moved if target.root_bone == "origin" else target.moved | {0}
    translations = {bone: np.empty((frames, 3)) for bone in sorted(movable)}
    wanders = dict.fromkeys(translations, False)
    for first in range(0, frames, _CHUNK):
        span = slice(first, min(first + _CHUNK, frames))
        for bone, rotation, translation_m in _bones(target, skeleton, motion, held, span):
            rotations[span, bone] = rotation
            if bone in translations:
                translations[bone][span] = translation_m
                wanders[bone] |= bool(np.abs(translation_m - target.offsets_m[bone]).max(initial=0.0) > STEADY_M)
    return BoneMotion(
        rotations, {bone: values for bone, values in translations.items() if wanders[bone] or bone == target.hips}
    )


_Placed: TypeAlias = tuple[FloatArray, FloatArray]
"""Positions (n, 3) in metres and rotations (n, 4)."""


def _bones(
    target: TargetSkeleton, skeleton: Skeleton, motion: Motion, held: Sequence[Trajectory], span: slice
) -> list[tuple[int, FloatArray, FloatArray]]:
    """Return each bone's index with its rotation (n, 4) and translation (n, 3) relative to its parent, at the n frames
    of a span."""
    turns = quaternion.normalize(motion.rotations[span])
    joints = forward(skeleton, turns, motion.hips_m[span].astype(np.float64))
    frames = len(turns)

    def of_joint(bone: int) -> _Placed:
        joint = target.joint_of_bone[bone]
        turned = quaternion.multiply(joints.rotations[:, joint], target.joint_from_bone[bone])
        return joints.positions_m[:, joint], turned

    places: list[_Placed] = []
    result = []
    for bone, (parent, joint) in enumerate(zip(target.parents, target.joint_of_bone, strict=True)):
        above = places[parent] if parent >= 0 else (np.zeros((frames, 3)), np.tile(quaternion.IDENTITY, (frames, 1)))
        steady_m = above[0] + quaternion.rotate(above[1], target.offsets_m[bone])
        if joint >= 0:
            place = of_joint(bone)
        elif bone in target.tied:
            place = of_joint(target.tied[bone])
        elif bone in target.sockets:
            path = held[target.sockets[bone]]
            place = np.asarray(path.positions_m[span], np.float64), quaternion.normalize(path.rotations[span])
        elif bone in target.twists:
            twist = target.twists[bone]
            _, turn = quaternion.swing_twist(turns[:, twist.joint], twist.axis)
            part = quaternion.from_axis_angle(twist.axis, twist.share * quaternion.twist_angle(turn, twist.axis))
            base = quaternion.multiply(joints.rotations[:, twist.base], part)
            place = steady_m, quaternion.multiply(base, target.joint_from_bone[bone])
        else:
            place = steady_m, quaternion.multiply(above[1], target.t_pose[bone])
        if bone == 0 and target.root_bone == "motion":
            place = _over_floor(place, joints.of(skeleton.index(HIPS)))
        places.append(place)
        back = quaternion.conjugate(above[1])
        local = quaternion.multiply(back, place[1]), quaternion.rotate(back, place[0] - above[0])
        if bone == 0 and target.place is not None:
            there = placed_trajectory(Trajectory(local[1], local[0]), target.place)
            local = np.asarray(there.rotations, np.float64), np.asarray(there.positions_m, np.float64)
        result.append((bone, *local))
    return result


def _over_floor(rest: _Placed, hips: _Placed) -> _Placed:
    """Return the transform of a root bone that moves along below the hips on the floor, rotated with them about the
    vertical axis; ``rest`` is its transform at rest.
    """
    _, heading = quaternion.swing_twist(hips[1], np.array([0.0, 1.0, 0.0]))
    below = hips[0] * np.array([1.0, 0.0, 1.0])
    return below + quaternion.rotate(heading, rest[0]), quaternion.multiply(heading, rest[1])


def normalised_target(skeleton: Skeleton) -> TargetSkeleton:
    """Return the normalised skeleton as a target: every bone is a joint."""
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
