"""Default outfits of players: in a new piece by the kind of piece, later those that most players wear."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import msgspec

from app.project.band_in_title import Band, bands_in_title
from app.project.model import Project
from app.rig.people.wardrobe import NO_CHOICE, OWN_CLOTHES, OutfitChoice, wardrobe
from app.score.contents import PieceContents
from app.score.track_channel import TrackChannel
from app.score.track_instrument import use_of

CONCERT, JAZZ = "concert_black", "jazz_suit"
UNIFORMS: Final[Mapping[Band, str]] = {
    "marching": "marching",
    "japanese_school": "school_uniform",
    "school": "school_blazer",
}
"""Outfit of each kind of band that a title may name."""
BASSES: Final = frozenset(range(32, 40))
CHORDS: Final = frozenset((*range(8), *range(16, 21), *range(24, 32)))
"""General MIDI programs of chord instruments: basses; pianos, organs and guitars."""
MOST_IN_JAZZ: Final = 18
"""Greatest number of winds in a jazz orchestra; a larger group is a concert band, whatever else plays."""


def outfit_of_piece(contents: PieceContents, players: int) -> str:
    """Return the id of the outfit that suits a piece: the uniform of a band that the title names, else for jazz if
    winds play with a rhythm section, else for a concert.

    Parameters
    ----------
    players : int
        Number of musicians on the stage.
    """
    rhythm = any(use_of(channel) == "rhythm" for channel in contents.channels)
    jazz = rhythm and players <= MOST_IN_JAZZ and all(_has(contents.channels, one) for one in (BASSES, CHORDS))
    uniforms = tuple(UNIFORMS[band] for band in bands_in_title(contents.title))
    wanted = (*uniforms, *((JAZZ,) if jazz else ()), CONCERT)
    return next((id for id in wanted if id in wardrobe()), OWN_CLOTHES)


def _has(channels: Sequence[TrackChannel], programs: frozenset[int]) -> bool:
    return any(use_of(channel) == "melodic" and channel.program in programs for channel in channels)


def with_outfit(project: Project, outfit_id: str) -> Project:
    """Return the project with all players in an outfit in its own colours."""
    choice = OutfitChoice(outfit_id)
    players = (msgspec.structs.replace(player, outfit=choice) for player in project.players)
    return replace(project, players=tuple(players)) if outfit_id else project


def common_outfit(project: Project) -> OutfitChoice:
    """Return the outfit that most players on the stage wear, for a new player; in an empty piece that for a concert."""
    worn = Counter(player.outfit for player in project.bodies)
    if worn:
        return worn.most_common(1)[0][0]
    return OutfitChoice(CONCERT) if CONCERT in wardrobe() else NO_CHOICE
