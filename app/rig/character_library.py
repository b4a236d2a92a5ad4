"""The characters a person can cast: the bundled ones and those of their own folder, read again when its files change.

A person's own character is a file (VRM, glTF or FBX) and beside it ``<id>.toml``, which names the file and says what
was corrected by hand: which bone is which joint, which morphs make a face. What is wrong with a file is told and the
last good version of it stays in use. Everybody asks `character_library`; `reload_characters` alone replaces it.

Messages
--------
character.missing : id, known
    "There is no character named '{id}'; known: {known}"
table.invalid : file, place, detail
    "{file}: {place}: {detail}"; and what `app.formats.toml` says
character.file_missing : file, name
    "{file} names {name}, which is not beside it"
character.odd_name : file
    "the name of {file} has characters that cannot be shown; rename it"
character.taken : file, id
    "{file} describes '{id}', which is a character of ours"
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache
from importlib.resources import files
from pathlib import Path
from threading import RLock
from types import MappingProxyType
from typing import Final, TypeAlias

import msgspec
import platformdirs

from app.encoding import shown
from app.errors import AppError, FileError, MapError, Message, UsageError, shortened
from app.formats.atomic import atomic_write
from app.formats.files import files_in, open_file, read_file
from app.formats.gltf.read import MOST_BYTES
from app.formats.toml import read_toml, shaped, toml
from app.rig.character import load_character
from app.rig.model import Character
from app.rig.read_figure import SUFFIXES

FOLDER_VARIABLE: Final = "SUISOU_CHARACTERS"
"""Environment variable that names another folder for a person's own characters."""
MOST_ID: Final = 60
MOST_TITLE: Final = 200
RESERVED: Final = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)", re.IGNORECASE)
"""Names that are devices on Windows."""

Stamp: TypeAlias = tuple[tuple[str, int, int], ...]
"""Names, times and sizes of files; and why a folder could not be listed."""


class CharacterEntry(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """What ``<id>.toml`` says.

    Attributes
    ----------
    file : str
        Name of the character's file, in the same folder.
    title : str
        What the character is called; empty: by its id.
    joints : dict of str to str
        By VRM 1.0 joint: the bone that is it, whatever its name suggests; empty: none is.
    morphs : dict of str to dict of str to float
        By ARKit name: weights of the file's own morphs that make it.
    """

    file: str
    title: str = ""
    joints: dict[str, str] = {}
    morphs: dict[str, dict[str, float]] = {}


@dataclass(frozen=True)
class Source:
    """Where a character comes from.

    Attributes
    ----------
    path : Path
        The character's file.
    entry : CharacterEntry or None
        What a person's own folder says about it; None: bundled.
    stamp : tuple
        The files as they were when they were read.
    """

    path: Path
    entry: CharacterEntry | None = None
    stamp: Stamp = ()


@dataclass(frozen=True)
class CharacterLibrary:
    """All characters, as they were when the folder was read.

    Attributes
    ----------
    folder : Path
        A person's own.
    sources : mapping of str to Source
        By id: first the bundled ones, then a person's own, each in the order of the ids.
    problems : mapping of Path to Message
        What is wrong with a person's files. Where an earlier version was good, ``sources`` has that.
    revisions : mapping of str to int
        How often the character of each id became another one; of those that never did, nothing.
    stamp : tuple
    """

    folder: Path
    sources: Mapping[str, Source]
    problems: Mapping[Path, Message] = field(default_factory=dict)
    revisions: Mapping[str, int] = field(default_factory=dict)
    stamp: Stamp = ()

    @property
    def own(self) -> Mapping[str, CharacterEntry]:
        """A person's own characters, by id."""
        return {id: source.entry for id, source in self.sources.items() if source.entry is not None}


def own_folder() -> Path:
    """Where a person's own characters are; need not exist."""
    named = os.environ.get(FOLDER_VARIABLE)
    return Path(named) if named else platformdirs.user_data_path("suisou", appauthor=False) / "characters"


@cache
def bundled_characters() -> Mapping[str, Path]:
    """Return the bundled characters: id and file, in the order of their ids. Looked up once."""
    folder = Path(str(files("resources"))) / "characters"
    return MappingProxyType({path.stem: path for path in sorted(folder.glob("*.glb"))})


def read_characters(folder: Path, before: CharacterLibrary | None = None) -> CharacterLibrary:
    """Read a person's folder anew.

    Parameters
    ----------
    folder : Path
        One that is not there holds no characters.
    before : CharacterLibrary, optional
        What was read before: the good versions of entries that are wrong now stay in use.
    """
    # Also the one that a program has called X.VRM.
    problems: dict[Path, Message] = {}
    try:
        listed = files_in(folder, ".toml", *SUFFIXES)
    except FileError as error:
        problems[folder] = error.message
        listed = []
    stamp = (*_stamp(listed), *((problem.id, 0, 0) for problem in problems.values()))
    if before is not None and before.folder == folder and before.stamp == stamp:
        return before
    bundled = {id: Source(path) for id, path in bundled_characters().items()}
    own: dict[str, Source] = {}
    for path in listed:
        if path.suffix.lower() != ".toml":
            continue
        try:
            own[path.stem] = _own_source(path)
        except AppError as error:
            problems[path] = error.message
            if before is not None and path.stem in before.own:
                own[path.stem] = before.sources[path.stem]
    sources = {**bundled, **own}
    revisions = dict(before.revisions) if before is not None else {}
    known = before.sources if before is not None else sources
    for id in {**sources, **known}:
        if sources.get(id) != known.get(id):
            revisions[id] = revisions.get(id, 0) + 1
    return CharacterLibrary(folder, sources, problems, revisions, stamp)


def _own_source(path: Path) -> Source:
    """The source of an entry. Raises FileError."""
    if not path.stem.isprintable():  # Bytes that are no UTF-8 are not printable either.
        raise FileError("character.odd_name", file=str(path))
    if path.stem in bundled_characters():
        # What is known of ours beforehand, their size and their holds, would not be true of another.
        raise FileError("character.taken", file=str(path), id=path.stem)
    entry = read_entry(path)
    file = path.parent / entry.file
    if not os.path.isfile(file):
        raise FileError("character.file_missing", file=str(path), name=entry.file)
    return Source(file, entry, _stamp([path, file]))


def read_entry(path: Path) -> CharacterEntry:
    """Read the description of a person's own character. Raises FileError, MapError."""
    entry = shaped(read_toml(path), CharacterEntry, str(path))
    if not _is_plain(entry.file):
        detail = f"{shortened(entry.file)!r} must be the name of a file in this folder ({', '.join(SUFFIXES)})"
        raise MapError("table.invalid", file=str(path), place="file", detail=detail)
    if len(entry.title) > MOST_TITLE:
        raise MapError("table.invalid", file=str(path), place="title", detail=f"at most {MOST_TITLE} characters")
    return entry


def _is_plain(name: str) -> bool:
    """Whether a name can only be that of a character's file in the same folder, on every system."""
    plain = not set(name) & set('<>:"/\\|?*') and name.isprintable() and not name.startswith(".")
    return plain and name.lower().endswith(SUFFIXES)


def _stamp(paths: list[Path]) -> Stamp:
    stamps = []
    for path in paths:
        try:
            status = path.stat()
        except OSError:
            continue  # Gone between listing and looking: as if it were not listed.
        stamps.append((path.name, status.st_mtime_ns, status.st_size))
    return tuple(stamps)


_lock = RLock()
_loading = RLock()
"""Held while a character is loaded, which may take seconds; never waited for with `_lock`."""
_library: CharacterLibrary | None = None
_good: dict[Path, Character] = {}
"""The last good version of each of a person's own files."""


def begin_characters() -> CharacterLibrary:
    """Have the bundled characters alone, unless the folder was read already: for a program that reads it beside its
    window (`reload_characters`)."""
    global _library
    with _lock:
        bundled = {id: Source(path) for id, path in bundled_characters().items()}
        _library = _library or CharacterLibrary(own_folder(), bundled)
        return _library


def character_library() -> CharacterLibrary:
    """Return the characters as they were last read; the first who asks reads them."""
    return _library if _library is not None else reload_characters()


def reload_characters() -> CharacterLibrary:
    """Read the person's folder again if something in it changed, and return what everybody gets from now on."""
    global _library
    with _lock:
        _library = read_characters(own_folder(), _library)
        return _library


def characters() -> Mapping[str, Path]:
    """Return all characters: id and file, first the bundled ones, then a person's own."""
    return {id: source.path for id, source in character_library().sources.items()}


def character_revision(id: str) -> int:
    """How often the character of an id became another one: what is kept for a character is kept for this too."""
    return character_library().revisions.get(id, 0)


def character_named(id: str) -> Character:
    """Return a character; loaded once per version of its files.

    Raises
    ------
    UsageError
        There is none of this id.
    FileError
        A person's own file holds none, and never did since the program began.
    """
    sources = character_library().sources
    if id not in sources:
        raise UsageError("character.missing", id=id, known=", ".join(sources))
    source = sources[id]
    with _loading:
        try:
            character = _opened(id, source)
        except FileError:
            if source.path not in _good:
                raise
            return _good[source.path]
        if source.entry is not None:
            _good[source.path] = character
        return character


def _opened(id: str, source: Source) -> Character:
    return _loaded(id, source.path, source.stamp, msgspec.json.encode(source.entry))


@lru_cache(maxsize=16)
def _loaded(id: str, path: Path, stamp: Stamp, entry: bytes) -> Character:
    """A character by the stamps of its files and what is said about it."""
    said = msgspec.json.decode(entry, type=CharacterEntry | None)
    return load_character(path) if said is None else load_character(path, id, said.joints, said.morphs)


def character_problems() -> Mapping[str, Message]:
    """What is wrong with a person's own characters, by id; those whose file has not been opened yet are opened."""
    found = {path.stem: problem for path, problem in character_library().problems.items()}
    for id, source in character_library().sources.items():
        if source.entry is not None and id not in found:
            try:
                _opened(id, source)
            except AppError as error:
                found[id] = error.message
    return found


def add_character(
    path: Path,
    title: str = "",
    joints: Mapping[str, str] | None = None,
    morphs: Mapping[str, Mapping[str, float]] | None = None,
) -> str:
    """Copy a character's file into the person's folder and describe it there.

    Parameters
    ----------
    path : Path
    title : str
        What it is called; by its file's name where empty.
    joints, morphs : mapping
        Corrections, as in `CharacterEntry`.

    Returns
    -------
    str
        Its id.

    Raises
    ------
    FileError
        It cannot play, or cannot be copied.
    """
    title = shortened(" ".join(title.split()), MOST_TITLE) or shown(path.stem)
    load_character(path, shown(path.stem), joints or {}, morphs or {})
    folder = own_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError("file.cannot_write", file=str(folder), reason=error.strerror or str(error)) from error
    with _lock:
        id = _free_id(title, folder)
        suffix = path.suffix.lower() if path.suffix.lower() in SUFFIXES else _suffix_of(path)
        content = read_file(path, MOST_BYTES)
        with atomic_write(folder / f"{id}{suffix}") as stream:
            stream.write(content)
        # A file without a description is nobody: what fails between the two leaves no half of a character.
        faces = {name: dict(parts) for name, parts in (morphs or {}).items()}
        write_entry(id, CharacterEntry(f"{id}{suffix}", title, dict(joints or {}), faces))
        return id


def write_entry(id: str, entry: CharacterEntry) -> None:
    """Describe one of a person's own characters, anew or for the first time, and read the folder again.

    Raises FileError ``file.cannot_write``.
    """
    table = {name: value for name, value in msgspec.to_builtins(entry).items() if name == "file" or value}
    with atomic_write(own_folder() / f"{id}.toml") as stream:
        stream.write(toml(table).encode())
    reload_characters()


def remove_character(id: str) -> None:
    """Remove one of a person's own characters, and its file if no other is made of it. Raises UsageError, FileError."""
    sources = reload_characters().sources
    source = sources.get(id)
    if source is None or source.entry is None:
        raise UsageError("character.missing", id=id, known=", ".join(character_library().own))
    shared = any(other.path == source.path for name, other in sources.items() if name != id)
    for path in (own_folder() / f"{id}.toml", *(() if shared else (source.path,))):
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise FileError("file.cannot_write", file=str(path), reason=error.strerror or str(error)) from error
    reload_characters()


def _free_id(title: str, folder: Path) -> str:
    """An id from a title that no character has and no file in the folder is called by."""
    stem = re.sub(r"[^a-z0-9]+", "_", title.lower()).strip("_")[:MOST_ID].strip("_") or "character"
    if RESERVED.fullmatch(stem):
        stem = f"character_{stem}"
    taken = {id.casefold() for id in reload_characters().sources}
    taken |= {path.stem.casefold() for path in folder.iterdir()}
    id, number = stem, 1
    while id in taken:
        number += 1
        id = f"{stem}_{number}"
    return id


def _suffix_of(path: Path) -> str:
    """The ending of a file that is not called as what it is."""
    with open_file(path) as opened:
        start = opened.read(16)
    return ".glb" if start.startswith(b"glTF") else ".fbx" if start.startswith(b"Kaydara") else ".gltf"
