"""A motion file's own skeleton in one frame, the joints of its bones, and the error if no body is found in it.

Automatic results are kept beside the user's corrections, even if the file cannot be read as a body.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.errors import Argument, FileError
from app.formats.bvh.clip import BvhClip
from app.rig import quaternion
from app.rig.characters.joint_mapping import JointMapping, corrected
from app.rig.figure import Figure

_SIDED: Final = ("Eye", "Toes", *(f"{finger}Proximal" for finger in ("Index", "Middle", "Ring", "Little")))
JOINTS: Final = (
    *(name for name in SEGMENTS if name not in ("spine", "chest")),
    "neck",
    *(f"{side}{part}" for part in _SIDED for side in ("left", "right")),
)
"""Joints from which a motion is read; the parts of the trunk are the bones between hips and arms, regardless of
names.
"""
REQUIRED: Final = tuple(name for name in SEGMENTS if name not in ("spine", "chest"))
"""Joints that are necessary for reading a motion."""


@dataclass(frozen=True, eq=False)
class RawSkeleton:
    """Skeleton of a motion file in one frame, as shown to the user who maps its bones.

    Attributes
    ----------
    found : JointMapping
        Bones found without corrections.
    places : ndarray, shape (J, 3)
        Position of each joint, Y up, in the file's unit.
    lines : ndarray, shape (L, 2, 3)
        Lines from each bone's parent to the bone, and to the ends of the last ones.
    figures : tuple of str
        Names of all skeletons in a file with several.
    figure_name : str
        Name of this skeleton among them.
    """

    figure: Figure
    found: JointMapping
    places: FloatArray
    lines: FloatArray
    figures: tuple[str, ...] = ()
    figure_name: str = ""

    def corrected(self, joints: Mapping[str, str]) -> JointMapping:
        """Return the bones with the user's corrections. Raises FileError for an unknown name."""
        return corrected(self.figure, self.found, joints, JOINTS)


class BodyError(FileError):
    """No body was found in a skeleton; the user can correct its bones."""

    def __init__(self, id: str, skeleton: RawSkeleton, /, **arguments: Argument) -> None:
        super().__init__(id, **arguments)
        self.skeleton = skeleton


def zero_pose(bvh: BvhClip, file: str) -> Figure:
    """Return the figure of the file's zero pose, in the file's unit."""
    still = np.zeros((len(bvh.names), 4))
    still[:, 3] = 1.0
    return Figure(file, "bvh", bvh.names, bvh.parents, np.asarray(bvh.offsets_cm, np.float64), still, ())


def raw_skeleton(
    bvh: BvhClip, file: str, found: JointMapping, places: FloatArray, rotations: FloatArray
) -> RawSkeleton:
    """Build the skeleton of one frame for showing it to the user.

    Parameters
    ----------
    places, rotations : ndarray, shapes (J, 3) and (J, 4)
        World positions and rotations of the joints, Y up.
    """
    lines = [(places[parent], places[joint]) for joint, parent in enumerate(bvh.parents) if parent >= 0]
    lines += [
        (places[joint], places[joint] + quaternion.rotate(rotations[joint], end))
        for joint, end in bvh.end_sites_cm.items()
    ]
    shape = np.array(lines, np.float64).reshape(-1, 2, 3)
    return RawSkeleton(zero_pose(bvh, file), found, places, shape, bvh.figures, bvh.figure)
