"""Conversion of skin weights for formats with a fixed number of influences per vertex."""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray, IntArray
from app.formats.scene import SkinnedMesh


def influences(mesh: SkinnedMesh) -> tuple[IntArray, FloatArray]:
    """Return bone indices and weights (V, K) of V vertices with at most K bones each, strongest first.

    Each bone occurs once per vertex and weights sum to 1; unused slots have bone 0 and weight 0. A vertex without
    weights follows the root. K is as small as possible.
    """
    count, width = mesh.weights.shape
    joints = np.where(mesh.weights > 0, mesh.joint_indices, -1).astype(np.int64)
    weights = np.where(mesh.weights > 0, mesh.weights, 0.0).astype(np.float64)
    by_joint = np.argsort(joints, axis=1, kind="stable")
    joints, weights = np.take_along_axis(joints, by_joint, axis=1), np.take_along_axis(weights, by_joint, axis=1)
    for slot in range(width - 1, 0, -1):
        # A bone that occurs twice is now in neighbouring slots: its weights are added in the first one.
        twice = joints[:, slot] == joints[:, slot - 1]
        weights[:, slot - 1] += np.where(twice, weights[:, slot], 0.0)
        weights[twice, slot] = 0.0
    by_weight = np.argsort(-weights, axis=1, kind="stable")
    joints, weights = np.take_along_axis(joints, by_weight, axis=1), np.take_along_axis(weights, by_weight, axis=1)
    used = max(1, int((weights > 0).sum(axis=1).max(initial=0)))
    result_joints, result_weights = np.zeros((count, used), dtype=np.int64), np.zeros((count, used))
    kept = min(used, width)
    result_joints[:, :kept], result_weights[:, :kept] = joints[:, :kept], weights[:, :kept]
    result_joints[result_weights == 0] = 0
    result_weights[result_weights.sum(axis=1) == 0, 0] = 1.0
    return result_joints, result_weights / result_weights.sum(axis=1, keepdims=True)
