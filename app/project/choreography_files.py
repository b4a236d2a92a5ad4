"""Bundled choreographies, and the paths of choreography files."""

from __future__ import annotations

import os
import re
from functools import cache
from importlib.resources import files
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Final

SUFFIX: Final = ".choreography"

_NAME: Final = re.compile(r"[a-z0-9][a-z0-9_-]{0,59}", re.ASCII)


@cache
def bundled_choreographies() -> tuple[str, ...]:
    """Return the names of the bundled choreographies, sorted."""
    folder = _folder()
    if not os.path.isdir(folder):
        return ()
    return tuple(sorted(path.stem for path in folder.iterdir() if path.suffix == SUFFIX and is_bundled_name(path.stem)))


def is_bundled_name(choreography: str) -> bool:
    """Return whether a text can be the name of a bundled choreography, also of another version, and not a path: it has
    neither separator nor suffix.
    """
    return _NAME.fullmatch(choreography) is not None


def is_choreography(choreography: str) -> bool:
    """Return whether a text can identify a choreography: a bundled name, or an absolute path of a ``.choreography``
    file on any system.
    """
    if is_bundled_name(choreography):
        return True
    absolute = PurePosixPath(choreography).is_absolute() or PureWindowsPath(choreography).is_absolute()
    return absolute and "\0" not in choreography and choreography.casefold().endswith(SUFFIX)


def choreography_path(choreography: str) -> Path:
    """Return the path of a choreography's file: bundled, or the path itself."""
    return _folder() / f"{choreography}{SUFFIX}" if is_bundled_name(choreography) else Path(choreography)


def _folder() -> Path:
    return Path(str(files("resources"))) / "choreographies"
