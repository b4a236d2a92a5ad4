"""Where the journals of running takes lie: beside the project's file; of a project without one, where its unsaved work
is kept."""

from __future__ import annotations

import os
import time
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


def journals_of(document: Path | None, *stems: Path) -> tuple[Path, ...]:
    """The journals that belong to a project and that no one writes any more, the oldest first."""
    found = []
    for beside in (*stems, *((document,) if document is not None else ())):
        try:
            entries = sorted(beside.parent.iterdir())
        except OSError:
            continue
        found += [
            path
            for path in entries
            if path.name.startswith(f"{beside.name}.") and path.name.endswith(SUFFIX) and _is_left(path)
        ]
    return tuple(found)


def _is_left(path: Path) -> bool:
    """Whether it is a file, which no one writes any more. A link is none of ours, and where it leads is not opened."""
    return os.path.isfile(path) and not os.path.islink(path) and not is_locked(path)
