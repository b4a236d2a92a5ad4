"""Lookup of an Unreal project, and check that it can be written."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

from app.encoding import shown
from app.errors import FileError, shortened
from app.formats.files import cannot_read, read_file

LEAST_ENGINE: Final = (5, 2)
"""Oldest supported engine version; earlier ones have other functions for adding tracks."""
_MOST_BYTES: Final = 16 << 20


@dataclass(frozen=True)
class UnrealProject:
    """An Unreal Engine project.

    Attributes
    ----------
    file : path
        The ``.uproject`` file.
    engine : str
        Its ``EngineAssociation``: ``"5.6"``, the id of an engine built from source, or empty.
    version : (int, int) or None
        Version of the engine; None if the file does not contain it.
    """

    file: Path
    engine: str
    version: tuple[int, int] | None

    @property
    def folder(self) -> Path:
        """Return the folder of the project."""
        return self.file.parent

    @property
    def name(self) -> str:
        """Name of the project."""
        return shown(self.file.stem)


def find_project(path: Path) -> UnrealProject:
    """Find the project for a file or folder given by the user.

    Raises
    ------
    FileError
        There is no such project, or its file cannot be read.
    """
    try:
        found = _project_file(path)
        content = _content(found)
    except OSError as error:
        raise cannot_read(path, error) from error
    engine = content.get("EngineAssociation", "")
    if not isinstance(engine, str):
        raise FileError("unreal.not_a_project", file=os.fspath(found), detail="EngineAssociation is no text")
    numbers = re.match(r"(\d{1,4})\.(\d{1,4})(?:\D|$)", engine)
    version = None if numbers is None else (int(numbers[1]), int(numbers[2]))
    if version is not None and version < LEAST_ENGINE:
        least = ".".join(map(str, LEAST_ENGINE))
        raise FileError("unreal.too_old", file=os.fspath(found), version=engine, least=least)
    return UnrealProject(found, engine, version)


def require_writable(project: UnrealProject, paths: Iterable[PurePosixPath] = ()) -> None:
    """Raise FileError if a project's folder cannot be written, or if a file to be replaced is write-protected (even
    where the system would allow it).

    The ``.uproject`` file may be write-protected by version control, since it is not changed.
    """
    if not os.access(project.folder, os.W_OK | os.X_OK):
        raise FileError("unreal.read_only", file=os.fspath(project.folder))
    for path in paths:
        if not os.access(project.folder / path, os.W_OK):
            raise FileError("unreal.locked", file=os.fspath(project.folder / path))


def _project_file(path: Path) -> Path:
    if os.path.isdir(path):
        found = sorted(file for file in path.iterdir() if file.suffix.lower() == ".uproject" and os.path.isfile(file))
        if not found:
            raise FileError("unreal.no_project", file=os.fspath(path))
        if len(found) > 1:
            raise FileError("unreal.several", file=os.fspath(path), names=", ".join(file.name for file in found))
        return found[0].absolute()
    if not os.path.exists(path):
        raise FileError("unreal.not_found", file=os.fspath(path))
    if path.suffix.lower() != ".uproject" or not os.path.isfile(path):
        raise FileError("unreal.no_project", file=os.fspath(path))
    return path.absolute()


def _content(file: Path) -> dict[str, object]:
    """Return the JSON content of a project's file. Unreal writes UTF-8, or UTF-16 for non-ASCII content."""
    data = read_file(file, _MOST_BYTES)
    try:
        wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
        content = json.loads(data.decode("utf-16" if wide else "utf-8-sig"))
    except json.JSONDecodeError as error:
        detail = f"its text cannot be understood from line {error.lineno}, column {error.colno} on"
        raise FileError("unreal.not_a_project", file=os.fspath(file), detail=detail) from error
    except UnicodeDecodeError as error:
        raise FileError("unreal.not_a_project", file=os.fspath(file), detail="it is not text") from error
    except (ValueError, RecursionError) as error:
        raise FileError("unreal.not_a_project", file=os.fspath(file), detail=shortened(error)) from error
    if isinstance(content, dict) and isinstance(content.get("FileVersion"), int):
        return content
    raise FileError("unreal.not_a_project", file=os.fspath(file), detail="it has no FileVersion")
