"""Lowest point of the skin of a foot, whose vertices move with the foot and its toes in parts."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.skin_around import skin_around
from app.rig import quaternion
from app.rig.ik import Side
from app.rig.model import Character
from app.rig.skeleton import rest_positions
from app.rig.sole import foot_joints, roll_point_m

PITCHES_DEG: Final = np.arange(-90.0, 271.0, 10.0)
"""Pitches of a foot in degrees for which its lowest vertices are found."""
ROLLS_DEG: Final = (-90.0, -60.0, -40.0, -25.0, -12.0, -5.0, 0.0, 5.0, 12.0, 25.0, 40.0, 60.0, 90.0)
"""Rolls of a foot in degrees for which its lowest vertices are found."""
BENDS_DEG: Final = (0.0, 8.0, 16.0, 25.0, 35.0, 45.0, 60.0)
"""Bends of toes in degrees for which the lowest vertices of a foot are found."""
PART: Final = 2000
"""Number of vertices that are compared at once."""


def lowest_m_of(vertices_m: FloatArray, foot: FloatArray, toes: FloatArray) -> FloatArray:
    """Return the height (F,) in metres of the lowest of some vertices relative to the ball of the foot.

    Parameters
    ----------
    vertices_m : (K, 6) float64
        Vertices, see `lowest_vertices_m`.
    foot : (F, 4) float64
        World rotation of the foot.
    toes : (F, 4) float64
        Rotation of the toes relative to the foot.
    """
    return np.asarray((_upward(foot, toes) @ vertices_m.T).min(axis=1, initial=np.inf))


def lowest_vertices_m(character: Character, side: Side) -> FloatArray:
    """Return the vertices (K, 6) of a foot's skin that are the lowest in some pose: their positions in the T-pose
    relative to the ball, in metres, times their weight to the foot, and the same times their weight to the toes.

    The height of a blended vertex is linear in both. The share of other joints (of the shin, around the ankle) counts
    as the foot's.
    """
    skeleton = character.skeleton
    joints = foot_joints(skeleton, side)
    ball_m = rest_positions(skeleton)[joints[0]] + roll_point_m(skeleton, side)
    poses, found = _poses(), np.zeros((0, 6))
    for own in skin_around(character, joints):
        toes = np.isin(own.mesh.joints[own.rows], joints[1:]) * own.mesh.weights[own.rows].astype(np.float64)
        share, place_m = np.clip(toes.sum(axis=1, keepdims=True), 0.0, 1.0), own.rest_m - ball_m
        both_m = np.concatenate([place_m * (1.0 - share), place_m * share], axis=1)
        for start in range(0, len(both_m), PART):
            found = np.concatenate([found, both_m[start : start + PART]])
            found = found[np.unique((poses @ found.T).argmin(axis=1))]
    return found


def _poses() -> FloatArray:
    """Return the vertical (P, 6) in the frames of foot and toes, in the poses of `PITCHES_DEG`, `ROLLS_DEG` and
    `BENDS_DEG`."""
    pitch, roll, bend = np.radians(list(product(PITCHES_DEG, ROLLS_DEG, BENDS_DEG))).T
    ahead, across = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    foot = quaternion.multiply(quaternion.from_axis_angle(across, pitch), quaternion.from_axis_angle(ahead, roll))
    return _upward(foot, quaternion.from_axis_angle(across, -bend))


def _upward(foot: FloatArray, toes: FloatArray) -> FloatArray:
    """Return the vertical (F, 6) in the frames of foot and toes, one after the other."""
    both = (foot, quaternion.multiply(foot, toes))
    return np.concatenate(
        [quaternion.rotate(quaternion.conjugate(turned), np.array([0.0, 1.0, 0.0])) for turned in both], axis=1
    )
