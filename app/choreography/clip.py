"""A captured or generated motion of the 16 segments, with export as a BVH file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction

from app.arrays import FloatArray, IntArray
from app.choreography.body import ENDS, PARENT_OF, SEGMENTS, body_skeleton
from app.formats.bvh.clip import BvhClip
from app.formats.bvh.write import write_bvh
from app.rig import quaternion
from app.rig.model import Skeleton
from app.rig.skeleton import JointTransforms, forward_by_joint


@dataclass(frozen=True, eq=False)
class BodyShape:
    """Size of a body in the T-pose facing +Z in metres.

    Attributes
    ----------
    offsets_m : (16, 3) float64
        See `app.choreography.body.body_skeleton`.
    ends_m : (5, 3) float64
        Vector from the joint of each of `app.choreography.body.ENDS` to its end.
    skeleton : Skeleton
        The root, then the segments.
    """

    offsets_m: FloatArray
    ends_m: FloatArray
    skeleton: Skeleton

    @classmethod
    def of(cls, offsets_m: FloatArray, ends_m: FloatArray) -> BodyShape:
        """Create the shape of a body from its offsets and end vectors, together with its skeleton."""
        return cls(offsets_m, ends_m, body_skeleton(offsets_m))


@dataclass(frozen=True, eq=False)
class MotionClip:
    """A motion of a body. Frame ``n`` is at ``n / fps`` seconds; metres, Y up.

    Attributes
    ----------
    hips_m : (F, 3) float64
        Place of the hips in the world; the floor is at Y = 0.
    rotations : (F, 16, 4) float64
        Rotation of each segment relative to its parent (for the hips: to the world), unit quaternions xyzw, each frame
        in the hemisphere of the previous one; the identity in the T-pose.
    """

    shape: BodyShape
    fps: Fraction
    hips_m: FloatArray
    rotations: FloatArray

    def __len__(self) -> int:
        """Return the number of frames."""
        return len(self.hips_m)

    @property
    def length_s(self) -> float:
        """Time from the first to the last frame."""
        return float((len(self) - 1) / self.fps)

    def span(self, start: int, stop: int) -> MotionClip:
        """Return the frames ``start`` to before ``stop`` as a clip."""
        return MotionClip(self.shape, self.fps, self.hips_m[start:stop], self.rotations[start:stop])

    def at(self, frames: IntArray) -> MotionClip:
        """Return some frames (N,) as a clip."""
        return MotionClip(self.shape, self.fps, self.hips_m[frames], self.rotations[frames])

    def mirrored(self) -> MotionClip:
        """Return the motion with left and right exchanged."""
        swapped = [
            SEGMENTS.index(name.replace("left", "right") if name.startswith("left") else name.replace("right", "left"))
            for name in SEGMENTS
        ]
        rotations = self.rotations[:, swapped] * (1.0, -1.0, -1.0, 1.0)
        return replace(self, hips_m=self.hips_m * (-1.0, 1.0, 1.0), rotations=rotations)

    def world(self, joints: Iterable[int] | None = None) -> JointTransforms:
        """World transforms: joint 0 is the root on the floor, joint ``1 + n`` segment ``n``; all joints, or those given
        with their ancestors."""
        turns = [quaternion.repeated(quaternion.IDENTITY, len(self)), *self.rotations.transpose(1, 0, 2)]
        return forward_by_joint(self.shape.skeleton, turns, self.hips_m, joints)


def write_motion(path: str | os.PathLike[str], clip: MotionClip) -> None:
    """Write a motion as a BVH file with joints named as the segments, atomically. Raises FileError."""
    names = list(SEGMENTS)
    parents = [names.index(parent) if parent in names else -1 for parent in PARENT_OF.values()]
    ends_cm = {names.index(name): 100.0 * end_m for name, end_m in zip(ENDS, clip.shape.ends_m, strict=True)}
    offsets_cm, hips_cm = 100.0 * clip.shape.offsets_m, 100.0 * clip.hips_m
    write_bvh(path, BvhClip(tuple(names), tuple(parents), offsets_cm, ends_cm, clip.fps, hips_cm, clip.rotations))
