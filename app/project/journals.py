"""Paths of recording journals: next to the project's file or, without one, next to its autosave. If that disk is full,
the journal continues in another folder.
"""

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
    """Return an unused path for a new journal.

    Parameters
    ----------
    document : Path or None
        The project's file.
    *stems : Path
        For a project without a file: paths of its autosaves, without suffix; the first is this editor's.

    Raises
    ------
    AppError
        The project has no file, and there is no folder for unsaved work either.
    """
    if document is None and not stems:
        raise AppError("record.no_place")
    beside = document if document is not None else stems[0]
    moment = datetime.fromtimestamp(time.time(), UTC).strftime("%Y%m%d-%H%M%S-%f")
    return beside.with_name(f"{beside.name}.{moment}{SUFFIX}")


def second_path(first: Path, *stems: Path) -> Path:
    """Return the path at which a journal continues when its disk is full.

    Parameters
    ----------
    first : Path
        Path of the journal, from `journal_path`.
    *stems : Path
        See `journal_path`; for a project with a file, the journal continues in the folder of unsaved work.
    """
    name, moment, _ = first.name.rsplit(".", 2)
    stem = stems[0].name if stems else name
    folder = second_folder(first.parent, *(stem.parent for stem in stems[:1]))
    return folder / f"{stem}.{moment}{SUFFIX}"


def second_folder(first: Path, *folders: Path) -> Path:
    """Return the first of some folders and the system's temporary folder that is on another disk than ``first``, or
    else in another folder. Folders that cannot be created are skipped.
    """
    temporary = Path(tempfile.gettempdir())
    found: list[tuple[bool, bool, int, Path]] = []
    for number, folder in enumerate((*folders, temporary)):
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            found.append((folder.stat().st_dev == first.stat().st_dev, folder == first, number, folder))
    return min(found)[-1] if found else temporary


def journals_of(document: Path | None, *stems: Path) -> tuple[Path, ...]:
    """Return the journals of a project that no process is writing, oldest first."""
    besides = (*stems, *((document,) if document is not None else ()))
    return tuple(
        path
        for beside in (*besides, *(Path(tempfile.gettempdir()) / stem.name for stem in stems))
        for path in _left_in(beside.parent)
        if path.name.startswith(f"{beside.name}.")
    )


def in_second_places(*stems: Path) -> tuple[Path, ...]:
    """Return the journals of any project that no process is writing, in the folders used if a disk is full."""
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
    """Return whether a path is a regular file that no process is writing. Links are never followed."""
    return os.path.isfile(path) and not os.path.islink(path) and not is_locked(path)


def _is_of_another_user(path: Path) -> bool:
    # On Windows each user has a temporary folder of their own.
    return sys.platform != "win32" and path.lstat().st_uid != os.getuid()
