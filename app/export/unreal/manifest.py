"""Manifest of exported files in each folder, with the hash of each file as written."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

import msgspec

from app.errors import FileError, Message, shortened
from app.export.tree import stays_inside
from app.export.unreal.layout import MANIFEST
from app.formats.files import open_file, read_file
from app.formats.json_data import decode_json

SCHEMA: Final = 1
MOST_BYTES: Final = 2**26
_TEXTS: Final = frozenset((".json", ".py", ".uplugin"))


class OwnFile(msgspec.Struct, frozen=True):
    """Size and hash of an exported file. Line ends of texts are normalised to ``\\n`` first, since version control may
    change them.
    """

    bytes: int
    sha256: str


class Manifest(msgspec.Struct, frozen=True):
    """List of the files that this program wrote into a folder, with their hashes by relative path."""

    schema: int
    made_by: str
    files: dict[str, OwnFile]


@dataclass(frozen=True)
class Changes:
    """Effects on the existing files of a folder of writing into it.

    Attributes
    ----------
    replaced, removed : tuple of path
        Paths within the folder of files that will be replaced and removed.
    kept : tuple of Message
        Messages about obsolete files that were changed by hand, which are kept.
    staying : dict of path to OwnFile
        Files that were requested to stay, with their state when written.
    """

    replaced: tuple[PurePosixPath, ...]
    removed: tuple[PurePosixPath, ...]
    kept: tuple[Message, ...]
    staying: dict[PurePosixPath, OwnFile]


def own_text(data: bytes) -> OwnFile:
    """Return size and SHA-256 of a text for the manifest, with line ends made uniform."""
    text = data.replace(b"\r\n", b"\n")
    return OwnFile(len(text), hashlib.sha256(text).hexdigest())


def own_file(path: Path) -> OwnFile:
    """Return size and SHA-256 of a file for the manifest; line ends of text files are made uniform first."""
    if path.suffix.lower() in _TEXTS:
        return own_text(read_file(path, MOST_BYTES))
    with open_file(path) as stream:
        return OwnFile(path.stat().st_size, hashlib.file_digest(stream, "sha256").hexdigest())


def is_as_left(path: Path, known: OwnFile, by_length: bool = False) -> bool:
    """Return whether a file is unchanged since it was written; ``by_length`` compares only its size, which is fast."""
    if by_length and path.suffix.lower() not in _TEXTS:
        return path.stat().st_size == known.bytes
    return own_file(path) == known


def changes(
    folder: Path,
    coming: Collection[PurePosixPath],
    by_length: bool = False,
    stays: Collection[PurePosixPath] = (),
) -> Changes:
    """Determine the effects of writing some files into a folder.

    Parameters
    ----------
    folder : path
        The folder.
    coming : collection of path
        Paths within the folder of the files to write.
    by_length : bool
        See `is_as_left`.
    stays : collection of path
        Paths within the folder that are kept although not written.

    Raises
    ------
    FileError
        A file to be replaced was not written by this program or was changed since, or the manifest is damaged.
    """
    own = read_manifest(folder)
    replaced = []
    for path in sorted(coming):
        there = folder / path
        if path == PurePosixPath(MANIFEST):
            if os.path.exists(there):
                replaced.append(path)
        elif os.path.exists(there) or os.path.islink(there):
            known = own.get(path)
            if known is None or not os.path.isfile(there):
                raise FileError("unreal.in_the_way", file=os.fspath(there))
            if not is_as_left(there, known, by_length):
                raise FileError("unreal.changed", file=os.fspath(there))
            replaced.append(path)
    removed, kept = [], []
    for path, known in sorted(own.items()):
        there = folder / path
        if path not in coming and path not in stays and os.path.isfile(there):
            if is_as_left(there, known, by_length):
                removed.append(path)
            else:
                kept.append(Message("unreal.kept", {"file": os.fspath(there)}))
    staying = {path: known for path, known in own.items() if path in stays and path not in coming}
    return Changes(tuple(replaced), tuple(removed), tuple(kept), staying)


def read_manifest(folder: Path) -> dict[PurePosixPath, OwnFile]:
    """Return the files that earlier exports wrote into a folder; empty without a manifest."""
    path = folder / MANIFEST
    if not os.path.exists(path):
        return {}
    try:
        manifest = decode_json(read_file(path, MOST_BYTES), Manifest, os.fspath(path))
    except FileError as error:
        detail = error.message.arguments.get("detail", error.message.id)
        raise FileError("unreal.manifest", file=os.fspath(path), detail=detail) from error
    for name in manifest.files:
        if not stays_inside(name):
            raise FileError("unreal.manifest", file=os.fspath(path), detail=repr(shortened(name)))
    return {PurePosixPath(name): own for name, own in manifest.files.items()}


def encode_manifest(files: Mapping[str, OwnFile], creator: str) -> bytes:
    """Return a manifest of files as indented JSON: size and checksum by path, and the program that wrote them."""
    manifest = Manifest(SCHEMA, creator, dict(sorted(files.items())))
    return msgspec.json.format(msgspec.json.encode(manifest), indent=1) + b"\n"
