"""The breath of a player who rests: small and slow, in and out, while the instrument is lowered for long."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from app.chance import chance
from app.motion.curves.curve import Curve, moves
from app.plan.model import GestureEvent

LEAST_S: Final = 6.0
"""In a shorter time nothing of it is seen."""
FROM_S, UNTIL_S = 1.8, 1.6
"""It begins so long after the instrument goes down, and ends so long before it is up again."""
WAYS = ((1.3, 1.8), (1.6, 2.3), (0.3, 1.1), (0.6, 1.0))
"""Bounds of the seconds in, out and of the pause, and of the depth."""
MOST: Final = 60
"""No rest has more of them, however long it is."""


def quiet_breaths(gestures: Sequence[GestureEvent]) -> Curve:
    """How much of a quiet breath is in, 0..1, from a player's gestures."""
    rows: list[tuple[float, float, float]] = []
    free_s = -float("inf")
    for event in sorted(gestures, key=lambda event: event.start_s):
        if event.kind != "lower_instrument" or event.end_s - event.start_s < LEAST_S:
            continue
        at_s = max(event.start_s + FROM_S, free_s)
        for number in range(MOST):
            place = ("quiet breath", event.id, round(1000.0 * event.start_s), number)
            in_s, out_s, pause_s, deep = (
                low + (high - low) * chance(*place, index) for index, (low, high) in enumerate(WAYS)
            )
            if at_s + in_s + out_s > event.end_s - UNTIL_S:
                break
            rows += [(at_s, at_s + in_s, deep), (at_s + in_s, at_s + in_s + out_s, 0.0)]
            at_s += in_s + out_s + pause_s
        free_s = at_s
    return moves(rows)
