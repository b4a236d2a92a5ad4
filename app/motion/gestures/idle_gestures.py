"""Body motion while not playing: counting, looking around, settling the hands, looking up, bowing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Envelopes, minimum_jerk, rows_changed_s
from app.plan.model import GestureEvent
from app.score.metre_map import FeltBeats, beat_ticks_at
from metadata.model import AmplitudeScale, ConcertMotion, at_amplitude

BOW = (0.36, 0.56)
"""Shares of a bow at which the trunk has arrived below, and at which it begins to rise."""
LOOK_UP_S = 0.7
"""Seconds in which the head is raised, and lowered again."""
COUNT_EASE = 1.0
"""Number of beats over which counting fades in and out."""
MOST_BOW_RAD = float(np.deg2rad(36.0))
"""Greatest bend of the trunk in a bow in radians."""


@dataclass(frozen=True)
class ConcertSamples:
    """Strength 0..1 of each gesture made while not playing (bow, getting up, settling, counting), as arrays (F,) over F
    frames.
    """

    bow: FloatArray | float = 0.0
    up: FloatArray | float = 0.0
    settle: FloatArray | float = 0.0
    count: FloatArray | float = 0.0


NOTHING_BESIDE: Final = ConcertSamples()


@dataclass(frozen=True)
class Beside:
    """Offsets (F,) that gestures while not playing add to the body: hips, trunk and neck forward, hips back, shoulders
    up, elbows out; and the share by which the lowered instrument is raised.
    """

    hips_rad: FloatArray | float
    back_m: FloatArray | float
    trunk_rad: FloatArray | float
    neck_rad: FloatArray | float
    shoulders_rad: FloatArray | float
    elbows_rad: FloatArray | float
    up_share: FloatArray | float


def beside_playing(
    done: ConcertSamples, sizes: ConcertMotion, amplitude: float, amount: FloatArray | float, seated: bool
) -> Beside:
    """Compute the offsets of the body from gestures while not playing; ``amount`` is a factor of the usual size."""

    def rad(scale: AmplitudeScale) -> FloatArray | float:
        return amount * float(np.deg2rad(at_amplitude(scale, amplitude)))

    bow = done.bow * (sizes.bow_seated_share if seated else 1.0)
    stands = 0.0 if seated else np.minimum(amount, 1.5)
    return Beside(
        hips_rad=done.bow * stands * float(np.deg2rad(at_amplitude(sizes.bow_hips_deg, amplitude))),
        back_m=done.bow * stands * at_amplitude(sizes.bow_back_m, amplitude),
        trunk_rad=bow * np.minimum(rad(sizes.bow_trunk_deg), MOST_BOW_RAD),
        neck_rad=bow * np.minimum(rad(sizes.bow_head_deg), 0.5 * MOST_BOW_RAD)
        + done.count * rad(sizes.count_head_deg)
        - done.up * (1.0 - done.bow) * rad(sizes.look_up_deg),
        shoulders_rad=done.settle * rad(sizes.settle_shoulders_deg),
        elbows_rad=done.settle * rad(sizes.settle_elbows_deg),
        up_share=done.settle * np.minimum(amount * sizes.settle_share, 0.3),
    )


@dataclass(frozen=True, eq=False)
class Counting:
    """Head nods while counting beats, 0..1, lowest on each beat.

    Attributes
    ----------
    start_s, length_s, beats, amount : (N,) float64
        Counts in order, without overlap.
    """

    start_s: FloatArray
    length_s: FloatArray
    beats: FloatArray
    amount: FloatArray

    @classmethod
    def of(cls, events: Sequence[GestureEvent], felt_beats: FeltBeats) -> Counting:
        """Collect the counting gestures of a player; those that overlap the previous one are dropped."""
        rows: list[tuple[float, float, int, int, float]] = []
        for event in events:
            free_s = rows[-1][0] + rows[-1][1] if rows else -np.inf
            if event.end_s > event.start_s >= free_s:
                ticks = event.start_tick, event.end_tick - event.start_tick
                rows.append((event.start_s, event.end_s - event.start_s, *ticks, max(event.amount, 0.0)))
        table = np.array(rows, dtype=np.float64).reshape(-1, 5)
        first_tick = table[:, 2].astype(np.int64)
        beats = np.maximum(1.0, np.round(table[:, 3] / beat_ticks_at(felt_beats, first_tick))) if rows else table[:, 3]
        return cls(table[:, 0], table[:, 1], beats, table[:, 4])

    def sample(self, times_s: FloatArray) -> FloatArray:
        """Return the strength (F,) of the counting gesture at ascending times (F,)."""
        result = np.zeros(len(times_s))
        first = np.searchsorted(times_s, self.start_s)
        last = np.searchsorted(times_s, self.start_s + self.length_s)
        for index in np.flatnonzero(last > first):
            here = slice(first[index], last[index])
            beat = (times_s[here] - self.start_s[index]) / self.length_s[index] * self.beats[index]
            eased = minimum_jerk(np.clip(np.minimum(beat, self.beats[index] - beat) / COUNT_EASE, 0.0, 1.0))
            # Reaches down on each beat and rises soon after.
            result[here] = self.amount[index] * eased * np.square(0.5 + 0.5 * np.cos(2.0 * np.pi * beat))
        return result

    def changed_s(self, other: Counting) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both have equal values."""
        mine, others = (np.stack((one.start_s, one.length_s, one.beats, one.amount), axis=1) for one in (self, other))
        spans = [np.stack((rows[:, 0], rows[:, 0] + rows[:, 1]), axis=1) for rows in (mine, others)]
        return rows_changed_s(mine, others, *spans)


@dataclass(frozen=True, eq=False)
class Concert:
    """A player's gestures while not playing (bow, getting up, settling, counting) as curves over time."""

    bow: Envelopes
    up: Envelopes
    settle: Envelopes
    count: Counting

    @classmethod
    def of(cls, gestures: Sequence[GestureEvent], felt_beats: FeltBeats) -> Concert:
        """Make the curves from a player's gestures."""
        return cls(
            bow=Envelopes.of([_at_shares(event, *BOW) for event in gestures if event.part == "bow"]),
            up=Envelopes.of([_eased(event, LOOK_UP_S) for event in gestures if event.part == "audience"]),
            settle=Envelopes.of([_at_shares(event, 0.4, 0.5) for event in gestures if event.part == "settle"]),
            count=Counting.of([event for event in gestures if event.part == "count"], felt_beats),
        )

    def sample(self, times_s: FloatArray) -> ConcertSamples:
        """Return the strength of each gesture at ascending times."""
        return ConcertSamples(**{member.name: getattr(self, member.name).sample(times_s) for member in fields(self)})

    def changed_s(self, other: Concert) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both have equal gestures."""
        return np.concatenate(
            [getattr(self, member.name).changed_s(getattr(other, member.name)) for member in fields(self)]
        )


def _at_shares(event: GestureEvent, full: float, fall: float) -> tuple[float, float, float, float, float]:
    length_s = event.end_s - event.start_s
    return event.start_s, event.start_s + full * length_s, event.start_s + fall * length_s, event.end_s, event.amount


def _eased(event: GestureEvent, ease_s: float) -> tuple[float, float, float, float, float]:
    ease_s = min(ease_s, 0.5 * (event.end_s - event.start_s))
    return event.start_s, event.start_s + ease_s, event.end_s - ease_s, event.end_s, event.amount
