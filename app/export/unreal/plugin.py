"""Installation of the importing plug-in in an Unreal project that has none or an older version.

The project's own file is not changed: a plug-in in its folder is enabled automatically, and enables those it needs.
"""

from __future__ import annotations

import json
import os
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import Final

from app.errors import FileError
from app.export.unreal.layout import MANIFEST, PLUGIN
from app.export.unreal.manifest import MOST_BYTES, own_text, read_manifest
from app.formats.files import read_file

DESCRIPTOR: Final = "Suisou.uplugin"
CREATED_BY: Final = "Suisou"


def plugin_files() -> dict[PurePosixPath, bytes]:
    """Return the content of the plug-in's files, by path in its folder."""
    return dict(sorted(_below(Path(str(files("resources"))) / "unreal" / "Suisou", PurePosixPath())))


def requested_plugin(folder: Path) -> dict[PurePosixPath, bytes]:
    """Return the plug-in's files to write into a project's folder: all, or none if it is up to date.

    Raises
    ------
    FileError
        There is a plug-in of that name by someone else, or the manifest is damaged.
    """
    own = plugin_files()
    place = folder / PLUGIN
    if not os.path.exists(place):
        return own
    there = _version(read_file(place / DESCRIPTOR, MOST_BYTES)) if os.path.isfile(place / DESCRIPTOR) else None
    if there is None and any(path.name != MANIFEST for path in place.iterdir()):
        raise FileError("unreal.plugin_foreign", file=os.fspath(place))
    newest = _version(own[PurePosixPath(DESCRIPTOR)])
    if there is not None and newest is not None and there > newest:
        return {}
    same = read_manifest(place) == {path: own_text(data) for path, data in own.items()}
    return {} if there is not None and same else own


def _version(descriptor: bytes) -> int | None:
    """Return the version of this program's plug-in from its descriptor; None for other plug-ins."""
    try:
        content = json.loads(descriptor.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        return None
    if not isinstance(content, dict) or content.get("CreatedBy") != CREATED_BY:
        return None
    version = content.get("Version")
    return version if isinstance(version, int) else None


def _below(folder: Path, path: PurePosixPath) -> list[tuple[PurePosixPath, bytes]]:
    found: list[tuple[PurePosixPath, bytes]] = []
    for entry in folder.iterdir():
        if os.path.isdir(entry):
            if entry.name != "__pycache__":
                found += _below(entry, path / entry.name)
        else:
            found.append((path / entry.name, entry.read_bytes()))
    return found
