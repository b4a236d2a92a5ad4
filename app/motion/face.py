"""Morph weights of the face (ARKit's 52 names) from the plan: embouchure, breath, tongue, effort, expression, lids.

Every morph is a sum of drivers, each a curve 0..1 of time, with weights from `metadata`, clipped to 0..1. The jaw also
opens as far as lips need that close around something, or blow through an opening: that is solved from how the
character's own morphs move its lips.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.motion.curve import Curve, Envelopes, FloatArray, Trace, moves, moves_to
from app.plan.model import EmbouchureEvent, PlayerPlan, same_events
from app.rig.hold import Lips
from metadata.model import Embouchure, Expression

FORM_S = 0.16
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

LIDS = ("eyeBlinkLeft", "eyeBlinkRight")
AROUND_FROM, AROUND_BY = 0.32, 0.06
"""Lowered by less than this, the lips begin to part for what goes between them; by less than that they have."""
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
    expressions: dict[str, FloatArray]


@dataclass(frozen=True)
class Face:
    """What one player's plan asks of the face, as curves of time.

    Attributes
    ----------
    at_lips : Curve
        1 while the lips are formed.
    expressions : dict of str to Envelopes
        By name.
    """

    at_lips: Curve
    tension: Curve | Trace
    effort: Curve | Trace
    air: Curve | Trace
    tongue: Envelopes
    mouth_open: Envelopes
    expressions: dict[str, Envelopes]

    @classmethod
    def of(
        cls, plan: PlayerPlan, embouchure_tension: float, before: tuple[Face, PlayerPlan, float] | None = None
    ) -> Face:
        """From a whole plan, or from what is the same as in the plan ``before``. ``embouchure_tension`` scales the
        tension; 1 is as planned."""
        events = plan.embouchures
        embouchures = ("embouchures", "traces")
        if before is not None and before[2] == embouchure_tension and same_events(plan, before[1], *embouchures):
            face, other, _ = before
            return replace(
                face,
                tongue=face.tongue if same_events(plan, other, "tongues") else _tongue(plan),
                mouth_open=face.mouth_open if same_events(plan, other, "breaths") else breath_opening(plan),
                expressions=face.expressions if same_events(plan, other, "expressions") else _shown(plan),
            )
        tension, effort, air = _strains(plan, embouchure_tension)
        return cls(
            at_lips=_tracked(events, [1.0] * len(events), FORM_S, 0.0),
            tension=tension,
            effort=effort,
            air=air,
            tongue=_tongue(plan),
            mouth_open=breath_opening(plan),
            expressions=_shown(plan),
        )

    def sample(self, times_s: FloatArray) -> Drivers:
        """What moves the face at ascending times."""
        driven = vars(self).items()
        return Drivers(
            **{name: curve.sample(times_s) for name, curve in driven if name != "expressions"},
            expressions={name: envelopes.sample(times_s) for name, envelopes in self.expressions.items()},
        )


def face_morphs(
    face: Drivers,
    embouchure: Embouchure,
    lips: Lips,
    expressions: Mapping[str, Expression],
    blinks: FloatArray,
    lowered: FloatArray,
) -> dict[str, FloatArray]:
    """Weights 0..1 of every morph that moves, each (F,) float64.

    Parameters
    ----------
    embouchure : Embouchure
        Weights of the instrument's kind of embouchure.
    lips : Lips
        Of the character, with the instrument.
    expressions : mapping of str to Expression
        All that ``face`` names.
    blinks : (F,) float64
        Lids: 1 is closed.
    lowered : (F,) float64
        0 with the instrument at the lips, 1 with it lowered.
    """
    inhaling, at_lips, tension = face.mouth_open, face.at_lips, face.tension
    formed = at_lips * (1.0 - 0.9 * inhaling)
    around = formed
    if lips.apart_m > 0.0:
        # What is between the lips stays between them in a rest, as long as it is not lowered.
        share = np.clip((AROUND_FROM - lowered) / (AROUND_FROM - AROUND_BY), 0.0, 1.0)
        around = share * share * (3.0 - 2.0 * share)
    resting = np.maximum(around - at_lips, 0.0) * (1.0 - 0.9 * inhaling)
    drivers: list[tuple[FloatArray, Mapping[str, float]]] = [
        (formed * (1.0 - tension) + resting, embouchure.relaxed),
        (formed * tension, embouchure.tight),
        (formed * face.air, embouchure.air),
        (formed * face.effort, embouchure.effort),
        (face.tongue, embouchure.tongue_stroke),
        (inhaling, embouchure.inhale),
    ]
    for name, shown in face.expressions.items():
        expression = expressions[name]
        drivers.append((shown if expression.while_playing else shown * (1.0 - at_lips), expression.weights))
    drivers.append((blinks, dict.fromkeys(LIDS, 1.0)))
    morphs = _mixed(drivers)
    if lips.jaw:
        _part_lips(morphs, lips, around, formed)
    return morphs


def usual_morphs(embouchure: Embouchure, lips: Lips) -> dict[str, float]:
    """The face of a middling tension, with the jaw as it closes the lips around what lies between them."""
    morphs = {name: np.array([weight]) for name, weight in embouchure.usual.items()}
    one = np.ones(1)
    if lips.jaw:
        _part_lips(morphs, lips, one, one)
    return {name: float(values[0]) for name, values in morphs.items()}


def _part_lips(morphs: dict[str, FloatArray], lips: Lips, around: FloatArray, formed: FloatArray) -> None:
    """Open the jaw until the lips are as far apart as they must be, and by what it opens for a breath beyond that."""
    needed = lips.jaw_for(lips.apart_m + lips.opening_m * formed, morphs, len(around))
    beyond = morphs.get(lips.jaw, np.zeros(len(around)))
    morphs[lips.jaw] = np.clip(around * needed + beyond, 0.0, 1.0)


def _mixed(drivers: Sequence[tuple[FloatArray, Mapping[str, float]]]) -> dict[str, FloatArray]:
    morphs: dict[str, FloatArray] = {}
    for driver, weights in drivers:
        for name, weight in weights.items():
            if weight != 0.0:
                morphs[name] = morphs.get(name, 0.0) + weight * driver
    for values in morphs.values():
        np.clip(values, 0.0, 1.0, out=values)
    return morphs
