"""Depths of breaths, and problems where the air does not last."""

from __future__ import annotations

from bisect import bisect_right

import msgspec
import numpy as np

from app.arrays import FloatArray, IntArray
from app.errors import Message
from app.plan.breath.lungs import drawn_share, levels
from app.plan.event_id import EventId
from app.plan.model import BreathEvent, Problem
from app.plan.music.piece import EPSILON, LineTimes
from app.score.model import Note

LEAST_DEPTH = 0.3


def with_depths(
    events: tuple[BreathEvent, ...], used: FloatArray, lung_s: float, refill: FloatArray, index_of: dict[str, int]
) -> tuple[BreathEvent, ...]:
    """Set the depth of each breath to what the phrase after it needs, limited by the time available for the breath;
    depths set by hand stay. ``index_of`` maps note ids to indices.
    """
    breaths, used_s = [*np.flatnonzero(refill > 0.0).tolist(), len(refill)], used.tolist()
    result = []
    for event in events:
        if not event.corrected:
            index = index_of[EventId.parse(event.id).of]
            until = breaths[bisect_right(breaths, index)]
            # The air needed for the rest of a note is unknown within it, so its duration is used.
            need = 1.0 if event.is_within else (used_s[until] - used_s[index]) / lung_s
            most = drawn_share(event.end_s - event.start_s) if event.draws_air else 1.0
            depth = min(max(LEAST_DEPTH + (1.0 - LEAST_DEPTH) * need, LEAST_DEPTH), max(most, LEAST_DEPTH), 1.0)
            event = msgspec.structs.replace(event, depth=round(depth, 4))
        result.append(event)
    return tuple(result)


def too_long(
    notes: tuple[Note, ...], times: LineTimes, used: FloatArray, lung_s: float, refill: FloatArray
) -> list[Problem]:
    """A problem for each stretch of notes that needs more air than is available."""
    level = levels(used, lung_s, refill)
    starts: IntArray = np.unique(np.concatenate(([0], np.flatnonzero(refill > 0.0))))
    ends = np.append(starts[1:], len(notes))
    problems = []
    for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
        air_s = float(used[end] - used[start])
        if air_s > level[start] * lung_s + EPSILON:
            start_s, end_s = float(times.onset_s[start]), float(times.played_end_s[end - 1])
            arguments = {
                "note": notes[start].id,
                "phrase_s": round(end_s - start_s, 2),
                "air_s": round(air_s, 2),
                "lung_s": round(float(level[start]) * lung_s, 2),
            }
            problems.append(Problem(Message("breath.too_long", arguments), notes[start].id, start_s, end_s))
    return problems
