"""Project files: one readable JSON document, written whole or not at all.

The file says its version first; older ones are migrated (`app.project.migrations`), newer ones refused. Paths of media
are kept relative to the file where both lie in one tree, so that a folder can be moved or sent. Whatever a file holds,
names are only texts: nothing but the recording, the MIDI file it came from and a choreography's file is ever a path.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

import msgspec

from app.encoding import restored, shown
from app.errors import FileError, Message, shortened
from app.formats.atomic import atomic_write
from app.formats.files import open_file, read_file
from app.formats.json_data import UNREADABLE, decode_json
from app.formats.other_computers import host_of, is_file, may_touch
from app.plan.by_hand.corrections import Correction
from app.project.check import faults
from app.project.check_stored import plain_number
from app.project.choreography_files import bundled_choreographies, choreography_path, is_bundled_name
from app.project.dance_corrections import DanceCorrection
from app.project.migrations import CURRENT, VERSION_KEY, migrated
from app.project.model import Project
from app.project.stored_content import Content, content_of, project_of
from app.rig.characters.character_library import characters
from app.rig.people.wardrobe import wardrobe
from instrument_maps.library import all_maps

SUFFIX: Final = ".suisou"
BACKUP: Final = ".bak"
"""Suffix of the backup: the file as it was before it was last saved."""

AUTOSAVE: Final = ".autosave"
"""Put behind the file's name: the work on it that is not saved yet."""

MOST_BYTES: Final = 256 * 2**20


class Autosaved(msgspec.Struct, frozen=True):
    """Facts of an autosave, under the key ``autosave``; a saved file does not have it.

    Nothing here depends on a clock: one may have been set back.

    Attributes
    ----------
    work : str
        The same for all autosaves from opening a project to saving or closing it, also across a crash and a recovery.
    generation : int
        Ascends within a work: the highest is the newest.
    editor : str
        Token of the editor that wrote it (`app.project.running_editors`).
    document : str
        Absolute path of the project's file (`app.encoding.stored`); empty for a project that was never saved.
    base : str
        `content_hash` of that file when the work on it began; empty where it was not there.
    """

    work: str
    generation: int
    editor: str = ""
    document: str = ""
    base: str = ""


class _Autosave(Content, kw_only=True):
    """Contents of an autosave."""

    autosave: Autosaved


class _Facts(msgspec.Struct):
    """Facts of an autosave that are read besides its project."""

    autosave: Autosaved | None = None


def save(project: Project, path: str | os.PathLike[str]) -> str:
    """Write a project; what the file held before stays beside it as ``.bak``.

    Returns
    -------
    str
        `content_hash` of the file.

    Raises
    ------
    FileError
        The system refuses, the file is write-protected, or the project holds what could not be read again; the file
        is as it was.
    """
    target = Path(os.path.realpath(path))
    content = encode(project, target)
    if os.path.exists(target) and not os.access(target, os.W_OK):
        raise FileError("project.read_only", file=os.fspath(path))
    with atomic_write(path, backup=backup_path(target)) as stream:
        stream.write(content)
    return content_hash(content)


def content_hash(content: bytes) -> str:
    """By which it is known whether a file holds what it held before; its times would not do, clocks are set back."""
    return hashlib.sha256(content).hexdigest()


def file_hash(path: Path) -> str:
    """`content_hash` of a file; empty where it is not there or cannot be read."""
    try:
        with open_file(path) as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except (OSError, FileError):
        # The next read or write of the file raises the reason.
        return ""


def backup_path(path: Path) -> Path:
    """Return where the version before the last save is."""
    return path.with_name(path.name + BACKUP)


def encode(project: Project, path: Path) -> bytes:
    """The bytes of a project's file that is to lie at a path; the same project gives the same bytes.

    Raises
    ------
    FileError
        ``project.cannot_save``: the project holds what could not be read again.
    """
    content = content_of(project, path)

    def written() -> bytes:
        raw = msgspec.to_builtins(content, order="deterministic", enc_hook=plain_number)
        return ("".join(_layout(raw, "")) + "\n").encode()

    return _encoded(written, path)


def encode_autosave(project: Project, path: Path, facts: Autosaved) -> bytes:
    """The bytes of an autosave that is to lie at a path: a project's file without its layout, which would cost fifty
    times the time, and what it says of itself.

    Raises
    ------
    FileError
        ``project.cannot_save``: the project holds what could not be read again.
    """
    content = _Autosave(autosave=facts, **msgspec.structs.asdict(content_of(project, path)))
    return _encoded(lambda: msgspec.json.encode(content, enc_hook=plain_number), path)


def _encoded(write: Callable[[], bytes], path: Path) -> bytes:
    file = os.fspath(path)
    try:
        content = write()
    except (TypeError, ValueError, OverflowError) as error:
        raise FileError("project.cannot_save", file=file, place="-", detail=shortened(error)) from error
    if len(content) > MOST_BYTES:
        detail = f"{len(content) >> 20} MB; a project's file is at most {MOST_BYTES >> 20} MB"
        raise FileError("project.cannot_save", file=file, place="-", detail=detail)
    return content


def load(path: str | os.PathLike[str]) -> Project:
    """Read a project.

    What it needs and this computer does not have (an instrument, a character, the recording, the reference video) stays
    in it; `missing` and `missing_media` tell.

    Raises
    ------
    FileError
        See the module's docstring.
    """
    return decode(read(path), Path(os.path.realpath(path)), os.fspath(path))


def read(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a project's file, for `decode`. Raises FileError."""
    return read_file(path, MOST_BYTES)


def decode(content: bytes, path: Path, name: str | None = None) -> Project:
    """The project in the bytes of a file that lies at a path.

    Parameters
    ----------
    name : str, optional
        What the file is called in messages, by default its path.
    """
    file = os.fspath(path) if name is None else name
    if content.startswith(b"MThd"):
        raise FileError("project.is_midi", file=file)
    raw = decode_json(content, _ANY, file, "project.damaged")
    version = raw.get(VERSION_KEY) if isinstance(raw, dict) else None
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise FileError("project.damaged", file=file, detail=f"no {VERSION_KEY}")
    raw.pop("autosave", None)
    if version > CURRENT:
        raise FileError("project.newer", file=file, version=version, known=CURRENT)
    try:
        raw = migrated(raw, version)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        raise FileError("project.invalid", file=file, place=f"version {version}", detail=repr(error)) from error
    project = project_of(raw, path.parent, file)
    for place, detail in faults(project):
        raise FileError("project.invalid", file=file, place=place, detail=detail)
    return project


def autosave_facts(content: bytes) -> Autosaved | None:
    """Facts in the bytes of an autosave; None if there are none, as in older versions."""
    try:
        facts = _FACTS.decode(content).autosave
    except UNREADABLE:
        return None
    return None if facts is None else msgspec.structs.replace(facts, document=file_named(facts.document))


def file_named(text: str) -> str:
    """The absolute path of a file, as a note or an autosave names it; empty where it can be no file's."""
    path = Path(restored(text))
    return str(path) if path.is_absolute() and path.name and "\0" not in str(path) else ""


def is_project_file(path: Path) -> bool:
    """Return whether a file is called like a project's, or like what is kept beside one."""
    name = path.name.casefold()
    return any(name.endswith(f"{SUFFIX}{more}") for more in ("", BACKUP, AUTOSAVE))


def missing(project: Project) -> tuple[Message, ...]:
    """Warnings about what players and dancers need and this computer lacks; the project keeps it, and plays again where
    it is there.

    Messages: ``project.instrument_missing`` (player, id), ``project.character_missing`` (player, id),
    ``project.outfit_missing`` (player, id),
    ``project.choreography_missing`` (dancer, name, known), ``project.choreography_file_missing`` (dancer, file),
    ``project.choreography_elsewhere`` (dancer, file, host).
    """
    instruments, bodies = all_maps(), characters()
    found = []
    for player in project.players:
        if player.instrument_id not in instruments:
            found.append(Message("project.instrument_missing", {"player": player.name, "id": player.instrument_id}))
        if player.character_id not in bodies:
            found.append(Message("project.character_missing", {"player": player.name, "id": player.character_id}))
        if player.parameters.choreography:
            found += choreography_missing(player.name, player.parameters.choreography)
    for dancer in project.dancers:
        if dancer.character_id not in bodies:
            found.append(Message("project.character_missing", {"player": dancer.name, "id": dancer.character_id}))
        found += choreography_missing(dancer.name, dancer.choreography)
    for one in project.performers:
        if one.outfit.id and one.outfit.id not in wardrobe():
            found.append(Message("project.outfit_missing", {"player": one.name, "id": one.outfit.id}))
    return tuple(found)


def choreography_missing(dancer: str, choreography: str) -> tuple[Message, ...]:
    """Warning about the missing choreography of a dancer or player of this name; nothing if it is there. Messages: see
    `missing`."""
    path = choreography_path(choreography)
    if not may_touch(path):
        return (
            Message(
                "project.choreography_elsewhere",
                {"dancer": dancer, "file": shown(choreography), "host": host_of(path)},
            ),
        )
    if is_file(path):
        return ()
    if is_bundled_name(choreography):
        known = ", ".join(bundled_choreographies()) or "-"
        return (Message("project.choreography_missing", {"dancer": dancer, "name": choreography, "known": known}),)
    return (Message("project.choreography_file_missing", {"dancer": dancer, "file": shown(choreography)}),)


def missing_media(project: Project) -> Path | None:
    """The recording or the reference video that is not at its place (any more); to be asked for. One on a computer that
    the user did not agree to is not looked for."""
    paths = (track.path for track in (project.audio, project.video) if track is not None)
    return next((Path(path) for path in paths if may_touch(path) and not is_file(path)), None)


def elsewhere(project: Project) -> tuple[str, ...]:
    """Paths of the recording, the reference video and choreographies on computers that the user did not agree to."""
    tracks = [track.path for track in (project.audio, project.video) if track is not None]
    dances = [player.parameters.choreography for player in project.players]
    dances += [dancer.choreography for dancer in project.dancers]
    return tuple(path for path in dict.fromkeys((*tracks, *dances)) if not may_touch(path))


# Layout


def _layout(value: Any, indent: str) -> Iterator[str]:
    """JSON with two spaces a level, in which what holds no other values, a note for one, takes one line."""
    if not isinstance(value, dict | list | tuple) or not any(map(_is_nested, _values(value))):
        yield msgspec.json.format(msgspec.json.encode(value), indent=0).decode()
        return
    deeper = indent + "  "
    brackets = "{}" if isinstance(value, dict) else "[]"
    before = brackets[0]
    for key, item in value.items() if isinstance(value, dict) else enumerate(value):
        yield f"{before}\n{deeper}"
        if isinstance(value, dict):
            yield f"{msgspec.json.encode(key).decode()}: "
        yield from _layout(item, deeper)
        before = ","
    yield f"\n{indent}{brackets[1]}"


def _values(value: Any) -> Any:
    return value.values() if isinstance(value, dict) else value


def _is_nested(value: Any) -> bool:
    return isinstance(value, dict | list | tuple) and len(value) > 0


# Worked out here, under the import's lock: two threads that use a type for the first time at once crash msgspec.
for _type in (Content, tuple[Correction, ...], tuple[DanceCorrection, ...]):
    msgspec.json.Decoder(_type)
_ANY: Final[msgspec.json.Decoder[Any]] = msgspec.json.Decoder()
_FACTS: Final = msgspec.json.Decoder(_Facts)
