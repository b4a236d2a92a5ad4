"""Skinning of whole patches of a character vertex by vertex, as a reference for landmarks and files."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.rig.skeleton import JointTransforms
from app.rig.skinning import Patch, skin_matrices


def deform(part: Patch, transforms: JointTransforms, morphs: Mapping[str, AnyFloatArray] | None = None) -> FloatArray:
    """Deform the vertices of a patch.

    Parameters
    ----------
    part : Patch
    transforms : JointTransforms
        Must hold every joint of the patch.
    morphs : dict of str to (F,), optional
        Weight curves by morph name.

    Returns
    -------
    (F, V, 3) float64
        World positions, metres.
    """
    matrices = skin_matrices(part.joints, part.joint_from_mesh, transforms)
    positions = part.positions_m[None]
    for name, deltas in part.morphs.items():
        if morphs is not None and name in morphs:
            positions = positions + np.multiply.outer(np.asarray(morphs[name], dtype=np.float64), deltas)
    blended = np.tensordot(matrices, part.weights, axes=([1], [1]))  # (F, 3, 4, V)
    result: FloatArray = (blended[:, :, :3] * positions.transpose(0, 2, 1)[:, None]).sum(axis=2)
    result += blended[:, :, 3]
    return np.ascontiguousarray(result.transpose(0, 2, 1))
