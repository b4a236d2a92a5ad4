"""What the generator does on a channel of a player, over the whole performance."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.motion.generated_channel import generated
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.motion import playing_of
from app.plan.model import PlayerPlan

RATE_HZ: Final = 25.0
MOST_SAMPLES: Final = 200_000
_ASKED: Final = ("breaths", "tongues", "embouchures", "cues", "gestures", "expressions", "poses", "traces")
"""What of a plan a channel depends on beside its own curves."""


def generated_channel(performance: Performance, player_id: str, channel: str) -> tuple[FloatArray, FloatArray]:
    """Times and values of a channel, in its unit, without the animator's curves. Raises AppError where the player
    cannot be seen."""
    performer = performer_of(performance, performance.project.player(player_id))
    curves = playing_of(performance, performer, danced=False)
    frame = curves.plan.time_frame
    count = int(min(RATE_HZ * (frame.end_s - frame.first_frame_s) + 2.0, MOST_SAMPLES))
    times_s = np.linspace(frame.first_frame_s, frame.end_s, count)
    return times_s, generated(curves, channel, times_s)


def generated_anew(before: PlayerPlan, after: PlayerPlan) -> bool:
    """Return whether a channel may be another than it was."""
    if before is after:
        return False
    same = before.player_id == after.player_id and before.time_frame == after.time_frame
    return not (same and all(getattr(before, kind) is getattr(after, kind) for kind in _ASKED))
