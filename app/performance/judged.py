"""All that is wrong with a player's performance, its generated motion included: the same in every report.

Messages: ``judged.sparsely`` (rate, hours), ``judged.not`` (players, hours, most).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Final, NamedTuple

from app.contacts.breaks import JUDGED_PER_S, by_time, contact_problems
from app.contacts.judge import ContactJudge
from app.errors import Message
from app.motion.model import Motion
from app.performance.cast import Performer, performers_of
from app.performance.ensemble import Performance
from app.performance.motion import CHUNK, playing_of
from app.performance.span import whole_span
from app.plan.model import Problem
from app.project.performers import Player

FREE_FRAMES, FRAMES_PER_NOTE = 200_000, 16
"""Frames of all players together that a report makes: in any piece, and for each of its notes. In longer pieces only
those are made that are looked at, and in pieces of hours with few notes fewer are."""
LEAST_PER_S: Final = 2.0
"""At fewer frames in a second breaks of a contact would be missed, and nothing is looked at."""


class Judged(NamedTuple):
    """Problems of players by their ids, and what to say where their motion was not looked at as densely as usual."""

    problems: dict[str, tuple[Problem, ...]]
    notice: Message | None


def all_problems(performance: Performance, players: Iterable[Player]) -> Judged:
    """`judged_problems` of players; of those who cannot be seen, what is known without a motion."""
    found = {player.id: performance.problems(player.id) for player in players}
    performers = performers_of(performance, (performance.project.player(player_id) for player_id in found)).made
    notes = sum(len(performance.project.part(one.player).notes) for one in performers.values())
    stride, notice = _stride(performance, len(performers), notes)
    if stride:
        found |= {player_id: judged_problems(performance, one, stride=stride) for player_id, one in performers.items()}
    return Judged(found, notice)


def _stride(performance: Performance, players: int, notes: int) -> tuple[int, Message | None]:
    """Every how many-th frame of players is made to be looked at, 0 for none; and what to say of it."""
    fps = performance.project.fps
    count = whole_span(performance.time_frame, fps).count * players
    most = FREE_FRAMES + FRAMES_PER_NOTE * notes
    if count <= most:
        return 1, None
    usual = max(1, round(float(fps) / JUDGED_PER_S))
    stride = usual * max(1, math.ceil(count / usual / most))
    if stride == usual:
        return usual, None
    frame, rate = performance.time_frame, float(fps) / stride
    hours = round((frame.end_s - frame.first_frame_s) / 3600.0, 1)
    if rate < LEAST_PER_S:
        return 0, Message("judged.not", {"players": players, "hours": hours})
    return stride, Message("judged.sparsely", {"rate": round(rate, 1), "hours": hours})


def judged_problems(
    performance: Performance, performer: Performer, motion: Motion | None = None, *, stride: int = 1
) -> tuple[Problem, ...]:
    """Problems of plan and body, and the contacts that a motion breaks, by time.

    Parameters
    ----------
    motion : Motion, optional
        Some frames of the player's; without it all are made for this, and let go again.
    stride : int, optional
        Without a motion only every so many-th frame is made.
    """
    playing, known = playing_of(performance, performer), performance.problems(performer.player.id)
    judge = ContactJudge(playing, performer.character, performer.model)
    if motion is not None:
        breaks = judge.breaks(motion)
    else:
        fps = performance.project.fps
        count = math.ceil(whole_span(performance.time_frame, fps).count / stride)
        chunks = ((first, min(CHUNK, count - first)) for first in range(0, count, CHUNK))
        breaks = tuple(found for chunk in chunks for found in judge.breaks(playing.motion(fps / stride, *chunk)))
    return by_time((*known, *contact_problems(breaks, performance.plan(performer.player).grips, known)))
