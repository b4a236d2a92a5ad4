"""Faces: neutral beneath, above it what the rules show (`app.plan.rules`, `app.plan.faces.expressions_at_moments`).
What a name looks like is in ``metadata/expressions``.

Messages: ``expression.default``.
"""

from __future__ import annotations

from app.errors import Message
from app.plan.model import ExpressionEvent, TimeFrame
from app.plan.rules import in_order
from app.score.tempo import TempoMap
from metadata.model import Expression

SMILE_ID = "expression:smile"
"""The smile after the last note, which corrections name."""


def neutral_face(clock: TempoMap, frame: TimeFrame, face: Expression) -> ExpressionEvent:
    """The face beneath all others, as long as the performance."""
    return ExpressionEvent(
        id="expression:neutral",
        expression=face.name,
        start_tick=round(clock.ticks(frame.first_frame_s)),
        end_tick=round(clock.ticks(frame.end_s)),
        start_s=frame.first_frame_s,
        end_s=frame.end_s,
        strength=1.0,
        fade_in_s=face.fade_in_s,
        fade_out_s=face.fade_out_s,
        reason=Message("expression.default"),
    )


def all_shown(
    neutral: ExpressionEvent, at_moments: tuple[ExpressionEvent, ...], at_notes: tuple[ExpressionEvent, ...]
) -> tuple[ExpressionEvent, ...]:
    """All expressions of one player, ordered by start."""
    return tuple(sorted((neutral, *at_moments, *at_notes), key=in_order))
