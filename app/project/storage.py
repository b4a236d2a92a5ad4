"""Project files: one readable JSON document, written atomically.

The file begins with its version; older ones are migrated (`app.project.migrations`), newer ones refused. Media paths
are stored relative to the file where possible, so that a folder can be moved. Only recording, video, source MIDI file
and choreography files are used as paths; all names are plain text.
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
"""Suffix of the backup: the previously saved version of the file."""

AUTOSAVE: Final = ".autosave"
"""Suffix of the file with unsaved work."""

MOST_BYTES: Final = 256 * 2**20


class Autosaved(msgspec.Struct, frozen=True):
    """Facts stored in an autosave under the key ``autosave``; saved projects have none.

    None of them depends on a clock, which may be set back.

    Attributes
    ----------
    work : str
        Id of the work from opening a project to saving or closing it, also across a crash and recovery.
    generation : int
        Ascends within a work: the highest is the newest.
    editor : str
        Token of the editor that wrote it (`app.project.running_editors`).
    document : str
        Absolute path of the project's file (`app.encoding.stored`); empty if it was never saved.
    base : str
        `content_hash` of that file when the work began; empty if it did not exist.
    """

    work: str
    generation: int
    editor: str = ""
    document: str = ""
    base: str = ""


class _Autosave(Content, kw_only=True):
    """Contents of an autosave: those of a project's file, and the facts."""

    autosave: Autosaved


class _Facts(msgspec.Struct):
    """The facts of an autosave, decoded without its project."""

    autosave: Autosaved | None = None


def save(project: Project, path: str | os.PathLike[str]) -> str:
    """Save a project; the previous content is kept as ``.bak``.

    Returns
    -------
    str
        `content_hash` of the file.

    Raises
    ------
    FileError
        The system refuses, the file is write-protected, or the project could not be read again; the file is unchanged.
    """
    target = Path(os.path.realpath(path))
    content = encode(project, target)
    if os.path.exists(target) and not os.access(target, os.W_OK):
        raise FileError("project.read_only", file=os.fspath(path))
    with atomic_write(path, backup=backup_path(target)) as stream:
        stream.write(content)
    return content_hash(content)


def content_hash(content: bytes) -> str:
    """Return a hash of a file's content, to detect changes independently of file times."""
    return hashlib.sha256(content).hexdigest()


def file_hash(path: Path) -> str:
    """Return the `content_hash` of a file; empty if it does not exist or cannot be read."""
    try:
        with open_file(path) as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except (OSError, FileError):
        # The next access to the file raises the error.
        return ""


def backup_path(path: Path) -> Path:
    """Return the path of the backup made at the last save."""
    return path.with_name(path.name + BACKUP)


def encode(project: Project, path: Path) -> bytes:
    """Encode a project as the bytes of its file at a path; equal projects give equal bytes.

    Raises
    ------
    FileError
        The project has content that could not be read again.
    """
    content = content_of(project, path)

    def written() -> bytes:
        raw = msgspec.to_builtins(content, order="deterministic", enc_hook=plain_number)
        return ("".join(_layout(raw, "")) + "\n").encode()

    return _encoded(written, path)


def encode_autosave(project: Project, path: Path, facts: Autosaved) -> bytes:
    """Encode an autosave for a path: a project's file with facts, without layout, which is fifty times faster.

    Raises
    ------
    FileError
        The project has content that could not be read again.
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
    """Load a project.

    Instruments, characters and media missing on this computer stay in the project; `missing` and `missing_media` list
    them.

    Raises
    ------
    FileError
        The file cannot be read, is no project, or is from a newer version.
    """
    return decode(read(path), Path(os.path.realpath(path)), os.fspath(path))


def read(path: str | os.PathLike[str]) -> bytes:
    """Read the bytes of a project's file, for `decode`. Raises FileError."""
    return read_file(path, MOST_BYTES)


def decode(content: bytes, path: Path, name: str | None = None) -> Project:
    """Decode the bytes of a project file at a path.

    Parameters
    ----------
    name : str, optional
        File name for messages; by default the path.
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
    """Return the facts in the bytes of an autosave; None if there are none, as in older versions."""
    try:
        facts = _FACTS.decode(content).autosave
    except UNREADABLE:
        return None
    return None if facts is None else msgspec.structs.replace(facts, document=file_named(facts.document))


def file_named(text: str) -> str:
    """Return the absolute path of a file as stored in a note or autosave; empty if it is invalid."""
    path = Path(restored(text))
    return str(path) if path.is_absolute() and path.name and "\0" not in str(path) else ""


def is_project_file(path: Path) -> bool:
    """Return whether a file name is that of a project, its backup or its autosave."""
    name = path.name.casefold()
    return any(name.endswith(f"{SUFFIX}{more}") for more in ("", BACKUP, AUTOSAVE))


def missing(project: Project) -> tuple[Message, ...]:
    """Return warnings about instruments, characters, outfits and choreographies that are missing on this computer. The
    project keeps their names, and they are used again on a computer that has them."""
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
    """Return a warning if the choreography of the dancer of a name is missing; empty if it exists."""
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
    """Return the recording or reference video that does not exist at its path, so that the user can locate it; None if
    all exist. Paths on other computers are checked only if the user agreed.
    """
    paths = (track.path for track in (project.audio, project.video) if track is not None)
    return next((Path(path) for path in paths if may_touch(path) and not is_file(path)), None)


def elsewhere(project: Project) -> tuple[str, ...]:
    """Return the paths of media and choreographies on other computers that the user has not agreed to access."""
    tracks = [track.path for track in (project.audio, project.video) if track is not None]
    dances = [player.parameters.choreography for player in project.players]
    dances += [dancer.choreography for dancer in project.dancers]
    return tuple(path for path in dict.fromkeys((*tracks, *dances)) if not may_touch(path))


# Layout


def _layout(value: Any, indent: str) -> Iterator[str]:
    """Yield JSON text with two spaces per level; values without nested values, such as a note, take one line."""
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


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
for _type in (Content, tuple[Correction, ...], tuple[DanceCorrection, ...]):
    msgspec.json.Decoder(_type)
_ANY: Final[msgspec.json.Decoder[Any]] = msgspec.json.Decoder()
_FACTS: Final = msgspec.json.Decoder(_Facts)
