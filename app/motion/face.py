"""What a plan asks of a face, as curves of time: embouchure, breath, tongue, effort, expressions, what playing costs.

`app.motion.face_morphs` makes the weights of a character's morphs of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.motion.curve import Curve, Envelopes, FloatArray, Trace, moves, moves_to
from app.motion.exertion import Exertion, Lungs, exertion_of
from app.motion.held_notes import easing, firmness, vibrato_size
from app.motion.spline import Spline
from app.motion.strokes import attack_pushes, back_strokes, tip_strokes
from app.plan.model import PlayerPlan, same_events
from metadata.face_model import FaceMotion

FORM_S = 0.26
"""The lips form in this time before the first note of a phrase, and let go as slowly after its last."""
SHIFT_S = 0.09
"""From one note's tension to the next."""
SHIFT_SHARE = 0.45
HOLD_S = 0.8
"""In rests shorter than this the lips stay formed (but for a breath)."""
SWELL_S = 0.35
"""Effort and air swell and fade slowly, over several notes."""

START, END, TENSION, EFFORT, AIR = range(5)
"""Columns of `Asked.notes`."""

SHALLOWEST = 0.5
"""However shallow a breath, the mouth opens by this share of a full one's."""


def _tracked(notes: FloatArray, targets: FloatArray, shift_s: float, rest_value: float | None) -> Curve:
    """A value (N,) that is reached at each onset, held, and (``rest_value``) left in rests longer than `HOLD_S`; notes
    as of `Asked.notes`."""
    initial = rest_value or 0.0
    if not len(notes):
        return moves((), initial)
    onsets_s = notes[:, START]
    lasts_s = np.minimum(notes[:, END], np.append(onsets_s[1:], np.inf))
    before = np.append(initial, targets[:-1])
    free_s = np.append(-np.inf, np.maximum(onsets_s, lasts_s - SHIFT_SHARE * (lasts_s - onsets_s))[:-1])
    left_s = np.append(-np.inf, lasts_s[:-1])
    # Two rows for every note: back to rest where there is one before it, and to its own value.
    rows = np.empty((len(notes), 2, 3))
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


def _tension(asked: Asked) -> Curve | Trace:
    """As it was recorded where it was, else from note to note; so are effort and air."""
    traces, scale = asked.plan.traces, asked.embouchure_tension
    if traces is None:
        return _tracked(asked.notes, np.minimum(scale * asked.notes[:, TENSION], 1.0), SHIFT_S, None)
    return Trace(traces.start_s, traces.step_s, np.minimum(scale * traces.tension, 1.0))


def _strain(asked: Asked, column: int) -> Curve | Trace:
    """Effort or air."""
    traces = asked.plan.traces
    if traces is None or traces.air is None or traces.effort is None:
        return _tracked(asked.notes, asked.notes[:, column], SWELL_S, 0.0)
    return Trace(traces.start_s, traces.step_s, traces.effort if column == EFFORT else traces.air)


def breath_opening(plan: PlayerPlan) -> Envelopes:
    """How far the mouth is open for air: up through a breath's first part, shut again at its end."""
    rows = []
    for breath in plan.breaths:
        if breath.kind != "breath":
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
    # In the order of their names: an expression that is shown earlier does not change how the others add up.
    return {name: Envelopes.of(rows[name]) for name in sorted(rows)}


@dataclass(frozen=True)
class Drivers:
    """What moves the face at some frames: members as of `Face`, each (F,) float64."""

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
class Asked:
    """What the curves of a face are made from.

    Attributes
    ----------
    embouchure_tension : float
        Scales the tension; 1 is as planned.
    motion : FaceMotion
        Of the body.
    lungs : Lungs
        Of the player, with the instrument.
    """

    plan: PlayerPlan
    embouchure_tension: float
    motion: FaceMotion
    lungs: Lungs

    @cached_property
    def notes(self) -> FloatArray:
        """(N, 5): start and end (seconds), tension, effort and air of every embouchure."""
        events = self.plan.embouchures
        rows = [(event.start_s, event.end_s, event.tension, event.effort, event.air) for event in events]
        return np.array(rows, np.float64).reshape(-1, 5)

    def same(self, other: Asked, *kinds: str) -> bool:
        """Whether what is made of these events of the plan is the same."""
        mine, others = (one.plan.time_frame for one in (self, other))
        alike = (self.embouchure_tension, self.lungs, mine) == (other.embouchure_tension, other.lungs, others)
        return alike and self.motion is other.motion and same_events(self.plan, other.plan, *kinds)


@dataclass(frozen=True)
class Face:
    """What one player's plan asks of the face, as curves of time.

    Attributes
    ----------
    at_lips : Curve
        1 while the lips are formed.
    tongue, tongue_back, push : Envelopes
        The tongue's strokes, and the breath behind them (`app.motion.strokes`).
    firm, eased, vibrato : Curve
        What the lips do within notes and between them (`app.motion.held_notes`).
    exertion : Spline
        Members of `Exertion`.
    expressions : dict of str to Envelopes
        By name.
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

    @classmethod
    def of(cls, asked: Asked, before: tuple[Face, Asked] | None = None) -> Face:
        """From a whole plan, or from what is the same as in the plan ``before``."""
        plan, face = asked.plan, None
        lips = tongues = breaths = shown = times = tension = effort = air = False
        if before is not None and asked.same(before[1], "traces"):
            face, other = before
            lips, tongues, breaths, shown = (
                same_events(plan, other.plan, kind) for kind in ("embouchures", "tongues", "breaths", "expressions")
            )
            # Most of what an edit of a note leaves as it was is found out by comparing: that costs less than making it.
            times = lips or np.array_equal(asked.notes[:, :TENSION], other.notes[:, :TENSION])
            tension, effort, air = (
                times and (lips or np.array_equal(asked.notes[:, column], other.notes[:, column]))
                for column in (TENSION, EFFORT, AIR)
            )
        return cls(
            at_lips=face.at_lips if face and times else _tracked(asked.notes, np.ones(len(asked.notes)), FORM_S, 0.0),
            tension=face.tension if face and tension else _tension(asked),
            effort=face.effort if face and effort else _strain(asked, EFFORT),
            air=face.air if face and air else _strain(asked, AIR),
            tongue=face.tongue if face and tongues else tip_strokes(plan),
            tongue_back=face.tongue_back if face and tongues else back_strokes(plan),
            push=face.push if face and tongues else attack_pushes(plan),
            mouth_open=face.mouth_open if face and breaths else breath_opening(plan),
            firm=face.firm if face and air and tongues else firmness(plan),
            eased=face.eased if face and times else easing(plan),
            vibrato=face.vibrato if face and air else vibrato_size(plan),
            exertion=face.exertion if face and lips and breaths else exertion_of(plan, asked.motion, asked.lungs),
            expressions=face.expressions if face and shown else _shown(plan),
        )

    def sample(self, times_s: FloatArray) -> Drivers:
        """What moves the face at ascending times."""
        alone = {name: curve for name, curve in vars(self).items() if name not in ("expressions", "exertion")}
        return Drivers(
            **{name: curve.sample(times_s) for name, curve in alone.items()},
            exertion=Exertion(*self.exertion.sample(times_s)),
            expressions={name: envelopes.sample(times_s) for name, envelopes in self.expressions.items()},
        )
