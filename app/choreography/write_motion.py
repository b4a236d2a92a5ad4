"""A motion of the 16 segments as a BVH file."""

from __future__ import annotations

import os

from app.choreography.body import ENDS, PARENT_OF, SEGMENTS
from app.choreography.clip import MotionClip
from app.formats.bvh import BvhClip, write_bvh


def write_motion(path: str | os.PathLike[str], clip: MotionClip) -> None:
    """Write a BVH file of the body's joints, named as the segments, whole or not at all. Raises FileError."""
    names = list(SEGMENTS)
    parents = [names.index(parent) if parent in names else -1 for parent in PARENT_OF.values()]
    ends_cm = {names.index(name): 100.0 * end_m for name, end_m in zip(ENDS, clip.shape.ends_m, strict=True)}
    offsets_cm, hips_cm = 100.0 * clip.shape.offsets_m, 100.0 * clip.hips_m
    write_bvh(path, BvhClip(tuple(names), tuple(parents), offsets_cm, ends_cm, clip.fps, hips_cm, clip.rotations))
