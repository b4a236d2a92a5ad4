"""Planned steps, taps and heel lifts; feet stand still between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import minimum_jerk, rows_changed_s
from app.plan.gestures.feet import FOOT_KINDS, foot_of, moves_s
from app.plan.model import GestureEvent
from metadata.model import Body, at_amplitude

UNLOADS_S = 0.45
"""Seconds in which the weight shifts before a foot leaves the ground, and after it returns."""
PUSH_OFF_RAD = float(np.deg2rad(9.0))
"""Angle in radians of the sole when a stepping foot pushes off with its toes."""
HEEL_S = 0.5
"""Seconds in which heels rise and sink, at most half of the gesture."""
STRIKE_SHARE = 0.35
"""Last share of a tap, in which the toes come down."""


@dataclass(frozen=True, eq=False)
class Feet:
    """All foot gestures of a player, one per row.

    Attributes
    ----------
    kinds, sides : (N,) float64
        Index in `FOOT_KINDS`; 1: left foot, -1: right foot.
    start_s, end_s, size : (N,) float64
        Start and end in seconds, and size 0..1.
    step_s : float
        Seconds for which a stepping foot is in the air.
    """

    kinds: FloatArray
    sides: FloatArray
    start_s: FloatArray
    end_s: FloatArray
    size: FloatArray
    step_s: float

    @classmethod
    def of(cls, events: Sequence[GestureEvent], step_s: float, generated_feet: float = 1.0) -> Feet:
        """Collect the foot gestures of a player; generated ones are scaled by ``generated_feet``, the animator's are
        not.
        """
        rows = [
            (
                FOOT_KINDS.index(event.kind),
                1.0 if foot_of(event) == "left" else -1.0,
                event.start_s,
                event.end_s,
                min(abs(event.amount), 1.0) * (1.0 if event.corrected else generated_feet),
            )
            for event in events
            if event.end_s > event.start_s and event.amount != 0.0 and (event.corrected or generated_feet > 0.0)
        ]
        kinds, sides, start_s, end_s, size = np.array(rows, dtype=np.float64).reshape(-1, 5).T
        return cls(kinds, sides, start_s, end_s, size, step_s)

    def sample(self, times_s: FloatArray) -> dict[str, FloatArray]:
        """Sample the feet at ascending times, each (F,), 0..1; parts at rest are omitted.

        ``left_ahead``: forward position of the left foot; ``left_up``: its height; ``left_push``: lead of its heel over
        its toes; ``left_heel`` and ``left_toes``: their lift; ``left_unloaded``: weight shifted to the other foot.
        """
        result: dict[str, FloatArray] = {}
        if not len(times_s):
            return result
        spans_s = self._spans_s
        for row in np.flatnonzero((spans_s[:, 0] <= times_s[-1]) & (spans_s[:, 1] >= times_s[0])).tolist():
            side = "left" if self.sides[row] > 0.0 else "right"
            here = slice(*np.searchsorted(times_s, spans_s[row]).tolist())
            if here.start == here.stop:
                continue
            span_s, size = (float(self.start_s[row]), float(self.end_s[row])), float(self.size[row])
            kind = FOOT_KINDS[int(self.kinds[row])]
            shape = (
                _step(times_s[here], span_s, self.step_s) if kind == "step" else _lifted(times_s[here], span_s, kind)
            )
            for name, values in shape.items():
                total = result.setdefault(f"{side}_{name}", np.zeros(len(times_s)))
                np.maximum(total[here], size * values, out=total[here])
        return result

    def changed_s(self, other: Feet) -> FloatArray:
        """Return the K spans (K, 2) in seconds outside of which both have equal feet."""
        return rows_changed_s(self._rows, other._rows, self._spans_s, other._spans_s)

    @property
    def _rows(self) -> FloatArray:
        return np.stack((self.kinds, self.sides, self.start_s, self.end_s, self.size), axis=1)

    @property
    def _spans_s(self) -> FloatArray:
        around_s = np.where(self.kinds == FOOT_KINDS.index("step"), UNLOADS_S, 0.0)
        return np.stack((self.start_s - around_s, self.end_s + around_s), axis=1)


def _step(times_s: FloatArray, span_s: tuple[float, float], step_s: float) -> dict[str, FloatArray]:
    """Return the motion (N,), by component, of a foot that steps out at the start of a span and back at its end; each
    step lasts ``step_s``."""
    ahead, up, push, unloaded = (np.zeros(len(times_s)) for _ in range(4))
    for (begin_s, end_s), way in zip(moves_s(span_s, step_s), (1.0, -1.0), strict=True):
        phase = np.clip((times_s - begin_s) / (end_s - begin_s), 0.0, 1.0)
        ahead += way * minimum_jerk(phase)
        up += 16.0 * np.square(phase * (1.0 - phase))
        # The toes bend up with the foot, and down in time for the sole to land flat.
        push += 16.0 * np.square(phase * (1.0 - phase)) * (1.0 - 2.0 * phase)
        coming = minimum_jerk(np.clip((times_s - begin_s) / UNLOADS_S + 1.0, 0.0, 1.0))
        going = minimum_jerk(np.clip((end_s - times_s) / UNLOADS_S + 1.0, 0.0, 1.0))
        unloaded = np.maximum(unloaded, np.minimum(coming, going))
    return {"ahead": ahead, "up": up, "push": push, "unloaded": unloaded}


def _lifted(times_s: FloatArray, span_s: tuple[float, float], kind: str) -> dict[str, FloatArray]:
    """Return the lift (N,), 0..1, of toes or heel during a span, by the name of the part: toes come down on the beat at
    the end of a tap; a heel is raised, held and lowered."""
    start_s, end_s = span_s
    length_s = end_s - start_s
    falls_s = STRIKE_SHARE * length_s if kind == "tap" else min(HEEL_S, 0.5 * length_s)
    rises_s = length_s - falls_s if kind == "tap" else falls_s
    up = minimum_jerk(np.clip((times_s - start_s) / rises_s, 0.0, 1.0))
    down = minimum_jerk(np.clip((end_s - times_s) / falls_s, 0.0, 1.0))
    return {"toes" if kind == "tap" else "heel": np.minimum(up, down)}


def feet_moved(
    levels: Mapping[str, FloatArray], body: Body, amplitude: float, amount: float, *, steps: bool
) -> dict[str, FloatArray]:
    """Scale samples (N,) of `Feet.sample` to the body, in metres and radians, by name; without ``steps`` feet may not
    leave their place. ``amplitude`` is the size of all motion, ``amount`` that of feet."""
    footwork = body.footwork
    ahead_m, up_m, heel, toes = (
        amount * at_amplitude(scale, amplitude)
        for scale in (footwork.step_m, footwork.lift_m, footwork.heel_deg, footwork.toes_deg)
    )
    push = amount * PUSH_OFF_RAD * min(2.0 * amplitude, 1.0)
    sizes = {"ahead": ahead_m, "up": up_m, "push": push, "heel": float(np.deg2rad(heel))}
    if not steps:
        sizes = {}
    sizes |= {"toes": float(np.deg2rad(toes))}
    moved = {}
    for name, values in levels.items():
        part = name.split("_")[1]
        if sizes.get(part, 0.0) > 0.0:
            moved[name] = sizes[part] * values
    return moved
