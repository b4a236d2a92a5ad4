"""Putting corrections into a project and taking them out: one for each place, the last one counts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from app.plan.by_hand.corrections import Correction
from app.project.edit.found_events import OWN as OWN
from app.project.edit.found_events import Placed as Placed
from app.project.edit.found_events import corrections_of as corrections_of
from app.project.edit.found_events import events_of as events_of
from app.project.edit.found_events import is_there as is_there
from app.project.edit.found_events import placed_events as placed_events
from app.project.model import Project


def with_corrections(project: Project, player_id: str, corrections: Iterable[Correction]) -> Project:
    """Add corrections; each takes the place of one about the same place. KeyError where there is no such player."""
    before = project.corrections.get(project.player(player_id).id, ())
    kept = {correction.place: correction for correction in before}
    for correction in corrections:
        kept[correction.place] = correction
    return _with(project, player_id, tuple(kept.values()))


def take_back(project: Project, player_id: str, corrections: Iterable[Correction]) -> Project:
    """Remove corrections: the generator decides there again. Others are not touched."""
    places = {correction.place for correction in corrections}
    before = project.corrections.get(player_id, ())
    return _with(project, player_id, tuple(item for item in before if item.place not in places))


def _with(project: Project, player_id: str, corrections: tuple[Correction, ...]) -> Project:
    if corrections == project.corrections.get(player_id, ()):
        return project
    others = {key: value for key, value in project.corrections.items() if key != player_id}
    return replace(project, corrections={**others, player_id: corrections} if corrections else others)


class Edited(NamedTuple):
    """A project after an edit, and the ids that the edited events have in it, in the order they were given."""

    project: Project
    event_ids: tuple[str, ...]
