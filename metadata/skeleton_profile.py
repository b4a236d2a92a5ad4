"""Table of a skeleton: its joints, their rotation axes, and fingers."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

import msgspec

from metadata.face_model import EmbouchureKind as EmbouchureKind
from metadata.face_model import EmbouchureWeights as EmbouchureWeights
from metadata.face_model import FaceMotion as FaceMotion
from metadata.units import AmplitudeScale as AmplitudeScale
from metadata.units import Axis as Axis
from metadata.units import Delay as Delay
from metadata.units import Fraction01 as Fraction01
from metadata.units import NotNegative as NotNegative
from metadata.units import Positive as Positive
from metadata.units import Range as Range
from metadata.units import at_amplitude as at_amplitude

Turn: TypeAlias = Literal["flexion", "sideways", "twist"]
"""An axis of `JointAxes`."""
USUAL_TURNS: Final[tuple[Turn, Turn, Turn]] = ("flexion", "sideways", "twist")


class JointAxes(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Anatomical axes of a joint in the T-pose, about which flexion, sideways bend and twist are measured. Positive
    flexion closes the joint or bends it forward; the other directions are explained in the profile's comments.
    """

    flexion: Axis
    sideways: Axis
    twist: Axis


class ProfileJoint(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A joint of the skeleton that every character has: its parent (empty for the root) and the key of its axes and
    limits."""

    name: str
    parent: str
    kind: str
    required: bool = True


class Finger(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The three joints of a finger, from the palm outwards."""

    joints: tuple[str, str, str]


class SkeletonProfile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Names and roles of a skeleton's joints.

    Attributes
    ----------
    joints : tuple of ProfileJoint
        In topological order.
    axes : dict of str to JointAxes
        Axes by joint kind, for the left side and the middle; see `joint_axes`.
    chains : dict of str to tuple of str
        ``spine``, ``neck``, ``left_arm`` (clavicle to hand), ``right_arm``, ``left_leg``, ``right_leg``.
    fingers : dict of str to dict of str to Finger
        Fingers by side (``left``, ``right``) and name (``thumb``, ``index``, ``middle``, ``ring``, ``little``).
    turns : dict of str to tuple of str
        Order of rotation axes, from the parent on, in files with angles, by joint kind; `USUAL_TURNS` by default.
    """

    name: str
    description: str
    joints: tuple[ProfileJoint, ...]
    axes: dict[str, JointAxes]
    chains: dict[str, tuple[str, ...]]
    fingers: dict[Literal["left", "right"], dict[Literal["thumb", "index", "middle", "ring", "little"], Finger]]
    turns: dict[str, tuple[Turn, Turn, Turn]] = {}

    def joint(self, name: str) -> ProfileJoint:
        """Return the joint with a name. Raises KeyError if there is none."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise KeyError(name)

    def joint_axes(self, name: str) -> JointAxes:
        """Return the anatomical axes of a joint. Those of a right joint are the left one's mirrored in the plane X = 0,
        so that signs have the same meaning on both sides (axes are pseudovectors: y and z change sign).
        """
        axes = self.axes[self.joint(name).kind]
        if not name.startswith("right"):
            return axes
        return JointAxes(_mirrored(axes.flexion), _mirrored(axes.sideways), _mirrored(axes.twist))


def _mirrored(axis: Axis) -> Axis:
    # 0.0 - y instead of -y avoids negative zeros.
    return (axis[0], 0.0 - axis[1], 0.0 - axis[2])
