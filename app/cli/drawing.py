"""Shared options of commands that draw players: view, output file and cancelling."""

from __future__ import annotations

import argparse
import os
import signal
import threading
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from app.encoding import shown
from app.errors import FileError, StopRequested, UsageError
from app.project.camera_bookmarks import OF_INSTRUMENTS, CameraBookmark, View
from app.project.parameters import select_players

if TYPE_CHECKING:
    from app.project.model import Project


def kept_camera(project: Project, name: str) -> CameraBookmark:
    """Return the camera bookmark of a name, ignoring case. Raises UsageError if there is none."""
    found = next((camera for camera in project.cameras if camera.name.casefold() == name.casefold()), None)
    if found is None:
        known = ", ".join(camera.name for camera in project.cameras) or "-"
        raise UsageError("camera.unknown", name=name, known=known)
    return found


def parsed_view(
    arguments: argparse.Namespace, project: Project, of_all: Collection[View] = ()
) -> tuple[View, tuple[str, ...]]:
    """Return the requested view, and the ids of the performers in it.

    Parameters
    ----------
    of_all : collection of View
        Views of all performers unless players are named; the others are of the first. The ensemble view is always of
        all and gets no ids.

    Raises
    ------
    UsageError
        If a player is unknown, or an instrument view is requested of a dancer.
    """
    everyone = project.performers
    view: View = arguments.view or ("front" if arguments.players else "ensemble")
    if not arguments.players and view == "ensemble":
        return view, ()
    if arguments.players:
        chosen = [everyone[index] for index in select_players(arguments.players, [one.name for one in everyone])]
    else:
        chosen = list(everyone if view in of_all else everyone[:1])
    if view in OF_INSTRUMENTS and chosen[0].id in project.dancer_ids:
        raise UsageError("picture.dancer_view", dancer=chosen[0].name, view=view)
    return view, tuple(one.id for one in chosen)


def require_writable(path: Path, folder: Path) -> None:
    """Raise FileError if a folder does not exist or cannot be written to; the error names ``path``."""
    if not os.path.isdir(folder):
        raise FileError("file.cannot_write", file=str(path), reason=f"{shown(folder)} is not a folder")
    if not os.access(folder, os.W_OK):
        raise FileError("file.cannot_write", file=str(path), reason=f"{shown(folder)} cannot be written to")


def nearest(path: Path) -> Path:
    """Return the longest beginning of a path that exists."""
    return next((place for place in (path, *path.parents) if os.path.exists(place)), path)


@contextmanager
def stoppable() -> Iterator[StopRequested]:
    """Yield a function that returns whether Ctrl-C or a request to end (SIGTERM) was received, since an exception would
    be lost in Qt's calls.
    """
    stopped = threading.Event()

    def stop(number: int, frame: FrameType | None) -> None:
        stopped.set()

    before = [(number, signal.signal(number, stop)) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        yield stopped.is_set
    finally:
        for number, handler in before:
            signal.signal(number, handler)
