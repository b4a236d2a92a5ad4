"""A motion file's own skeleton in one frame, which joint each of its bones is, and the error of a body not found in it.

What is found by itself stays known beside what a user corrects, also where the file cannot be read as a body.
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
"""Joints that a motion is read by; the parts of the trunk are the bones between hips and arms, whatever they are
called."""
REQUIRED: Final = tuple(name for name in SEGMENTS if name not in ("spine", "chest"))
"""Joints without which no motion is read."""


@dataclass(frozen=True, eq=False)
class RawSkeleton:
    """A file's skeleton in one frame.

    Attributes
    ----------
    found : JointMapping
        Bones as they are found without corrections.
    places : ndarray, shape (J, 3)
        Joints, Y up, in the file's unit.
    lines : ndarray, shape (L, 2, 3)
        From each bone's parent to the bone, and to the ends of the last ones.
    figures : tuple of str
        Names of all skeletons of the file where it has several.
    figure_name : str
        This one's among them.
    """

    figure: Figure
    found: JointMapping
    places: FloatArray
    lines: FloatArray
    figures: tuple[str, ...] = ()
    figure_name: str = ""

    def corrected(self, joints: Mapping[str, str]) -> JointMapping:
        """Bones with a user's corrections. Raises FileError where one names what there is not."""
        return corrected(self.figure, self.found, joints, JOINTS)


class BodyError(FileError):
    """No body was found in a skeleton, whose bones can be corrected by hand."""

    def __init__(self, id: str, skeleton: RawSkeleton, /, **arguments: Argument) -> None:
        super().__init__(id, **arguments)
        self.skeleton = skeleton


def zero_pose(bvh: BvhClip, file: str) -> Figure:
    """The zero pose, in the file's unit: nothing that reads it depends on the size."""
    still = np.zeros((len(bvh.names), 4))
    still[:, 3] = 1.0
    return Figure(file, "bvh", bvh.names, bvh.parents, np.asarray(bvh.offsets_cm, np.float64), still, ())


def raw_skeleton(
    bvh: BvhClip, file: str, found: JointMapping, places: FloatArray, rotations: FloatArray
) -> RawSkeleton:
    """Skeleton in one frame.

    Parameters
    ----------
    places, rotations : ndarray, shapes (J, 3) and (J, 4)
        In the world, Y up.
    """
    lines = [(places[parent], places[joint]) for joint, parent in enumerate(bvh.parents) if parent >= 0]
    lines += [
        (places[joint], places[joint] + quaternion.rotate(rotations[joint], end))
        for joint, end in bvh.end_sites_cm.items()
    ]
    shape = np.array(lines, np.float64).reshape(-1, 2, 3)
    return RawSkeleton(zero_pose(bvh, file), found, places, shape, bvh.figures, bvh.figure)
