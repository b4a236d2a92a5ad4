"""Target skeleton with the core bones of Unreal Engine 5's mannequin, in the proportions of a character.

Bone axes are those of an Unreal asset's file if one is given, so that animations are interchangeable with it. Without a
file the conventional axes of the mannequin (its table in `metadata`) are used, which are close but not equal; Unreal's
IK retargeter then transfers animations to the asset.

The mannequin has no eyes and no jaw: ``eye_l`` and ``eye_r`` are added to the head if the character has eyes; parts on
the jaw move with the head.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.export.own_skeleton import limb_twist
from app.export.target import HIPS, TargetSkeleton, Twist
from app.formats.toml import read_toml, shaped
from app.rig import quaternion
from app.rig.characters.bone_placements import local_placements
from app.rig.characters.t_pose import rest_of, turns_to_t_pose, upright
from app.rig.figure import Figure
from app.rig.model import Skeleton
from app.rig.skeleton import rest_positions
from metadata.model import REQUIRED_JOINTS
from metadata.tables import ROOT

TABLE: Final = ROOT / "mannequin.toml"


class _Bone(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A bone of Unreal's mannequin in the program's table: at a joint, at a share ``along`` of the way between two
    joints, or coinciding with another bone.
    """

    name: str
    parent: str = ""
    axes: str = ""
    joint: str = ""
    between: tuple[str, str] = ("", "")
    along: float = 0.0
    twists: bool = False
    tied: str = ""

    def of_side(self, x: str, side: str) -> _Bone:
        """Return the left or right variant of a bone defined for both sides."""
        said = msgspec.json.encode(self).decode().replace("{x}", x).replace("{side}", side)
        return msgspec.json.decode(said, type=_Bone)


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Contents of the program's table of the mannequin: bones before those of the sides, bones of each side, bones
    after them, added bones, and the named X and Z axes.
    """

    trunk: tuple[_Bone, ...]
    sides: tuple[_Bone, ...]
    others: tuple[_Bone, ...]
    added: tuple[_Bone, ...]
    axes: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]]


_TABLE: Final = shaped(read_toml(TABLE, TABLE.name), _Table, TABLE.name)
_BONES: Final = (
    *_TABLE.trunk,
    *(bone.of_side(x, side) for x, side in (("l", "left"), ("r", "right")) for bone in _TABLE.sides),
    *_TABLE.others,
)
_ADDED: Final = tuple(bone.of_side(x, side) for x, side in (("l", "left"), ("r", "right")) for bone in _TABLE.added)
MANNEQUIN: Final[Mapping[str, str]] = {bone.name: bone.parent for bone in _BONES}
"""Parent of each bone; empty for the root."""
_STRAIGHT: Final = ("root", "foot_l", "foot_r")
"""Bones with unrotated axes; all others have X along the bone."""


@dataclass(frozen=True, eq=False)
class MannequinAxes:
    """Rotations of the bones of an Unreal asset, by name of the bone.

    Attributes
    ----------
    rest : mapping of str to (4,) float64
        ``parent_from_bone`` in the rest pose.
    t_pose : mapping of str to (4,) float64
        ``world_from_bone`` in the T-pose.
    """

    rest: Mapping[str, FloatArray]
    t_pose: Mapping[str, FloatArray]


def mannequin_axes(asset: Figure) -> MannequinAxes:
    """Return the rotations of the mannequin's bones in a figure; empty if it lacks even the bones of a body."""
    names = {name: bone for bone, name in enumerate(asset.bone_names) if name in MANNEQUIN}
    bones = {bone.joint: names[bone.name] for bone in _BONES if bone.joint and bone.name in names}
    if any(joint not in bones for joint in REQUIRED_JOINTS):
        return MannequinAxes({}, {})  # not a mannequin; comparing the bones reports it
    asset = upright(asset, bones)
    rest = rest_of(asset)
    turns = turns_to_t_pose(asset, rest, bones)
    joint_of = {bone: joint for joint, bone in bones.items()}
    turned = np.tile(quaternion.IDENTITY, (len(asset.bone_names), 1))
    for bone, parent in enumerate(asset.parents):
        own = turns.get(joint_of.get(bone, ""))
        turned[bone] = own if own is not None else turned[parent] if parent >= 0 else quaternion.IDENTITY
    t_pose = quaternion.multiply(turned, rest.rotations)
    return MannequinAxes(
        {name: asset.rotations[bone] for name, bone in names.items()},
        {name: t_pose[bone] for name, bone in names.items()},
    )


def mannequin_target(skeleton: Skeleton, asset: MannequinAxes | None = None) -> TargetSkeleton:
    """Return a target skeleton with the mannequin's bones in the proportions of a character.

    Parameters
    ----------
    skeleton : Skeleton
        Skeleton of the character.
    asset : MannequinAxes, optional
        Axes of the asset for which it is made; bones missing there use the conventional axes.
    """
    names = tuple(MANNEQUIN)
    parents = tuple(names.index(bone.parent) if bone.parent else -1 for bone in _BONES)
    joint_of_bone = tuple(skeleton.names.index(bone.joint) if bone.joint in skeleton.names else -1 for bone in _BONES)
    tied = {index: names.index(bone.tied) for index, bone in enumerate(_BONES) if bone.tied}
    places = _places(skeleton, joint_of_bone, tied)
    turned = _conventional(places, tied)
    if asset is not None:
        for name in asset.t_pose.keys() & set(names):
            turned[names.index(name)] = asset.t_pose[name]
        for bone, other in tied.items():
            turned[bone] = turned[other]
    offsets, t_pose = local_placements(parents, places, turned)
    rest = t_pose.copy()
    if asset is not None:
        for name in asset.rest.keys() & set(names):
            rest[names.index(name)] = asset.rest[name]
    joint_from_bone = np.where((np.array(joint_of_bone) >= 0)[:, None], turned, quaternion.IDENTITY)
    twists = _twists(skeleton, places)
    joint_from_bone[list(twists)] = turned[list(twists)]
    target = TargetSkeleton(
        "ue5",
        names,
        parents,
        offsets,
        rest,
        t_pose,
        joint_of_bone,
        joint_from_bone,
        twists,
        tied,
        hips=joint_of_bone.index(skeleton.index(HIPS)),
    )
    return _with_added(target, skeleton, places, turned, asset or MannequinAxes({}, {}))


def _with_added(
    target: TargetSkeleton, skeleton: Skeleton, places: FloatArray, turned: FloatArray, asset: MannequinAxes
) -> TargetSkeleton:
    """Return the target with bones for those joints of the character that the mannequin lacks.

    ``places`` and ``turned`` are positions and rotations of the target's bones in the world.
    """
    added = [bone for bone in _ADDED if bone.joint in skeleton.names]
    if not added:
        return target
    joints = rest_positions(skeleton)
    parents = [target.names.index(bone.parent) for bone in added]
    numbers = [skeleton.index(bone.joint) for bone in added]
    own = np.stack([asset.t_pose.get(bone.name, _axes(bone)) for bone in added])
    back = quaternion.conjugate(turned[parents])
    local = quaternion.multiply(back, own)
    return replace(
        target,
        names=(*target.names, *(bone.name for bone in added)),
        parents=(*target.parents, *parents),
        offsets_m=np.concatenate([target.offsets_m, quaternion.rotate(back, joints[numbers] - places[parents])]),
        rest=np.concatenate(
            [target.rest, [asset.rest.get(bone.name, turn) for bone, turn in zip(added, local, strict=True)]]
        ),
        t_pose=np.concatenate([target.t_pose, local]),
        joint_of_bone=(*target.joint_of_bone, *numbers),
        joint_from_bone=np.concatenate([target.joint_from_bone, own]),
        added=frozenset(range(len(target.names), len(target.names) + len(added))),
    )


def _places(skeleton: Skeleton, joint_of_bone: tuple[int, ...], tied: Mapping[int, int]) -> FloatArray:
    """Return the world positions (B, 3) in metres of the mannequin's B bones, for a character's skeleton in
    the T-pose.
    """
    joints = rest_positions(skeleton)
    places = np.zeros((len(_BONES), 3))
    for index, bone in enumerate(_BONES):
        if joint_of_bone[index] >= 0:
            places[index] = joints[joint_of_bone[index]]
        elif bone.joint:  # toes: the only one of these joints that a body may lack
            ankle = joints[skeleton.index(bone.joint.replace("Toes", "Foot"))]
            places[index] = ankle + ankle[1] * np.array([0.0, -0.8, 1.5])
        elif bone.along:
            start, end = (joints[skeleton.index(name)] for name in bone.between)
            places[index] = start + bone.along * (end - start)
        elif index in tied:
            places[index] = places[tied[index]]
    return places


def _axes_of(bone: _Bone) -> tuple[FloatArray, FloatArray]:
    """Return the conventional X and Z axis (3,) of a bone of Unreal's mannequin in this program's world axes."""
    x, z = np.array(_TABLE.axes[bone.axes])[:, [0, 2, 1]]  # Y in Unreal is Z here
    return x, z


def _axes(bone: _Bone) -> FloatArray:
    x, z = _axes_of(bone)
    turn: FloatArray = quaternion.from_frames(x, np.cross(z, x))
    return turn


def _conventional(places: FloatArray, tied: Mapping[int, int]) -> FloatArray:
    """Return the world rotations (B, 4) of B bones in the T-pose with the mannequin's conventional axes.

    ``places`` (B, 3) are their positions, ``tied`` has the earlier bone with which a bone coincides.
    """
    names = tuple(MANNEQUIN)
    turned = np.tile(quaternion.IDENTITY, (len(_BONES), 1))
    for index, bone in enumerate(_BONES):
        if index in tied:
            turned[index] = turned[tied[index]]
            continue
        x, z = _axes_of(bone)
        if bone.axes not in _STRAIGHT and (way := _way(bone, places, names)) is not None:
            x = np.copysign(1.0, way @ x) * way
        y = np.cross(z, x)
        turned[index] = quaternion.from_frames(x, y / np.linalg.norm(y))
    return turned


def _way(bone: _Bone, places: FloatArray, names: tuple[str, ...]) -> FloatArray | None:
    """Return the world direction (3,) in which a bone of the mannequin points at rest; None for pelvis and head.

    That is towards the next bone of its chain; the last bone points like the one before.
    """
    index = names.index(bone.name)
    chain = [
        child
        for child, other in enumerate(_BONES)
        if other.parent == bone.name and other.axes[:-2] in (bone.axes[:-2], "foot") and not other.twists
    ]
    if bone.axes == "trunk" and bone.name in ("pelvis", "head"):
        return None
    if bone.axes.startswith("hand") and bone.name.startswith("hand"):
        chain = [child for child in chain if names[child].startswith("middle")]
    if bone.twists or not chain:
        if bone.parent not in names or bone.axes != _BONES[names.index(bone.parent)].axes:
            return None
        parent = names.index(bone.parent)
        if bone.twists:
            return _way(_BONES[parent], places, names)
        way = places[index] - places[parent]
    else:
        way = places[chain[0]] - places[index]
    length = float(np.linalg.norm(way))
    return way / length if length > 1e-6 else None


def _twists(skeleton: Skeleton, places: FloatArray) -> dict[int, Twist]:
    joints = rest_positions(skeleton)
    found = {}
    for index, bone in enumerate(_BONES):
        if bone.twists:
            base, end = (skeleton.index(name) for name in bone.between)
            way = joints[end] - joints[base]
            found[index] = limb_twist(skeleton, base, end, way / np.linalg.norm(way), bone.along)
    return found
