"""Breath data from a part's controllers: gaps without breath, its strength, and lip motion.

The curve of a breath sensor drops to zero when the player stops blowing and stays there during the inhalation. A curve
drawn for dynamics does not: it shows loudness, not breaths. Gaps are therefore used only if the curve is at zero in
most rests.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.music.piece import ControllerSteps, LineTimes
from app.score.tempo import TempoMap

BLOWS_FROM, STOPS_AT = 6.0 / 127.0, 2.0 / 127.0
"""Controller values 0..1 at which blowing begins, and the lower ones at which it ends, above a sensor's noise."""
GASP_S = 0.12
"""Gap in seconds below which no air is inhaled: tonguing, or a finger between two keys."""
BREATH_S = 0.3
"""Gap in seconds from which a breath is certain; a shorter one may end a detached note and is a breath only if air is
needed.
"""
LATE_S = 0.15
"""Greatest seconds after a note's onset in the score at which the player begins to blow."""
SILENT_SHARE = 0.5
"""Least share of the rests in which a curve is zero for its gaps to count as breaths."""
LEAST_PLAYED_S = 0.03
"""Seconds of blowing below which a note was not blown."""


@dataclass(frozen=True, eq=False)
class BreathEnvelope:
    """A recorded breath curve over time, in seconds.

    Attributes
    ----------
    at_s, values : (K,) float64
        A step function; the first value holds before.
    gaps_s : (G, 2) float64
        Spans without breath, ordered, from minus to plus infinity.
    """

    at_s: FloatArray
    values: FloatArray
    gaps_s: FloatArray

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing inputs of cached steps."""
        if not isinstance(other, BreathEnvelope):
            return NotImplemented
        return all(np.array_equal(getattr(self, field.name), getattr(other, field.name)) for field in fields(self))

    __hash__ = None  # type: ignore[assignment]

    def mean(self, starts_s: FloatArray, ends_s: FloatArray) -> FloatArray:
        """Return the mean value (N,) of the breath controller over each span of seconds."""
        return step_means(self.at_s, self.values, starts_s, ends_s)

    def plays(self, times: LineTimes) -> BoolArray:
        """Mask (N,) of the notes that were blown; notes outside the recorded bars were not."""
        lasts = times.played_end_s > times.onset_s
        ends_s = np.where(lasts, times.played_end_s, times.onset_s + GASP_S)
        return np.asarray(self.mean(times.onset_s, ends_s) > STOPS_AT)

    def has_breath_gaps(self, times: LineTimes) -> bool:
        """Return whether the gaps of the curve are inhalations of a player, not silences of a curve drawn
        for dynamics.
        """
        gaps_s = self.gaps_s[np.isfinite(self.gaps_s).all(axis=1)]
        gaps_s = gaps_s[gaps_s[:, 1] - gaps_s[:, 0] >= GASP_S]
        played = self.plays(times)
        rests_s = np.stack((times.played_end_s[:-1], times.onset_s[1:]), axis=1)
        rests_s = rests_s[played[:-1] & played[1:] & (rests_s[:, 1] - rests_s[:, 0] >= BREATH_S)]
        if len(gaps_s) == 0 or len(rests_s) == 0:
            return len(gaps_s) > 0
        # The first gap that ends after the beginning of the rest also begins before the end of the rest.
        first = np.searchsorted(gaps_s[:, 1], rests_s[:, 0], side="right")
        begins_s = np.append(gaps_s[:, 0], np.inf)[first]
        return bool(np.mean(begins_s < rests_s[:, 1]) >= SILENT_SHARE)


@dataclass(frozen=True, eq=False)
class BreathGaps:
    """Gap in the recorded breath before each note.

    Attributes
    ----------
    start_s, end_s : (N,) float64
        NaN where a note has no gap before it; the end is at most the note's onset.
    played : (N,) bool
        Mask of notes that were blown; for the others the recording gives no breaths.
    """

    start_s: FloatArray
    end_s: FloatArray
    played: BoolArray

    @property
    def length_s(self) -> FloatArray:
        """Length (N,) in seconds of each gap; 0 without one."""
        return np.nan_to_num(self.end_s - self.start_s)


def blown(steps: ControllerSteps, clock: TempoMap) -> BreathEnvelope:
    """Convert the steps of a breath controller from ticks to seconds, with the gaps in which nothing is blown."""
    at_s = clock.seconds(steps.ticks)
    return BreathEnvelope(at_s, steps.values, find_gaps(at_s, steps.values))


def find_gaps(at_s: FloatArray, values: FloatArray) -> FloatArray:
    """Return the G spans (G, 2) in seconds without breath, however short; also before the first value."""
    reported = np.where(values >= BLOWS_FROM, 1, np.where(values <= STOPS_AT, 0, -1))
    last: IntArray = np.maximum.accumulate(np.where(reported >= 0, np.arange(len(reported)), -1))
    blows = np.where(last >= 0, reported[last], 0)
    changes = np.diff(blows, prepend=0)
    starts_s = np.concatenate(([-np.inf], at_s[changes < 0]))
    ends_s = at_s[changes > 0]
    return np.stack((starts_s, np.append(ends_s, np.inf)[: len(starts_s)]), axis=1)


def gaps_within(envelope: BreathEnvelope, times: LineTimes) -> list[tuple[int, float, float]]:
    """Return the longest gap in the recorded breath within each note that has one: index of the note, start and end in
    seconds."""
    gaps_s = envelope.gaps_s[np.isfinite(envelope.gaps_s).all(axis=1)]
    gaps_s = gaps_s[gaps_s[:, 1] - gaps_s[:, 0] >= BREATH_S]
    notes = np.searchsorted(times.onset_s + LEAST_PLAYED_S, gaps_s[:, 0]) - 1
    # A gap that ends later is a breath for the next note: see `silences`.
    inside = (notes >= 0) & (gaps_s[:, 1] <= times.played_end_s[notes] - LATE_S)
    longest: dict[int, tuple[float, float]] = {}
    for note, (start_s, end_s) in zip(notes[inside].tolist(), gaps_s[inside].tolist(), strict=True):
        before = longest.get(note, (0.0, 0.0))
        longest[note] = max(before, (start_s, end_s), key=lambda gap: gap[1] - gap[0])
    return [(note, *longest[note]) for note in sorted(longest)]


def silences(envelope: BreathEnvelope, times: LineTimes) -> BreathGaps:
    """Return the gap before each note: the longest one since the previous note.

    A gap in the middle of a note is not used here (`gaps_within`); if the previous note was not blown either, the gap
    begins at its end.
    """
    count = len(times.onset_s)
    start_s, end_s = np.full(count, np.nan), np.full(count, np.nan)
    gaps_s = envelope.gaps_s[np.isfinite(envelope.gaps_s).all(axis=1)]
    serves = np.searchsorted(times.onset_s + LATE_S, gaps_s[:, 1])
    inner = (serves > 0) & (serves < count)
    gaps_s, serves = gaps_s[inner], serves[inner]
    begun_s, ended_s = times.onset_s[serves - 1], times.played_end_s[serves - 1]
    starts_s = np.where(gaps_s[:, 0] > begun_s + LEAST_PLAYED_S, gaps_s[:, 0], ended_s)
    ends_s = np.minimum(gaps_s[:, 1], times.onset_s[serves])
    played = envelope.plays(times)
    kept = (ends_s - starts_s >= GASP_S) & (ends_s > ended_s - LATE_S) & played[serves]
    starts_s, ends_s, serves = starts_s[kept], ends_s[kept], serves[kept]
    # The longest gap of each note comes last and is kept.
    order = np.lexsort((ends_s - starts_s, serves))
    start_s[serves[order]], end_s[serves[order]] = starts_s[order], ends_s[order]
    return BreathGaps(start_s, end_s, played)


def step_means(at: FloatArray, values: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the mean (N,) of a step function over spans from ``starts`` to ``ends``; before its first step at ``at``
    the function has its first value."""
    area = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(at))])

    def integral(places: FloatArray) -> FloatArray:
        step = np.clip(np.searchsorted(at, places, side="right") - 1, 0, None)
        result: FloatArray = area[step] + values[step] * (places - at[step])
        return result

    means: FloatArray = (integral(ends) - integral(starts)) / (ends - starts)
    return means
