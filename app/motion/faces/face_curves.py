"""Curves of a face from a plan: embouchure, breath, tongue, effort, expressions, exertion.

`app.motion.faces.morph_weights` converts them to a character's morph weights.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, Envelopes, Trace, moves, moves_to
from app.motion.curves.spline import Spline
from app.motion.faces.exertion import Exertion, exertion_of
from app.motion.faces.lips_within_notes import firmness, tension_release, vibrato_size
from app.motion.faces.tongue_strokes import attack_pushes, back_strokes, tip_strokes
from app.plan.model import EmbouchureEvent, PlayerPlan, only
from app.plan.sampled_lip_curves import SampledCurves
from app.steps import StepTable, reading

FORM_S = 0.26
"""Seconds in which the lips form before the first note of a phrase and relax after its last."""
SHIFT_S = 0.09
"""Seconds of the transition between the tensions of two notes."""
SHIFT_SHARE = 0.45
HOLD_S = 0.8
"""Length in seconds of a rest below which the lips stay formed, except for breaths."""
SWELL_S = 0.35
"""Seconds in which effort and air change, over several notes."""

SHALLOWEST = 0.5
"""Opening of the mouth for the shallowest breath, relative to a full breath."""


def _tracked(spans_s: FloatArray, targets: FloatArray, shift_s: float, rest_value: float | None) -> Curve:
    """Return a curve that reaches a target (N,) at the onset of each note, holds it, and returns to ``rest_value`` in
    rests longer than `HOLD_S`; ``spans_s`` (N, 2) are starts and ends of notes."""
    initial = rest_value or 0.0
    if not len(spans_s):
        return moves((), initial)
    onsets_s = spans_s[:, 0]
    lasts_s = np.minimum(spans_s[:, 1], np.append(onsets_s[1:], np.inf))
    before = np.append(initial, targets[:-1])
    free_s = np.append(-np.inf, np.maximum(onsets_s, lasts_s - SHIFT_SHARE * (lasts_s - onsets_s))[:-1])
    left_s = np.append(-np.inf, lasts_s[:-1])
    # Two rows for each note: back to rest if it follows a rest, then to its own value.
    rows = np.empty((len(spans_s), 2, 3))
    if rest_value is not None:
        gap_s = onsets_s - left_s
        rests = np.isfinite(left_s) & (gap_s > HOLD_S)
        back_s = left_s + np.minimum(2.0 * FORM_S, gap_s / 2.0)
        free_s = np.where(rests, back_s, free_s)
        rows[:, 0] = np.stack((left_s, back_s, np.where(rests, rest_value, before)), axis=1)
    else:
        rows[:, 0] = np.stack((onsets_s, onsets_s, before), axis=1)
    rows[:, 1] = np.stack((np.maximum(onsets_s - shift_s, free_s), onsets_s, targets), axis=1)
    table = rows.reshape(-1, 3)
    if rest_value is not None:
        table = np.append(table, [[lasts_s[-1], lasts_s[-1] + 2.0 * FORM_S, rest_value]], axis=0)
    return moves_to(table[:, 0], table[:, 1], table[:, 2], initial)


@dataclass(frozen=True, eq=False)
class Column:
    """Values of the embouchures of all N notes, (N,) or (N, 2); two columns are compared to decide whether a curve can
    be reused.
    """

    values: FloatArray

    def __eq__(self, other: object) -> bool:
        """Return whether the other column has equal values."""
        return isinstance(other, Column) and np.array_equal(self.values, other.values)

    def __hash__(self) -> int:
        return hash(self.values.tobytes())


def _spans(lips: tuple[EmbouchureEvent, ...]) -> Column:
    return Column(np.array([(event.start_s, event.end_s) for event in lips]).reshape(-1, 2))


def _column(lips: tuple[EmbouchureEvent, ...], name: str) -> Column:
    return Column(np.array([getattr(event, name) for event in lips], np.float64))


def _at_lips(spans: Column) -> Curve:
    return _tracked(spans.values, np.ones(len(spans.values)), FORM_S, 0.0)


def _tension(spans: Column, tensions: Column, traces: SampledCurves | None, embouchure_tension: float) -> Curve | Trace:
    """Curve of lip tension: as recorded if there are recorded values, else moving from note to note."""
    if traces is None:
        return _tracked(spans.values, np.minimum(embouchure_tension * tensions.values, 1.0), SHIFT_S, None)
    return Trace(traces.start_s, traces.step_s, np.minimum(embouchure_tension * traces.tension, 1.0))


def _effort(spans: Column, efforts: Column, traces: SampledCurves | None) -> Curve | Trace:
    if traces is None or traces.air is None or traces.effort is None:
        return _tracked(spans.values, efforts.values, SWELL_S, 0.0)
    return Trace(traces.start_s, traces.step_s, traces.effort)


def _air(spans: Column, airs: Column, traces: SampledCurves | None) -> Curve | Trace:
    if traces is None or traces.air is None or traces.effort is None:
        return _tracked(spans.values, airs.values, SWELL_S, 0.0)
    return Trace(traces.start_s, traces.step_s, traces.air)


def breath_opening(plan: PlayerPlan) -> Envelopes:
    """Return the opening of the mouth for breaths: it opens in the first part of each breath and is closed
    at its end.
    """
    rows = []
    for breath in plan.breaths:
        if not breath.draws_air:
            continue
        length_s = breath.end_s - breath.start_s
        shut_s = min(0.35 * length_s, 0.22)
        open_s = min(0.40 * length_s, 0.45)
        height = SHALLOWEST + (1.0 - SHALLOWEST) * breath.depth
        rows.append((breath.start_s, breath.start_s + open_s, breath.end_s - shut_s, breath.end_s, height))
    return Envelopes.of(rows)


def _shown(plan: PlayerPlan) -> dict[str, Envelopes]:
    rows: dict[str, list[tuple[float, float, float, float, float]]] = {}
    for event in plan.expressions:
        full_s, fall_s = event.start_s + event.fade_in_s, event.end_s - event.fade_out_s
        rows.setdefault(event.expression, []).append((event.start_s, full_s, fall_s, event.end_s, event.strength))
    # Sorted by name, so that the order of display does not change the order of summation.
    return {name: Envelopes.of(rows[name]) for name in sorted(rows)}


@dataclass(frozen=True)
class Drivers:
    """Inputs of the face's motion at F frames, such as lip tension, effort and air; fields as in `FaceCurves`, each
    (F,)."""

    at_lips: FloatArray
    tension: FloatArray
    effort: FloatArray
    air: FloatArray
    tongue: FloatArray
    tongue_back: FloatArray
    push: FloatArray
    mouth_open: FloatArray
    firm: FloatArray
    eased: FloatArray
    vibrato: FloatArray
    exertion: Exertion
    expressions: dict[str, FloatArray]


@dataclass(frozen=True)
class FaceCurves:
    """One player's face as curves of time, made from the plan.

    Attributes
    ----------
    at_lips : Curve
        1 while the lips are formed around the mouthpiece.
    tongue, tongue_back, push : Envelopes
        Tongue strokes, and the breath pushes behind them (`app.motion.faces.tongue_strokes`).
    firm, eased, vibrato : Curve
        Motion of the lips within and between notes (`app.motion.faces.lips_within_notes`).
    exertion : Spline
        Fields of `Exertion`.
    expressions : dict of str to Envelopes
        Strength of expressions by name.
    """

    at_lips: Curve
    tension: Curve | Trace
    effort: Curve | Trace
    air: Curve | Trace
    tongue: Envelopes
    tongue_back: Envelopes
    push: Envelopes
    mouth_open: Envelopes
    firm: Curve
    eased: Curve
    vibrato: Curve
    exertion: Spline
    expressions: dict[str, Envelopes]

    def sample(self, times_s: FloatArray) -> Drivers:
        """Sample the inputs of the face at ascending times."""
        alone = {name: curve for name, curve in vars(self).items() if name not in ("expressions", "exertion")}
        return Drivers(
            **{name: curve.sample(times_s) for name, curve in alone.items()},
            exertion=Exertion(*self.exertion.sample(times_s)),
            expressions={name: envelopes.sample(times_s) for name, envelopes in self.expressions.items()},
        )


FACE: Final = StepTable(
    lips="plan.embouchures",
    traces="plan.traces",
    spans=_spans,
    tensions=partial(_column, name="tension"),
    efforts=partial(_column, name="effort"),
    airs=partial(_column, name="air"),
    plan_of_lips=partial(only, fields=("embouchures", "traces")),
    plan_of_tongue=partial(only, fields=("tongues",)),
    plan_of_breaths=partial(only, fields=("breaths",)),
    plan_of_expressions=partial(only, fields=("expressions",)),
    plan_of_attacks=partial(only, fields=("embouchures", "tongues")),
    plan_of_effort=partial(only, fields=("embouchures", "traces", "breaths")),
    at_lips=_at_lips,
    tension=_tension,
    effort=_effort,
    air=_air,
    tongue=reading(tip_strokes, plan="plan_of_tongue"),
    tongue_back=reading(back_strokes, plan="plan_of_tongue"),
    push=reading(attack_pushes, plan="plan_of_tongue"),
    mouth_open=reading(breath_opening, plan="plan_of_breaths"),
    firm=reading(firmness, plan="plan_of_attacks"),
    eased=reading(tension_release, plan="plan_of_lips"),
    vibrato=reading(vibrato_size, plan="plan_of_lips"),
    exertion=reading(exertion_of, plan="plan_of_effort", face="face_motion"),
    expressions=reading(_shown, plan="plan_of_expressions"),
    face=FaceCurves,
)
"""Steps that compute a face from the plan, the player's ``embouchure_tension`` (1 is as planned) and lungs, and the
body's ``face_motion``.
"""
