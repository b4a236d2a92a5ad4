"""Faults of a capture: flips, where a segment turns away for a frame or a few and back; steps, where the whole body
turns and goes on so, as where frames are missing; a rest pose put first.

Many converted files begin with their rest pose, which the body leaves within a frame to a few.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion

LEAST_RAD: Final = 0.35
"""A turn between two frames that is smaller than this (20 degrees) is no flip."""
LEAST_RAD_S: Final = 20.0
"""Nor is a slower one: dancers' segments, relative to what carries them, stay below this but for throws."""
RETURN_PART: Final = 0.35
"""After a flip the segment is back near where it was: nearer than this part of the smaller of the two turns. A true
fast motion goes on instead."""
LONGEST_S: Final = 0.035
"""A flip lasts no longer, but at least a frame."""

STEP_TIMES: Final = 2.5
LEAST_STEP_RAD_S: Final = 6.0
"""In a step the hips turn faster than so many times the speed before and after it, and by this more."""
LEAST_APART_S: Final = 0.2
"""Frames are not missing again so soon after a step: what turns by steps more often than this moves so."""
STEP_FADE_S: Final = 0.4
"""Time within which the rest of lean and height after a step fades into what was captured."""
LEAD_IN_S: Final = 0.15
"""A rest pose put before the motion, and what the jump to the motion leaves of swings, is over within this time."""
AFTER_S: Final = 0.5
CALM: Final = 2.0
CALM_RAD_S: Final = 1.0
"""It is over when the body is no faster than this many times its median speed in the time after it, or than that."""


@dataclass(frozen=True, order=True)
class Flip:
    """Frames ``start`` to ``stop`` (half-open) of a segment that were replaced."""

    segment: str
    start: int
    stop: int


def lead_in(clip: MotionClip) -> int:
    """Number of frames before the motion proper: 0, unless the clip begins with a turn faster than a body's."""
    fps = float(clip.fps)
    steps, later = round(LEAD_IN_S * fps), round((LEAD_IN_S + AFTER_S) * fps)
    first = clip.rotations[: later + 1]
    speeds = _angle(first[:-1], first[1:]).max(axis=1, initial=0.0) * fps
    if not len(speeds) or speeds[0] <= LEAST_RAD_S:
        return 0
    # Files are filtered with their rest pose in them: after the jump the body still slows down and swings.
    usual = CALM * float(np.median(speeds[steps:])) if len(speeds) > steps else LEAST_RAD_S
    wild = np.flatnonzero(speeds[:steps] > max(usual, CALM_RAD_S))
    return int(wild[-1]) + 1 if len(wild) else 0


def mend_flips(clip: MotionClip) -> tuple[MotionClip, tuple[Flip, ...]]:
    """Replace flipped frames by interpolation between the frames beside them; all others stay to the bit.

    Returns
    -------
    MotionClip
        The same value where there is no flip.
    tuple of Flip
    """
    rotations = clip.rotations.copy()
    longest = max(1, round(LONGEST_S * float(clip.fps)))
    found = [flip for at in range(len(SEGMENTS)) for flip in _mend(rotations[:, at], SEGMENTS[at], longest, clip)]
    return (replace(clip, rotations=rotations), tuple(found)) if found else (clip, ())


def mend_steps(clip: MotionClip) -> tuple[MotionClip, tuple[Flip, ...]]:
    """Let the body go on where its hips turn by a step: what follows is turned about the vertical and moved.

    Returns
    -------
    MotionClip
        The same value where there is no step.
    tuple of Flip
        Of the hips, with the frames in which lean and height were changed; all later ones are only turned and moved.
    """
    turns = _angle(clip.rotations[:-1, 0], clip.rotations[1:, 0])
    following = _Following(clip)
    found = []
    beside = STEP_TIMES * np.maximum(turns[:-2], turns[2:])
    next_from = 0.0
    for at in (np.flatnonzero((turns[1:-1] - beside) * float(clip.fps) > LEAST_STEP_RAD_S) + 1).tolist():
        if at >= next_from:
            following.go_on(at)
            found.append(Flip("hips", at + 1, min(len(clip), at + 1 + following.fade)))
            next_from = at + LEAST_APART_S * float(clip.fps)
    return (following.clip(), tuple(found)) if found else (clip, ())


class _Following:
    """Hips that go on at their speed after steps. A step turns and moves all later frames, which wait for that until
    another step or the end: so steps cost what they change, however many they are.

    Attributes
    ----------
    fade : int
        Frames in which what a step leaves of lean and height goes.
    """

    def __init__(self, clip: MotionClip) -> None:
        self._clip = clip
        self._hips, self._turns = clip.hips_m.copy(), clip.rotations[:, 0].copy()
        self._done = 0
        self._turn, self._way = quaternion.IDENTITY, np.zeros(3)
        self.fade = round(STEP_FADE_S * float(clip.fps))

    def _move(self, stop: int) -> None:
        """Turn and move the frames before ``stop`` that still wait for it."""
        some = slice(self._done, max(stop, self._done))
        self._hips[some] = quaternion.rotate(self._turn, self._hips[some]) + self._way
        self._turns[some] = quaternion.multiply(self._turn, self._turns[some])
        self._done = some.stop

    def go_on(self, last: int) -> None:
        """Let the frames after ``last`` go on from there at the speed it had."""
        self._move(min(last + 3 + self.fade, len(self._hips)))
        hips, turns = self._hips, self._turns
        goes_on = hips[last] + (hips[last] - hips[last - 1])
        turn = quaternion.multiply(turns[last], quaternion.conjugate(turns[last - 1]))
        missing = quaternion.multiply(quaternion.multiply(turn, turns[last]), quaternion.conjugate(turns[last + 1]))
        lean, yaw = quaternion.swing_twist(missing, (0.0, 1.0, 0.0))
        faded = slice(last + 1, self._done)
        times = np.arange(faded.stop - faded.start) / (STEP_FADE_S * float(self._clip.fps))
        left = (1.0 - np.minimum(times, 1.0)) ** 2 * (1.0 + 2.0 * np.minimum(times, 1.0))
        rise_m = goes_on[1] - hips[last + 1, 1]
        flat = np.array((1.0, 0.0, 1.0))
        way = goes_on * flat - quaternion.rotate(yaw, hips[last + 1] * flat)
        hips[faded] = quaternion.rotate(yaw, hips[faded]) + way + (left * rise_m)[:, None] * (0.0, 1.0, 0.0)
        leaning = quaternion.from_rotation_vector(left[:, None] * quaternion.to_rotation_vector(lean))
        turned = quaternion.multiply(leaning, quaternion.multiply(yaw, turns[faded]))
        side = np.sign(float(turned[0] @ turns[last])) or 1.0
        turns[faded] = side * turned
        self._turn = side * quaternion.multiply(yaw, self._turn)
        self._way = quaternion.rotate(yaw, self._way) + way

    def clip(self) -> MotionClip:
        """The clip with these hips."""
        self._move(len(self._hips))
        rotations = self._clip.rotations.copy()
        rotations[:, 0] = self._turns
        return replace(self._clip, hips_m=self._hips, rotations=rotations)


def _mend(turns: FloatArray, name: str, longest: int, clip: MotionClip) -> list[Flip]:
    """Flips of one segment (F, 4), mended in place."""
    least = max(LEAST_RAD, LEAST_RAD_S / float(clip.fps))
    jumps = _angle(turns[:-1], turns[1:])
    there = np.flatnonzero(jumps > least)
    found, changed = [], 0
    for before, first in zip(there.tolist(), _returns(turns, there, jumps, longest, least).tolist(), strict=True):
        # What was seen of frames that were replaced since is out of date.
        stop = first if before >= changed else _return(turns, before, longest, least)
        if stop <= before:
            continue
        frame = before + 1
        shares = np.arange(1, stop - before) / (stop - before)
        mended = quaternion.slerp(turns[before], turns[stop], shares)
        sides = np.where(mended @ turns[before] < 0.0, -1.0, 1.0)
        turns[frame:stop] = mended * sides[:, None]
        found.append(Flip(name, frame, stop))
        changed = stop
    return found


def _returns(turns: FloatArray, there: IntArray, jumps: FloatArray, longest: int, least: float) -> IntArray:
    """Return where a segment is back after it turned away, for each of some frames before that; -1 where it is not."""
    stops = np.full(len(there), -1)
    for length in range(2, longest + 2):
        open_ = np.flatnonzero((stops < 0) & (there + length < len(turns)))
        before = there[open_]
        smaller = np.minimum(jumps[before], jumps[before + length - 1])
        apart = _angle(turns[before], turns[before + length])
        back = open_[(smaller > least) & (apart < RETURN_PART * smaller)]
        stops[back] = there[back] + length
    return stops


def _return(turns: FloatArray, before: int, longest: int, least: float) -> int:
    """The same for one frame; the frame itself where it does not come back."""
    some = turns[before : before + longest + 2]
    if float(_angle(some[0], some[1])) <= least:
        return before
    jumps = _angle(some[:-1], some[1:])
    smaller = np.minimum(jumps[0], jumps[1:])
    back = np.flatnonzero((smaller > least) & (_angle(some[0], some[2:]) < RETURN_PART * smaller))
    return before + 2 + int(back[0]) if len(back) else before


def _angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """Radians between rotations (..., 4)."""
    angle: FloatArray = 2.0 * np.arccos(np.clip(np.abs(np.einsum("...i,...i->...", a, b)), 0.0, 1.0))
    return angle
