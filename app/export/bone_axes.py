"""Axes that the bones of a file turn about: those of the anatomy, in the space of each bone.

Formats with angles turn a bone about three axes one after another. Where the middle one of them is a quarter turn away,
the other two turn about the same line and their curves jump; so the middle one is an axis that a body turns little
about, and the first, wherever there is one, a hinge. The skeleton's table (`metadata.skeleton_profile`) has the order
of each kind of joint; the nearest axes of the bone have it in the file. Nothing depends on a motion, so that all files
on one skeleton have the same orders.
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
"""A bone that is where a hand or foot is turns with the whole limb, and then least about the limb's length."""

OBJECT_AXES: FloatArray = np.eye(3)[[1, 2, 0]]
"""Axes of an instrument: the way it faces, then to its side, then up and down, which may be straight down."""


def bone_axes(target: TargetSkeleton, skeleton: Skeleton) -> tuple[FloatArray | None, ...]:
    """Axes (3, 3) of each bone of a target, as of `app.formats.scene.Bone`; None of one that is no joint.

    Parameters
    ----------
    target : TargetSkeleton
    skeleton : Skeleton
        The character's, whose joints the target's bones are.
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
    """Axes of a joint in the space of its bone, in an order."""
    rows = np.array([getattr(axes, turn) for turn in turns], np.float64)
    turned: FloatArray = quaternion.rotate(quaternion.conjugate(joint_from_bone), rows)
    return turned
