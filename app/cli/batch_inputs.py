"""Digests of all inputs of a batch export, so that only pieces with changed inputs are exported again."""

from __future__ import annotations

import argparse
import hashlib
import json
import os
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from app.errors import AppError, FileError
from app.formats.files import files_in, open_file
from app.formats.user_folder import UserFolder
from app.project.choreography_files import choreography_path, is_bundled_name
from app.project.model import Project
from app.project.storage import is_project_file, load
from app.rig.characters.character_library import LIBRARY as CHARACTERS
from app.version import program_version
from instrument_maps.library import LIBRARY as INSTRUMENTS
from metadata.library import FOLDERS

OWN_FOLDERS: Final[tuple[UserFolder[Any, Any], ...]] = (INSTRUMENTS, CHARACTERS, *FOLDERS)
_ROOMS: Final = ("app", "instrument_maps", "metadata", "resources")
"""Packages whose content influences an export."""
_NOT_INSTALLED: Final = frozenset({"__pycache__", "build"})
"""Folders that exist in a checkout but not in an installation."""
_ELSEWHERE: Final = frozenset(
    {
        "file",
        "to",
        "jobs",
        "scheduler",
        "piece",
        "run",
        "given",
        "command",
        "language",
        "pitch_names",
        "middle_c",
        "pitches",
    }
)
"""Arguments that do not influence the content of an export."""


@cache
def program_digest() -> str:
    """Return a digest of the program (version, code, tables, models and sounds), equal on all machines."""
    digest = hashlib.sha256(program_version().encode())
    for room in _ROOMS:
        folder = Path(str(files(room)))
        _add_files(
            digest,
            folder,
            (path for path in folder.rglob("*") if _NOT_INSTALLED.isdisjoint(path.relative_to(folder).parts)),
        )
    return digest.hexdigest()


def own_digests() -> dict[str, str]:
    """Return digests of the user's own tables, models and characters by the name of their folder."""
    found = {}
    for kind in OWN_FOLDERS:
        digest = hashlib.sha256()
        try:
            _add_files(digest, kind.folder(), files_in(kind.folder(), *kind.suffixes))
        except FileError as error:
            digest.update(error.message.id.encode())
        found[kind.name] = digest.hexdigest()
    return found


def piece_digest(piece: Path, arguments: argparse.Namespace, own: dict[str, str]) -> str:
    """Return a digest of everything that a piece's exported files depend on.

    Parameters
    ----------
    arguments : Namespace
        Arguments of the command ``export``; those that only choose the output place or the speed of the export are
        ignored.
    own : dict of str to str
        Result of `own_digests`.
    """
    options = {name: repr(value) for name, value in sorted(vars(arguments).items()) if name not in _ELSEWHERE}
    digest = hashlib.sha256(json.dumps([program_digest(), options, own]).encode())
    paths = [piece, *_named_files(piece)]
    asset: Path | None = getattr(arguments, "check_skeleton", None)
    for path in (*paths, *(() if asset is None else (asset,))):
        _add(digest, path)
    return digest.hexdigest()


def _named_files(piece: Path) -> list[Path]:
    """Return the files that a project refers to and that its export reads: recording and choreographies."""
    if not is_project_file(piece):
        return []
    try:
        project = load(piece)
    except AppError:
        return []  # Exporting the piece reports the error.
    return [Path(path) for path in dict.fromkeys(_named(project))]


def _named(project: Project) -> Iterable[str]:
    if project.audio is not None:
        yield project.audio.path
    dances = (
        *(dancer.choreography for dancer in project.dancers),
        *(p.parameters.choreography for p in project.players),
    )
    for choreography in dances:
        if choreography and not is_bundled_name(choreography):
            yield str(choreography_path(choreography))


def _add_files(digest: Any, folder: Path, paths: Iterable[Path]) -> None:
    """Add the names and contents of a folder's files to a digest, ordered by name."""
    for path in sorted(path for path in paths if os.path.isfile(path)):
        digest.update(os.fsencode(f"{path.relative_to(folder).as_posix()}\0"))
        _add(digest, path)


def _add(digest: Any, path: Path) -> None:
    """Add the content of a file to a digest, or a mark if it cannot be read."""
    try:
        with open_file(path) as stream:
            digest.update(hashlib.file_digest(stream, "sha256").digest())
    except (FileError, OSError):
        digest.update(b"unreadable")
