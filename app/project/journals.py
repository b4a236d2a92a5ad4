"""Folders of running takes' journals: beside the project's file; without a file, beside its unsaved work. A journal
whose disk is full goes on in a second place."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from app.errors import AppError
from app.formats.locks import is_locked

SUFFIX: Final = ".take-journal"


def journal_path(document: Path | None, *stems: Path) -> Path:
    """A name for a new journal.

    Parameters
    ----------
    document : Path or None
        The project's file.
    *stems : Path
        What the unsaved work of a project without a file is called, without a suffix; the first is this editor's.

    Raises
    ------
    AppError
        ``record.no_place``: the project has no file, and nowhere to keep unsaved work either.
    """
    if document is None and not stems:
        raise AppError("record.no_place")
    beside = document if document is not None else stems[0]
    moment = datetime.fromtimestamp(time.time(), UTC).strftime("%Y%m%d-%H%M%S-%f")
    return beside.with_name(f"{beside.name}.{moment}{SUFFIX}")


def second_path(first: Path, *stems: Path) -> Path:
    """Return where a journal goes on whose own disk takes nothing more.

    Parameters
    ----------
    first : Path
        As `journal_path` gave it.
    *stems : Path
        As there: of a project with a file the second place is where unsaved work is kept.
    """
    name, moment, _ = first.name.rsplit(".", 2)
    stem = stems[0].name if stems else name
    folder = second_folder(first.parent, *(stem.parent for stem in stems[:1]))
    return folder / f"{stem}.{moment}{SUFFIX}"


def second_folder(first: Path, *folders: Path) -> Path:
    """The first of some folders, and of the system's for temporary files, that is on another disk than ``first``, or
    else is another one; those that cannot be made are left out."""
    temporary = Path(tempfile.gettempdir())
    found: list[tuple[bool, bool, int, Path]] = []
    for number, folder in enumerate((*folders, temporary)):
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            found.append((folder.stat().st_dev == first.stat().st_dev, folder == first, number, folder))
    return min(found)[-1] if found else temporary


def journals_of(document: Path | None, *stems: Path) -> tuple[Path, ...]:
    """The journals that belong to a project by their names and that no one writes any more, the oldest first."""
    besides = (*stems, *((document,) if document is not None else ()))
    return tuple(
        path
        for beside in (*besides, *(Path(tempfile.gettempdir()) / stem.name for stem in stems))
        for path in _left_in(beside.parent)
        if path.name.startswith(f"{beside.name}.")
    )


def in_second_places(*stems: Path) -> tuple[Path, ...]:
    """Journals of any project that no one writes any more, in the folders where one of a project with a file may have
    gone on."""
    folders = dict.fromkeys((*(stem.parent for stem in stems), Path(tempfile.gettempdir())))
    return tuple(path for folder in folders for path in _left_in(folder))


def _left_in(folder: Path) -> Iterator[Path]:
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return
    is_shared = folder == Path(tempfile.gettempdir())
    for path in entries:
        if path.name.endswith(SUFFIX) and _is_left(path) and not (is_shared and _is_of_another_user(path)):
            yield path


def _is_left(path: Path) -> bool:
    """Return whether it is a file that no one writes any more. A link is none of ours; where it leads is not opened."""
    return os.path.isfile(path) and not os.path.islink(path) and not is_locked(path)


def _is_of_another_user(path: Path) -> bool:
    # On Windows every user has a folder for temporary files.
    return sys.platform != "win32" and path.lstat().st_uid != os.getuid()
