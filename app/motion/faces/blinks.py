"""Blinks: at phrase ends, in breaths and rests, rarely within a phrase, never in a fast run or on an entry (people
blink about 17 times a minute at rest, and much less in a visual task: Bentivoglio et al. 1997).

Random values depend on places in time, so an edit only changes nearby blinks.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Envelopes
from app.motion.curves.seeded_chance import generator
from app.motion.faces.silences import Silences, holds, overlaps
from app.plan.model import PlayerPlan
from app.plan.styles import share_at

BLINK_DOWN_S, BLINK_SHUT_S, BLINK_UP_S = 0.08, 0.03, 0.16
BLINK_S = BLINK_DOWN_S + BLINK_SHUT_S + BLINK_UP_S
ENTRY_GUARD_S = 0.20
SLOT_S: Final = 1.3
"""Length in seconds of the periods in which there is at most one blink, besides those at the ends of phrases."""
AT_BREATH, IN_REST, IN_PHRASE = 0.8, 0.40, 0.14
"""Probabilities of a blink at a breath, in a rest and in a phrase."""
BREATH_LEAD_S, BREATH_SPREAD_S = 0.06, 0.14
"""Seconds before a breath at which a phrase's blink begins, and the range by which it may be later."""
APART_S: Final = 1.1
"""Seconds that other blinks keep away from a phrase's blink."""
LAG_S = (0.004, 0.014)
"""Range in seconds of the delay of one eye; which eye depends on the player."""
LEAST_SHUT = (0.90, 0.98)
"""Range of the greatest closure of the delayed eye."""
HALF = (0.15, 0.55)
"""Probability of a half blink, and its closure."""


def blinks_of(plan: PlayerPlan, silences: Silences, seed: int, amount: float) -> tuple[Envelopes, Envelopes]:
    """Return the closure of the left and of the right lids over a performance; ``amount`` is the frequency of blinks, 1
    is usual."""
    random = generator(plan.player_id, seed, "blink")
    lag_s, shut = float(random.uniform(*LAG_S)), float(random.uniform(*LEAST_SHUT))
    left_late = bool(random.random() < 0.5)
    table = random.random((4096, 3))
    starts_s, heights = _starts(plan, silences, table, amount, random)
    first, second = _closing(starts_s, heights), _closing(starts_s + lag_s, shut * heights)
    return (second, first) if left_late else (first, second)


def _closing(starts_s: FloatArray, heights: FloatArray) -> Envelopes:
    shut_s = starts_s + BLINK_DOWN_S
    return Envelopes(starts_s, shut_s, shut_s + BLINK_SHUT_S, starts_s + BLINK_S, heights)


def _starts(
    plan: PlayerPlan, silences: Silences, table: FloatArray, amount: float, random: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Return the times (K,) at which the eyelids begin to blink, and the closure (K,) of each blink 0..1."""
    frame = plan.time_frame
    breaths_s = silences.breaths_s
    # Chances depend on the position in the score, so that editing a breath changes only its own.
    ticks = np.array([event.start_tick for event in plan.breaths if event.draws_air], dtype=np.int64)
    drawn = table[(ticks * 2654435761 >> 7) % len(table)]
    phrase_s = breaths_s[:, 0] - BREATH_LEAD_S + BREATH_SPREAD_S * drawn[:, 0]
    phrase_s = np.minimum(phrase_s, breaths_s[:, 1] - BLINK_S - 0.02)
    often = drawn[:, 1] < AT_BREATH * amount * share_at(plan.styles, "blink", phrase_s)
    phrase_s, drawn = phrase_s[often], drawn[often]
    slots = int(np.ceil((frame.end_s - frame.first_frame_s) / SLOT_S))
    chances = random.random((slots, 3))
    other_s = frame.first_frame_s + (np.arange(slots) + 0.2 + 0.6 * chances[:, 0]) * SLOT_S
    likely = np.where(holds(silences.rests_s, other_s), IN_REST, IN_PHRASE)
    apart = ~overlaps(np.stack((phrase_s - APART_S, phrase_s + APART_S), axis=1), other_s, other_s)
    kept = (chances[:, 1] < likely * amount * share_at(plan.styles, "blink", other_s)) & apart
    starts_s = np.concatenate((phrase_s, other_s[kept]))
    depth = np.concatenate((drawn[:, 2], chances[kept, 2]))
    order = np.argsort(starts_s, kind="stable")
    starts_s, depth = starts_s[order], depth[order]
    entries_s = silences.entries_s
    guarded = np.stack((entries_s - ENTRY_GUARD_S, entries_s + ENTRY_GUARD_S), axis=1)
    ends_s = starts_s + BLINK_S + LAG_S[1]
    free = ~overlaps(guarded, starts_s, ends_s) & ~overlaps(silences.quick_s, starts_s, ends_s)
    free &= starts_s >= frame.first_frame_s
    return starts_s[free], np.where(depth[free] < HALF[0], HALF[1], 1.0)
