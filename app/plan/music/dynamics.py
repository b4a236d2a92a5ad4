"""Strength of body motion by dynamics: larger when loud, smaller when soft."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from app.arrays import FloatArray, running_medians
from app.plan.music.breath_controller import BreathEnvelope
from app.plan.music.piece import MEZZOFORTE, LineTimes

LOUDNESSES = (0.0, 0.26, 0.39, MEZZOFORTE, 0.76, 0.88, 1.0)
"""Loudness of silence, pianissimo, piano, mezzoforte, forte, fortissimo and the maximum: MIDI velocities 33,
49, 80 ...
"""
VIGOURS = (0.1, 0.25, 0.5, 1.0, 1.4, 1.8, 2.0)
"""Size of motions for each of these dynamics, relative to mezzoforte."""
AROUND_S = 1.0
"""Seconds before and after a moment over which loudness is averaged for the body's motion."""
HELD_S = 0.5
"""Length in seconds of the sections in which a long note's loudness is examined, so that a crescendo shows."""
ACCENT = 0.1
"""Difference in loudness (0..1) from the notes around that makes a note accented: 13 of 127 velocities."""
ACCENT_NOTES = 3
"""Number of adjacent notes before and after a note with which it is compared."""


@dataclass(frozen=True, eq=False)
class Dynamics:
    """Strength of motion over a part, and its accents.

    Attributes
    ----------
    at_s, vigour : (K,) float64
        Size of motion relative to mezzoforte at times in seconds, linear between them.
    accents : (N,) float64
        Excess loudness of each accented note over the notes around it; 0 for other notes.
    """

    at_s: FloatArray
    vigour: FloatArray
    accents: FloatArray

    def at(self, times_s: FloatArray) -> FloatArray:
        """Factor (N,) by which motions are larger or smaller at given seconds because of loudness; 1 if nothing is
        played."""
        if len(self.at_s) == 0:
            return np.ones(len(times_s))
        return np.asarray(np.interp(times_s, self.at_s, self.vigour))

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing plans."""
        if not isinstance(other, Dynamics):
            return NotImplemented
        pairs = zip((self.at_s, self.vigour, self.accents), (other.at_s, other.vigour, other.accents), strict=True)
        return all(np.array_equal(mine, others) for mine, others in pairs)

    __hash__ = None  # type: ignore[assignment]


def dynamics_of(times: LineTimes, envelope: BreathEnvelope | None) -> Dynamics:
    """Compute the dynamics of a part from its recorded or drawn loudness curve, else from its notes."""
    lasts_s = times.duration_s
    parts = np.maximum(np.ceil(lasts_s / HELD_S), 1.0).astype(np.int64)
    within = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    step_s = np.repeat(lasts_s / parts, parts)
    starts_s = np.repeat(times.onset_s, parts) + within * step_s
    loudness = np.repeat(times.loudness, parts)
    if envelope is not None and len(starts_s):
        blown = np.repeat(envelope.plays(times), parts) & (step_s > 0.0)
        loudness = loudness.copy()
        loudness[blown] = envelope.mean(starts_s[blown], (starts_s + step_s)[blown])
    at_s = starts_s + step_s / 2.0
    vigour = vigour_of(mean_around(starts_s, step_s, loudness, at_s, AROUND_S)) if len(at_s) else loudness
    return Dynamics(at_s, vigour, _accents(times))


def vigour_of(loudness: FloatArray) -> FloatArray:
    """Return the factor (N,) by which motions are larger or smaller at a loudness 0..1, relative to mezzoforte."""
    return np.asarray(np.interp(np.round(loudness, 6), LOUDNESSES, VIGOURS))


Size = TypeVar("Size", float, FloatArray)


def amount_at_vigour(amount: Size, vigour: Size) -> Size:
    """Scale an amount -1..1 of a motion by a vigour: in proportion if it is below 1; above 1 small amounts grow most,
    and an amount of 1 stays 1.
    """
    return amount * vigour / (1.0 + abs(amount) * (vigour - 1.0) * (vigour > 1.0))


def mean_around(
    starts_s: FloatArray, lasts_s: FloatArray, loudness: FloatArray, at_s: FloatArray, around_s: float
) -> FloatArray:
    """Mean loudness (K,) of notes sounding within ``around_s`` of each time.

    Parameters
    ----------
    starts_s, lasts_s, loudness : (N,) float64
        Notes in order, or parts of them.
    at_s : (K,) float64
        Times in seconds.
    """
    knots_s = np.stack((starts_s, starts_s + lasts_s), axis=1).ravel()
    sums = []
    for weights in (lasts_s, lasts_s * loudness):
        total = np.concatenate(([0.0], np.cumsum(weights)))
        reached = np.stack((total[:-1], total[1:]), axis=1).ravel()
        sums.append(np.interp(at_s + around_s, knots_s, reached) - np.interp(at_s - around_s, knots_s, reached))
    return np.where(sums[0] > 1e-9, sums[1] / np.maximum(sums[0], 1e-9), loudness)


def louder_by(times: LineTimes) -> FloatArray:
    """Excess of the loudness (N,) of each note over that of the notes around it, and over the dynamic in force if that
    is known (three *forte* notes are no accents). 0 throughout in a part whose loudness varies too little.
    """
    loudness = times.loudness
    if len(loudness) < 2 or np.ptp(loudness) < ACCENT:
        return np.zeros(len(loudness))
    padded = np.pad(loudness, ACCENT_NOTES, mode="reflect" if len(loudness) > ACCENT_NOTES else "edge")
    around = running_medians(padded, 2 * ACCENT_NOTES + 1)
    return np.asarray(loudness - np.maximum(around, times.level))


def _accents(times: LineTimes) -> FloatArray:
    """Excess loudness (N,) of each accented note over its surroundings, 0 for other notes; of consecutive accents only
    the first counts.
    """
    more = louder_by(times)
    louder = np.append(-np.inf, times.loudness[:-1]) + ACCENT / 2.0 <= times.loudness
    return np.where((more >= ACCENT) & louder, more, 0.0)
