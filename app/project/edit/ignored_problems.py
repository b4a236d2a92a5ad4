"""Edits of which problems are ignored."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from app.plan.model import Problem
from app.project.ignored_problems import IgnoredProblem, ignored_problem, is_ignored
from app.project.model import Project


def ignore(project: Project, performer_id: str, problems: Iterable[Problem]) -> Project:
    """Let problems of a performer be."""
    clock, known = project.score.tempo_map, project.ignored_problems.get(performer_id, ())
    added = (ignored_problem(problem, clock) for problem in problems)
    return _with(project, performer_id, tuple(dict.fromkeys((*known, *added))))


def unignore(project: Project, performer_id: str, problems: Iterable[Problem]) -> Project:
    """Count problems of a performer again."""
    clock, known = project.score.tempo_map, project.ignored_problems.get(performer_id, ())
    again = tuple(problems)
    kept = tuple(item for item in known if not any(is_ignored(problem, (item,), clock) for problem in again))
    return _with(project, performer_id, kept)


def _with(project: Project, performer_id: str, ignored: tuple[IgnoredProblem, ...]) -> Project:
    if ignored == project.ignored_problems.get(performer_id, ()):
        return project
    others = {id: items for id, items in project.ignored_problems.items() if id != performer_id}
    return replace(project, ignored_problems={**others, performer_id: ignored} if ignored else others)
