"""Air in the trunk: how full it is, and the shapes of ribs and belly that show it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, moves
from app.plan.model import BreathEvent
from metadata.model import BREATH_MORPHS, BreathMotion

LEAD_S = 0.03
"""The trunk is widest this long before a breath ends, as the lungs are full."""
LONGEST_S = 14.0
"""Air lasts no longer."""
SPENT_S = 4.0
"""After so long most of it is gone: what a shorter phrase leaves is in proportion."""
KEPT = 0.15
"""What is left of it when the next breath is drawn."""
FLAT = 0.12
"""Level before the first breath."""
BELLY_LEADS = 0.85
"""The belly widens ahead of the ribs: it is this power of how full the trunk is."""


def air(breaths: Sequence[BreathEvent]) -> Curve:
    """How much air there is, 0..1: up over each breath, down through the whole phrase after it."""
    drawn = sorted((breath for breath in breaths if breath.kind == "breath"), key=lambda breath: breath.start_s)
    rows: list[tuple[float, float, float]] = []
    level = FLAT
    for breath, following in zip_longest(drawn, drawn[1:]):
        start_s = max(breath.start_s, rows[-1][1]) if rows else breath.start_s
        if breath.end_s <= start_s:
            continue
        top_s = max(breath.end_s - LEAD_S, 0.5 * (start_s + breath.end_s))
        level += (1.0 - level) * (0.45 + 0.55 * breath.depth)
        rows.append((start_s, top_s, level))
        until_s = breath.end_s + LONGEST_S
        if following is not None:
            until_s = min(until_s, following.start_s)
        if until_s > breath.end_s:
            level += (KEPT - level) * min(1.0, (until_s - breath.end_s) / SPENT_S)
            rows.append((breath.end_s, until_s, level))
    return moves(rows, FLAT if rows else 0.0)


def widened(level: FloatArray, push: FloatArray | float, breath: BreathMotion, amount: float) -> dict[str, FloatArray]:
    """Weights of the shapes of a trunk with so much air in it, while the belly pushes so hard, 0..1."""
    chest, belly = BREATH_MORPHS
    full = np.clip(amount * level, 0.0, 1.0)
    return {
        chest: breath.chest_share * full,
        belly: breath.belly_share * np.power(full, BELLY_LEADS) * (1.0 - breath.push_share * push),
    }
