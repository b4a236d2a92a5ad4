"""Digests of everything that a folder's exports are made from: what changed in it is exported again."""

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
"""Packages that decide what an export holds."""
_NOT_INSTALLED: Final = frozenset({"__pycache__", "build"})
"""Folders that a checkout has and an installation does not."""
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
"""Arguments that say where and how an export is made, not what it holds."""


@cache
def program_digest() -> str:
    """Digest of this program: version, code, tables, models and sounds, on every machine the same."""
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
    """Digest of the user's own tables, models and characters, by kind (the name of their folder)."""
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
    """Digest of everything that the exported files of a piece depend on.

    Parameters
    ----------
    arguments : Namespace
        Of the command ``export``; what only says where and how the work is done is left out.
    own : dict of str to str
        `own_digests`.
    """
    options = {name: repr(value) for name, value in sorted(vars(arguments).items()) if name not in _ELSEWHERE}
    digest = hashlib.sha256(json.dumps([program_digest(), options, own]).encode())
    paths = [piece, *_named_files(piece)]
    asset: Path | None = getattr(arguments, "check_skeleton", None)
    for path in (*paths, *(() if asset is None else (asset,))):
        _add(digest, path)
    return digest.hexdigest()


def _named_files(piece: Path) -> list[Path]:
    """The files that a project names and that its export reads: its recording and its choreographies."""
    if not is_project_file(piece):
        return []
    try:
        project = load(piece)
    except AppError:
        return []  # Its export reports what is wrong with it.
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
    """Add the names and the contents of the files in a folder, in the order of their names."""
    for path in sorted(path for path in paths if os.path.isfile(path)):
        digest.update(os.fsencode(f"{path.relative_to(folder).as_posix()}\0"))
        _add(digest, path)


def _add(digest: Any, path: Path) -> None:
    """Add the content of a file, or that it cannot be read."""
    try:
        with open_file(path) as stream:
            digest.update(hashlib.file_digest(stream, "sha256").digest())
    except (FileError, OSError):
        digest.update(b"unreadable")
