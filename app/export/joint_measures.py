"""Measurement of joint angles and angular accelerations in a file against human limits."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.export.joint_playback import JointPlayback
from app.export.joints import anatomical_angles, angular_accelerations
from metadata.model import Body, JointLimits
from metadata.skeleton_profile import SkeletonProfile

_CHUNK = 512
BEYOND_DEG = 0.1
"""Degrees beyond its range from which a joint counts as beyond it. A joint that turns between two angles at the edge of
its range passes up to 0.06 degrees outside, since rotations do not add like angles; 0.1 degrees move a fingertip by
less than 0.2 mm.
"""
_AXES = ("flexion", "sideways", "twist")


class JointMeasure(msgspec.Struct, frozen=True):
    """The joint closest to its limit, or furthest beyond it: its value and bound, and in ``beyond`` the number of
    frames in which any joint is beyond.
    """

    joint: str
    value: float
    bound: float
    beyond: int
    """Number of frames in which any of the joints exceeds the bound."""


def measure_joints(
    joints: JointPlayback, body: Body, profile: SkeletonProfile, fps: float
) -> tuple[JointMeasure, JointMeasure]:
    """Return two measures: the joint angle furthest beyond its range in degrees (negative if all angles are inside, by
    at least that much) with the bound `BEYOND_DEG`, and the angular acceleration closest to its limit.
    """
    frames, limits = joints.playback.clip.frames, _limits(joints, body, profile)
    bounds = np.array([limit.acceleration_rad_s2 for limit in limits.values()])[:, None]
    low, high = _ranges_deg(limits.values())
    axes = np.array([msgspec.structs.astuple(profile.joint_axes(joints.names[bone])) for bone in limits])
    furthest, fastest = np.full((len(_AXES), len(limits)), -math.inf), np.zeros(len(limits))
    outside = too_fast = 0
    # In chunks that fit a core's cache, with two additional frames for the accelerations.
    for first in range(0, frames if limits else 0, _CHUNK):
        turns = joints.rotations(first, min(first + _CHUNK + 2, frames)).transpose(2, 1, 0)[:, [*limits]]
        moves = (turns != turns[..., :1]).any(axis=(0, 2))
        for rows, some in ((~moves, turns[:, ~moves, :1]), (moves, turns[:, moves])):
            angles = np.degrees(anatomical_angles(some[..., :_CHUNK], axes[rows]))
            excess = np.maximum(low[:, rows] - angles.min(axis=-1), angles.max(axis=-1) - high[:, rows])
            furthest[:, rows] = np.maximum(furthest[:, rows], excess)
            if (excess > BEYOND_DEG).any():
                beyond = np.maximum(low[:, rows, None] - angles, angles - high[:, rows, None]) > BEYOND_DEG
                outside += int(beyond.sum()) * (min(_CHUNK, frames - first) // angles.shape[-1])
        accelerations = angular_accelerations(turns[:, moves], fps)
        if accelerations.size:
            fastest[moves] = np.maximum(fastest[moves], accelerations.max(axis=-1))
            too_fast += int((accelerations > bounds[moves]).sum())
    return _furthest(joints, limits, furthest.T, outside), _fastest(joints, limits, fastest, bounds[:, 0], too_fast)


def _limits(joints: JointPlayback, body: Body, profile: SkeletonProfile) -> Mapping[int, JointLimits]:
    """Return the anatomical limits of the joints that have some, by their index in the playback."""
    known = {joint.name: joint.kind for joint in profile.joints}
    kinds = {bone: known.get(name, "") for bone, name in enumerate(joints.names)}
    return {bone: body.limits[kind] for bone, kind in kinds.items() if kind in body.limits}


def _ranges_deg(limits: Iterable[JointLimits]) -> FloatArray:
    """Return the smallest and the largest angles (2, 3, J) in degrees: flexion, sideways and twist of J joints."""
    rows = [(one.flexion_deg, one.sideways_deg, one.twist_deg) for one in limits]
    return np.array(rows).reshape(-1, len(_AXES), 2).T


def _furthest(
    joints: JointPlayback, limits: Mapping[int, JointLimits], excess_deg: FloatArray, beyond: int
) -> JointMeasure:
    worst = ("", -math.inf)
    for bone, row in zip(limits, excess_deg, strict=True):
        for name, excess in zip(_AXES, row, strict=True):
            worst = max(worst, (f"{joints.names[bone]} {name}", round(float(excess), 4)), key=lambda item: item[1])
    return JointMeasure(worst[0], worst[1], BEYOND_DEG, beyond)


def _fastest(
    joints: JointPlayback, limits: Mapping[int, JointLimits], greatest: FloatArray, bounds: FloatArray, beyond: int
) -> JointMeasure:
    if joints.playback.clip.frames < 3 or not limits:
        return JointMeasure("", 0.0, 0.0, 0)
    worst = int(np.argmax(greatest / bounds))
    return JointMeasure(joints.names[[*limits][worst]], round(float(greatest[worst]), 3), float(bounds[worst]), beyond)
