"""Morph weights of the face (ARKit's 52 names) from the plan: embouchure, breath, tongue, effort, expression, lids.

Every morph is a sum of drivers, each a curve 0..1 of time, with the weights of the tables below, clipped to 0..1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.motion.curve import Curve, Envelopes, FloatArray, moves
from app.motion.gaze import Gaze
from app.plan.model import EmbouchureEvent, PlayerPlan

FORM_S = 0.16
"""The lips form in this time before the first note of a phrase, and let go as slowly after its last."""
SHIFT_S = 0.09
"""From one note's tension to the next."""
SHIFT_SHARE = 0.45
HOLD_S = 0.8
"""In rests shorter than this the lips stay formed (but for a breath)."""
TONGUE_RELEASE_S = 0.05
EFFORT_S = 0.35
"""Effort and air swell and fade slowly, over several notes."""

Weights = Mapping[str, float]


def _both(**weights: float) -> dict[str, float]:
    return {f"{name}{side}": weight for name, weight in weights.items() for side in ("Left", "Right")}


FORMED: Weights = {"mouthClose": 0.02, "mouthPucker": 0.16, "mouthRollLower": 0.12, "mouthRollUpper": 0.10} | _both(
    mouthPress=0.25, mouthDimple=0.12
)
"""Lips of a buzzing player at no tension: together, corners firm."""
TENSE: Weights = {"mouthPucker": -0.12, "mouthRollLower": 0.12, "mouthShrugLower": 0.10} | _both(
    mouthPress=0.40, mouthStretch=0.30, mouthDimple=0.22, cheekSquint=0.12
)
"""What full tension (the highest notes) adds: drawn tight. See T5."""
SLACK: Weights = {"mouthPucker": 0.10, "mouthFunnel": 0.06, "jawOpen": 0.035}
"""What no tension (the lowest notes) adds: relaxed, the jaw lower."""
EFFORT: Weights = {"browInnerUp": 0.10} | _both(browDown=0.32, eyeSquint=0.50, cheekSquint=0.30, noseSneer=0.12)
AIR: Weights = {"cheekPuff": 0.12}
INHALING: Weights = {"jawOpen": 0.46, "mouthFunnel": 0.10, "mouthShrugUpper": -0.05, "browInnerUp": 0.10} | _both(
    mouthStretch=0.22, mouthLowerDown=0.16, noseSneer=0.14, mouthDimple=0.10
)
"""The mouth opens by the jaw and at the corners while the upper lip stays where it is."""
TONGUE: Weights = {"tongueOut": 0.06, "jawOpen": 0.012}
LIDS: Weights = _both(eyeBlink=1.0)


def _tracked(
    events: Sequence[EmbouchureEvent], values: Sequence[float], shift_s: float, rest_value: float | None
) -> Curve:
    """A value that is reached at each onset, held, and (``rest_value``) left in rests longer than `HOLD_S`."""
    segments: list[tuple[float, float, float]] = []
    value, free_s, last_s = rest_value or 0.0, -np.inf, -np.inf
    for event, target in zip(events, values, strict=True):
        onset_s = event.start_s
        gap_s = onset_s - last_s
        if rest_value is not None and np.isfinite(last_s) and gap_s > HOLD_S:
            free_s = last_s + min(2.0 * FORM_S, gap_s / 2.0)
            if value != rest_value:
                segments.append((last_s, free_s, rest_value))
            value = rest_value
        start_s = max(onset_s - shift_s, free_s)
        if target != value:
            segments.append((start_s, onset_s, target))
            value = target
        end_s = max(event.end_s, onset_s)
        free_s = max(onset_s, end_s - SHIFT_SHARE * (end_s - onset_s))
        last_s = end_s
    if rest_value is not None and value != rest_value:
        segments.append((last_s, last_s + 2.0 * FORM_S, rest_value))
    return moves(segments, rest_value or 0.0)


def breath_opening(plan: PlayerPlan) -> Envelopes:
    """How far the mouth is open for air: up through a breath's first part, shut again at its end."""
    rows = []
    for breath in plan.breaths:
        if breath.kind != "breath":
            continue
        length_s = breath.end_s - breath.start_s
        shut_s = min(0.35 * length_s, 0.22)
        open_s = min(0.40 * length_s, 0.45)
        height = 0.60 + 0.40 * breath.depth
        rows.append((breath.start_s, breath.start_s + open_s, breath.end_s - shut_s, breath.end_s, height))
    return Envelopes.of(rows)


def _tongue(plan: PlayerPlan) -> Envelopes:
    return Envelopes.of(
        [(e.start_s, e.end_s - 0.3 * (e.end_s - e.start_s), e.end_s, e.end_s + TONGUE_RELEASE_S, 1.0) for e in plan.tongues]
    )


def _expressions(plan: PlayerPlan) -> dict[str, Envelopes]:
    rows: dict[str, list[tuple[float, float, float, float, float]]] = {}
    for event in plan.expressions:
        rows.setdefault(event.expression, []).append(
            (event.start_s, event.start_s + event.fade_in_s, event.end_s - event.fade_out_s, event.end_s, event.strength)
        )
    return {name: Envelopes.of(spans) for name, spans in rows.items()}


def face_morphs(
    plan: PlayerPlan,
    gaze: Gaze,
    expressions: Mapping[str, Weights],
    embouchure_tension: float,
    times_s: FloatArray,
) -> dict[str, FloatArray]:
    """Weights 0..1 of every morph that moves, each (F,) float64.

    Parameters
    ----------
    plan : PlayerPlan
    gaze : Gaze
        For the lids.
    expressions : mapping
        Morph weights of each expression the plan names.
    embouchure_tension : float
        Scales tension; 1 is as planned.
    times_s : (F,) float64
        Ascending.
    """
    events = plan.embouchures
    tension_values = [min(1.0, embouchure_tension * event.tension) for event in events]
    inhaling = breath_opening(plan).sample(times_s)
    formed = _tracked(events, [1.0] * len(events), FORM_S, 0.0).sample(times_s) * (1.0 - 0.85 * inhaling)
    tension = _tracked(events, tension_values, SHIFT_S, None).sample(times_s)
    drivers: list[tuple[FloatArray, Weights]] = [
        (formed, FORMED),
        (formed * tension, TENSE),
        (formed * (1.0 - tension), SLACK),
        (_tracked(events, [event.effort for event in events], EFFORT_S, 0.0).sample(times_s), EFFORT),
        (_tracked(events, [event.air for event in events], EFFORT_S, 0.0).sample(times_s) * formed, AIR),
        (inhaling, INHALING),
        (_tongue(plan).sample(times_s), TONGUE),
    ]
    for name, envelopes in _expressions(plan).items():
        drivers.append((envelopes.sample(times_s), expressions[name]))
    drivers.append((gaze.blinks.sample(times_s), LIDS))
    return _mixed(drivers)


def _mixed(drivers: Sequence[tuple[FloatArray, Weights]]) -> dict[str, FloatArray]:
    morphs: dict[str, FloatArray] = {}
    for driver, weights in drivers:
        for name, weight in weights.items():
            if weight == 0.0:
                continue
            if name in morphs:
                morphs[name] += weight * driver
            else:
                morphs[name] = weight * driver
    for weight_curve in morphs.values():
        np.clip(weight_curve, 0.0, 1.0, out=weight_curve)
    return morphs
