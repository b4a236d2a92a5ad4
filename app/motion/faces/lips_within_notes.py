"""Lip motion within notes: firming before an attack, settling after it, release between notes, and vibrato on held
notes.

Lip muscles are active before a tone begins (trumpeters: Heuser and McNitt-Gray 1991).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, moves, moves_to
from app.plan.model import PlayerPlan

PREPARES_S: Final = 0.14
SETTLES_S: Final = 0.22
PREPARES_SHARE: Final = 0.35
"""Share of the previous note after which the preparation begins, in quick notes."""
SLURRED: Final = 0.35
"""Size of a slurred note's motion relative to an attack's."""
WHOLE_S: Final = 0.45
"""Length in seconds of a note with a full attack; shorter notes have a smaller one."""
RESTED_S, RESTED = 0.5, 1.4
"""Length in seconds of a rest after which an attack is stronger, and the factor."""
EASES_S, BACK_S = 0.30, 0.16
"""Seconds in which the tension decreases in a gap, and returns after it."""
EASED: Final = 0.7
GAP_S: Final = 0.12
"""Length in seconds of a gap below which the tension does not decrease."""
VIBRATO_FROM_S: Final = 0.6
"""Length in seconds of a note from which vibrato begins."""
VIBRATO_WHOLE_S: Final = 1.6
"""Length in seconds of a note with full vibrato."""
VIBRATO_AFTER_S, VIBRATO_IN_S, VIBRATO_OUT_S = 0.28, 0.75, 0.12
"""Seconds after the onset at which vibrato begins, of its fade-in, and before the end at which it stops."""


def _notes(plan: PlayerPlan) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return onsets, ends (seconds) and loudness 0..1 (N,) of the notes with a length, in order."""
    events = plan.embouchures
    starts_s = np.array([event.start_s for event in events])
    ends_s = np.minimum(np.array([event.end_s for event in events]), np.append(starts_s[1:], np.inf))
    air = np.array([event.air for event in events])
    lasting = (ends_s - starts_s > 1e-3) & (np.append(starts_s[1:], np.inf) - starts_s > 1e-3)
    return starts_s[lasting], ends_s[lasting], air[lasting]


def firmness(plan: PlayerPlan) -> Curve:
    """Return the firmness of the lips over time: rising before each attack, less before a slur, and falling
    soon after.
    """
    if not plan.embouchures:
        return moves(())
    starts_s, ends_s, air = _notes(plan)
    tongued_s = np.array([event.end_s for event in plan.tongues])
    near = np.searchsorted(tongued_s, starts_s - 1e-3)
    tongued = (near < len(tongued_s)) & (np.append(tongued_s, np.inf)[near] < starts_s + 1e-3)
    strokes = np.append([event.strength for event in plan.tongues], 0.0)[near]
    before_s = np.append(starts_s[:1] - 1.0, starts_s[:-1])
    from_s = np.maximum(starts_s - PREPARES_S, before_s + PREPARES_SHARE * (starts_s - before_s))
    until_s = np.minimum(starts_s + SETTLES_S, np.append(from_s[1:], np.inf))
    size = np.where(tongued, strokes, SLURRED) * (0.55 + 0.45 * air) * np.minimum((ends_s - starts_s) / WHOLE_S, 1.0)
    rested = starts_s - np.append(-np.inf, ends_s[:-1]) > RESTED_S
    size = np.minimum(np.where(rested, RESTED * size, size), 1.0)
    rows = np.empty((len(starts_s), 2, 3))
    rows[:, 0] = np.stack((from_s, starts_s, size), axis=1)
    rows[:, 1] = np.stack((starts_s, until_s, np.zeros(len(starts_s))), axis=1)
    table = rows.reshape(-1, 3)
    return moves_to(table[:, 0], table[:, 1], table[:, 2])


def tension_release(plan: PlayerPlan) -> Curve:
    """Return the release of lip tension between notes and after the last one."""
    starts_s, ends_s, _ = _notes(plan)
    # All notes may be too short.
    if not len(starts_s):
        return moves((), EASED)
    next_s = np.append(starts_s[1:], np.inf)
    gaps = next_s - ends_s > GAP_S
    from_s, to_s = ends_s[gaps], next_s[gaps]
    half_s = 0.5 * (to_s - from_s)
    eased_s = from_s + np.minimum(EASES_S, half_s)
    back_s = np.maximum(to_s - BACK_S, eased_s)
    depth = EASED * np.minimum(half_s / EASES_S, 1.0)
    rows = np.empty((len(from_s), 2, 3))
    rows[:, 0] = np.stack((from_s, eased_s, depth), axis=1)
    rows[:, 1] = np.stack((back_s, to_s, np.zeros(len(from_s))), axis=1)
    table = np.concatenate(([[starts_s[0] - BACK_S, starts_s[0], 0.0]], rows.reshape(-1, 3)))
    table = table[np.isfinite(table[:, 1])]
    return moves_to(table[:, 0], table[:, 1], table[:, 2], EASED)


def vibrato_size(plan: PlayerPlan) -> Curve:
    """Return the amount of vibrato, 0..1; none with recorded lips, which contain their own."""
    if not plan.embouchures or plan.has_recorded_lips:
        return moves(())
    starts_s, ends_s, air = _notes(plan)
    length_s = ends_s - starts_s
    long = length_s > VIBRATO_FROM_S
    starts_s, ends_s, length_s, air = starts_s[long], ends_s[long], length_s[long], air[long]
    share = np.clip((length_s - 0.5 * VIBRATO_FROM_S) / (VIBRATO_WHOLE_S - 0.5 * VIBRATO_FROM_S), 0.0, 1.0)
    full_s = np.minimum(starts_s + VIBRATO_AFTER_S + VIBRATO_IN_S, ends_s - VIBRATO_OUT_S)
    rows = np.empty((len(starts_s), 2, 3))
    rows[:, 0] = np.stack((starts_s + VIBRATO_AFTER_S, full_s, share * (0.7 + 0.3 * air)), axis=1)
    rows[:, 1] = np.stack((ends_s - VIBRATO_OUT_S, ends_s, np.zeros(len(starts_s))), axis=1)
    table = rows.reshape(-1, 3)
    return moves_to(table[:, 0], table[:, 1], table[:, 2])
