"""All that is wrong with a player's performance, its generated motion included: the same in every report.

Messages: ``judged.sparsely`` (rate, players, minutes), ``judged.not`` (players, minutes).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Final, NamedTuple

from app.contacts.breaks import JUDGED_PER_S, Break, by_time, contact_problems
from app.contacts.judge import ContactJudge
from app.errors import Message
from app.motion.model import Motion
from app.performance.cast import Performer, performers_of
from app.performance.ensemble import Performance
from app.performance.motion import CHUNK, playing_of
from app.performance.span import whole_span
from app.plan.model import Problem
from app.project.performers import Player

WHOLE_FRAMES: Final = 120_000
"""Frames of all players together up to which motion is made of all, before every fourth is posed and looked at; in
longer pieces nothing is made of those between."""
MOST_WORK: Final = 110_000
"""Work on a piece at most, in frames of one player that are looked at. In longer pieces fewer are in each second."""
PLAYER_WORK, NOTE_WORK = 850, 1
"""What a player and a note take beside them, in the same measure: curves are made of every one."""
SPARSE_S: Final = 4.0
"""Seconds of a player for each note from which a piece counts as one with few notes: slower than any chorale ..."""
SPARSE_FRAMES, SPARSE_PER_NOTE = 50_000, 4
"""... of which so many are looked at, and for each note so many more, up to those of any piece."""
LEAST_PER_S: Final = 2.0
"""At fewer frames in a second breaks of a contact would be missed, and nothing is looked at."""


class _Looked(NamedTuple):
    """Which frames are looked at: every how many-th at a rate."""

    fps: Fraction
    every: int


class Judged(NamedTuple):
    """Problems of players by their ids, and what to say where their motion was not looked at as densely as usual."""

    problems: dict[str, tuple[Problem, ...]]
    notice: Message | None


def all_problems(performance: Performance, players: Iterable[Player]) -> Judged:
    """`judged_problems` of players; of those who cannot be seen, what is known without a motion."""
    found = {player.id: performance.problems(player.id) for player in players}
    performers = performers_of(performance, (performance.project.player(player_id) for player_id in found)).made
    notes = sum(len(performance.project.part(one.player).notes) for one in performers.values())
    looked, notice = _looked(performance, len(performers), notes)
    if looked is not None:
        by_musician: dict[str, list[Performer]] = {}
        for one in performers.values():
            by_musician.setdefault(performance.project.musician(one.player).id, []).append(one)
        for together in by_musician.values():
            found |= _judged(performance, together, looked)
    return Judged(found, notice)


def _judged(
    performance: Performance, performers: Sequence[Performer], looked: _Looked
) -> dict[str, tuple[Problem, ...]]:
    """Problems of a musician's players, who share what is made of each piece of the performance."""
    fps, every = looked
    playing = [playing_of(performance, one) for one in performers]
    judges = [ContactJudge(curves, one.character, one.model) for curves, one in zip(playing, performers, strict=True)]
    breaks: list[list[Break]] = [[] for _ in performers]
    count, chunk = whole_span(performance.time_frame, fps).count, CHUNK // every * every
    for first in range(0, count, chunk):
        for curves, judge, mine in zip(playing, judges, breaks, strict=True):
            mine += judge.breaks(curves.motion(fps, first, min(chunk, count - first), every))
    return {
        one.player.id: _problems(performance, one.player, mine) for one, mine in zip(performers, breaks, strict=True)
    }


def _looked(performance: Performance, players: int, notes: int) -> tuple[_Looked | None, Message | None]:
    """Which frames of players are looked at, None for none; and what to say of it."""
    fps = performance.project.fps
    count = whole_span(performance.time_frame, fps).count * players
    most = max(MOST_WORK - PLAYER_WORK * players - NOTE_WORK * notes, 1)
    if count / float(fps) > SPARSE_S * notes:
        most = min(most, SPARSE_FRAMES + SPARSE_PER_NOTE * notes)
    usual = max(1, round(float(fps) / JUDGED_PER_S))
    stride = usual * max(1, math.ceil(count / usual / most))
    if stride == usual and count <= WHOLE_FRAMES:
        return _Looked(fps, usual), None
    if stride == usual:
        return _Looked(fps / usual, 1), None
    frame, rate = performance.time_frame, float(fps) / stride
    minutes = max(1, round((frame.end_s - frame.first_frame_s) / 60.0))
    if rate < LEAST_PER_S:
        return None, Message("judged.not", {"players": players, "minutes": minutes})
    return _Looked(fps / stride, 1), Message(
        "judged.sparsely", {"rate": round(rate, 1), "players": players, "minutes": minutes}
    )


def judged_problems(performance: Performance, performer: Performer, motion: Motion) -> tuple[Problem, ...]:
    """Problems of plan and body, and the contacts that some frames of a player's motion break, by time."""
    judge = ContactJudge(playing_of(performance, performer), performer.character, performer.model)
    return _problems(performance, performer.player, judge.breaks(motion))


def _problems(performance: Performance, player: Player, breaks: Iterable[Break]) -> tuple[Problem, ...]:
    known = performance.problems(player.id)
    return by_time((*known, *contact_problems(breaks, performance.plan(player).grips, known)))
