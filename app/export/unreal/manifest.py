"""Manifest of our files: a list in each folder that we write into, with the digest of each file as written."""

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
    """Digest of one of our files. Line ends of texts count as ``\n``: version control may have changed them."""

    bytes: int
    sha256: str


class Manifest(msgspec.Struct, frozen=True):
    """The files of a folder that are ours, by their path in it. The manifest itself is ours too."""

    schema: int
    made_by: str
    files: dict[str, OwnFile]


@dataclass(frozen=True)
class Changes:
    """Effects of writing into a folder on its present files.

    Attributes
    ----------
    replaced, removed : tuple of path
        In the folder.
    kept : tuple of Message
        Leftovers that were changed by hand.
    staying : dict of path to OwnFile
        In the folder: what was asked to stay, as it was when we wrote it.
    """

    replaced: tuple[PurePosixPath, ...]
    removed: tuple[PurePosixPath, ...]
    kept: tuple[Message, ...]
    staying: dict[PurePosixPath, OwnFile]


def own_text(data: bytes) -> OwnFile:
    """Record of a text's content."""
    text = data.replace(b"\r\n", b"\n")
    return OwnFile(len(text), hashlib.sha256(text).hexdigest())


def own_file(path: Path) -> OwnFile:
    """Record of a file's content."""
    if path.suffix.lower() in _TEXTS:
        return own_text(read_file(path, MOST_BYTES))
    with open_file(path) as stream:
        return OwnFile(path.stat().st_size, hashlib.file_digest(stream, "sha256").hexdigest())


def is_as_left(path: Path, known: OwnFile, by_length: bool = False) -> bool:
    """Return whether a file holds what it did when we wrote it; by its length alone where no one is to wait."""
    if by_length and path.suffix.lower() not in _TEXTS:
        return path.stat().st_size == known.bytes
    return own_file(path) == known


def changes(
    folder: Path,
    coming: Collection[PurePosixPath],
    by_length: bool = False,
    stays: Collection[PurePosixPath] = (),
) -> Changes:
    """Effects on a folder of writing some files into it.

    Parameters
    ----------
    folder : path
    coming : collection of path
        In it.
    by_length : bool
        See `is_as_left`.
    stays : collection of path
        In it: what is not removed although it is not written.

    Raises
    ------
    FileError
        Something that would be replaced is not ours, or is not as we left it; the manifest is damaged.
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
    """The files of a folder that are ours; none where there is no manifest."""
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
    """The manifest of some files, as indented JSON."""
    manifest = Manifest(SCHEMA, creator, dict(sorted(files.items())))
    return msgspec.json.format(msgspec.json.encode(manifest), indent=1) + b"\n"
