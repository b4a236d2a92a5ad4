"""Curves that go where gestures go."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

import numpy as np

from app.motion.curve import Curve, moves
from app.motion.path import Path
from app.plan.model import GestureEvent, GestureKind

QUICK_S = 0.6
"""Gestures shorter than this are smaller in proportion: no one leans as far in half the time."""


def follow(events: Sequence[GestureEvent], kind: GestureKind, transition_s: float) -> Curve:
    """A value that goes to each gesture's amount within ``transition_s`` of its start, and stays."""
    return moves(_targets(events, kind, transition_s))


def path(events: Sequence[GestureEvent], kind: GestureKind) -> Path:
    """A value that goes to each gesture's amount over the whole gesture, and does not stop at what it passes."""
    return Path.through(_targets(events, kind, None))


def _targets(
    events: Sequence[GestureEvent], kind: GestureKind, transition_s: float | None
) -> list[tuple[float, float, float]]:
    """Where gestures go and when, ``(start_s, end_s, value)``.

    It goes back to 0 where the next gesture is more than its own length (at least a second) away.
    """
    chosen = [event for event in events if event.kind == kind]
    segments: list[tuple[float, float, float]] = []
    for event, following in zip_longest(chosen, chosen[1:]):
        end_s = event.end_s if following is None else min(event.end_s, following.start_s)
        length_s = end_s - event.start_s
        if length_s <= 0.0:
            continue
        move_s = length_s if transition_s is None else min(transition_s, length_s)
        size = min(1.0, move_s / QUICK_S)
        amount = min(max(event.amount * size, -1.0), 1.0)
        segments.append((event.start_s, event.start_s + move_s, amount))
        pause_s = np.inf if following is None else following.start_s - end_s
        if pause_s > max(1.0, length_s):
            segments.append((end_s, end_s + min(max(length_s, 1.0), 2.0, pause_s), 0.0))
    return segments
