"""Concatenation of motion segments: each is rotated and moved to the end of the previous one, and blended."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from app.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import foot_contacts
from app.choreography.features import facing, height_m
from app.choreography.joins import (
    FADE_S,
    STATURE_M,
    Clouds,
    best_turn_rad,
    fading_difference,
)
from app.choreography.limbs import hinge_ranges
from app.choreography.model import ChoreographyModel
from app.choreography.seam_blends import HipsOnTheWay, Seams, blend_rotations
from app.choreography.steering import Ahead
from app.rig import quaternion

LATELY_S: Final = 1.0
"""Seconds of motion whose mean is the dancer's place."""
_UP: Final = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Frames:
    """Segment and moment of the captured motion that each of F output frames shows.

    Attributes
    ----------
    segments : (N,) int64
        Segments of the model in the order of dancing.
    which : (F,) int64
        For each frame the index in ``segments``, ascending.
    source_s : (F,) float64
        Time in seconds in the clip of that segment.
    speeds : (F,) float64
        Speed at which the clip passes: 1 as captured, 0 at rest.
    """

    segments: IntArray
    which: IntArray
    source_s: FloatArray
    speeds: FloatArray


class Stitcher:
    """The motion of a model, prepared for concatenation in any order.

    Attributes
    ----------
    starts, ends : Clouds
        The bodies about the first and the last frame of each segment.
    contacts : list of (F, 2) bool
        Whether the feet of each clip stand, by frame.
    hinges : (4, 2) float64
        Ranges of knees and elbows, see `app.choreography.limbs.hinge_ranges`.
    """

    def __init__(self, model: ChoreographyModel) -> None:
        self._model = model
        self._clips = [_SmoothClip(clip) for clip in model.clips]
        self._heights_m = [height_m(clip) for clip in model.clips]
        self.hinges = hinge_ranges(model.clips)
        self.contacts = [foot_contacts(clip) for clip in model.clips]
        self.starts = Clouds(model.clips, [(one.clip, one.start) for one in model.segments])
        self.ends = Clouds(model.clips, [(one.clip, one.end) for one in model.segments])

    def feet_standing(self, frames: Sequence[int]) -> IntArray:
        """Number (S,) of feet that stand at a given frame of each segment's clip."""
        return np.array(
            [
                self.contacts[one.clip][min(frame, len(self.contacts[one.clip]) - 1)].sum()
                for one, frame in zip(self._model.segments, frames, strict=True)
            ],
            np.int64,
        )

    def follows(self, segment: int, after: int) -> bool:
        """Return whether a segment begins in the capture where another one ends."""
        one, other = self._model.segments[after], self._model.segments[segment]
        return one.clip == other.clip and one.end == other.start

    def still(self, count: int, body: int, fps: Fraction) -> MotionClip:
        """Return a clip that holds the first pose of the model, with the body of one of its clips."""
        first = self._model.segments[0]
        hips, rotations = self._clips[first.clip].at(np.full(count, float(first.start)))
        scale = self._heights_m[body] / self._heights_m[first.clip]
        return MotionClip(self._model.clips[body].shape, fps, hips * _UP * scale, rotations)

    def stitched(
        self, frames: Frames, body: int, fps: Fraction, ends: int
    ) -> tuple[MotionClip, BoolArray, tuple[int, ...]]:
        """Concatenate the captured segments shown by ``frames`` to one motion.

        Parameters
        ----------
        body : int
            Index of the clip whose body dances.
        ends : int
            Frame before which the dance ends, facing the audience.

        Returns
        -------
        clip : MotionClip
            The motion, facing the audience at the dancer's place.
        contacts : (F, 2) bool
            Whether the left and the right foot stand in the capture.
        seams : tuple of int
            Frames at which motion begins that does not continue the capture before it.
        """
        runs = np.flatnonzero(np.diff(frames.which, prepend=-1, append=frames.which[-1] + 1))
        (captured_m, rotations), contacts = self._captured(frames, runs, body, fps)
        rate, turns = float(fps), np.zeros(len(rotations))
        way, ahead = HipsOnTheWay(rate, len(frames.which)), Ahead.of(rotations, runs, ends, rate)
        seams: list[int] = []
        rows: list[int] = []
        steered: list[_Steer] = []
        turn, moved = 0.0, 0.0 + 0.0j
        before: int | None = None
        for run, (start, stop) in enumerate(pairwise(runs.tolist())):
            step, kept, seam = int(frames.which[start]), (turn, moved), before is not None
            segment = int(frames.segments[step])
            if before is None:
                turn, moved = self._home(segment, body)
            else:
                earlier = int(frames.segments[before])
                seam = not self.follows(segment, earlier)
                if seam or step != before + 1:
                    turn, moved = self._aligned(earlier, segment, turn, moved, self._heights_m[body])
                if (lately := way.lately(start, LATELY_S)) is not None:
                    turn, moved = ahead.steered(run, turn, moved, way.place(start), lately)
                if seam:
                    seams.append(start)
                    rows.append(start + run)
                    steered.clear()
                else:
                    # The capture continues exactly; only position and facing change gradually.
                    steered.append(_Steer(start, kept, (turn, moved)))
            # One additional frame: the first two show how fast the old and the new motion diverge.
            here = slice(start + run, stop + run + 1)
            steered = [one for one in steered if one.start > start - FADE_S * rate]
            times_s = (start + np.arange(stop - start + 1)) / rate
            turns[here], factors, moves = _place_at(times_s, turn, moved, steered, rate)
            way.append(start, _placed(captured_m[here], factors, moves), seam=seam)
            before = step
        rotations[:, 0] = quaternion.multiply(quaternion.from_axis_angle(_UP, turns), rotations[:, 0])
        shown = np.arange(len(frames.which)) + np.repeat(np.arange(len(runs) - 1), np.diff(runs))
        blend_rotations(rotations, shown, Seams(np.array(seams, np.int64), np.array(rows, np.int64)), self.hinges, rate)
        shape = self._model.clips[body].shape
        turned = np.take(rotations.transpose(1, 2, 0), shown, axis=2).transpose(2, 0, 1)
        clip = MotionClip(shape, fps, way.hips, quaternion.continuous(turned))
        return clip, contacts, tuple(seams)

    def _captured(
        self, frames: Frames, runs: IntArray, body: int, fps: Fraction
    ) -> tuple[tuple[FloatArray, FloatArray], BoolArray]:
        """Look up the captured motion for every output frame: hips (N, 3), rotations (N, B, 4), and whether each foot
        stands. Each run of frames is followed by one more frame for the transition.
        """
        last = runs[1:] - 1
        after_s = frames.source_s[last] + frames.speeds[last] / float(fps)
        source_s, which = (
            np.insert(frames.source_s, runs[1:], after_s),
            np.insert(frames.which, runs[1:], frames.which[last]),
        )
        clips = np.array([segment.clip for segment in self._model.segments])[frames.segments]
        hips, rotations = quaternion.planes(len(which), 3), quaternion.planes(len(which), len(SEGMENTS), 4)
        contacts = np.zeros((len(frames.which), 2), bool)
        for number, (smooth, clip) in enumerate(zip(self._clips, self._model.clips, strict=True)):
            here, shown = clips[which] == number, clips[frames.which] == number
            hips[here], rotations[here] = smooth.at(source_s[here] * float(clip.fps))
            hips[here] *= self._heights_m[body] / self._heights_m[number]
            nearest = np.clip(np.rint(frames.source_s[shown] * float(clip.fps)).astype(int), 0, len(clip) - 1)
            contacts[shown] = self.contacts[number][nearest]
        return (hips, rotations), contacts

    def _home(self, segment: int, body: int) -> tuple[float, complex]:
        """Rotation in radians and move (complex, metres) that put the start of a segment at the dancer's place, facing
        the audience.
        """
        one = self._model.segments[segment]
        source = self._model.clips[one.clip]
        turn = -float(quaternion.twist_angle(facing(source.span(one.start, one.start + 1)), _UP)[0])
        hips = source.hips_m[one.start] * self._heights_m[body] / self._heights_m[one.clip]
        return turn, -complex(np.exp(1j * turn)) * complex(hips[2], hips[0])

    def _aligned(
        self, before: int, after: int, turn: float, moved: complex, own_height_m: float
    ) -> tuple[float, complex]:
        """Return the turn about the vertical in radians, and the move over the floor (complex, metres: forward + left ·
        i), that join a segment to the end of the one before; ``turn`` and ``moved`` are those of the segment before."""
        own = best_turn_rad(self.ends.flat[before], self.starts.flat[after])
        scale = own_height_m / STATURE_M
        reached = complex(np.exp(1j * turn)) * self.ends.middle[before] * scale + moved
        turn += own
        return turn, reached - complex(np.exp(1j * turn)) * self.starts.middle[after] * scale


class _SmoothClip:
    """A clip interpolated smoothly between its frames."""

    def __init__(self, clip: MotionClip) -> None:
        self._last = len(clip) - 1.0
        frames = np.arange(len(clip))
        self._hips = CubicSpline(frames, clip.hips_m)
        self._rotations = CubicSpline(frames, clip.rotations.reshape(len(clip), -1))

    def at(self, frames: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return hips (N, 3) and local rotations (N, 16, 4) at possibly fractional frames within the clip."""
        frames = np.clip(frames, 0.0, self._last)
        turns = self._rotations(frames).reshape(len(frames), len(SEGMENTS), 4)
        return self._hips(frames), quaternion.normalize(turns)


class _Steer(NamedTuple):
    """Change of rotation (radians) and move (complex, metres) of a motion from a frame on."""

    start: int
    old: tuple[float, complex]
    new: tuple[float, complex]


def _place_at(
    times_s: FloatArray, turn: float, moved: complex, steered: Sequence[_Steer], fps: float
) -> tuple[FloatArray, ComplexArray, ComplexArray]:
    """Return the rotation in radians, the factor of positions (complex), and the move at each time (F,), after gradual
    changes.
    """
    turns = np.full(len(times_s), turn)
    factors, moves = np.full(len(times_s), np.exp(1j * turn)), np.full(len(times_s), moved, np.complex128)
    for start, old, new in steered:
        left = fading_difference(np.ones(()), np.zeros(()), times_s - start / fps)
        turns += left * (old[0] - new[0])
        factors += left * (np.exp(1j * old[0]) - np.exp(1j * new[0]))
        moves += left * (old[1] - new[1])
    return turns, factors, moves


def _placed(hips_m: FloatArray, factors: ComplexArray, moves: ComplexArray) -> FloatArray:
    """Turn positions (F, 3) by the complex ``factors`` about the vertical, and move them over the floor by ``moves``
    (complex, metres: Z + X · i), each (F,)."""
    flat = factors * (hips_m[:, 2] + 1j * hips_m[:, 0]) + moves
    return np.stack([flat.imag, hips_m[:, 1], flat.real], axis=1)
