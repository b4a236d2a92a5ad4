"""Edits of what players dance while they play.

Messages: ``dancer.no_choreography`` (file) of `app.project.edit.dancers`.
"""

from __future__ import annotations

import os
from collections.abc import Collection

from app.chance import next_seed
from app.project.edit.dancers import checked_choreography
from app.project.edit.players import set_parameters
from app.project.model import Project


def set_body_dance(project: Project, player_ids: Collection[str], choreography: str | os.PathLike[str]) -> Project:
    """Let the bodies of players dance a choreography while they play: a bundled one by its name, any other by its file;
    empty: they move as is generated.

    Raises
    ------
    AppError
        ``dancer.no_choreography``.
    """
    chosen = checked_choreography(choreography) if os.fspath(choreography) else ""
    return set_parameters(project, player_ids, choreography=chosen)


def vary_body_dances(project: Project, player_ids: Collection[str]) -> Project:
    """Give each of these players another dance to the same music, each a different one."""
    for player in project.players:
        if player.id in player_ids:
            # 0 is a dance of the player's own.
            variation = next_seed(player.id, player.parameters.dance_variation) or 1
            project = set_parameters(project, (player.id,), dance_variation=variation)
    return project
