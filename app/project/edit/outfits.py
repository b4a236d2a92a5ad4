"""Edits of what players and dancers wear: outfits and their colours."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from typing import Final, TypeVar

import msgspec

from app.errors import UsageError
from app.project.edit.players import musicians_of
from app.project.model import Project
from app.project.parameters import select_players
from app.project.performers import Dancer, Player
from app.project.value_checks import COLOUR
from app.rig.people.wardrobe import TINTS, OutfitChoice, Tint, wardrobe

OWN: Final = "own"
"""Choice for the character's own clothes."""
P = TypeVar("P", bound=Player | Dancer)


def give_outfit(project: Project, performer_ids: Collection[str], outfit_id: str) -> Project:
    """Give an outfit to players and dancers, in its own colours; an empty id gives them their own clothes."""
    return _worn(project, performer_ids, lambda worn: worn if worn.id == outfit_id else OutfitChoice(outfit_id))


def colour_outfit(project: Project, performer_ids: Collection[str], tint: Tint, colour: str) -> Project:
    """Set the colour ``#rrggbb`` of a part of the outfits of players and dancers; empty for the outfit's own colour."""
    return _worn(project, performer_ids, lambda worn: msgspec.structs.replace(worn, **{tint: colour}))


def dress_everyone(project: Project, choice: OutfitChoice) -> Project:
    """Give all players and dancers the same outfit in the same colours."""
    return _wearing(project, [one.id for one in project.performers], choice)


def with_outfits(project: Project, texts: Iterable[str]) -> Project:
    """Set outfits of players and dancers from command-line texts, one after the other.

    Parameters
    ----------
    texts : iterable of str
        ``[NAME=]OUTFIT[,COLOUR...]``: name or pattern of players and dancers (all if absent); id of an outfit, or
        ``own`` for their own clothes; its colours, ``#rrggbb``, in the order of `TINTS`.

    Raises
    ------
    UsageError
        No performer has such a name, or there is no such outfit or colour.
    """
    names = [one.name for one in project.performers]
    for text in texts:
        who, named, worn = text.rpartition("=")
        chosen = select_players([who], names) if named else range(len(names))
        project = _wearing(project, [project.performers[index].id for index in chosen], read_choice(worn))
    return project


def read_choice(text: str) -> OutfitChoice:
    """Read an outfit and its colours, ``OUTFIT[,COLOUR...]``. Raises UsageError."""
    id, *colours = (part.strip() for part in text.split(","))
    if id == OWN and not colours:
        return OutfitChoice()
    outfit = wardrobe().get(id)
    if outfit is None:
        raise UsageError("outfit.unknown", outfit=id, possible=", ".join((OWN, *wardrobe())))
    if len(colours) > len(TINTS) or not all(map(COLOUR.fullmatch, filter(None, colours))):
        raise UsageError("outfit.colours", text=text, possible=", ".join(outfit.tints) or "-")
    return OutfitChoice(id, **dict(zip(TINTS, colours, strict=False)))


def _wearing(project: Project, performer_ids: Collection[str], choice: OutfitChoice) -> Project:
    return _worn(project, performer_ids, lambda worn: choice)


def _worn(project: Project, performer_ids: Collection[str], change: Callable[[OutfitChoice], OutfitChoice]) -> Project:
    """Return the project with the outfits of some performers changed; a musician with several instruments has one
    outfit.
    """
    ids = {*performer_ids, *musicians_of(project, performer_ids)}

    def changed(one: P) -> P:
        worn = change(one.outfit) if one.id in ids else one.outfit
        return one if worn == one.outfit else msgspec.structs.replace(one, outfit=worn)

    players, dancers = tuple(map(changed, project.players)), tuple(map(changed, project.dancers))
    same = all(one is other for one, other in zip((*players, *dancers), project.performers, strict=True))
    return project if same else replace(project, players=players, dancers=dancers)
