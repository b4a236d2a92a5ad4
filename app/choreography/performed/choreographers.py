"""Choreographies by name or path, cached while their files are unchanged."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from app.choreography.generate import Choreographer
from app.choreography.model_file import read_model
from app.errors import AppError, Message
from app.formats.other_computers import refuse_others
from app.plan.model import TimeFrame
from app.project.choreography_files import choreography_path
from app.project.performers import Player
from app.project.storage import choreography_missing

MOST_DANCED_S: Final = 900.0
"""Longest performance in seconds that is danced to: two seconds of a dance take a megabyte and a hundredth of a
second.
"""


def choreographer_of(choreography: str) -> Choreographer:
    """Return the choreography with this name or path, ready for generating; its file is read again if it has changed.
    Raises FileError.
    """
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


def too_long_to_dance(frame: TimeFrame) -> Message | None:
    """Return the reason why a performance is too long for a dance, which is generated as a whole; None if it is not."""
    length_s = frame.end_s - frame.first_frame_s
    if length_s <= MOST_DANCED_S:
        return None
    return Message("dance.too_long", {"minutes": round(length_s / 60.0), "most": round(MOST_DANCED_S / 60.0)})


def unfit_choreography(player: Player, frame: TimeFrame) -> Message | None:
    """Return the reason why a player cannot dance the selected choreography; None if it can or none is selected."""
    choreography = player.parameters.choreography
    if not choreography:
        return None
    if (too_long := too_long_to_dance(frame)) is not None:
        return too_long
    for message in choreography_missing(player.name, choreography):
        return message
    try:
        choreographer_of(choreography)
    except AppError as error:
        return error.message
    return None
