"""How far the instrument is off the lips."""

from __future__ import annotations

from collections.abc import Sequence

from app.motion.curves.curve import Curve, moves
from app.plan.model import GestureEvent


def lowering(gestures: Sequence[GestureEvent], lower_s: float, raise_s: float) -> Curve:
    """0 with the instrument at the lips, 1 with it lowered; it is up again when the gesture ends.

    Gestures that overlap are one: the instrument stays down from the first to the last, as low as the lowest of them.
    """
    spans: list[tuple[float, float, float]] = []
    lowerings = (event for event in gestures if event.end_s > event.start_s)
    for event in sorted(lowerings, key=lambda event: event.start_s):
        if spans and event.start_s < spans[-1][1]:
            start_s, end_s, amount = spans[-1]
            spans[-1] = (start_s, max(end_s, event.end_s), max(amount, event.amount))
        else:
            spans.append((event.start_s, event.end_s, event.amount))
    segments: list[tuple[float, float, float]] = []
    for start_s, end_s, amount in spans:
        share = min(1.0, (end_s - start_s) / (lower_s + raise_s))
        segments.append((start_s, start_s + share * lower_s, amount))
        segments.append((end_s - share * raise_s, end_s, 0.0))
    return moves(segments)
