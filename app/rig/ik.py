"""Analytic two-bone inverse kinematics of arms and legs, vectorised over frames.

A limb is an upper bone, a lower bone and an end (hand or foot). Bones never stretch: a target out of reach is
approached, with the last per cent of the limb's length softened so that the middle joint does not jump.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.model import Skeleton

Side = Literal["left", "right"]

SOFT_SHARE = 0.01
"""Share of the limb's length within which full extension is approached exponentially."""

TWIST_SHARE = 0.5
"""Share of the hand's twist that the forearm takes, so that neither wrist nor elbow is twisted too far."""


@dataclass(frozen=True, eq=False)
class Limb:
    """The joints and rest geometry of an arm or a leg.

    Attributes
    ----------
    upper, lower, end : int
        Joints: shoulder, elbow, wrist; or hip, knee, ankle.
    upper_vector_m, lower_vector_m : (3,) float64
        Vector from each joint to the next at rest.
    hinge_axis : (3,) float64
        Unit axis at rest about which a positive rotation of the lower bone bends the limb.
    twist_share : float
        Share of the end's twist about the lower bone that the lower bone takes (the forearm's pronation).
    """

    upper: int
    lower: int
    end: int
    upper_vector_m: FloatArray
    lower_vector_m: FloatArray
    hinge_axis: FloatArray
    twist_share: float

    @cached_property
    def upper_m(self) -> float:
        """Length of the upper bone in metres."""
        return float(np.linalg.norm(self.upper_vector_m))

    @cached_property
    def lower_m(self) -> float:
        """Length of the lower bone in metres."""
        return float(np.linalg.norm(self.lower_vector_m))

    @property
    def length_m(self) -> float:
        """Length in metres of upper and lower bone together."""
        return self.upper_m + self.lower_m

    @cached_property
    def rest_frames(self) -> tuple[FloatArray, FloatArray]:
        """Return for both bones the rotation (4,) at rest from the world to a frame of the bone's direction
        and hinge.
        """
        upper = _rest_frame(self.upper_vector_m / self.upper_m, self.hinge_axis)
        return upper, _rest_frame(self.lower_vector_m / self.lower_m, self.hinge_axis)


@dataclass(frozen=True)
class LimbPose:
    """Rotations of a limb: ``parent_from_joint`` (F, 4) of each joint, and the distance of the end from its target
    (F,).

    ``bones`` are the world rotations (F, 4) of upper and lower bone before the lower one takes its share of the twist.
    """

    upper: FloatArray
    lower: FloatArray
    end: FloatArray
    miss_m: FloatArray
    bones: tuple[FloatArray, FloatArray]


@lru_cache(maxsize=64)
def arm(skeleton: Skeleton, side: Side, twist_share: float = TWIST_SHARE) -> Limb:
    """Return the limb of an arm (VRM names). The elbow bends forwards in the T-pose."""
    hinge = np.array([0.0, -1.0 if side == "left" else 1.0, 0.0])
    return _limb(skeleton, [f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand"], hinge, twist_share)


@lru_cache(maxsize=64)
def leg(skeleton: Skeleton, side: Side, twist_share: float = 0.0) -> Limb:
    """Return the limb of a leg (VRM names). The knee bends backwards."""
    return _limb(
        skeleton, [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"], np.array([1.0, 0.0, 0.0]), twist_share
    )


def solve_limb(
    limb: Limb,
    root_m: FloatArray,
    parent_rotation: FloatArray,
    target_m: FloatArray,
    target_rotation: FloatArray,
    pole: FloatArray,
) -> LimbPose:
    """Return the pose of a limb whose end is at a target.

    Parameters
    ----------
    root_m : (F, 3) float64
        World position of the upper joint (shoulder or hip joint).
    parent_rotation : (F, 4) float64
        World rotation of the upper joint's parent.
    target_m, target_rotation : (F, 3) and (F, 4) float64
        Target world transform of the end joint.
    pole : (F, 3) or (3,) float64
        World direction of the middle joint from the line of root and target; need not be a unit vector or orthogonal.
    """
    a, b = limb.upper_m, limb.lower_m
    line = target_m - root_m
    requested = np.sqrt(quaternion.dot(line, line))
    direction = line / np.maximum(requested, 1e-9)[:, None]
    distance = _soft_limit(requested, a + b, abs(a - b))
    off = pole - direction * quaternion.dot(pole, direction)[:, None]
    off /= np.maximum(np.sqrt(quaternion.dot(off, off)), 1e-9)[:, None]
    # Law of cosines: the middle joint is `along` the line and `aside` of it.
    along = (a * a - b * b + distance * distance) / (2.0 * distance)
    aside = np.sqrt(np.maximum(a * a - along * along, 0.0))
    middle = direction * along[:, None] + off * aside[:, None]
    end = direction * distance[:, None]
    # Bending rotates the upper bone towards the end, about middle x (end - middle).
    hinge = quaternion.cross(off, direction)
    upper_rest, lower_rest = limb.rest_frames
    upper_world = quaternion.multiply(quaternion.from_frames(middle / a, hinge), upper_rest)
    lower_world = quaternion.multiply(quaternion.from_frames((end - middle) / b, hinge), lower_rest)
    return _posed(limb, (upper_world, lower_world), parent_rotation, target_rotation, np.abs(requested - distance))


def swivelled(
    limb: Limb, pose: LimbPose, turn: FloatArray, parent_rotation: FloatArray, target_rotation: FloatArray
) -> LimbPose:
    """Return the limb rotated by ``turn`` (F, 4), in the world, about the line from its root to its target; the end
    keeps its place and rotation.
    """
    upper_world, lower_world = (quaternion.multiply(turn, bone) for bone in pose.bones)
    return _posed(limb, (upper_world, lower_world), parent_rotation, target_rotation, pose.miss_m)


def end_of(limb: Limb, lower_world: FloatArray, target_rotation: FloatArray) -> FloatArray:
    """Return the rotation ``parent_from_joint`` (F, 4) of the end; ``lower_world`` is the lower bone before its share
    of the twist.
    """
    twisted = _with_twist(limb, lower_world, target_rotation)
    return quaternion.multiply(quaternion.conjugate(twisted), target_rotation)


def _posed(
    limb: Limb,
    bones: tuple[FloatArray, FloatArray],
    parent_rotation: FloatArray,
    target_rotation: FloatArray,
    miss_m: FloatArray,
) -> LimbPose:
    upper_world, lower_world = bones[0], _with_twist(limb, bones[1], target_rotation)
    return LimbPose(
        upper=quaternion.multiply(quaternion.conjugate(parent_rotation), upper_world),
        lower=quaternion.multiply(quaternion.conjugate(upper_world), lower_world),
        end=quaternion.multiply(quaternion.conjugate(lower_world), target_rotation),
        miss_m=miss_m,
        bones=bones,
    )


def _with_twist(limb: Limb, lower_world: FloatArray, target_rotation: FloatArray) -> FloatArray:
    if not limb.twist_share:
        return lower_world
    axis = limb.lower_vector_m / limb.lower_m
    twist = quaternion.twist_angle(quaternion.multiply(quaternion.conjugate(lower_world), target_rotation), axis)
    return quaternion.multiply(lower_world, quaternion.from_axis_angle(axis, limb.twist_share * twist))


def _soft_limit(distance: FloatArray, longest: float, shortest: float) -> FloatArray:
    """Keep distances within the limb's reach, smoothly (to the first derivative) near full extension."""
    band = SOFT_SHARE * longest
    over = np.maximum(distance - (longest - band), 0.0)
    soft = np.where(over > 0.0, longest - band * np.exp(-over / band), distance)
    return np.maximum(soft, shortest + 1e-6)


def _rest_frame(rest: FloatArray, hinge: FloatArray) -> FloatArray:
    """Return the rotation (4,) from the world to a frame whose axes are a bone's rest direction, and the component of
    its hinge orthogonal to that.
    """
    hinge = hinge - rest * float(rest @ hinge)
    return quaternion.conjugate(quaternion.from_frames(rest, hinge / np.linalg.norm(hinge)))


def _limb(skeleton: Skeleton, names: list[str], hinge: FloatArray, twist_share: float) -> Limb:
    upper, lower, end = (skeleton.index(name) for name in names)
    return Limb(upper, lower, end, skeleton.offsets_m[lower], skeleton.offsets_m[end], hinge, twist_share)
