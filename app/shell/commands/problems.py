"""Commands that walk through the problems of all players."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from app.editor.selection import Selection
from app.editor.session import Session, Severity
from app.errors import Message
from app.plan.model import Problem
from app.shell.action import Action

_visited: WeakKeyDictionary[Session, tuple[str, Problem]] = WeakKeyDictionary()


def problems(session: Session) -> list[tuple[str, Problem]]:
    """The problems of all players and dancers with their ids, in the order of time."""
    found = [(one.id, problem) for one in session.project.performers for problem in session.problems(one.id)]
    return sorted(found, key=lambda item: item[1].start_s)


def go_to_problem(session: Session, step: int) -> None:
    """Show the next problem (1) or the one before (-1): of the one shown last, else of the playhead; round the end."""
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
    if player_id in session.project.dancer_ids:
        session.set_dancer(player_id)
    else:
        others = tuple(id for id in session.players if id != player_id)
        session.set_players((player_id, *others) if player_id in session.players else (player_id,))
    notes = frozenset({problem.note_id}) if problem.note_id is not None else frozenset[str]()
    session.select(Selection(notes=notes))
    session.reveal(problem.start_s)
    session.notice(problem.message, Severity.WARNING)


def _has_problems(session: Session) -> bool:
    return any(session.problems(one.id) for one in session.project.performers)


ACTIONS: tuple[Action, ...] = (
    Action(
        "problems.next", lambda session: go_to_problem(session, 1), "view", "F8", enabled=_has_problems, icon="problem"
    ),
    Action("problems.previous", lambda session: go_to_problem(session, -1), "view", "Shift+F8", enabled=_has_problems),
)
