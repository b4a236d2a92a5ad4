"""A body in one frame as points for drawing: joints, ends, outlines of the feet and directions of the knees.

Everything is oriented by the body's facing and relative to its height: X to its left, Y up from the floor, Z ahead.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.captured_joints import BENT_DEG, Y, unit
from app.choreography.clip import MotionClip
from app.choreography.features import ANKLE_PART, facing, joint_points_m, points_m, size_m
from app.rig import quaternion

_KNEES: Final = tuple(SEGMENTS.index(f"{side}LowerLeg") for side in ("left", "right"))
_OUTLINE: Final = ((0.11, -0.24), (0.2, 0.62), (0.09, 0.97), (-0.09, 0.97), (-0.2, 0.62), (-0.11, -0.24))
"""Outline of a sole: places to the left of and ahead of the ankle, relative to the distance from ankle to toes."""
_KNEE_PART: Final = 0.06
"""Length of a drawn knee's direction relative to the height."""


@dataclass(frozen=True, eq=False)
class BodyPose:
    """Points of a body in one frame.

    Attributes
    ----------
    points : ndarray, shape (21, 3)
        Joints of the segments, then the ends, as in `app.choreography.features.points_m`.
    feet : ndarray, shape (2, 7, 3)
        Ankle and outline of the sole of the left and the right foot.
    knees : ndarray, shape (K, 2, 3)
        Start and end of the line that shows to which side a knee points; none for a knee that never bends.
    """

    points: FloatArray
    feet: FloatArray
    knees: FloatArray


def body_pose(clip: MotionClip, frame: int, caps: FloatArray | None = None) -> BodyPose:
    """Return the pose of a clip at a frame.

    Parameters
    ----------
    caps : ndarray, shape (2, 3), optional
        Directions of the knees, see `knee_caps`.
    """
    one = clip.span(frame, frame + 1)
    turn, below, size = quaternion.conjugate(facing(one)[0]), one.hips_m[0] * (1.0, 0.0, 1.0), size_m(one)
    rotations = one.world().rotations[0, 1:]

    def seen(places: FloatArray) -> FloatArray:
        return np.asarray(quaternion.rotate(turn, places - below) / size)

    joints = joint_points_m(one)[0]
    feet = [
        joints[SEGMENTS.index(name)] + quaternion.rotate(rotations[SEGMENTS.index(name)], _foot_m(clip, name))
        for name in FEET
    ]
    lines = []
    for knee, cap in zip(_KNEES, np.zeros((2, 3)) if caps is None else caps, strict=True):
        if np.linalg.norm(cap):
            way = quaternion.rotate(rotations[knee], cap) * _KNEE_PART * size
            lines.append((joints[knee], joints[knee] + way))
    return BodyPose(seen(joints), seen(np.array(feet)), seen(np.array(lines).reshape(-1, 2, 3)))


def t_pose_of(clip: MotionClip) -> MotionClip:
    """Return a single frame with the body in T-pose, its soles on the floor."""
    still = np.tile(quaternion.IDENTITY, (1, len(SEGMENTS), 1))
    return MotionClip(clip.shape, clip.fps, clip.shape.offsets_m[:1], still)


def knee_caps(clip: MotionClip) -> FloatArray:
    """Find the direction (2, 3) in which the left and the right knee point, in the axes of the lower legs: +Z if they
    bend as knees do, zero for a knee that never bends.

    It is across the mean axis about which the knee bends during the motion, not taken from the bones' own axes.
    """
    positions, rotations = points_m(clip), clip.world().rotations[:, 1:]
    found = np.zeros((2, 3))
    for side, knee in enumerate(_KNEES):
        above, below = positions[:, knee - 1], positions[:, knee + 1]
        bend = np.cross(unit(positions[:, knee] - above), unit(below - positions[:, knee]))
        if np.percentile(np.linalg.norm(bend, axis=1), 90) > np.sin(np.radians(BENT_DEG[0])):
            axis = quaternion.rotate(quaternion.conjugate(rotations[:, knee]), bend).sum(axis=0)
            found[side] = unit(np.cross(axis, Y))
    return found


def _foot_m(clip: MotionClip, name: str) -> FloatArray:
    """Ankle and outline of the sole (7, 3) of a foot in its axes, in metres from the ankle."""
    tip = clip.shape.ends_m[ENDS.index(name)]
    reach_m = float(np.linalg.norm(tip))
    ahead = unit(tip * (1.0, 0.0, 1.0))
    left = np.cross(Y, ahead)
    sole = [reach_m * (aside * left + far * ahead - ANKLE_PART * Y) for aside, far in _OUTLINE]
    return np.array([np.zeros(3), *sole])
