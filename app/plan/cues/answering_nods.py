"""Nods of players who come in on another player's cue: smaller, and a little later."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.errors import Message
from app.plan.model import CONDUCTOR, CueEvent, GestureEvent
from app.plan.music.piece import NoteTimes, Piece, Seeds
from app.score.model import Note

SOONEST_S: Final = 0.02
LATEST_S: Final = 0.06
"""Greatest delay in seconds of a follower's nod behind the leader's; each follower has an individual delay."""
SMALLEST: Final = 0.3
LARGEST: Final = 0.55
"""Size of followers' nods relative to the leader's."""
UNDER_CONDUCTOR: Final = 0.6
"""Size of the nods of players who follow a conductor."""


def answering_nods(
    notes: tuple[Note, ...], times: NoteTimes, answered: Sequence[CueEvent], piece: Piece, seeds: Seeds
) -> list[GestureEvent]:
    """Plan a nod of a player for every cue with which the player comes in, unless the player's first note comes later
    than the cue's beat.

    Parameters
    ----------
    answered : sequence of CueEvent
        Cues with which the player comes in.
    """
    found: dict[str, GestureEvent] = {}
    for cue in answered:
        index = int(np.searchsorted(times.onset_tick, cue.end_tick))
        if index == len(notes) or float(times.onset_s[index]) > cue.end_s + cue.beat_s:
            continue
        after_s = SOONEST_S + (LATEST_S - SOONEST_S) * seeds.chance_at("nod after", cue.end_tick)
        size = SMALLEST + (LARGEST - SMALLEST) * seeds.chance_at("nod", cue.end_tick)
        if cue.player_id == CONDUCTOR:
            size *= UNDER_CONDUCTOR
        start_s, end_s = cue.start_s + after_s, cue.downbeat_s + after_s
        event_id = f"nod:{notes[index].id}"
        # If two players cue the same entry, the first one is answered.
        found.setdefault(
            event_id,
            GestureEvent(
                id=event_id,
                kind="nod",
                start_tick=round(piece.clock.ticks(start_s)),
                end_tick=round(piece.clock.ticks(end_s)),
                start_s=start_s,
                end_s=end_s,
                amount=round(min(cue.amount * size, 1.0), 4),
                reason=Message("gesture.nod", {"after_ms": round(1000.0 * after_s)}),
            ),
        )
    return list(found.values())
