"""Eyeballs, and the lids that lie on them and stay on them when a body is changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.people.moved_joints import SIDES, MovedJoints

LID_M = (0.002, 0.008)
"""Heights in metres above the eyeball up to which lids keep their distance from it, and from which they do not."""


@dataclass(frozen=True, eq=False)
class NearEye:
    """Those of N points that are near an eyeball, such as the lids.

    Attributes
    ----------
    eye : int
        Joint of the eye.
    rows : (K,) int
        Indices of the points.
    far_m : (K,)
        Their distances from the centre of the eyeball.
    share : (K, 1)
        Share by which they keep that distance.
    """

    eye: int
    rows: IndexArray
    far_m: FloatArray
    share: FloatArray


def near_eyes(character: Character, points_m: FloatArray) -> tuple[NearEye, ...]:
    """Return the points (N, 3) that are near each eyeball of a body in its rest pose; empty if there are none."""
    found = []
    for side, _ in SIDES:
        eye = character.skeleton.index(f"{side}Eye")
        radius_m = _ball_m(character, eye)
        far_m = np.linalg.norm(points_m - _centre_m(character, eye), axis=1)
        rows = np.flatnonzero((far_m < radius_m + LID_M[1]) & (far_m > 0.5 * radius_m))
        if not radius_m or not len(rows):
            continue
        share = np.clip((radius_m + LID_M[1] - far_m[rows]) / (LID_M[1] - LID_M[0]), 0.0, 1.0)[:, None]
        found.append(NearEye(eye, rows, far_m[rows], share * share * (3.0 - 2.0 * share)))
    return tuple(found)


def off_the_eyes(near: Sequence[NearEye], after_m: FloatArray, joints: MovedJoints) -> FloatArray:
    """Return the points (N, 3) on a changed body, in which those near an eyeball keep their distances from its centre,
    so that lids still fit. ``after_m`` is changed.
    """
    for one in near:
        way = after_m[one.rows] - joints.after[one.eye, :3, 3]
        kept = way * (one.far_m / np.maximum(np.linalg.norm(way, axis=1), 1e-6))[:, None]
        after_m[one.rows] += one.share * (kept - way)
    return after_m


def ball_rows(mesh: Mesh, eye: int) -> IndexArray:
    """Return the vertices (K,) of a mesh that belong to the eyeball of a joint."""
    return np.flatnonzero((mesh.weights * (mesh.joints == eye)).sum(axis=1) > 0.99)


def _centre_m(character: Character, eye: int) -> FloatArray:
    centre: FloatArray = np.linalg.inv(character.joint_from_mesh)[eye, :3, 3].astype(np.float64)
    return centre


@lru_cache(maxsize=16)
def _ball_m(character: Character, eye: int) -> float:
    """Return the radius of an eyeball in metres; 0 if there is none."""
    centre = np.linalg.inv(character.joint_from_mesh[eye])[:3, 3]
    radii = [0.0]
    for mesh in character.meshes:
        radii += np.linalg.norm(mesh.positions_m[ball_rows(mesh, eye)] - centre, axis=1).tolist()
    return float(max(radii))
