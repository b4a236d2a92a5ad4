"""Accents of the body: a small rise before, a dip on the note, and a rebound above the start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import rows_changed_s
from app.plan.model import ACCENT_AT, GestureEvent

DOWN_HALF, BEFORE_HALF, AFTER_HALF = 0.27, 0.19, 0.23
"""Half widths of the dip, of the preparation before it and of the rebound after it, as shares of an accent's length."""
BEFORE, AFTER = 0.25, 0.14
"""Height of the body in the preparation and the rebound, as shares of the dip."""


@dataclass(frozen=True, eq=False)
class Accents:
    """Dips of trunk and head; each is deepest, with the largest acceleration, on its note.

    Attributes
    ----------
    start_s, length_s, amount : (N,) float64
        Start and length in seconds and size of each dip, in order of start.
    """

    start_s: FloatArray
    length_s: FloatArray
    amount: FloatArray

    @classmethod
    def of(cls, events: Sequence[GestureEvent]) -> Accents:
        """Return the motion of the accents among a player's gesture events."""
        rows = [
            (event.start_s, event.end_s - event.start_s, event.amount)
            for event in events
            if event.end_s > event.start_s
        ]
        table = np.array(rows, dtype=np.float64).reshape(-1, 3)
        return cls(table[:, 0], table[:, 1], table[:, 2])

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the downward motion at ascending times, 1 on an accent of amount 1, (F,)."""
        first = np.searchsorted(times_s, self.start_s)
        counts = np.maximum(np.searchsorted(times_s, self.start_s + self.length_s) - first, 0)
        if not counts.any():
            return np.zeros(len(times_s))
        event = np.repeat(np.arange(len(counts)), counts)
        frame = np.arange(len(event)) - np.repeat(np.cumsum(counts) - counts, counts) + np.repeat(first, counts)
        phase = (times_s[frame] - self.start_s[event]) / self.length_s[event] - ACCENT_AT
        down = _bump(phase, 0.0, DOWN_HALF)
        down -= BEFORE * _bump(phase, BEFORE_HALF - ACCENT_AT, BEFORE_HALF)
        down -= AFTER * _bump(phase, 1.0 - ACCENT_AT - AFTER_HALF, AFTER_HALF)
        # Summed in the order of the accents for any choice of frames, so that results are identical to the bit.
        total: FloatArray = np.bincount(frame, self.amount[event] * down, len(times_s)).astype(np.float64)
        return total

    def changed_s(self, other: Accents) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both sets of accents have equal values."""
        mine, others = (np.stack((one.start_s, one.length_s, one.amount), axis=1) for one in (self, other))
        spans = [np.stack((row[:, 0], row[:, 0] + row[:, 1]), axis=1) for row in (mine, others)]
        return rows_changed_s(mine, others, *spans)


def _bump(phase: FloatArray, centre: float, half: float) -> FloatArray:
    """Return a smooth bump (N,) of height 1 at the phase ``centre`` that reaches 0 at a distance of ``half``."""
    inside = 1.0 - np.square(np.clip((phase - centre) / half, -1.0, 1.0))
    bump: FloatArray = np.square(np.square(inside))
    return bump
