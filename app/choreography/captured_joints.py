"""A captured body in the world: joint positions, and properties of bones that are independent of the zero pose.

A knee or an elbow bends about an axis that is fixed in the adjacent bones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.rig import quaternion

X: Final = np.array([1.0, 0.0, 0.0])
Y: Final = np.array([0.0, 1.0, 0.0])
Z: Final = np.array([0.0, 0.0, 1.0])
LEG: Final = ("UpperLeg", "LowerLeg", "Foot")
ARM: Final = ("UpperArm", "LowerArm", "Hand")
SIDES: Final = (("left", 1.0), ("right", -1.0))
BENT_DEG: Final = (8.0, 20.0)
"""Bend in degrees in nine of ten frames below which a joint's hinge is unknown, and above which it is certain."""
NEAR_TOES: Final = 0.4
"""Distance of the toes' joint from the ankle, relative to that of the foot's tip, up to which it does not show where
the foot points: rigs with a joint straight below the ankle have 0.2, others at least 0.6.
"""
FINGERS: Final = ("Index", "Middle", "Ring", "Little")
T_POSE_DEG: Final = 25.0
"""Greatest angle in degrees of arms from pointing sideways, of legs from hanging straight down and of the trunk from
upright in a T-pose.
"""
JUMP_PART: Final = 0.25
JUMP_TIMES: Final = 3.0
"""A joint has jumped if it moves between two frames by more than `JUMP_PART` of the distance from hips to head and
`JUMP_TIMES` times farther than in 99 of 100 frames.
"""
SETTLES: Final = 40
NEAR_PART: Final = 1e-3
"""`SETTLES` is the number of iterations for a geometric median; `NEAR_PART` the least distance from it, relative to its
length, that is used as a divisor.
"""
FIXED: Final = (0.9, 0.97)
"""Length of the mean of a hinge's unit axes, relative to a bone: below the first value it is no hinge, above the second
certainly one.
"""


@dataclass(frozen=True, eq=False)
class Captured:
    """A captured motion in the world, Y up, with the bones known as joints and body segments.

    Attributes
    ----------
    positions, rotations : ndarray, shapes (F, J, 3) and (F, J, 4)
        World position and rotation of each of J bones in F frames.
    joints : mapping of str to int
        Bones by VRM 1.0 joint.
    segments : mapping of str to int
        Bones by segment.
    tips : mapping of str to ndarray, shape (3,)
        Vector from the joint of each of `app.choreography.body.ENDS` to the next joint or the end of its bone, in the
        bone's axes: for a hand to the mean of these without the thumb, else to the farthest; zero if there is none.
    thumbs : mapping of str to ndarray, shape (F, 3)
        Vector from each hand's joint to the end of its thumb, in the world; zero if there is none.
    """

    positions: FloatArray
    rotations: FloatArray
    joints: Mapping[str, int]
    segments: Mapping[str, int]
    tips: Mapping[str, FloatArray]
    thumbs: Mapping[str, FloatArray]

    def at(self, joint: str) -> FloatArray:
        """Return the position (F, 3) of a joint in the world."""
        places: FloatArray = self.positions[:, self.joints[joint]]
        return places

    def has_toes(self, side: str) -> bool:
        """Return whether a foot has a joint between ankle and tip that shows which way it points."""
        if f"{side}Toes" not in self.joints:
            return False
        far = np.linalg.norm(self.at(f"{side}Toes") - self.at(f"{side}Foot"), axis=1)
        return float(np.median(far)) > NEAR_TOES * float(np.linalg.norm(self.tips[f"{side}Foot"]))

    def start(self, segment: str) -> FloatArray:
        """World position (F, 3) of the joint at which a segment begins."""
        places: FloatArray = self.positions[:, self.segments[segment]]
        return places

    def within(self, segment: str, ways: FloatArray) -> FloatArray:
        """Convert directions (F, 3) of the world to the axes of a segment's bone, in each frame."""
        return quaternion.rotate(quaternion.conjugate(self.rotations[:, self.segments[segment]]), ways)

    def mean(self, segment: str, ways: FloatArray) -> FloatArray:
        """Mean (3,) over the motion of world directions (F, 3), as unit vectors in the axes of a segment's bone."""
        mean: FloatArray = self.within(segment, unit(ways)).mean(axis=0)
        return mean

    def bend(self, limb: Sequence[str], sign: float) -> FloatArray:
        """Axis (F, 3) about which the middle joint of a limb bends, with the sine of the bend as its length; positive
        bends are about +X for legs and +Y for arms in the T-pose.

        Parameters
        ----------
        limb : sequence of str
            Names of its three joints.
        sign : float
            1 for a left limb, -1 for a right one.
        """
        upper, lower, end = (self.at(name) for name in limb)
        axes = np.cross(unit(lower - upper), unit(end - lower))
        return axes if limb[0].endswith("Leg") else -sign * axes

    def hinge(self, segment: str, bend: FloatArray) -> tuple[FloatArray, float]:
        """Find the axis (3,) of a knee's or elbow's hinge in the axes of an adjacent bone, with its
        reliability, 0..1.
        """
        total, fixed = self.axis(segment, bend)
        return unit(total), min(self.bent(bend), _share(fixed, FIXED))

    def axis(self, segment: str, bend: FloatArray) -> tuple[FloatArray, float]:
        """Sum (3,) over the motion of a joint's bending axes (F, 3), in the axes of a segment's bone; and the constancy
        of their direction, 1 if it never changes.
        """
        axes = self.within(segment, bend)
        total: FloatArray = axes.sum(axis=0)
        return total, float(np.linalg.norm(total) / max(np.linalg.norm(axes, axis=1).sum(), 1e-12))

    def bent(self, bend: FloatArray) -> float:
        """Certainty, 0..1, that a joint with the bending axes ``bend`` bends at all during the motion."""
        sine = min(1.0, float(np.percentile(np.linalg.norm(bend, axis=1), 90)))
        return _share(float(np.degrees(np.arcsin(sine))), BENT_DEG)

    def knuckles(self, side: str) -> list[FloatArray]:
        """World positions (F, 3) of the first joint of each existing finger from the index finger on, without the
        thumb.
        """
        names = [f"{side}{finger}Proximal" for finger in FINGERS]
        return [self.at(name) for name in names if name in self.joints]

    @property
    def up(self) -> FloatArray:
        """Up direction +Y repeated for every frame, (F, 3)."""
        return np.tile(Y, (len(self.positions), 1))

    @cached_property
    def hip_line(self) -> FloatArray:
        """Vector from the right to the left hip joint, (F, 3)."""
        return self.at("leftUpperLeg") - self.at("rightUpperLeg")

    @cached_property
    def shoulder_line(self) -> FloatArray:
        """Vector from the right to the left shoulder, (F, 3)."""
        return self.at("leftUpperArm") - self.at("rightUpperArm")

    @cached_property
    def posed(self) -> IntArray:
        """Frames (K,) of a T-pose that was added before or after the motion; there the motion jumps."""
        upright = [np.einsum("fi,fi->f", unit(self.top - self.start("hips")), self.up)]
        for side, sign in SIDES:
            arm = unit(self.at(f"{side}Hand") - self.at(f"{side}UpperArm"))
            leg = unit(self.at(f"{side}UpperLeg") - self.at(f"{side}Foot"))
            upright += [
                sign * np.einsum("fi,fi->f", arm, unit(self.shoulder_line)),
                np.einsum("fi,fi->f", leg, self.up),
            ]
        t_pose = np.min(upright, axis=0) > np.cos(np.radians(T_POSE_DEG))
        names = [side + name for side, _ in SIDES for name in (*LEG, *ARM)]
        ways = np.array([self.at(name) - self.at("hips") for name in ("head", *names)])
        steps = np.linalg.norm(np.diff(ways, axis=1), axis=2).max(axis=0)
        far = JUMP_PART * float(np.median(np.linalg.norm(ways[0], axis=1)))
        if not len(steps):
            return np.zeros(0, np.int64)
        jumps = np.flatnonzero(steps > max(far, JUMP_TIMES * float(np.percentile(steps, 99.0))))
        if not len(jumps):
            return np.zeros(0, np.int64)
        before, after = np.arange(jumps[0] + 1), np.arange(jumps[-1] + 1, len(t_pose))
        return np.concatenate([frames for frames in (before, after) if t_pose[frames].all()] or [before[:0]])

    @cached_property
    def top(self) -> FloatArray:
        """World position (F, 3) of the joint at the top of the chest."""
        return self.at("neck" if "neck" in self.joints else "head")

    @cached_property
    def standing(self) -> IntArray:
        """Indices of the frames in which the body stands upright: the head is in the upper half of the
        heights it has.
        """
        height = self.at("head")[:, 1]
        frames: IntArray = np.flatnonzero(height >= np.median(height))
        return frames


def _share(value: float, bounds: tuple[float, float]) -> float:
    return float(np.clip((value - bounds[0]) / (bounds[1] - bounds[0]), 0.0, 1.0))


def unit(vectors: FloatArray) -> FloatArray:
    """Scale vectors to length 1; zero vectors stay zero."""
    result: FloatArray = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return result


def middle(vectors: FloatArray) -> FloatArray:
    """Geometric median (3,) of N vectors (N, 3): the point with the least total distance to them, which unlike a median
    by component does not depend on the axes.
    """
    found: FloatArray = vectors.mean(axis=0)
    for _ in range(SETTLES):
        weights = 1.0 / np.maximum(np.linalg.norm(vectors - found, axis=1), NEAR_PART * np.linalg.norm(found) + 1e-12)
        found = weights @ vectors / weights.sum()
    return found


def angle_deg(a: FloatArray, b: FloatArray) -> float:
    """Angle between two vectors (3,), degrees."""
    return float(np.degrees(np.arccos(np.clip(unit(a) @ unit(b), -1.0, 1.0))))
