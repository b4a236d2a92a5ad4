"""The bones of a file under the names that other programs give theirs."""

from __future__ import annotations

from app.export.target import TargetSkeleton
from app.rig.model import Skeleton
from metadata.known_names import BoneNames
from metadata.load import load_bone_names

SPINE = ("spine", "chest", "upperChest")


def joint_names(table: BoneNames) -> dict[str, str]:
    """The name of every joint that a table knows: of several the first. Of the bones between hips and neck the lowest
    are ours."""
    result = {joint: names[0] for joint, names in table.middle.items()}
    result |= {joint: names[0] for joint, names in zip(SPINE, table.spine, strict=False)}
    for side, words in (("left", table.left), ("right", table.right)):
        result |= {side + joint: names[0].replace("{side}", words[0]) for joint, names in table.sides.items()}
    return result


def profile_names(profile: str, target: TargetSkeleton, skeleton: Skeleton) -> dict[int, str]:
    """Names by bone for a skeleton that is written on; a bone that is no joint of the profile keeps its own.

    Parameters
    ----------
    profile : str
        Name of a table of bone names.
    target : TargetSkeleton
    skeleton : Skeleton
        The character's, whose joints the target's bones are.
    """
    names = joint_names(load_bone_names()[profile])
    joints = {joint: names[name] for joint, name in enumerate(skeleton.names) if name in names}
    return {bone: joints[joint] for joint, bone in target.bone_of_joint.items() if joint in joints}
