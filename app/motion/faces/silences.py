"""Times in a plan that affect faces: silences, fast runs, phrase starts and ends."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.plan.model import PlayerPlan

REST_S = 1.0
QUICK_S = 0.16
"""Time in seconds between onsets below which notes are a fast run."""
CARRIED_S = 1.3
"""Seconds for which an instrument is moved to or from the lips."""


@dataclass(frozen=True, eq=False)
class Silences:
    """Notes and silences of one player, by which blinks and glances are timed.

    Attributes
    ----------
    starts_s, ends_s : (N,) float64
        Times of the notes, in order.
    rests_s : (R, 2) float64
        Silences of at least `REST_S`; the first one is before the first note and the last one after the last, of any
        length.
    quick_s : (Q, 2) float64
        Spans of notes that follow each other within `QUICK_S`.
    breaths_s : (B, 2) float64
        Spans of the breaths.
    carried_s : (C, 2) float64
        Spans in which the instrument moves from or to the lips.
    """

    starts_s: FloatArray
    ends_s: FloatArray
    rests_s: FloatArray
    quick_s: FloatArray
    breaths_s: FloatArray
    carried_s: FloatArray

    @classmethod
    def of(cls, plan: PlayerPlan) -> Silences:
        """Collect the times of notes, rests and breaths from a player's plan."""
        events, frame = plan.fingerings, plan.time_frame
        starts_s = np.array([event.start_s for event in events])
        ends_s = np.array([event.end_s for event in events])
        from_s, to_s = np.append(frame.first_frame_s, ends_s), np.append(starts_s, frame.end_s)
        silent = to_s - from_s >= REST_S
        silent[-1] = True
        short = np.diff(starts_s) < QUICK_S
        breaths_s = np.array([(event.start_s, event.end_s) for event in plan.breaths if event.draws_air])
        return cls(
            starts_s,
            ends_s,
            np.stack((from_s, to_s), axis=1)[silent],
            np.stack((starts_s[:-1][short], starts_s[1:][short]), axis=1),
            breaths_s.reshape(-1, 2),
            _carried_s(plan),
        )

    def __eq__(self, other: object) -> bool:
        """Return whether all times are equal, so that gazes are equal too."""
        if not isinstance(other, Silences):
            return NotImplemented
        return all(np.array_equal(getattr(self, one.name), getattr(other, one.name)) for one in fields(self))

    def __hash__(self) -> int:
        return hash((self.starts_s.tobytes(), self.ends_s.tobytes()))

    @property
    def entries_s(self) -> FloatArray:
        """Onset (K,) in seconds of the first note after each rest."""
        return self.rests_s[:-1, 1]


def _carried_s(plan: PlayerPlan) -> FloatArray:
    ways = [
        way
        for start_s, end_s in _lowered_s(plan)
        for way in ((start_s, start_s + CARRIED_S), (end_s - CARRIED_S, end_s))
    ]
    return np.array(sorted(ways), dtype=np.float64).reshape(-1, 2)


def _lowered_s(plan: PlayerPlan) -> list[tuple[float, float]]:
    return [(event.start_s, event.end_s) for event in plan.gestures if event.part == "lowering"]


def holds(spans_s: FloatArray, times_s: FloatArray) -> BoolArray:
    """Mask (F,) of the times that lie within any of K spans (K, 2), which are ordered by start."""
    return overlaps(spans_s, times_s, times_s)


def overlaps(spans_s: FloatArray, from_s: FloatArray, to_s: FloatArray) -> BoolArray:
    """Mask (F,) of intervals ``from_s``..``to_s`` that overlap one of the spans (K, 2)."""
    ends_s = np.append(-np.inf, np.maximum.accumulate(spans_s[:, 1]))
    found: BoolArray = ends_s[np.searchsorted(spans_s[:, 0], to_s, side="right")] > from_s
    return found
