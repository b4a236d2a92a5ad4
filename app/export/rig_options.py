"""Options for skeletons: attachment of instruments, root bone, rest pose, twist bones, eyes."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias, get_args

import msgspec

Attachment: TypeAlias = Literal["free", "socket", "ik"]
"""Attachment of the instrument: its own motion in the world, a child of the holding hand's bone, or a child of that
hand's IK target.
"""
RootBone: TypeAlias = Literal["origin", "place", "motion"]
"""Motion of the root bone: none (at the origin), none (at the place on the stage), or along the floor below
the hips.
"""
EyeTurn: TypeAlias = Literal["shapes", "bones"]
"""Representation of eye movement: the face's eyeLook shapes, or bones of the eyes."""
RestPose: TypeAlias = Literal["model", "t", "a"]
"""Rest pose of the arms: as modelled, horizontal (T-pose), or 45 degrees down (A-pose)."""

ATTACHMENTS: Final[tuple[Attachment, ...]] = get_args(Attachment)
ROOT_BONES: Final[tuple[RootBone, ...]] = get_args(RootBone)
REST_POSES: Final[tuple[RestPose, ...]] = get_args(RestPose)
EYE_TURNS: Final[tuple[EyeTurn, ...]] = get_args(EyeTurn)


class RigOptions(msgspec.Struct, frozen=True):
    """Requested options for skeletons.

    Attributes
    ----------
    instrument : Attachment
        Attachment of instruments.
    root_bone : RootBone
        Behaviour of the root bone.
    rest_pose : RestPose
        Rest pose of the file.
    twist_bones : bool
        Whether twist bones of the arms are added and hold skin.
    eyes : EyeTurn
        Whether shapes or bones rotate the eyes.
    """

    instrument: Attachment = "free"
    root_bone: RootBone = "origin"
    rest_pose: RestPose = "model"
    twist_bones: bool = False
    eyes: EyeTurn = "shapes"


DEFAULT_RIG: Final = RigOptions()
"""Options for an unchanged skeleton and an unattached instrument."""
