"""What a plan asks of a face, as curves of time: embouchure, breath, tongue, effort, expressions, what playing costs.

`app.motion.face_morphs` makes the weights of a character's morphs of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.motion.curve import Curve, Envelopes, FloatArray, Trace, moves, moves_to
from app.motion.exertion import Exertion, Lungs, exertion_of
from app.motion.held_notes import easing, firmness, vibrato_size
from app.motion.spline import Spline
from app.plan.model import EmbouchureEvent, PlayerPlan, same_events
from metadata.face_model import FaceMotion

FORM_S = 0.26
"""The lips form in this time before the first note of a phrase, and let go as slowly after its last."""
SHIFT_S = 0.09
"""From one note's tension to the next."""
SHIFT_SHARE = 0.45
HOLD_S = 0.8
"""In rests shorter than this the lips stay formed (but for a breath)."""
TONGUE_HOLD_SHARE = 0.3
TONGUE_RELEASE_S = 0.05
SWELL_S = 0.35
"""Effort and air swell and fade slowly, over several notes."""

SHALLOWEST = 0.5
"""However shallow a breath, the mouth opens by this share of a full one's."""


def _tracked(
    events: Sequence[EmbouchureEvent], values: Sequence[float], shift_s: float, rest_value: float | None
) -> Curve:
    """A value that is reached at each onset, held, and (``rest_value``) left in rests longer than `HOLD_S`."""
    initial = rest_value or 0.0
    if not events:
        return moves((), initial)
    onsets_s = np.array([event.start_s for event in events])
    lasts_s = np.minimum(np.array([event.end_s for event in events]), np.append(onsets_s[1:], np.inf))
    targets = np.array(values, dtype=np.float64)
    before = np.append(initial, targets[:-1])
    free_s = np.append(-np.inf, np.maximum(onsets_s, lasts_s - SHIFT_SHARE * (lasts_s - onsets_s))[:-1])
    left_s = np.append(-np.inf, lasts_s[:-1])
    # Two rows for every note: back to rest where there is one before it, and to its own value.
    rows = np.empty((len(events), 2, 3))
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


def _strains(plan: PlayerPlan, embouchure_tension: float) -> tuple[Curve | Trace, Curve | Trace, Curve | Trace]:
    """Tension, effort and air: as they were recorded where they were, else from note to note."""
    events, traces = plan.embouchures, plan.traces
    if traces is None:
        tensions = [min(1.0, embouchure_tension * event.tension) for event in events]
        tension: Curve | Trace = _tracked(events, tensions, SHIFT_S, None)
    else:
        tension = Trace(traces.start_s, traces.step_s, np.minimum(embouchure_tension * traces.tension, 1.0))
    if traces is None or traces.air is None or traces.effort is None:
        effort = _tracked(events, [event.effort for event in events], SWELL_S, 0.0)
        return tension, effort, _tracked(events, [event.air for event in events], SWELL_S, 0.0)
    recorded = [Trace(traces.start_s, traces.step_s, values) for values in (traces.effort, traces.air)]
    return tension, recorded[0], recorded[1]


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


def _tongue(plan: PlayerPlan) -> Envelopes:
    rows = []
    for event in plan.tongues:
        full_s = event.end_s - TONGUE_HOLD_SHARE * (event.end_s - event.start_s)
        rows.append((event.start_s, full_s, event.end_s, event.end_s + TONGUE_RELEASE_S, 1.0))
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
    mouth_open: Envelopes
    firm: Curve
    eased: Curve
    vibrato: Curve
    exertion: Spline
    expressions: dict[str, Envelopes]

    @classmethod
    def of(cls, asked: Asked, before: tuple[Face, Asked] | None = None) -> Face:
        """From a whole plan, or from what is the same as in the plan ``before``."""
        plan = asked.plan
        events = plan.embouchures
        if before is not None and asked.same(before[1], "embouchures", "traces"):
            face, other = before
            tongues, breaths = (same_events(plan, other.plan, kind) for kind in ("tongues", "breaths"))
            return replace(
                face,
                tongue=face.tongue if tongues else _tongue(plan),
                firm=face.firm if tongues else firmness(plan),
                mouth_open=face.mouth_open if breaths else breath_opening(plan),
                exertion=face.exertion if breaths else exertion_of(plan, asked.motion, asked.lungs),
                expressions=face.expressions if same_events(plan, other.plan, "expressions") else _shown(plan),
            )
        tension, effort, air = _strains(plan, asked.embouchure_tension)
        return cls(
            at_lips=_tracked(events, [1.0] * len(events), FORM_S, 0.0),
            tension=tension,
            effort=effort,
            air=air,
            tongue=_tongue(plan),
            mouth_open=breath_opening(plan),
            firm=firmness(plan),
            eased=easing(plan),
            vibrato=vibrato_size(plan),
            exertion=exertion_of(plan, asked.motion, asked.lungs),
            expressions=_shown(plan),
        )

    def sample(self, times_s: FloatArray) -> Drivers:
        """What moves the face at ascending times."""
        alone = {name: curve for name, curve in vars(self).items() if name not in ("expressions", "exertion")}
        return Drivers(
            **{name: curve.sample(times_s) for name, curve in alone.items()},
            exertion=Exertion(*self.exertion.sample(times_s)),
            expressions={name: envelopes.sample(times_s) for name, envelopes in self.expressions.items()},
        )
