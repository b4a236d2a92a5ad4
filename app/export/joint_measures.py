"""Whether the joints of a file stay within human ranges and accelerations."""

from __future__ import annotations

import math
from collections.abc import Mapping

import msgspec
import numpy as np
import numpy.typing as npt

from app.export.joint_playback import JointPlayback
from app.export.joints import anatomical_angles, angular_accelerations
from metadata.model import Body, JointLimits, SkeletonProfile

FloatArray = npt.NDArray[np.float64]

_CHUNK = 2048
_BEYOND_DEG = 0.01
_AXES = ("flexion", "sideways", "twist")


class JointMeasure(msgspec.Struct, frozen=True):
    """The joint that comes nearest to its bound, or goes beyond it."""

    joint: str
    value: float
    bound: float
    beyond: int
    """Frames (of any joint) beyond the bound."""


def measure_joints(
    joints: JointPlayback, body: Body, profile: SkeletonProfile, fps: float
) -> tuple[JointMeasure, JointMeasure]:
    """The joint angle that goes furthest beyond its range, degrees (negative: inside all ranges by that much), and the
    angular acceleration that comes nearest to its human bound."""
    frames, limits = joints.playback.clip.frames, _limits(joints, body, profile)
    bounds = np.array([limit.acceleration_rad_s2 for limit in limits.values()])
    furthest, fastest = np.full((len(limits), len(_AXES)), -math.inf), np.zeros(len(limits))
    outside = too_fast = 0
    # A chunk at a time, and two frames more for the accelerations: the rotations of a long file are many.
    for first in range(0, frames, _CHUNK):
        rotations = joints.rotations(first, min(first + _CHUNK + 2, frames))
        for row, (bone, limit) in enumerate(limits.items()):
            excess = _excess_deg(rotations[:_CHUNK, bone], joints.names[bone], limit, profile)
            outside += int((excess > _BEYOND_DEG).sum())
            furthest[row] = np.maximum(furthest[row], excess.max(axis=0))
        accelerations = angular_accelerations(rotations[:, [*limits]], fps)
        if accelerations.size:
            fastest = np.maximum(fastest, accelerations.max(axis=0))
            too_fast += int((accelerations > bounds).sum())
    return _furthest(joints, limits, furthest, outside), _fastest(joints, limits, fastest, bounds, too_fast)


def _limits(joints: JointPlayback, body: Body, profile: SkeletonProfile) -> Mapping[int, JointLimits]:
    """By the index of the joint."""
    known = {joint.name: joint.kind for joint in profile.joints}
    kinds = {bone: known.get(name, "") for bone, name in enumerate(joints.names)}
    return {bone: body.limits[kind] for bone, kind in kinds.items() if kind in body.limits}


def _excess_deg(rotations: FloatArray, name: str, limits: JointLimits, profile: SkeletonProfile) -> FloatArray:
    """How far (F, 3) the angles of a joint are beyond their ranges."""
    axes = profile.joint_axes(name)
    angles = np.degrees(
        anatomical_angles(rotations, np.asarray(axes.flexion), np.asarray(axes.sideways), np.asarray(axes.twist))
    )
    low, high = np.array([limits.flexion_deg, limits.sideways_deg, limits.twist_deg]).T
    excess_deg: FloatArray = np.maximum(low - angles, angles - high)
    return excess_deg


def _furthest(
    joints: JointPlayback, limits: Mapping[int, JointLimits], excess_deg: FloatArray, beyond: int
) -> JointMeasure:
    worst = ("", -math.inf)
    for bone, row in zip(limits, excess_deg, strict=True):
        for name, excess in zip(_AXES, row, strict=True):
            worst = max(worst, (f"{joints.names[bone]} {name}", round(float(excess), 4)), key=lambda item: item[1])
    return JointMeasure(worst[0], worst[1], 0.0, beyond)


def _fastest(
    joints: JointPlayback, limits: Mapping[int, JointLimits], greatest: FloatArray, bounds: FloatArray, beyond: int
) -> JointMeasure:
    if joints.playback.clip.frames < 3 or not limits:
        return JointMeasure("", 0.0, 0.0, 0)
    worst = int(np.argmax(greatest / bounds))
    return JointMeasure(joints.names[[*limits][worst]], round(float(greatest[worst]), 3), float(bounds[worst]), beyond)
