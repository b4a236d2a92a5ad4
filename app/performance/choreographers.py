"""Choreographies by name or path, kept as long as their files are the same."""

from __future__ import annotations

from functools import lru_cache

from app.choreography.generate import Choreographer
from app.choreography.library import choreography_path
from app.choreography.model_file import read_model
from app.errors import AppError, Message
from app.formats.other_computers import refuse_others
from app.project.performers import Player
from app.project.storage import choreography_missing


def choreographer_of(choreography: str) -> Choreographer:
    """A choreography by name or path, read again when its file is another one. Raises FileError."""
    path = choreography_path(choreography)
    refuse_others(path)
    try:
        status = path.stat()
        version = (status.st_mtime_ns, status.st_size)
    except OSError:
        version = (0, 0)
    return _choreographer(choreography, version)


@lru_cache(maxsize=8)
def _choreographer(choreography: str, version: tuple[int, int]) -> Choreographer:
    return Choreographer(read_model(choreography_path(choreography)))


def unfit_choreography(player: Player) -> Message | None:
    """Why a player cannot dance what was selected; None where nothing was, or nothing is wrong with it."""
    choreography = player.parameters.choreography
    if not choreography:
        return None
    for message in choreography_missing(player.name, choreography):
        return message
    try:
        choreographer_of(choreography)
    except AppError as error:
        return error.message
    return None
