"""Nods of head and instrument that give an entry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.motion.curve import FloatArray, bump, rows_changed_s
from app.plan.model import CueEvent

LIFT_LAG = 0.6547
"""Where the side lobe of a bump's acceleration peaks, in half widths: a lift placed there adds to the nod's peak
without moving it."""


@dataclass(frozen=True)
class Nods:
    """Dips and lifts of all cues: the dip's acceleration peaks on the preparatory beat, its width is the beat.

    Attributes
    ----------
    peak_s, half_s, amount : (N,) float64
    """

    peak_s: FloatArray
    half_s: FloatArray
    amount: FloatArray

    @classmethod
    def of(cls, cues: Sequence[CueEvent]) -> Nods:
        """From a player's cues."""
        rows = [(cue.peak_s, min(0.6 * cue.beat_s, cue.peak_s - cue.start_s), cue.amount) for cue in cues]
        table = np.array([row for row in rows if row[1] > 0.0], dtype=np.float64).reshape(-1, 3)
        return cls(table[:, 0], table[:, 1], table[:, 2])

    def sample(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Dip and lift, 1 as usual, at ascending times, each (F,) float64."""
        dip, lift = np.zeros(len(times_s)), np.zeros(len(times_s))
        first = np.searchsorted(times_s, self.peak_s - self.half_s)
        last = np.searchsorted(times_s, self.peak_s + 2.0 * self.half_s)
        for index in np.flatnonzero(last > first):
            here = slice(first[index], last[index])
            peak_s, half_s = float(self.peak_s[index]), float(self.half_s[index])
            amount = float(self.amount[index])
            np.maximum(dip[here], amount * bump(times_s[here], peak_s, half_s), out=dip[here])
            np.maximum(lift[here], amount * bump(times_s[here], peak_s + LIFT_LAG * half_s, half_s), out=lift[here])
        return dip, lift

    def changed_s(self, other: Nods) -> FloatArray:
        """Spans (K, 2) outside of which both have the very same values."""
        mine, others = (np.stack((nods.peak_s, nods.half_s, nods.amount), axis=1) for nods in (self, other))
        spans = [np.stack((row[:, 0] - row[:, 1], row[:, 0] + 2.0 * row[:, 1]), axis=1) for row in (mine, others)]
        return rows_changed_s(mine, others, *spans)
