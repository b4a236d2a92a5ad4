"""A player of a performance, made ready and in motion: `app.performance.motion` for tests that have one player."""

from __future__ import annotations

from app.motion.model import Motion
from app.motion.perform import Playing
from app.performance import motion
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.model import Player


def playing_of(performance: Performance, player: Player, before: Playing | None = None) -> Playing:
    """The player's plan, ready to be seen."""
    return motion.playing_of(performance, performer_of(performance, player), before)


def player_motion(performance: Performance, player: Player, span: FrameSpan) -> Motion:
    """The player's motion over some frames."""
    return motion.player_motion(performance, performer_of(performance, player), span)
