"""Our world as Unity sees it: left-handed, Y up, +X to the right when facing +Z; bones by `HumanBodyBones`."""

from __future__ import annotations

import numpy as np

from app.arrays import AnyFloatArray, FloatArray

_POSITION = np.array([-1.0, 1.0, 1.0])
_ROTATION = np.array([1.0, -1.0, -1.0, 1.0])
# The thumb's first bone is a metacarpal in VRM 1.0, and already the proximal one in Unity.
_THUMB = {"ThumbMetacarpal": "ThumbProximal", "ThumbProximal": "ThumbIntermediate"}


def unity_positions(positions_m: AnyFloatArray) -> FloatArray:
    """Positions (..., 3) in Unity's space, metres."""
    return np.asarray(positions_m * _POSITION + 0.0, np.float64)


def unity_rotations(rotations: AnyFloatArray) -> FloatArray:
    """Rotations (..., 4), xyzw, in Unity's space."""
    return np.asarray(rotations * _ROTATION, np.float64)


def unity_bone(joint: str) -> str:
    """The name in `HumanBodyBones` of a VRM 1.0 joint."""
    for side in ("left", "right"):
        if joint.startswith(side):
            part = joint.removeprefix(side)
            return side.capitalize() + _THUMB.get(part, part)
    return joint[:1].upper() + joint[1:]
