"""All problems of a player's performance including its motion, equal in every report."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Final, NamedTuple

from app.contacts.breaks import JUDGED_PER_S, Break, by_time, contact_problems
from app.contacts.judge import ContactJudge
from app.errors import Argument, Message
from app.motion.model import Motion
from app.performance.cast import Performer, performers_of
from app.performance.ensemble import Performance
from app.performance.motion import CHUNK, performance_curves
from app.performance.span import whole_span
from app.plan.model import Problem
from app.plan.problem_lines import Wording, problem_lines, problems_in_bars
from app.project.ignored_problems import split_by_ignored
from app.project.performers import Player

WHOLE_FRAMES: Final = 120_000
"""Number of frames of all players together up to which the whole motion is computed; every fourth frame is posed and
examined. In longer pieces only the examined frames are computed.
"""
MOST_WORK: Final = 74_000
"""Greatest work on a piece, in examined frames of one player (44 us each). In longer pieces fewer frames per second are
examined, then fewer players.
"""
NOTE_WORK: Final = 3.0
"""Work per note, in the same unit, for reading, planning and printing."""
PLAYER_WORK, CURVE_WORK = 1300, 1.0
"""Work for each examined player, for each posed player, and for each of their notes with curves."""
SPARSE_S: Final = 4.0
"""Seconds of a player per note above which a piece counts as having few notes: slower than any chorale; see
`SPARSE_FRAMES`.
"""
SPARSE_FRAMES, SPARSE_PER_NOTE = 50_000, 4
"""Number of examined frames in a long piece with few notes, and additional frames per note, up to the number for a
short piece.
"""
LEAST_PER_S: Final = 2.0
"""Least examined frames per second, since with fewer, breaks of a contact would be missed; below this, fewer players
are examined.
"""


class _Looked(NamedTuple):
    """Choice of frames to check for broken contacts: a frame rate, and every n-th frame at that rate."""

    fps: Fraction
    every: int


class Judged(NamedTuple):
    """Problems by player id, and a message if fewer frames or players than usual were checked."""

    problems: dict[str, tuple[Problem, ...]]
    notice: Message | None


def all_problems(performance: Performance, players: Iterable[Player], without_limit: bool = False) -> Judged:
    """Run `judged_problems` for players; for those that cannot be shown, only problems known without motion.

    Parameters
    ----------
    without_limit : bool
        Check all players at the usual rate, however long it takes.
    """
    found = {player.id: performance.problems(player.id) for player in players}
    performers = performers_of(performance, (performance.project.player(player_id) for player_id in found)).made
    by_musician: dict[str, list[Performer]] = {}
    for one in performers.values():
        by_musician.setdefault(performance.project.musician(one.player).id, []).append(one)
    groups = list(by_musician.values())
    notes = [sum(len(performance.project.part(one.player).notes) for one in together) for together in groups]
    most = math.inf if without_limit else MOST_WORK
    looked, judged = _looked(performance, [len(together) for together in groups], notes, most)
    for together in groups[:judged]:
        if looked is not None:
            found |= _judged(performance, together, looked)
    return Judged(found, _notice(performance, looked, groups, judged))


def _judged(
    performance: Performance, performers: Sequence[Performer], looked: _Looked
) -> dict[str, tuple[Problem, ...]]:
    """Check the motion of all instruments that one musician plays; returns the problems by player id."""
    fps, every = looked
    everyone = [performance_curves(performance, one) for one in performers]
    judges = [ContactJudge(curves, one.character, one.model) for curves, one in zip(everyone, performers, strict=True)]
    breaks: list[list[Break]] = [[] for _ in performers]
    count, chunk = whole_span(performance.time_frame, fps).count, CHUNK // every * every
    for first in range(0, count, chunk):
        for curves, judge, mine in zip(everyone, judges, breaks, strict=True):
            mine += judge.breaks(curves.motion(fps, first, min(chunk, count - first), every))
    return {
        one.player.id: _problems(performance, one.player, mine) for one, mine in zip(performers, breaks, strict=True)
    }


def _looked(
    performance: Performance, players: Sequence[int], notes: Sequence[int], most: float
) -> tuple[_Looked | None, int]:
    """Choose the frames to check (None: none), and the number of musicians to check, counted from the first.

    Parameters
    ----------
    players, notes : sequence of int
        Numbers of players and notes of each musician.
    most : float
        Largest amount of work: `MOST_WORK`, or infinity.
    """
    fps = performance.project.fps
    frames = whole_span(performance.time_frame, fps).count
    usual = max(1, round(float(fps) / JUDGED_PER_S))
    count = frames * sum(players)
    if most <= MOST_WORK and count / float(fps) > SPARSE_S * sum(notes):
        most = min(most, SPARSE_FRAMES + SPARSE_PER_NOTE * sum(notes))
    left = most - NOTE_WORK * sum(notes)
    works = [PLAYER_WORK * some + CURVE_WORK * many for some, many in zip(players, notes, strict=True)]
    for judged in range(len(players), 0, -1):
        room = left - sum(works[:judged])
        looked = frames * sum(players[:judged])
        stride = usual * max(1, math.ceil(looked / usual / max(room, 1.0)))
        if room >= 1.0 and float(fps) / stride >= LEAST_PER_S:
            if stride == usual and count <= WHOLE_FRAMES:
                return _Looked(fps, usual), judged
            return _Looked(fps / stride, 1), judged
    return None, 0


def _notice(
    performance: Performance, looked: _Looked | None, groups: Sequence[Sequence[Performer]], judged: int
) -> Message | None:
    """Return a message if fewer frames than usual, or not all players, were checked; else None."""
    frame, players = performance.time_frame, sum(map(len, groups))
    minutes = max(1, round((frame.end_s - frame.first_frame_s) / 60.0))
    if looked is None:
        return Message("judged.not", {"players": players, "minutes": minutes}) if groups else None
    rate = float(looked.fps) / looked.every
    usual = max(1, round(float(performance.project.fps) / JUDGED_PER_S))
    said: dict[str, Argument] = {"rate": round(rate, 1), "players": players, "minutes": minutes}
    if judged < len(groups):
        last = groups[judged - 1][-1].player.name
        return Message("judged.some", {**said, "judged": sum(map(len, groups[:judged])), "last": last})
    return Message("judged.sparsely", said) if rate < float(performance.project.fps) / usual else None


def reported_lines(
    performance: Performance,
    player: Player,
    problems: tuple[Problem, ...],
    wording: Wording,
    with_ignored: bool = False,
    bars: tuple[int, int] | None = None,
) -> tuple[list[str], int]:
    """Return the lines of a report about a player's problems, and the number of problems omitted because the project
    ignores them.

    Parameters
    ----------
    problems : tuple of Problem
        All problems of the player, from `judged_problems`.
    with_ignored : bool
        Include ignored problems.
    bars : (int, int) or None
        First and last bar of the report; None: the whole piece.
    """
    project = performance.project
    if bars is not None:
        problems = problems_in_bars(problems, project.score, player.part_id, bars)
    ignored = () if with_ignored else project.ignored_problems.get(player.id, ())
    counted, left = split_by_ignored(problems, ignored, project.score.tempo_map)
    lines = problem_lines(counted, project.score, wording, player.part_id, performance.instrument(player))
    return lines, len(left)


def judged_problems(performance: Performance, performer: Performer, motion: Motion) -> tuple[Problem, ...]:
    """Return all problems of a player by time: those of plan and body, and contacts broken in the frames of
    ``motion``.
    """
    judge = ContactJudge(performance_curves(performance, performer), performer.character, performer.model)
    return _problems(performance, performer.player, judge.breaks(motion))


def _problems(performance: Performance, player: Player, breaks: Iterable[Break]) -> tuple[Problem, ...]:
    known = performance.problems(player.id)
    return by_time((*known, *contact_problems(breaks, performance.plan(player).grips, known)))
