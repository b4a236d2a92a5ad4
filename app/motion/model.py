"""Motion of a performance: arrays sampled at a frame rate, generated from a plan and never edited."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from app.arrays import SingleArray
from app.plan.model import TimeFrame


@dataclass(frozen=True)
class Motion:
    """One player's motion. Frame ``n`` is at ``first_frame_s + n / fps``.

    Attributes
    ----------
    fps : Fraction
        Frames per second.
    first_frame_s : float
        Performance time of frame 0 in seconds; usually negative.
    rotations : (F, J, 4) float32
        ``parent_from_joint`` rotations, unit quaternions xyzw, in the order of the character's skeleton.
    hips_m : (F, 3) float32
        Translation of the hips in the root's frame, metres.
    morphs : dict of str to (F,) float32
        Weights 0..1 of those ARKit morph targets that move.
    controls : dict of str to (F,) float32
        Value 0..1 of every control of the instrument, and extension of its endpin under the name of the pin's node.
    instrument_position_m : (F, 3) float32
        Position of the instrument's origin (``world_from_instrument``), metres.
    instrument_rotation : (F, 4) float32
        Rotation of the instrument (``world_from_instrument``), xyzw.
    """

    fps: Fraction
    first_frame_s: float
    rotations: SingleArray
    hips_m: SingleArray
    morphs: dict[str, SingleArray]
    controls: dict[str, SingleArray]
    instrument_position_m: SingleArray
    instrument_rotation: SingleArray

    @property
    def frames(self) -> int:
        """Number of frames in the motion."""
        return len(self.hips_m)


def joined(pieces: Sequence[Motion]) -> Motion:
    """Concatenate consecutive stretches of one motion along their frames."""
    if len(pieces) == 1:
        return pieces[0]
    first = pieces[0]
    return Motion(
        fps=first.fps,
        first_frame_s=first.first_frame_s,
        rotations=np.concatenate([piece.rotations for piece in pieces]),
        hips_m=np.concatenate([piece.hips_m for piece in pieces]),
        morphs={name: np.concatenate([piece.morphs[name] for piece in pieces]) for name in first.morphs},
        controls={name: np.concatenate([piece.controls[name] for piece in pieces]) for name in first.controls},
        instrument_position_m=np.concatenate([piece.instrument_position_m for piece in pieces]),
        instrument_rotation=np.concatenate([piece.instrument_rotation for piece in pieces]),
    )


def frame_count(time_frame: TimeFrame, fps: Fraction) -> int:
    """Number of frames of a performance at a frame rate: those in ``[first_frame_s, end_s)``."""
    exact = (time_frame.end_s - time_frame.first_frame_s) * fps.numerator / fps.denominator
    return max(1, math.ceil(exact - 1e-9))
