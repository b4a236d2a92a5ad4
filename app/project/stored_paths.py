"""Converts paths between their stored form in project files and absolute paths."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import TypeVar

import msgspec

from app.encoding import PREFIX, restored, stored
from app.project.choreography_files import is_bundled_name
from app.project.performers import Player
from app.project.recording import AudioTrack
from app.project.video import VideoTrack

Track = TypeVar("Track", AudioTrack, VideoTrack)


def moved_track(track: Track | None, path: Callable[[str, Path], str], folder: Path) -> Track | None:
    """Return a recording or video with its path converted by ``path`` to the stored or the absolute form."""
    return None if track is None else msgspec.structs.replace(track, path=path(track.path, folder))


def stored_path(path: str, folder: Path) -> str:
    """Return a path in stored form: relative with slashes if it shares a folder below the root with the
    project's file.
    """
    if path and Path(path).is_absolute():
        try:
            shared = Path(os.path.commonpath([path, folder]))
        except ValueError:  # on different drives
            return stored(path)
        if shared != Path(shared.anchor):
            path = Path(os.path.relpath(path, folder)).as_posix()
    return stored(path)


def full_path(path: str, folder: Path) -> str:
    """Return an absolute path from a stored one; a path that is absolute only on another system stays unchanged."""
    path = restored(path)
    if not path or path.startswith(PREFIX) or PurePosixPath(path).is_absolute() or PureWindowsPath(path).is_absolute():
        return path
    return os.path.normpath(folder / path)


def stored_choreography(choreography: str, folder: Path) -> str:
    """Return the stored form of a choreography's path; empty values and names of bundled choreographies are returned
    unchanged.
    """
    return stored_path(choreography, folder) if choreography and not is_bundled_name(choreography) else choreography


def full_choreography(choreography: str, folder: Path) -> str:
    return full_path(choreography, folder) if choreography and not is_bundled_name(choreography) else choreography


def with_choreography(player: Player, choreography: str) -> Player:
    """Return a player with another choreography in the parameters."""
    if choreography == player.parameters.choreography:
        return player
    parameters = msgspec.structs.replace(player.parameters, choreography=choreography)
    return msgspec.structs.replace(player, parameters=parameters)
