"""Blends at the seams of a motion that is joined of segments: each new motion fades in from where the old one goes."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.body import SEGMENTS
from app.choreography.joins import (
    FADE_S,
    LEANS_RAD,
    MOST_CARRIED_RAD,
    facing_apart,
    facing_together,
    fading_difference,
    fading_turn,
)
from app.choreography.limbs import beyond_hinges, within_hinges
from app.rig import quaternion

MOST_SPIN_RAD: Final = 1.0
"""Change in radians within a frame of the difference between two motions above which it is ambiguous, near half a turn;
a join that poor is never chosen.
"""
_CARRIED_RAD: FloatArray = np.array([LEANS_RAD, *[MOST_CARRIED_RAD] * len(SEGMENTS)])


class Seams(NamedTuple):
    """Places at which a new motion begins that does not continue the one before it.

    Attributes
    ----------
    frames : (S,) int64
        First frame of the output of each new motion, ascending.
    rows : (S,) int64
        Row of the captured motion that is shown there; the row after it has the next moment of the new motion.
    """

    frames: IntArray
    rows: IntArray


class HipsOnTheWay:
    """Positions of the hips in output frames in progress; each new motion fades in from the previous one.

    Attributes
    ----------
    rate : float
        Frames per second.
    hips : (F, 3) float64
        Positions in metres, valid up to the last frames appended.
    """

    def __init__(self, rate: float, count: int) -> None:
        self.rate, self.hips = rate, np.zeros((count, 3))
        self._lasts = math.ceil(FADE_S * rate)
        times_s = np.arange(self._lasts) / rate
        self._held = fading_difference(np.ones(1), np.zeros(1), times_s)
        self._carried = fading_difference(np.zeros(1), np.ones(1), times_s)
        self._seam, self._off_m, self._drift_m_s = -self._lasts, np.zeros(3), np.zeros(3)

    def append(self, start: int, hips_m: FloatArray, *, seam: bool) -> None:
        """Add the positions (N + 1, 3) of a run of frames from ``start`` on, except the last one, which is only the
        start of the next motion's difference.

        At a seam they fade in from where the previous motion goes on to; a run that follows in the capture continues
        the difference before it.
        """
        count = len(hips_m) - 1
        if seam and start >= 2:
            before, last = self.hips[start - 2], self.hips[start - 1]
            step = last - before
            off, next_off = last + step - hips_m[0], last + step * 2.0 - hips_m[1]
            self._seam, self._off_m, self._drift_m_s = start, off, (next_off - off) * self.rate
        elif seam:
            self._seam = -self._lasts
        since = start - self._seam
        self.hips[start : start + count] = hips_m[:-1]
        if since < self._lasts:
            fading = slice(since, min(since + count, self._lasts))
            faded = self._held[fading] * self._off_m + self._carried[fading] * self._drift_m_s
            self.hips[start : start + len(faded)] += faded

    def place(self, frame: int) -> complex:
        """Position on the floor (complex, metres: Z + X · i) just before a frame."""
        return complex(self.hips[frame - 1, 2], self.hips[frame - 1, 0])

    def lately(self, frame: int, lasts_s: float) -> complex | None:
        """Mean position on the floor (complex, metres) over the time before a frame; None if there are too few
        frames."""
        first = max(0, frame - round(lasts_s * self.rate))
        if frame - first < 2:
            return None
        middle = self.hips[first:frame].mean(axis=0)
        return complex(middle[2], middle[0])


def blend_rotations(rotations: FloatArray, shown: IntArray, seams: Seams, hinges: FloatArray, rate: float) -> None:
    """Fade in the rotations of each new motion from where the previous one goes on to, in place.

    Parameters
    ----------
    rotations : (N, 16, 4) float64
        Rotations of the captured motion; those shown are replaced by the blended ones.
    shown : (F,) int64
        Row shown in each frame of the output, ascending.
    seams : Seams
        Seams; one before the third frame has no motion before it, and is not blended.
    hinges : (4, 2) float64
        See `app.choreography.limbs.hinge_ranges`.
    rate : float
        Frames per second.
    """
    lasts, starts = math.ceil(FADE_S * rate), seams.frames
    # The difference of a seam fades out before the next one, or ends there.
    stops = np.minimum(starts + lasts, np.append(starts[1:], len(shown)))
    left = starts >= 2
    fades = np.zeros(len(shown), bool)
    for start, stop in zip(starts[left].tolist(), stops[left].tolist(), strict=True):
        fades[start:stop] = True
    while left.any():
        # Seams whose motion before is complete are blended together.
        waits = fades[starts - 1] | fades[np.maximum(starts - 2, 0)]
        ready = np.flatnonzero(left & ~waits)
        lengths = (stops - starts)[ready]
        which = np.repeat(np.arange(len(ready)), lengths)
        since = np.arange(len(which)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
        frames = starts[ready][which] + since
        turned, spin_rad_s = _differences(rotations, shown, Seams(starts[ready], seams.rows[ready]), rate)
        off = quaternion.from_rotation_vector(fading_turn(turned[which], spin_rad_s[which], since / rate, _CARRIED_RAD))
        captured = facing_apart(rotations[shown[frames]])
        blended = quaternion.multiply(off, captured)
        edges = np.searchsorted(which, np.arange(len(ready) + 1))
        for at in np.unique(which[beyond_hinges(blended, hinges)]).tolist():
            some = slice(edges[at], edges[at + 1])
            blended[some] = within_hinges(blended[some], captured[some], hinges)
        rotations[shown[frames]] = facing_together(blended)
        fades[frames], left[ready] = False, False


def _differences(rotations: FloatArray, shown: IntArray, seams: Seams, rate: float) -> tuple[FloatArray, FloatArray]:
    """Compare new motions, by their first two frames, with where the old ones would go on to.

    The lean of the hips is compared apart from their facing, since it turns with a body that spins.

    Returns
    -------
    turned, spin_rad_s : (S, 17, 3) float64
        Rotation vectors of the differences at each seam, see `app.choreography.joins.facing_apart`, and their rates of
        change.
    """
    before, last = rotations[shown[seams.frames - 2]], rotations[shown[seams.frames - 1]]
    turn = quaternion.multiply(last, quaternion.conjugate(before))
    once = quaternion.multiply(turn, last)
    goes_on = once, quaternion.multiply(turn, once)
    new = rotations[seams.rows], rotations[seams.rows + 1]
    turned, later = (
        quaternion.to_rotation_vector(
            quaternion.multiply(facing_apart(old), quaternion.conjugate(facing_apart(begins)))
        )
        for old, begins in zip(goes_on, new, strict=True)
    )
    spin = later - turned
    spin = np.where(np.linalg.norm(spin, axis=-1, keepdims=True) > MOST_SPIN_RAD, 0.0, spin)
    return turned, spin * rate
