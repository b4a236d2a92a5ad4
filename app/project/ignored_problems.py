"""Problems ignored by the user: stored with the project and recognised in every later plan."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Annotated

import msgspec

from app.plan.model import Problem
from app.plan.problem_lines import PARTS
from app.score.limits import LAST_TICK
from app.score.tempo import TempoMap

_Id = Annotated[str, msgspec.Meta(max_length=200)]


class IgnoredProblem(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Identification of an ignored problem, without measured values, which differ in every plan.

    Attributes
    ----------
    message_id, note_id : str
        Message id and note id; ``note_id`` is empty if the problem has no note.
    body_part : str
        Side of the body or touching part that the message names.
    tick : int
        Start of a problem without a note; 0 for others.
    """

    message_id: _Id
    note_id: _Id = ""
    body_part: _Id = ""
    tick: Annotated[int, msgspec.Meta(ge=-LAST_TICK, le=LAST_TICK)] = 0


def ignored_problem(problem: Problem, clock: TempoMap) -> IgnoredProblem:
    """Return the stored form of a problem that is to be ignored."""
    named = [str(problem.message.arguments[name]) for name in PARTS if name in problem.message.arguments]
    tick = 0 if problem.note_id is not None else round(clock.ticks(problem.start_s))
    body_part = " ".join(named)[:200]
    return IgnoredProblem(problem.message.id, problem.note_id or "", body_part, min(max(tick, -LAST_TICK), LAST_TICK))


def moved_ignored(ignored: IgnoredProblem, place: Callable[[int], int]) -> IgnoredProblem:
    """Return an ignored problem after its music was moved; ``place`` converts old ticks to new ones."""
    return ignored if ignored.note_id else msgspec.structs.replace(ignored, tick=place(ignored.tick))


def is_ignored(problem: Problem, ignored: Iterable[IgnoredProblem], clock: TempoMap) -> bool:
    """Return whether a problem is among the ignored ones; one without a note may begin up to a quarter earlier or
    later.
    """
    own = ignored_problem(problem, clock)
    return any(
        (own.message_id, own.note_id, own.body_part) == (item.message_id, item.note_id, item.body_part)
        and abs(own.tick - item.tick) <= clock.ticks_per_quarter
        for item in ignored
    )


def split_by_ignored(
    problems: tuple[Problem, ...], ignored: tuple[IgnoredProblem, ...], clock: TempoMap
) -> tuple[tuple[Problem, ...], tuple[Problem, ...]]:
    """Split problems into those still shown and those the user ignores, both in their order."""
    if not ignored:
        return problems, ()
    by_kind: dict[tuple[str, str], list[IgnoredProblem]] = {}
    for item in ignored:
        by_kind.setdefault((item.message_id, item.note_id), []).append(item)
    counted, left = list[Problem](), list[Problem]()
    for problem in problems:
        same = by_kind.get((problem.message.id, problem.note_id or ""), ())
        (left if is_ignored(problem, same, clock) else counted).append(problem)
    return tuple(counted), tuple(left)
