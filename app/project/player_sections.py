"""Grouping of players into sections by family of instrument."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final, NamedTuple

from app.identity_cache import IdentityCache
from app.project.model import Project
from app.project.performers import Player
from instrument_maps.instrument_names import vocabulary
from instrument_maps.library import Library, library

GROUPED_FROM: Final = 6
"""Number of players from which a list of players is grouped by section."""


class PlayerSection(NamedTuple):
    """A section: players of one family of instruments.

    Attributes
    ----------
    family : str
        Family id of the vocabulary; empty for unknown families.
    player_ids : tuple of str
        Ids in the order of the project.
    """

    family: str
    player_ids: tuple[str, ...]

    @property
    def fold_name(self) -> str:
        """Key under which the editor stores whether the section is folded."""
        return f"players_section_{self.family or 'others'}"


_SECTIONS: IdentityCache[tuple[PlayerSection, ...]] = IdentityCache(1)
"""Sections of the open piece; a single entry, so that the players of closed pieces are freed."""


def sections(project: Project) -> tuple[PlayerSection, ...]:
    """Return the sections of a project, in the order of their first players."""
    return _SECTIONS.step(_sections, project.players, library())


def _sections(players: tuple[Player, ...], known: Library) -> tuple[PlayerSection, ...]:
    found: dict[str, list[str]] = {}
    for player in players:
        instrument = known.maps.get(player.instrument_id)
        family = "" if instrument is None else vocabulary().family(instrument.plays)
        found.setdefault(family, []).append(player.id)
    return tuple(PlayerSection(family, tuple(ids)) for family, ids in found.items())


def are_worth_grouping(project: Project) -> bool:
    """Return whether a list of players should be grouped by section: there are many players and several sections, and
    not everyone is in a section of their own.
    """
    return len(project.players) >= GROUPED_FROM and 1 < len(sections(project)) < len(project.players)


def in_sections_of(project: Project, player_ids: Collection[str]) -> tuple[str, ...]:
    """Return the ids of all players in the sections to which the given players belong, in project order."""
    chosen = {
        id
        for section in sections(project)
        if not {*player_ids}.isdisjoint(section.player_ids)
        for id in section.player_ids
    }
    return tuple(player.id for player in project.players if player.id in chosen)
