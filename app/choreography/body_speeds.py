"""Parts of a moving body, their speeds from frame to frame and the changes of these, and spans of frames."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion

PLACE: Final = len(SEGMENTS)
"""Index of the hips' place among the tracks of a clip, after its segments."""
PARTS: Final = (*SEGMENTS, "place")


def part_speeds(clip: MotionClip) -> FloatArray:
    """Speeds (F - 1, 17) from frame to frame: rotation of each of the 16 segments in rad/s, and movement of the hips in
    m/s.
    """
    turns = angle(clip.rotations[:-1], clip.rotations[1:])
    ways = np.linalg.norm(np.diff(clip.hips_m, axis=0), axis=-1, keepdims=True)
    return np.concatenate([turns, ways], axis=1) * float(clip.fps)


def angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the angle in radians between rotations (..., 4)."""
    # The distance between unit quaternions is exact for small angles, unlike the arc cosine of their product.
    dot = np.einsum("...i,...i->...", a, b)
    apart = np.linalg.norm(a - np.where(dot < 0.0, -1.0, 1.0)[..., None] * b, axis=-1)
    return np.asarray(4.0 * np.arcsin(np.clip(0.5 * apart, 0.0, 1.0)))


def turns_rad(rotations: FloatArray) -> FloatArray:
    """Return the vectors (F - 1, ..., 3) in radians that turn rotations (F, ..., 4) to those of the next frame."""
    return quaternion.to_rotation_vector(quaternion.multiply(rotations[1:], quaternion.conjugate(rotations[:-1])))


def changes_rad(turns: FloatArray) -> FloatArray:
    """Return the changes (F, ...) in radians of turns (F - 1, ..., 3) from frame to frame; 0 in the first and the last
    frame.

    They are the same for turns in the world's axes and in the part's own ones.
    """
    result = np.zeros((len(turns) + 1, *turns.shape[1:-1]))
    result[1:-1] = np.linalg.norm(np.diff(turns, axis=0), axis=-1)
    return result


def sudden(rotations: FloatArray, most_rad: float) -> BoolArray:
    """Mark where the turns of rotations (F, ..., 4) change by more than ``most_rad`` from frame to frame, as
    `changes_rad` of `turns_rad` does. Those are computed only where they may be, since most of a motion is calm.
    """
    found = np.zeros(rotations.shape[:-1], bool)
    if len(rotations) < 3:
        return found
    steps = rotations[1:] - rotations[:-1]
    bends = steps[1:] - steps[:-1]
    chords2 = quaternion.dot(steps, steps)
    # Of two turns d and e, half of whose sines are the vectors of their quaternions, the change is at most
    # 2 |e - d| / cos(a), where a is half of the greater turn; its sine is at most the chord between the frames.
    room = 1.0 - np.maximum(chords2[1:], chords2[:-1])
    near = np.nonzero(4.0001 * quaternion.dot(bends, bends) > most_rad * most_rad * room)
    if len(near[0]):
        before, here, after = (rotations[(near[0] + more, *near[1:])] for more in range(3))
        turns = turns_rad(np.stack([before, here, after]))
        found[1:-1][near] = changes_rad(turns)[1] > most_rad
    return found


def runs(of: BoolArray) -> list[tuple[int, int]]:
    """Return the spans (start, stop) of frames in which a condition (F,) is true; ``stop`` is exclusive."""
    edges = np.flatnonzero(np.diff(of.astype(np.int8), prepend=0, append=0))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
