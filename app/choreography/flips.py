"""Faults of a capture: flips, where a segment turns away for a frame or a few and back; steps, where the whole body
turns and goes on so, as where frames are missing; a rest pose put first.

Many converted files begin with their rest pose, which the body leaves within a frame to a few.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.rig import quaternion

FloatArray = npt.NDArray[np.float64]

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
STEP_FADE_S: Final = 0.4
"""What a step leaves of lean and height goes over into what was captured within this time."""
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
    found = []
    for at in range(1, len(turns) - 1):
        beside = STEP_TIMES * max(turns[at - 1], turns[at + 1])
        if (turns[at] - beside) * float(clip.fps) > LEAST_STEP_RAD_S:
            clip = _go_on(clip, at)
            found.append(Flip("hips", at + 1, min(len(clip), at + 1 + round(STEP_FADE_S * float(clip.fps)))))
    return clip, tuple(found)


def _go_on(clip: MotionClip, last: int) -> MotionClip:
    """The clip whose frames after ``last`` go on from there at the speed it had."""
    hips, rotations = clip.hips_m.copy(), clip.rotations.copy()
    goes_on = hips[last] + (hips[last] - hips[last - 1])
    turn = quaternion.multiply(rotations[last, 0], quaternion.conjugate(rotations[last - 1, 0]))
    missing = quaternion.multiply(
        quaternion.multiply(turn, rotations[last, 0]), quaternion.conjugate(rotations[last + 1, 0])
    )
    lean, yaw = quaternion.swing_twist(missing, (0.0, 1.0, 0.0))
    times = np.arange(len(clip) - last - 1) / (STEP_FADE_S * float(clip.fps))
    left = (1.0 - np.minimum(times, 1.0)) ** 2 * (1.0 + 2.0 * np.minimum(times, 1.0))
    after = hips[last + 1 :]
    rise_m = goes_on[1] - after[0, 1]
    moved = quaternion.rotate(yaw, (after - after[0]) * (1.0, 0.0, 1.0)) + goes_on * (1.0, 0.0, 1.0)
    hips[last + 1 :] = moved + (after[:, 1] + left * rise_m)[:, None] * (0.0, 1.0, 0.0)
    leaning = quaternion.from_rotation_vector(left[:, None] * quaternion.to_rotation_vector(lean))
    turned = quaternion.multiply(leaning, quaternion.multiply(yaw, rotations[last + 1 :, 0]))
    side = np.sign(float(turned[0] @ rotations[last, 0])) or 1.0
    rotations[last + 1 :, 0] = side * turned
    return replace(clip, hips_m=hips, rotations=rotations)


def _mend(turns: FloatArray, name: str, longest: int, clip: MotionClip) -> list[Flip]:
    """Flips of one segment (F, 4), mended in place."""
    least = max(LEAST_RAD, LEAST_RAD_S / float(clip.fps))
    found = []
    for before in map(int, np.flatnonzero(_angle(turns[:-1], turns[1:]) > least)):
        frame = before + 1
        for stop in range(frame + 1, min(frame + longest, len(turns) - 1) + 1):
            jumps = min(_angle(turns[before], turns[frame]), _angle(turns[stop - 1], turns[stop]))
            if jumps > least and _angle(turns[before], turns[stop]) < RETURN_PART * jumps:
                shares = np.arange(1, stop - before) / (stop - before)
                mended = quaternion.slerp(turns[before], turns[stop], shares)
                sides = np.where(mended @ turns[before] < 0.0, -1.0, 1.0)
                turns[frame:stop] = mended * sides[:, None]
                found.append(Flip(name, frame, stop))
                break
    return found


def _angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """Radians between rotations (..., 4)."""
    angle: FloatArray = 2.0 * np.arccos(np.clip(np.abs(np.einsum("...i,...i->...", a, b)), 0.0, 1.0))
    return angle
