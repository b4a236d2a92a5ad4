"""Nods of head and instrument: a lift before a beat and a dip onto it.

Used for cues by a leader, and for smaller answers by the other players.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import bump, rows_changed_s
from app.plan.model import CueEvent, GestureEvent

DIP_BEATS = 0.5
"""Half width of the dip around the beat, in beats; see `DIP_S`."""
DIP_S, SLOW_BEATS = 0.15, 0.2
"""Greatest half width of a dip in slow tempi: seconds plus a share of a beat; a slower drop would mark no beat."""
AFTER = 1.9
"""Factor for the time in which head and instrument rise after a dip, since their mass makes them slower."""
LIFT_BEATS = 0.85
"""Half width in beats of the lift before the dip, if there is time."""
NOD_BEATS = 1.5
"""Beats before the marked beat at which a nod begins."""
LIFT_LAG = 0.6547
"""Distance of a lift's centre before the beat, in half widths, at which the lift adds to the dip's peak acceleration
without shifting it (the side lobe of the acceleration of a bump).
"""


@dataclass(frozen=True, eq=False)
class Nods:
    """Lifts and dips of all nods: the dip's acceleration peaks on the marked beat, and its width follows the tempo.

    Attributes
    ----------
    beat_s, half_s, lift_s, amount : (N,) float64
        Marked beat, half widths of dip and lift, and size.
    """

    beat_s: FloatArray
    half_s: FloatArray
    lift_s: FloatArray
    amount: FloatArray

    @classmethod
    def of(cls, cues: Sequence[CueEvent], answers: Sequence[GestureEvent] = ()) -> Nods:
        """Collect the nods of a player: those of the player's own cues, and those in answer to cues of others (gestures
        that nod at their end).
        """
        rows = [(cue.downbeat_s, cue.start_s, cue.beat_s, cue.amount) for cue in cues]
        rows += [(one.end_s, one.start_s, (one.end_s - one.start_s) / NOD_BEATS, one.amount) for one in answers]
        rows = [row for row in rows if row[0] > row[1]]
        table = np.array(sorted(rows), dtype=np.float64).reshape(-1, 4)
        beat_s, room_s, length_s = table[:, 0], table[:, 0] - table[:, 1], table[:, 2]
        lift_s = np.minimum(LIFT_BEATS * length_s, room_s / (1.0 + LIFT_LAG))
        dip_s = np.minimum(DIP_BEATS * length_s, DIP_S + SLOW_BEATS * length_s)
        return cls(beat_s, np.minimum(dip_s, room_s), lift_s, table[:, 3])

    def sample(self, times_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Dip and lift at ascending times, 1 is the usual size, each (F,)."""
        dip, lift = np.zeros(len(times_s)), np.zeros(len(times_s))
        spans_s = self._spans_s
        first, last = (np.searchsorted(times_s, spans_s[:, side]) for side in (0, 1))
        for index in np.flatnonzero(last > first):
            here = slice(first[index], last[index])
            beat_s, lift_s = float(self.beat_s[index]), float(self.lift_s[index])
            amount = float(self.amount[index])
            np.maximum(dip[here], amount * _dip(times_s[here], beat_s, float(self.half_s[index])), out=dip[here])
            np.maximum(lift[here], amount * bump(times_s[here], beat_s - LIFT_LAG * lift_s, lift_s), out=lift[here])
        return dip, lift

    def changed_s(self, other: Nods) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both have equal nods."""
        mine, others = (
            np.stack((nods.beat_s, nods.half_s, nods.lift_s, nods.amount), axis=1) for nods in (self, other)
        )
        return rows_changed_s(mine, others, self._spans_s, other._spans_s)

    @property
    def _spans_s(self) -> FloatArray:
        first_s = np.minimum(self.beat_s - (1.0 + LIFT_LAG) * self.lift_s, self.beat_s - self.half_s)
        last_s = self.beat_s + np.maximum(AFTER * self.half_s, (1.0 - LIFT_LAG) * self.lift_s)
        return np.stack((first_s, last_s), axis=1)


def _dip(times_s: FloatArray, beat_s: float, half_s: float) -> FloatArray:
    """Dip (N,), 0..1, of a nod around a beat, with a prolonged return; acceleration is continuous at the beat."""
    after = np.maximum(times_s - beat_s, 0.0) / half_s
    stretched = after / (1.0 + after * (AFTER - 1.0) / AFTER)
    return bump(np.minimum(times_s, beat_s) + half_s * stretched, beat_s, half_s)
