"""Chunks of frames: division of a performance, stored motion of a player, and poses between frames."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from app.arrays import FloatArray, IndexArray, SingleArray
from app.motion.contacts.solve import padding_frames
from app.motion.model import Motion, frame_count
from app.plan.model import TimeFrame

CHUNK_S = 4.0
"""Length of a chunk in seconds: long enough for NumPy's overhead to be small, short enough for a correction to show
immediately.
"""
OVERHEAD_BYTES = 1024
"""Memory of a chunk besides its numbers."""


@dataclass(frozen=True)
class Pose:
    """One player's pose at one moment, in the player's frame (feet at the origin, facing +Z); fields as in
    `app.motion.model.Motion`, for one frame.

    Attributes
    ----------
    rotations : (J, 4) float32
        Rotation of each of J joints relative to its parent, xyzw.
    hips_m : (3,) float32
        Position of the hips in metres.
    morphs, controls : dict of str to float
        Weights of morphs by name, missing ones 0, and values 0..1 of the instrument's controls.
    instrument_position_m, instrument_rotation : (3,) and (4,) float32
        Position in metres and rotation of the instrument.
    """

    rotations: SingleArray
    hips_m: SingleArray
    morphs: dict[str, float]
    controls: dict[str, float]
    instrument_position_m: SingleArray
    instrument_rotation: SingleArray

    @classmethod
    def of(cls, motion: Motion, frame: int) -> Pose:
        """Return one frame of a motion as a pose."""
        return cls(
            rotations=motion.rotations[frame],
            hips_m=motion.hips_m[frame],
            morphs={name: float(values[frame]) for name, values in motion.morphs.items()},
            controls={name: float(values[frame]) for name, values in motion.controls.items()},
            instrument_position_m=motion.instrument_position_m[frame],
            instrument_rotation=motion.instrument_rotation[frame],
        )


Posed: TypeAlias = Callable[[str, float, Pose], Pose]
"""Function from a player's id, a time and the pose of the performance to the displayed pose."""


@dataclass(frozen=True, eq=False)
class Chunk:
    """Consecutive frames of one player's computed motion; joints that do not move are stored once.

    ``values`` (F, M + C) has for each of F frames the weights of M morphs, then the values of C controls.
    """

    still: SingleArray
    moving: IndexArray
    rotations: SingleArray
    placed: SingleArray
    values: SingleArray
    morphs: tuple[str, ...]
    controls: tuple[str, ...]
    bytes: int

    @classmethod
    def of(cls, motion: Motion) -> Chunk:
        # Reducing one axis after the other is forty times as fast as both at once.
        moves = (motion.rotations != motion.rotations[:1]).any(axis=0).any(axis=1)
        columns = [*motion.morphs.values(), *motion.controls.values()]
        still = motion.rotations[0].copy()
        rotations = np.ascontiguousarray(motion.rotations[:, moves])
        placed = np.concatenate((motion.hips_m, motion.instrument_position_m, motion.instrument_rotation), axis=1)
        values = np.stack(columns, axis=1) if columns else np.zeros((motion.frames, 0), np.float32)
        return cls(
            still=still,
            moving=np.flatnonzero(moves),
            rotations=rotations,
            placed=placed,
            values=values,
            morphs=tuple(motion.morphs),
            controls=tuple(motion.controls),
            bytes=still.nbytes + rotations.nbytes + placed.nbytes + values.nbytes + OVERHEAD_BYTES,
        )

    @property
    def frames(self) -> int:
        return len(self.placed)


def poses_of(chunks: Sequence[Chunk], frame: int, share: float) -> list[Pose]:
    """Poses of several players at a frame, or between it and the next one (``share`` 0..1 of the way).

    Computed for all players at once, which takes half the time.
    """
    if not chunks:
        return []
    turns = [chunk.rotations[frame] for chunk in chunks]
    placed = np.array([chunk.placed[frame] for chunk in chunks])
    values = np.concatenate([chunk.values[frame] for chunk in chunks])
    if share > 0.0:
        later = [(chunk, min(frame + 1, chunk.frames - 1)) for chunk in chunks]
        mixed = between(np.concatenate(turns), np.concatenate([chunk.rotations[at] for chunk, at in later]), share)
        turns = np.split(mixed, np.cumsum([len(own) for own in turns[:-1]]))
        placed_after = np.array([chunk.placed[at] for chunk, at in later])
        held = between(placed[:, 6:], placed_after[:, 6:], share)
        placed += np.float32(share) * (placed_after - placed)
        placed[:, 6:] = held
        values += np.float32(share) * (np.concatenate([chunk.values[at] for chunk, at in later]) - values)
    numbers, first, result = values.tolist(), 0, list[Pose]()
    for chunk, own, place in zip(chunks, turns, placed, strict=True):
        rotations = chunk.still.copy()
        rotations[chunk.moving] = own
        middle = first + len(chunk.morphs)
        end = middle + len(chunk.controls)
        result.append(
            Pose(
                rotations=rotations,
                hips_m=place[:3],
                morphs=dict(zip(chunk.morphs, numbers[first:middle], strict=True)),
                controls=dict(zip(chunk.controls, numbers[middle:end], strict=True)),
                instrument_position_m=place[3:6],
                instrument_rotation=place[6:],
            )
        )
        first = end
    return result


def between(before: SingleArray, after: SingleArray, share: float) -> SingleArray:
    """Interpolate rotations (N, 4) linearly between two similar frames, and normalise them."""
    sign = np.where(np.einsum("ji,ji->j", before, after) < 0.0, np.float32(-share), np.float32(share))
    mixed: SingleArray = before * np.float32(1.0 - share) + after * sign[:, None]
    mixed /= np.sqrt(np.einsum("ji,ji->j", mixed, mixed))[:, None]
    return mixed


@dataclass(frozen=True)
class FrameGrid:
    """The frames of a performance (rate, start, number), divided into chunks of ``length`` frames."""

    fps: Fraction
    start_s: float
    frames: int
    length: int

    @classmethod
    def of(cls, time_frame: TimeFrame, fps: Fraction) -> FrameGrid:
        return cls(fps, time_frame.first_frame_s, frame_count(time_frame, fps), max(1, round(CHUNK_S * fps)))

    @property
    def chunks(self) -> int:
        return -(-self.frames // self.length)

    def place(self, time_s: float) -> tuple[int, float]:
        """Convert a time to the index of the frame at or before it and the share of the way to the next frame; clipped
        to the performance.
        """
        exact = (time_s - self.start_s) * self.fps.numerator / self.fps.denominator
        frame = math.floor(exact + 1e-6)
        if frame < 0:
            return 0, 0.0
        if frame >= self.frames - 1:
            return self.frames - 1, 0.0
        return frame, max(exact - frame, 0.0) if exact - frame > 1e-6 else 0.0

    def span(self, chunk: int) -> tuple[int, int]:
        """First frame and number of frames of a chunk; the last chunk may be shorter."""
        first = chunk * self.length
        return first, min(self.length, self.frames - first)

    def same_frames(self, other: FrameGrid) -> bool:
        """Return whether equal frame numbers mean equal times in both grids."""
        return self.fps == other.fps and self.start_s == other.start_s

    def touched(self, spans_s: FloatArray) -> list[bool]:
        """Return for every chunk whether one of the spans (N, 2) in seconds overlaps it or the additional frames around
        it that its computation needs.
        """
        rate = self.fps.numerator / self.fps.denominator
        pad = padding_frames(self.fps) + 2
        result = np.zeros(self.chunks + 1, np.int64)
        first = np.clip((spans_s[:, 0] - self.start_s) * rate - pad, -1.0, self.frames)
        last = np.clip((spans_s[:, 1] - self.start_s) * rate + pad, -1.0, self.frames)
        low = np.maximum(np.floor(first / self.length), 0.0).astype(np.int64)
        high = np.minimum(np.floor(last / self.length) + 1.0, self.chunks).astype(np.int64)
        some = (high > low) & (last >= 0.0)
        np.add.at(result, low[some], 1)
        np.add.at(result, high[some], -1)
        return [bool(count) for count in np.cumsum(result)[:-1].tolist()]
