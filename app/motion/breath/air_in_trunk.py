"""Breathing of the trunk: fullness of lungs while playing and in rests, and morph weights of ribs and belly."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.chance import chance
from app.motion.curves.curve import Curve, moves
from app.plan.model import BreathEvent, GestureEvent
from metadata.model import BREATH_MORPHS, BreathMotion

LEAD_S = 0.03
"""Seconds before the end of a breath at which the trunk is widest."""
LONGEST_S = 14.0
"""Longest time in seconds for which air decreases."""
SPENT_S = 4.0
"""Seconds of playing after which most of the air is used; shorter phrases use a proportional amount."""
KEPT = 0.15
"""Share of the air that is left when the next breath begins."""
FLAT = 0.12
"""Filling of the lungs before the first breath."""
BELLY_LEADS = 0.85
"""Exponent applied to the filling of the trunk for the belly, which thus widens earlier than the ribs."""


EXHALE_S = 3.0
FULLEST = 1.4
LEAST_DRAWN = 0.4
"""Least increase in filling for each breath, so that every breath is visible even if breaths follow each other quickly
or the bell sinks.
"""
BREATH_LEAD_S = 0.03
"""Seconds before the end of a breath at which inhalation is complete."""
RESTS_S: Final = 6.0
"""Length in seconds of a rest below which no quiet breathing is shown."""
QUIET_FROM_S, QUIET_UNTIL_S = 1.8, 1.6
"""Seconds after the instrument is lowered at which quiet breathing begins, and before it is raised at which it ends."""
QUIET_WAYS = ((1.3, 1.8), (1.6, 2.3), (0.3, 1.1), (0.6, 1.0))
"""Ranges of a quiet breath: seconds of inhaling, of exhaling and of the pause, and the depth."""
MOST_QUIET: Final = 60
"""Greatest number of quiet breaths in a rest."""


class LungCurves(NamedTuple):
    """Two curves of breathing, both 0..1: the fullness of the lungs, and the backward lean of the preparatory motion
    before an entry.
    """

    full: Curve
    leaning: Curve


def lungs(breaths: Sequence[BreathEvent]) -> LungCurves:
    """Return two curves, both 0..1: the fullness of the lungs (rising over each breath, falling over the phrase), and
    the backward lean of the preparatory motion.
    """
    full: list[tuple[float, float, float]] = []
    lean: list[tuple[float, float, float]] = []
    level = 0.0
    drawn = sorted((breath for breath in breaths if breath.draws_air), key=lambda breath: breath.start_s)
    for breath, following in zip_longest(drawn, drawn[1:]):
        # Breaths that overlap after editing: the later one begins when the earlier one is full.
        start_s = max(breath.start_s, full[-1][1]) if full else breath.start_s
        if breath.end_s <= start_s:
            continue
        top_s = max(breath.end_s - BREATH_LEAD_S, 0.5 * (start_s + breath.end_s))
        rise = 0.5 + 0.5 * breath.depth
        level = min(FULLEST, level + rise)
        full.append((start_s, top_s, level))
        until_s = breath.end_s + EXHALE_S if following is None else min(breath.end_s + EXHALE_S, following.start_s)
        if until_s > breath.end_s:
            level = min(level * (1.0 - min(1.0, (until_s - breath.end_s) / 1.5)), FULLEST - LEAST_DRAWN)
            full.append((breath.end_s, until_s, level))
    free_s = -np.inf
    for breath in breaths:
        if not breath.draws_air and breath.end_s > max(breath.start_s, free_s):
            start_s = max(breath.start_s, free_s)
            free_s = breath.end_s + 0.6 * (breath.end_s - start_s)
            lean += [(start_s, breath.end_s, 1.0), (breath.end_s, free_s, 0.0)]
    return LungCurves(moves(full), moves(lean))


def air(breaths: Sequence[BreathEvent]) -> Curve:
    """Return the amount of air in the lungs, 0..1, over time: rising in each breath, falling through the whole
    following phrase.
    """
    drawn = sorted((breath for breath in breaths if breath.draws_air), key=lambda breath: breath.start_s)
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
    """Weights (F,), by name, of the morphs that widen chest and belly, from the lungs' ``level`` and the ``push`` of
    the belly, 0..1."""
    chest, belly = BREATH_MORPHS
    full = np.clip(amount * level, 0.0, 1.0)
    return {
        chest: breath.chest_share * full,
        belly: breath.belly_share * np.power(full, BELLY_LEADS) * (1.0 - breath.push_share * push),
    }


def quiet_breaths(gestures: Sequence[GestureEvent]) -> Curve:
    """Return the small and slow breathing, 0..1, of a player who keeps the instrument lowered for a long time."""
    rows: list[tuple[float, float, float]] = []
    free_s = -float("inf")
    for event in sorted(gestures, key=lambda event: event.start_s):
        if event.part != "lowering" or event.end_s - event.start_s < RESTS_S:
            continue
        at_s = max(event.start_s + QUIET_FROM_S, free_s)
        for number in range(MOST_QUIET):
            place = ("quiet breath", event.id, round(1000.0 * event.start_s), number)
            in_s, out_s, pause_s, deep = (
                low + (high - low) * chance(*place, index) for index, (low, high) in enumerate(QUIET_WAYS)
            )
            if at_s + in_s + out_s > event.end_s - QUIET_UNTIL_S:
                break
            rows += [(at_s, at_s + in_s, deep), (at_s + in_s, at_s + in_s + out_s, 0.0)]
            at_s += in_s + out_s + pause_s
        free_s = at_s
    return moves(rows)
