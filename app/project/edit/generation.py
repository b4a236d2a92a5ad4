"""Edits that make another random variation: new seeds for all players, some players, or some bars. Corrections stay."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import msgspec

from app.chance import next_seed
from app.plan.by_hand.corrections import Correction, Vary
from app.project.edit.corrections import take_back, with_corrections
from app.project.edit.players import musicians_of
from app.project.model import Project
from app.project.performers import Player

NAME = "varied-"


def vary_everyone(project: Project) -> Project:
    """Change the seed of the whole performance."""
    return replace(project, seed=next_seed("everyone", project.seed))


def vary_players(project: Project, player_ids: Iterable[str]) -> Project:
    """Change the seed of some players, with everything they play; the others stay as they are."""
    chosen = musicians_of(project, frozenset(player_ids))

    def varied(player: Player) -> Player:
        seed = next_seed(player.id, player.parameters.seed)
        return msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, seed=seed))

    return replace(
        project, players=tuple(varied(player) if player.id in chosen else player for player in project.players)
    )


def vary_span(project: Project, player_ids: Iterable[str], start_tick: int, end_tick: int) -> Project:
    """Add a random variation for some players from one tick to another; repeating it for the same span gives yet
    another.
    """
    for player_id in player_ids:
        said = variations(project, player_id)
        same = [item for item in said if (item.start_tick, item.end_tick) == (start_tick, end_tick)]
        if same:
            seed, name = next_seed(player_id, same[-1].seed), same[-1].name
        else:
            names = {item.name for item in said}
            name = next(name for number in range(1, len(names) + 2) if (name := f"{NAME}{number}") not in names)
            seed = next_seed(player_id, len(said))
        project = with_corrections(project, player_id, [Vary(name, start_tick, end_tick, seed)])
    return project


def unvary_span(project: Project, player_ids: Iterable[str], start_tick: int, end_tick: int) -> Project:
    """Remove every variation that overlaps a span, so that the original performance returns there."""
    for player_id in player_ids:
        there = variations(project, player_id, start_tick, end_tick)
        if there:
            project = take_back(project, player_id, there)
    return project


def variations(
    project: Project, player_id: str, start_tick: int | None = None, end_tick: int | None = None
) -> tuple[Vary, ...]:
    """Return the variations of a player: all, or those that overlap the span from ``start_tick`` to ``end_tick``."""
    return tuple(
        item
        for item in project.corrections.get(player_id, ())
        if isinstance(item, Vary)
        and (end_tick is None or item.start_tick < end_tick)
        and (start_tick is None or start_tick < item.end_tick)
    )


def by_hand(project: Project, player_ids: Iterable[str]) -> tuple[Correction, ...]:
    """Return all corrections of the given players other than random variations of bars."""
    return tuple(
        item
        for player_id in player_ids
        for item in project.corrections.get(player_id, ())
        if not isinstance(item, Vary)
    )
