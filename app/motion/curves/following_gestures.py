"""Curves that follow the amounts of gestures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, moves_to
from app.motion.curves.path import Path
from app.plan.model import GestureEvent

QUICK_S = 0.6
"""Length in seconds below which gestures are smaller in proportion."""


def follow(events: Sequence[GestureEvent], transition_s: float) -> Curve:
    """A curve that moves to each gesture's amount within ``transition_s`` of its start and stays."""
    return moves_to(*_targets(events, transition_s).T)


def path(events: Sequence[GestureEvent]) -> Path:
    """A curve that moves to each gesture's amount over the whole gesture, without stopping at values it passes."""
    return Path.through(_targets(events, None))


def _targets(events: Sequence[GestureEvent], transition_s: float | None) -> FloatArray:
    """Compute the moves to the amounts of gestures, as rows (S, 3) of ``start_s``, ``end_s`` and value.

    Returns to 0 if the next gesture is farther away than its own length (at least a second).
    """
    rows = [(event.start_s, event.end_s, event.amount) for event in events]
    start_s, end_s, amount = np.array(rows, np.float64).reshape(-1, 3).T
    next_s = np.append(start_s[1:], np.inf)[: len(start_s)]
    end_s = np.minimum(end_s, next_s)
    length_s = end_s - start_s
    move_s = length_s if transition_s is None else np.minimum(transition_s, length_s)
    amount = np.clip(amount * np.minimum(1.0, move_s / QUICK_S), -1.0, 1.0)
    pause_s = next_s - end_s
    back_s = np.minimum(np.clip(length_s, 1.0, 2.0), pause_s)
    table = np.empty((len(rows), 2, 3))
    table[:, 0] = np.stack((start_s, start_s + move_s, amount), axis=1)
    table[:, 1] = np.stack((end_s, end_s + back_s, np.zeros(len(rows))), axis=1)
    lasts = length_s > 0.0
    goes_back = lasts & (pause_s > np.maximum(1.0, length_s))
    targets: FloatArray = table[np.stack((lasts, goes_back), axis=1)]
    return targets
