"""Evaluates curves with handles: cubic Bézier segments whose handles lie between their keys, and eased moves.

Each value depends only on its own time, so any subset of times gives the same values.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.plan.events_by_hand import CurveSegment

HALVINGS: Final = 40
"""Number of bisections that find a position on a segment."""
THIRD, EVEN = 1.0 / 3.0, 1e-9
COLUMNS: Final = 9
"""Number of columns in a row: the fields of `CurveSegment` in order."""


def rows(segments: Sequence[CurveSegment]) -> FloatArray:
    """Return S segments as a table (S, `COLUMNS`), a row of numbers for each."""
    table = [
        (
            one.start_s, one.end_s, one.before, one.after,
            one.leave_s, one.leave_value, one.arrive_s, one.arrive_value, float(one.eased),
        )
        for one in segments
    ]  # fmt: skip
    return np.array(table, np.float64).reshape(-1, COLUMNS)


def sampled(segments: Sequence[CurveSegment], times_s: FloatArray) -> FloatArray:
    """Values at any times, (F,) float64; 0 before the first and after the last segment."""
    return sampled_rows(rows(segments), times_s)


def sampled_rows(table: FloatArray, times_s: FloatArray) -> FloatArray:
    """Sample a curve, given as a table of consecutive segments, at times in seconds."""
    result = np.zeros(len(times_s))
    if not len(table):
        return result
    inside = np.flatnonzero((times_s >= table[0, 0]) & (times_s <= table[-1, 1]))
    if not len(inside):
        return result
    at = times_s[inside]
    chosen = table[np.maximum(np.searchsorted(table[:, 0], at, side="right") - 1, 0)]
    start_s, end_s, before, after = chosen[:, 0], chosen[:, 1], chosen[:, 2], chosen[:, 3]
    length_s = np.maximum(end_s - start_s, 1e-9)
    phase = np.clip((at - start_s) / length_s, 0.0, 1.0)
    eased = before + (after - before) * (phase * phase * phase * (10.0 + phase * (6.0 * phase - 15.0)))
    free = chosen[:, 8] == 0.0
    values = eased
    if free.any():
        some = chosen[free]
        span_s = length_s[free]
        leave, arrive = (some[:, 4] - some[:, 0]) / span_s, (some[:, 6] - some[:, 0]) / span_s
        place = phase[free]
        # With handles at thirds of the way, as automatic ones are, a curve goes on evenly.
        uneven = (np.abs(leave - THIRD) > EVEN) | (np.abs(arrive - 2.0 * THIRD) > EVEN)
        if uneven.any():
            place[uneven] = _place(place[uneven], leave[uneven], arrive[uneven])
        values[free] = _cubic(place, some[:, 2], some[:, 5], some[:, 7], some[:, 3])
    result[inside] = values
    return result


def looked_at_s(table: FloatArray, step_s: float, most: int) -> FloatArray:
    """Ascending times in seconds at which a curve is checked, bounded for long segments.

    Parameters
    ----------
    table : (S, 9) float64
        See `rows`.
    step_s : float
        Distance of the times in segments with at most ``most`` steps.
    most : int
        Number of times in longer segments; they are denser where the handles make the curve steep.
    """
    start_s, leave_s, arrive_s, end_s = table[:, 0], table[:, 4], table[:, 6], table[:, 1]
    steps = np.ceil((end_s - start_s) / step_s)
    few = steps <= most
    counts = np.where(few, steps, most).astype(np.int64) + 1
    whose = np.repeat(np.arange(len(table)), counts)
    number = np.arange(len(whose)) - np.repeat(np.cumsum(counts) - counts, counts)
    even = np.minimum(start_s[whose] + number * step_s, end_s[whose])
    share = number / np.maximum(counts[whose] - 1, 1)
    eased = table[whose, 8] != 0.0
    leave_s, arrive_s = leave_s[whose], arrive_s[whose]
    steep = _cubic(share, start_s[whose], leave_s, arrive_s, end_s[whose])
    smooth = start_s[whose] + share * (end_s - start_s)[whose]
    return np.unique(np.where(few[whose], even, np.where(eased, smooth, steep)))


def _place(phase: FloatArray, leave: FloatArray, arrive: FloatArray) -> FloatArray:
    """Return the Bézier parameter (F,) at which a segment reaches each share ``phase`` of its time; handles lie within
    0..1.
    """
    low, high = np.zeros(len(phase)), np.ones(len(phase))
    nothing, whole = low.copy(), high.copy()
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        early = _cubic(middle, nothing, leave, arrive, whole) < phase
        low, high = np.where(early, middle, low), np.where(early, high, middle)
    return 0.5 * (low + high)


def _cubic(u: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    v = 1.0 - u
    return v * v * v * a + 3.0 * v * v * u * b + 3.0 * v * u * u * c + u * u * u * d
