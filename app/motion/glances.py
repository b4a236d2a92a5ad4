"""Glances at somebody among the fixations of a player's eyes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from app.plan.model import GlanceEvent

Fixation: TypeAlias = tuple[float, float, float, float]
"""When it begins, yaw and pitch in radians, and how much of it the head follows."""


def with_glances(
    fixations: Sequence[Fixation], glances: Sequence[GlanceEvent], apart_s: float, head_turns: float
) -> list[Fixation]:
    """Fixations with the glances among them: what begins during a glance is not seen, after it the eyes go back.

    Parameters
    ----------
    fixations, glances
        Each in order.
    apart_s : float
        No two begin nearer to each other.
    head_turns : float
        How much of what a fixation lets the head follow the head turns.
    """
    if not glances:
        return list(fixations)
    rows: list[Fixation] = []
    base = iter([*fixations, (float("inf"), 0.0, 0.0, 0.0)])
    resting = following = next(base)
    for index, glance in enumerate(glances):
        while following[0] < glance.start_s - apart_s:
            rows.append(following)
            resting, following = following, next(base)
        rows.append((glance.start_s, glance.yaw_rad, glance.pitch_rad, glance.head_share / head_turns))
        while following[0] < glance.end_s + apart_s:
            resting, following = following, next(base)
        if index + 1 == len(glances) or glances[index + 1].start_s >= glance.end_s + apart_s:
            rows.append((glance.end_s, *resting[1:]))
    while following[0] < float("inf"):
        rows.append(following)
        following = next(base)
    return rows
