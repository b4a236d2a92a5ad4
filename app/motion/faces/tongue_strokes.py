"""Visible tongue strokes: the tongue rises, touches and leaves at the onset; jaw and lips follow more slowly.

Strokes of the tip (*ta*, soft *da*) and of the back (*ka*) are separate curves, since they move different parts of the
mouth. Stressed attacks also have a push of breath.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.motion.curves.curve import Envelopes
from app.plan.model import Articulation, PlayerPlan, TongueEvent

RISES_S: Final = 0.06
"""Seconds before its contact at which the tongue begins to move to the reed or the teeth."""
FALLS_S: Final = 0.08
"""Seconds after its contact in which the tongue moves back."""
SOFTLY: Final = 1.6
"""Factor for the duration of a soft stroke, which has no clear edge."""
NEAR_SHARE: Final = 0.42
"""Greatest share of the time to the next stroke that the motion before or after a contact takes."""
PUSHED: Final[dict[Articulation, float]] = {"staccato": 0.3, "accent": 0.7, "marcato": 1.0}
"""Strength of the breath's push at an attack, by articulation."""
PUSH_FROM_S: Final = 0.07
"""Seconds before an attack at which the push begins."""
PUSH_UNTIL_S: Final = 0.20
"""Seconds after an attack at which the push ends."""


def tip_strokes(plan: PlayerPlan) -> Envelopes:
    """Return the height of the tongue's tip, 1 in a plain stroke."""
    return _strokes(plan.tongues, by_back=False)


def back_strokes(plan: PlayerPlan) -> Envelopes:
    """Return the height of the tongue's back, smaller than a stroke of the tip."""
    return _strokes(plan.tongues, by_back=True)


def _strokes(tongues: Sequence[TongueEvent], *, by_back: bool) -> Envelopes:
    start_s, end_s, strength = np.array(
        [(event.start_s, event.end_s, event.strength) for event in tongues], np.float64
    ).reshape(-1, 3).T  # fmt: skip
    steps_s = np.diff(end_s, prepend=-np.inf, append=np.inf)
    fall_s = np.array([FALLS_S * (SOFTLY if event.stroke == "da" else 1.0) for event in tongues], np.float64)
    rise_s = np.minimum(RISES_S, np.maximum(NEAR_SHARE * steps_s[:-1] - (end_s - start_s), 0.0))
    fall_s = np.minimum(fall_s, NEAR_SHARE * steps_s[1:])
    rows = np.stack((start_s - rise_s, start_s + 0.5 * (end_s - start_s), end_s, end_s + fall_s, strength), axis=1)
    return Envelopes.of(rows[np.array([(event.stroke == "ka") == by_back for event in tongues], np.bool_)])


def attack_pushes(plan: PlayerPlan) -> Envelopes:
    """Return the strength of breath pushes, 0..1, at short or stressed attacks."""
    rows = []
    for event in plan.tongues:
        hard = PUSHED.get(event.articulation, 0.0)
        if hard:
            at_s = event.end_s
            rows.append((at_s - PUSH_FROM_S, at_s, at_s + 0.25 * PUSH_UNTIL_S, at_s + PUSH_UNTIL_S, hard))
    return Envelopes.of(rows)
