"""Commands that step through the problems of all players."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from app.editor.problems import go_to_problem
from app.editor.session import Session
from app.errors import Message
from app.plan.model import Problem
from app.shell.action import Action

_visited: WeakKeyDictionary[Session, tuple[str, Problem]] = WeakKeyDictionary()


def problems(session: Session) -> list[tuple[str, Problem]]:
    """Return the problems of all players and dancers in the order of time, each with the performer's id.

    If the list of problems is filtered, only the listed ones are returned, unless there are none.
    """
    found = [(one.id, problem) for one in session.project.performers for problem in session.problems(one.id)]
    listed = [item for item in found if session.problem_filter.takes(*item, session.players)]
    return sorted(listed or found, key=lambda item: item[1].start_s)


def step_problems(session: Session, step: int) -> None:
    """Show the next problem (1) or the previous one (-1), counted from the one shown last or else from the playhead;
    the list wraps around.
    """
    found = problems(session)
    if not found:
        session.notice(Message("problems.none"))
        return
    last = _visited.get(session)
    if last in found:
        index = found.index(last) + step
    elif step > 0:
        index = next((i for i, (_, problem) in enumerate(found) if problem.start_s >= session.playhead_s), 0)
    else:
        before = [i for i, (_, problem) in enumerate(found) if problem.start_s < session.playhead_s]
        index = before[-1] if before else -1
    player_id, problem = found[index % len(found)]
    _visited[session] = (player_id, problem)
    go_to_problem(session, player_id, problem)


def _has_problems(session: Session) -> bool:
    return any(session.problems(one.id) for one in session.project.performers)


ACTIONS: tuple[Action, ...] = (
    Action(
        "problems.next", lambda session: step_problems(session, 1), "view", "F8", enabled=_has_problems, icon="problem"
    ),
    Action("problems.previous", lambda session: step_problems(session, -1), "view", "Shift+F8", enabled=_has_problems),
)
