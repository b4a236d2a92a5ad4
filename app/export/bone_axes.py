"""Anatomical rotation axes of the bones of a file, in each bone's space.

Formats with Euler angles rotate about three axes in order. If the middle rotation is a quarter turn, the other two axes
coincide and curves jump; so the middle axis is one with little rotation, and the first one a hinge if possible. The
skeleton's table (`metadata.skeleton_profile`) has the order for each kind of joint; the file uses the nearest axes of
the bone. The result does not depend on a motion, so all files on one skeleton agree.
"""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray
from app.export.target import TargetSkeleton
from app.rig import quaternion
from app.rig.model import Skeleton
from metadata.load import load_skeleton
from metadata.skeleton_profile import USUAL_TURNS, JointAxes, Turn

_TIED: tuple[Turn, Turn, Turn] = ("flexion", "twist", "sideways")
"""Order of axes for bones at a hand or foot whose place is fixed: they rotate with the whole limb, least about its
length.
"""

OBJECT_AXES: FloatArray = np.eye(3)[[1, 2, 0]]
"""Axes (3, 3) of an instrument: forward, sideways, up; the last one may be vertical."""


def bone_axes(target: TargetSkeleton, skeleton: Skeleton) -> tuple[FloatArray | None, ...]:
    """Return the rotation axes (3, 3) of each bone of a target, in the form of `app.formats.scene.Bone`; None for a
    bone that is no joint.

    Parameters
    ----------
    target : TargetSkeleton
        Skeleton with the bones.
    skeleton : Skeleton
        Skeleton of the character, whose joints correspond to the target's bones.
    """
    profile = load_skeleton()
    result: list[FloatArray | None] = []
    for bone, joint in enumerate(target.joint_of_bone):
        if bone in target.tied:
            joint = target.joint_of_bone[target.tied[bone]]
        if joint < 0:
            result.append(None)
            continue
        name = skeleton.names[joint]
        kind = profile.joint(name).kind
        turns = _TIED if bone in target.tied else profile.turns.get(kind, USUAL_TURNS)
        result.append(_in_bone(profile.joint_axes(name), turns, target.joint_from_bone[bone]))
    return tuple(result)


def _in_bone(axes: JointAxes, turns: tuple[Turn, ...], joint_from_bone: FloatArray) -> FloatArray:
    """Return the axes (N, 3) of a joint named in ``turns`` (such as flexion), in that order, in the frame of
    its bone.
    """
    rows = np.array([getattr(axes, turn) for turn in turns], np.float64)
    turned: FloatArray = quaternion.rotate(quaternion.conjugate(joint_from_bone), rows)
    return turned
