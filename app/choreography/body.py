"""The body of the choreography: 16 segments, each a joint of a normalised skeleton that moves everything beyond it.

Source: K. Kameda, I. Watanabe, M. Yamamoto, "Music Driven Computer Animation Based On HMM" (16 body parts).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import AnyFloatArray
from app.rig.model import Skeleton

PARENT_OF: Final = {
    "hips": "root",
    "spine": "hips",
    "chest": "spine",
    "head": "chest",
    "leftUpperArm": "chest",
    "leftLowerArm": "leftUpperArm",
    "leftHand": "leftLowerArm",
    "rightUpperArm": "chest",
    "rightLowerArm": "rightUpperArm",
    "rightHand": "rightLowerArm",
    "leftUpperLeg": "hips",
    "leftLowerLeg": "leftUpperLeg",
    "leftFoot": "leftLowerLeg",
    "rightUpperLeg": "hips",
    "rightLowerLeg": "rightUpperLeg",
    "rightFoot": "rightLowerLeg",
}
"""Parent of each segment, both by VRM 1.0 names."""
SEGMENTS: Final = tuple(PARENT_OF)
ENDS: Final = ("head", "leftHand", "rightHand", "leftFoot", "rightFoot")
"""Segments without children, each with an end (crown, fingertips, toes)."""
FEET: Final = ("leftFoot", "rightFoot")


def body_skeleton(offsets_m: AnyFloatArray) -> Skeleton:
    """Return the skeleton of a body: the root on the floor, then the 16 segments in the order of `SEGMENTS`.

    Parameters
    ----------
    offsets_m : (16, 3)
        Offset of each segment's proximal joint from its parent's in the T-pose facing +Z; the hips' offset is from the
        floor below them.
    """
    names = ("root", *SEGMENTS)
    parents = (-1, *(names.index(parent) for parent in PARENT_OF.values()))
    return Skeleton(names, parents, np.concatenate([np.zeros((1, 3)), np.asarray(offsets_m, np.float64)]))
