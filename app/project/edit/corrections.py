"""Adding and removing corrections, of which the last one at each place is used; and ignoring problems."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import NamedTuple, TypeVar

from app.plan.by_hand.corrections import Correction
from app.plan.model import Problem
from app.project.edit.found_events import OWN as OWN
from app.project.edit.found_events import Placed as Placed
from app.project.edit.found_events import corrections_of as corrections_of
from app.project.edit.found_events import events_of as events_of
from app.project.edit.found_events import is_there as is_there
from app.project.edit.found_events import placed_events as placed_events
from app.project.ignored_problems import IgnoredProblem, ignored_problem, is_ignored
from app.project.model import Project

T = TypeVar("T")


def with_corrections(project: Project, player_id: str, corrections: Iterable[Correction]) -> Project:
    """Add corrections; each replaces an existing one of the same kind at the same note or tick. KeyError for an unknown
    player.
    """
    before = project.corrections.get(project.player(player_id).id, ())
    kept = {correction.place: correction for correction in before}
    for correction in corrections:
        kept[correction.place] = correction
    return _with(project, player_id, tuple(kept.values()))


def take_back(project: Project, player_id: str, corrections: Iterable[Correction]) -> Project:
    """Remove corrections, so that the generated values return. Others are not changed."""
    places = {correction.place for correction in corrections}
    before = project.corrections.get(player_id, ())
    return _with(project, player_id, tuple(item for item in before if item.place not in places))


def ignore(project: Project, performer_id: str, problems: Iterable[Problem]) -> Project:
    """Mark problems of a performer as ignored, so that they are no longer shown."""
    clock, known = project.score.tempo_map, project.ignored_problems.get(performer_id, ())
    added = (ignored_problem(problem, clock) for problem in problems)
    return _ignoring(project, performer_id, tuple(dict.fromkeys((*known, *added))))


def unignore(project: Project, performer_id: str, problems: Iterable[Problem]) -> Project:
    """Show problems of a performer again that the user had marked as ignored."""
    clock, known = project.score.tempo_map, project.ignored_problems.get(performer_id, ())
    again = tuple(problems)
    kept = tuple(item for item in known if not any(is_ignored(problem, (item,), clock) for problem in again))
    return _ignoring(project, performer_id, kept)


def _with(project: Project, player_id: str, corrections: tuple[Correction, ...]) -> Project:
    now = _changed(project.corrections, player_id, corrections)
    return project if now is project.corrections else replace(project, corrections=now)


def _ignoring(project: Project, performer_id: str, ignored: tuple[IgnoredProblem, ...]) -> Project:
    now = _changed(project.ignored_problems, performer_id, ignored)
    return project if now is project.ignored_problems else replace(project, ignored_problems=now)


def _changed(
    known: Mapping[str, tuple[T, ...]], performer_id: str, items: tuple[T, ...]
) -> Mapping[str, tuple[T, ...]]:
    """Return the mapping ``known`` with a performer's items replaced, without empty entries; the same mapping if
    nothing changes.
    """
    if items == known.get(performer_id, ()):
        return known
    others = {id: kept for id, kept in known.items() if id != performer_id}
    return {**others, performer_id: items} if items else others


class Edited(NamedTuple):
    """A project after an edit, and the present ids of the edited events, in the given order."""

    project: Project
    event_ids: tuple[str, ...]
