"""Exports a project's piece as a MIDI file with the players' parts and names."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from app.errors import FileError, Message
from app.formats.other_computers import may_touch
from app.project.model import Project, map_choices
from app.score.write import PartPlayer, write_midi
from instrument_maps.model import InstrumentMap


def export_midi(project: Project, path: Path, maps: Mapping[str, InstrumentMap]) -> tuple[Message, ...]:
    """Write the piece including all edits and recordings; returns warnings about content that the file cannot hold.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        Maps by id. If a player's map is missing, the part's own instrument is written.

    Raises
    ------
    AppError
        The file cannot be written (see `app.score.write`), or it would overwrite the project's source.
    """
    _keep_source(project, path)
    performers: dict[str, PartPlayer] = {}
    for player in project.players:
        if player.instrument_id in maps:
            [choice] = map_choices([maps[player.instrument_id]])
            performers.setdefault(player.part_id, PartPlayer(player.name, choice))
    return write_midi(project.score, path, performers)


def _keep_source(project: Project, path: Path) -> None:
    """Raise AppError if the path is the project's source file, which holds more than the project."""
    if not project.score.unplayed or not project.source:
        return
    if not may_touch(project.source):
        return  # The file's computer is not accessed without consent, which choosing that file would have given.
    try:
        same = path.samefile(project.source)
    except OSError:
        return  # one of the two files does not exist
    if same:
        raise FileError("midi.onto_source", file=str(path), count=len(project.score.unplayed))
