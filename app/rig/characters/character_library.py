"""The available characters: bundled ones, and those in the user's own folder (see `app.formats.user_folder`).

A character of the user is a file (VRM, glTF or FBX) with ``<id>.toml`` beside it, which contains the file's name and
manual corrections of joints and face shapes. A person made from a bundled body has no file of its own, only
``<id>.toml``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.resources import files
from pathlib import Path
from threading import RLock
from types import MappingProxyType
from typing import Final

import msgspec

from app.encoding import shown
from app.errors import AppError, FileError, MapError, Message, UsageError, shortened
from app.formats.atomic import atomic_write
from app.formats.fbx.foreign_textures import media_folder
from app.formats.files import cannot_write
from app.formats.gltf.self_contained import read_whole
from app.formats.toml import read_toml, shaped, toml
from app.formats.user_folder import Read, Shelf, Stamp, UserFolder, stamp_of
from app.rig.characters.figure_build import PLAUSIBLE_M
from app.rig.characters.load_character import load_character
from app.rig.characters.read_figure import SUFFIXES, suffix_by_content
from app.rig.grip.body_size import arm_m
from app.rig.model import Character
from app.rig.people.bundled_people import bundled_people, bundled_person, person_arm_m, person_of
from app.rig.people.person import Person, checked

MOST_ID: Final = 60
MOST_TITLE: Final = 200
LEAST_M, MOST_M = PLAUSIBLE_M
"""Smallest and greatest height in metres that can be set for a character."""
RESERVED: Final = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)", re.IGNORECASE)
"""File names that are devices on Windows."""


class CharacterEntry(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Contents of ``<id>.toml``.

    Attributes
    ----------
    file : str
        Name of the character's file in the same folder; empty for a person.
    title : str
        Display name of the character; empty for the id.
    joints : dict of str to str
        Bone of each corrected VRM 1.0 joint, regardless of the bone's name; empty if there is no bone.
    morphs : dict of str to dict of str to float
        Weights of the file's morphs for each corrected ARKit shape.
    height_m : float
        Height of the character; 0 for the height in the file.
    hidden : list of str
        Meshes of the file that are hidden.
    person : Person or None
        Person made from a bundled body, instead of a file.
    """

    file: str = ""
    title: str = ""
    joints: dict[str, str] = {}
    morphs: dict[str, dict[str, float]] = {}
    height_m: float = 0.0
    hidden: list[str] = []
    person: Person | None = None


@dataclass(frozen=True)
class CharacterSource:
    """Origin of a character: a file or an entry in the library.

    Attributes
    ----------
    path : Path
        The character's file.
    entry : CharacterEntry or None
        Contents of ``<id>.toml`` in the user's folder; None for a bundled character.
    stamp : frozenset
        Size and time of change of the files when they were read.
    """

    path: Path
    entry: CharacterEntry | None = None
    stamp: Stamp = frozenset()


@dataclass(frozen=True)
class CharacterLibrary(Shelf[CharacterSource]):
    """All characters as of the last reading of the folder."""

    @property
    def sources(self) -> Mapping[str, CharacterSource]:
        """Sources by id: bundled ones, then the user's own, each sorted by id."""
        return self.items

    @property
    def own(self) -> Mapping[str, CharacterEntry]:
        """Entries of the user's own characters by id."""
        return {id: source.entry for id, source in self.sources.items() if source.entry is not None}


@cache
def bundled_characters() -> Mapping[str, Path]:
    """Return the files of the bundled bodies by id, in the order of their ids. Looked up once."""
    folder = Path(str(files("resources"))) / "characters"
    return MappingProxyType({path.stem: path for path in sorted(folder.glob("*.glb"))})


@cache
def our_characters() -> Mapping[str, Path]:
    """Return the paths of all bundled characters by id: complete bodies, then people made from them."""
    return MappingProxyType({**bundled_characters(), **bundled_people()})


@cache
def _bundled() -> Mapping[str, CharacterSource]:
    return {id: CharacterSource(path) for id, path in our_characters().items()}


def _own_source(path: Path) -> Read[CharacterSource]:
    """Read the source of a user's character by the path of its entry. Raises FileError."""
    if not path.stem.isprintable():  # bytes that are not UTF-8 are not printable either
        raise FileError("character.odd_name", file=str(path))
    if path.stem in our_characters():
        # Known sizes and holds of the bundled character would not apply to another one with its id.
        raise FileError("character.taken", file=str(path), id=path.stem)
    entry = read_entry(path)
    if entry.person is not None:
        return Read(CharacterSource(path, entry, stamp_of([path])), (path,))
    file = path.parent / entry.file
    if not os.path.isfile(file):
        raise FileError("character.file_missing", file=str(path), name=entry.file)
    return Read(CharacterSource(file, entry, stamp_of([path, file])), (path, file))


def read_entry(path: Path) -> CharacterEntry:
    """Read the entry (``<id>.toml``) of a character of the user. Raises FileError, MapError."""
    entry = shaped(read_toml(path), CharacterEntry, str(path))
    if entry.person is not None:
        checked(entry.person, str(path))
    if bool(entry.file) is (entry.person is not None) or (entry.file and not _is_plain(entry.file)):
        detail = f"{shortened(entry.file)!r} must be the name of a file in this folder ({', '.join(SUFFIXES)})"
        raise MapError("table.invalid", file=str(path), place="file", detail=detail)
    if len(entry.title) > MOST_TITLE:
        raise MapError("table.invalid", file=str(path), place="title", detail=f"at most {MOST_TITLE} characters")
    if entry.height_m and not LEAST_M <= entry.height_m <= MOST_M:
        detail = f"a height is {LEAST_M:g} to {MOST_M:g} m, or 0: as in the file"
        raise MapError("table.invalid", file=str(path), place="height_m", detail=detail)
    return entry


def _is_plain(name: str) -> bool:
    """Return whether a name is valid on every system for a character's file in the same folder."""
    plain = not set(name) & set('<>:"/\\|?*') and name.isprintable() and not name.startswith(".")
    return plain and name.lower().endswith(SUFFIXES)


LIBRARY: Final = UserFolder("characters", SUFFIXES, CharacterLibrary, _bundled, _own_source)
FOLDER_VARIABLE: Final = LIBRARY.variable
own_folder, begin_characters = LIBRARY.folder, LIBRARY.begin
character_library, reload_characters = LIBRARY.now, LIBRARY.reload
_loading = RLock()
"""Lock held while a character is loaded, which may take seconds; never awaited while holding the library's lock."""
_good: dict[Path, Character] = {}
"""Last valid version of each of the user's own files."""


def characters() -> Mapping[str, Path]:
    """Return the id and file of all characters: bundled ones, then the user's own."""
    return {id: source.path for id, source in character_library().sources.items()}


def character_revision(id: str) -> int:
    """Return the number of times that the character with an id was replaced, as part of cache keys."""
    return character_library().revisions.get(id, 0)


def character_named(id: str) -> Character:
    """Return a character, loading it once per version of its files.

    Raises
    ------
    UsageError
        The id is unknown.
    FileError
        The user's file contains no valid character, and has not done so since the program started.
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


@cache
def our_arm_m(id: str) -> float:
    """Return the length of a bundled character's right arm (upper and lower) in metres without building the
    character.
    """
    if id in bundled_people():
        return person_arm_m(bundled_person(id), character_named)
    return arm_m(character_named(id).skeleton, "right")


def _opened(id: str, source: CharacterSource) -> Character:
    return _loaded(id, source.path, source.stamp, msgspec.json.encode(source.entry))


@lru_cache(maxsize=48)
def _loaded(id: str, path: Path, stamp: Stamp, entry: bytes) -> Character:
    """Return the character of an id, by the state of its files and its entry."""
    said = msgspec.json.decode(entry, type=CharacterEntry | None)
    if said is None:
        return person_of(id, bundled_person(id), character_named) if id in bundled_people() else load_character(path)
    if said.person is not None:
        return person_of(id, said.person, character_named)
    return load_character(path, id, said.joints, said.morphs, said.height_m, said.hidden)


def carriage_of(id: str, instrument_id: str) -> tuple[float, float, float] | None:
    """Return the carriage of an instrument by a person: pitch, yaw and roll as in `Person.carriages`; None for the
    usual one.
    """
    entry = character_library().own.get(id)
    person = bundled_person(id) if id in bundled_people() else None if entry is None else entry.person
    return None if person is None else person.carriages.get(instrument_id)


def character_problems() -> Mapping[str, Message]:
    """Return the problems of the user's own characters by id, opening files that have not been opened yet."""
    found = {path.stem: problems[0] for path, problems in character_library().problems.items()}
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
    height_m: float = 0.0,
    hidden: Collection[str] = (),
) -> str:
    """Copy a character's file and the files it needs into the user's folder, and write its entry.

    Parameters
    ----------
    title : str
        Display name; empty for the file's name.
    joints, morphs, height_m, hidden
        Corrections, as in `CharacterEntry`.

    Returns
    -------
    str
        Id of the character.

    Raises
    ------
    FileError
        The figure cannot play, or cannot be copied.
    """
    title = shortened(" ".join(title.split()), MOST_TITLE) or shown(path.stem)
    load_character(path, shown(path.stem), joints or {}, morphs or {}, height_m, hidden)
    folder = own_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error) from error
    with LIBRARY.lock:
        id = _free_id(title, folder)
        suffix = _suffix_of(path)
        content = read_whole(path)
        if suffix == ".fbx":
            _keep_images(path, media_folder(folder / f"{id}{suffix}"))
        with atomic_write(folder / f"{id}{suffix}") as stream:
            stream.write(content)
        # The description is written last: a file without one is not a character, so a failure in between leaves no half
        # of one.
        faces = {name: dict(parts) for name, parts in (morphs or {}).items()}
        write_entry(id, CharacterEntry(f"{id}{suffix}", title, dict(joints or {}), faces, height_m, list(hidden)))
        return id


def _keep_images(path: Path, folder: Path) -> None:
    """Copy into a folder the images that an FBX file uses and that are next to it. Raises FileError."""
    from app.rig.characters.figure_fbx import fbx_images  # starts a process, only for FBX files

    images = fbx_images(path)
    if not images:
        return
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error) from error
    for name, content in images.items():
        with atomic_write(folder / name) as stream:
            stream.write(content)


def add_person(person: Person, title: str) -> str:
    """Store a person in the user's folder, and return its id. Raises FileError, MapError."""
    title = shortened(" ".join(title.split()), MOST_TITLE)
    checked(person, title)
    folder = own_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error) from error
    with LIBRARY.lock:
        id = _free_id(title, folder)
        write_entry(id, CharacterEntry(title=title, person=person))
        return id


def write_entry(id: str, entry: CharacterEntry) -> None:
    """Write the entry of one of the user's own characters, and read the folder again.

    Raises FileError if the entry cannot be written.
    """
    table = {name: value for name, value in msgspec.to_builtins(entry).items() if value}
    with atomic_write(own_folder() / f"{id}.toml") as stream:
        stream.write(toml(table).encode())
    reload_characters()


def remove_character(id: str) -> None:
    """Remove one of the user's own characters, and its file if no other character uses it. Raises UsageError,
    FileError.
    """
    sources = reload_characters().sources
    source = sources.get(id)
    if source is None or source.entry is None:
        raise UsageError("character.missing", id=id, known=", ".join(character_library().own))
    shared = any(other.path == source.path for name, other in sources.items() if name != id)
    images = media_folder(source.path)
    beside = () if shared or not os.path.isdir(images) else tuple(images.iterdir())
    for path in (own_folder() / f"{id}.toml", *(() if shared else (source.path, *beside))):
        try:
            path.unlink(missing_ok=True)
            if path in beside[-1:]:
                images.rmdir()
        except OSError as error:
            raise cannot_write(path, error) from error
    reload_characters()


def _free_id(title: str, folder: Path) -> str:
    """Return an unused id derived from a title."""
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
    """Return the suffix that fits a character's file by its content; the name only distinguishes VRM from GLB."""
    suffix = suffix_by_content(path)
    return ".vrm" if suffix == ".glb" and path.suffix.lower() == ".vrm" else suffix
