"""All that is wrong with a player's performance, its generated motion included: the same in every report."""

from __future__ import annotations

from collections.abc import Iterable

from app.contacts.breaks import by_time, contact_problems
from app.contacts.judge import ContactJudge
from app.motion.model import Motion
from app.performance.cast import Performer, performers_of
from app.performance.ensemble import Performance
from app.performance.motion import CHUNK, playing_of
from app.performance.span import whole_span
from app.plan.model import Problem
from app.project.performers import Player


def all_problems(performance: Performance, players: Iterable[Player]) -> dict[str, tuple[Problem, ...]]:
    """`judged_problems` of players by their ids; of those who cannot be seen, what is known without a motion."""
    found = {player.id: performance.problems(player.id) for player in players}
    performers = performers_of(performance, (performance.project.player(player_id) for player_id in found)).made
    return found | {player_id: judged_problems(performance, one) for player_id, one in performers.items()}


def judged_problems(
    performance: Performance, performer: Performer, motion: Motion | None = None
) -> tuple[Problem, ...]:
    """Problems of plan and body, and the contacts that a motion breaks, by time.

    Parameters
    ----------
    motion : Motion, optional
        Some frames of the player's; without it all are made for this, and let go again.
    """
    playing, known = playing_of(performance, performer), performance.problems(performer.player.id)
    judge = ContactJudge(playing, performer.character, performer.model)
    if motion is not None:
        breaks = judge.breaks(motion)
    else:
        fps = performance.project.fps
        count = whole_span(performance.time_frame, fps).count
        chunks = ((first, min(CHUNK, count - first)) for first in range(0, count, CHUNK))
        breaks = tuple(found for chunk in chunks for found in judge.breaks(playing.motion(fps, *chunk)))
    return by_time((*known, *contact_problems(breaks, performance.plan(performer.player).grips, known)))
