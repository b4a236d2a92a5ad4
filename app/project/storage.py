"""Project files: one readable JSON document, written whole or not at all.

The file says its version first; older ones are migrated (`app.project.migrations`), newer ones refused. Paths of media
are kept relative to the file where both lie in one tree, so that a folder can be moved or sent. Whatever a file holds,
names are only texts: nothing but the recording, the MIDI file it came from and a choreography's file is ever a path.

Messages (`FileError`): ``project.damaged``, ``project.invalid``, ``project.newer``, ``project.cannot_save``,
``project.read_only`` and what `read_file` says.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any, Final, TypeVar

import msgspec

from app.encoding import PREFIX, restored, shown, stored
from app.errors import FileError, Message, shortened
from app.formats.atomic import atomic_write
from app.formats.files import open_file, read_file
from app.formats.json_data import UNREADABLE, decode_json
from app.formats.other_computers import host_of, is_file, may_touch
from app.plan.by_hand.corrections import Correction
from app.project.casting import ConductorPlace
from app.project.check import faults
from app.project.check_stored import plain_number
from app.project.choreography_files import bundled_choreographies, choreography_path, is_bundled_name
from app.project.dance_corrections import DanceCorrection
from app.project.frame_rate import stored_rate
from app.project.ids import is_made_here
from app.project.import_decisions import ImportDecisions, ReadTiming
from app.project.migrations import CURRENT, VERSION_KEY, Raw, migrated
from app.project.model import PlayerTakes, Project
from app.project.performers import Dancer, Player
from app.project.recording import AudioTrack
from app.project.remarks import sayable
from app.project.video import VideoTrack
from app.rig.characters.character_library import characters
from app.score.model import ControllerCurve, Note, Score
from instrument_maps.library import all_maps
from metadata.model import Expression

SUFFIX: Final = ".suisou"
BACKUP: Final = ".bak"
"""Put behind the file's name: what it held before it was last saved."""

AUTOSAVE: Final = ".autosave"
"""Put behind the file's name: the work on it that is not saved yet."""

MOST_BYTES: Final = 256 * 2**20

_PLACE = re.compile(r"^(.*?)(?: - at (`key` in )?`\$?\.?(.*?)`)?$", re.DOTALL)

_CHECKED: Final = (
    *("audio", "video", "players", "dancers", "expressions", "score", "edited_notes", "takes"),
    *("edited_curves", "read_timing", "imported"),
)
"""Keys whose content may hold nothing that is not known."""

Track = TypeVar("Track", AudioTrack, VideoTrack)


class _Content(msgspec.Struct, forbid_unknown_fields=True):
    """What a file of the present version holds; corrections are read player by player, so that a fault in one of them
    is found by name."""

    schema_version: int
    source: str
    fps: str
    seed: int
    preroll_beats: float
    section_intensity: float
    conductor: ConductorPlace | None
    felt_beat_quarters: float | None
    audio: AudioTrack | None
    video: VideoTrack | None
    players: tuple[Player, ...]
    corrections: dict[str, list[Any]]
    dancers: tuple[Dancer, ...]
    dance_corrections: dict[str, list[Any]]
    expressions: tuple[Expression, ...]
    score: Score
    edited_notes: dict[str, tuple[Note, ...]]
    """By part that was read from a MIDI file: the file's version of the notes that are other ones here, or gone."""
    takes: dict[str, PlayerTakes]
    """By player."""
    edited_curves: dict[str, tuple[ControllerCurve, ...]]
    """By part that was read from a MIDI file: the file's controllers where they are other ones here."""
    read_timing: ReadTiming | None
    imported: ImportDecisions | None


class Autosaved(msgspec.Struct, frozen=True):
    """What an autosave says of itself, under the key ``autosave``; a file that was saved does not have it.

    Nothing here depends on a clock: one may have been set back.

    Attributes
    ----------
    work : str
        The same for all autosaves from opening a project to saving or closing it, also across a crash and a recovery.
    generation : int
        Ascends within a work: the highest is the newest.
    editor : str
        Token of the editor that wrote it (`app.project.presence`).
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


class _Autosave(_Content):
    """What an autosave holds."""

    autosave: Autosaved


class _Facts(msgspec.Struct):
    """What is read of an autosave beside its project."""

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
    content = _content(project, path)

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
    content = _Autosave(autosave=facts, **msgspec.structs.asdict(_content(project, path)))
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


def _content(project: Project, path: Path) -> _Content:
    for place, detail in faults(project):
        raise FileError("project.cannot_save", file=os.fspath(path), place=place, detail=detail)
    folder = path.absolute().parent
    return _Content(
        schema_version=CURRENT,
        source=_stored_path(project.source, folder),
        fps=str(project.fps),
        seed=project.seed,
        preroll_beats=project.preroll_beats,
        section_intensity=project.section_intensity,
        conductor=project.conductor,
        felt_beat_quarters=project.felt_beat_quarters,
        audio=_moved(project.audio, _stored_path, folder),
        video=_moved(project.video, _stored_path, folder),
        players=tuple(
            _dancing(player, _stored_choreography(player.parameters.choreography, folder)) for player in project.players
        ),
        corrections={player: list(corrections) for player, corrections in project.corrections.items() if corrections},
        dancers=tuple(
            msgspec.structs.replace(dancer, choreography=_stored_choreography(dancer.choreography, folder))
            for dancer in project.dancers
        ),
        dance_corrections={dancer: list(items) for dancer, items in project.dance_corrections.items() if items},
        expressions=project.expressions,
        score=project.score,
        edited_notes=_edited_notes(project),
        takes=dict(project.takes),
        edited_curves=_edited_curves(project),
        read_timing=project.read_timing,
        imported=project.imported,
    )


def _moved(track: Track | None, path: Callable[[str, Path], str], folder: Path) -> Track | None:
    """A recording or video with its path as the file has it, or as this machine does."""
    return None if track is None else msgspec.structs.replace(track, path=path(track.path, folder))


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
    project = _project(raw, path.parent, file)
    for place, detail in faults(project):
        raise FileError("project.invalid", file=file, place=place, detail=detail)
    return project


def autosave_facts(content: bytes) -> Autosaved | None:
    """What the bytes of an autosave say of it; None where they say nothing, as those of older versions."""
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
    """What players and dancers need and this computer does not have; the project keeps it, and plays again where it is
    there.

    Messages: ``project.instrument_missing`` (player, id), ``project.character_missing`` (player, id),
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
    return tuple(found)


def choreography_missing(dancer: str, choreography: str) -> tuple[Message, ...]:
    """What to report about a dancer or player of this name whose choreography is not there; nothing where it is.
    Messages: see `missing`."""
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


def _project(raw: Raw, folder: Path, file: str) -> Project:
    """The typed values of a file's content; what they mean is not looked at yet."""
    content = _converted(raw, _Content, "", file)
    fps = stored_rate(content.fps)
    if fps is None:
        raise FileError("project.invalid", file=file, place="fps", detail='must be like "60" or "30000/1001"')
    corrections = {
        player: _converted(items, tuple[Correction, ...], f"corrections[{player!r}]", file)
        for player, items in content.corrections.items()
        if items
    }
    dance_corrections = {
        dancer: _converted(items, tuple[DanceCorrection, ...], f"dance_corrections[{dancer!r}]", file)
        for dancer, items in content.dance_corrections.items()
        if items
    }
    # What a struct does not forbid it passes over: nothing in a file may be lost by saving it again.
    for key in _CHECKED:
        for place in _unknown(raw[key], msgspec.to_builtins(getattr(content, key)), key):
            raise FileError("project.invalid", file=file, place=place, detail="unknown key")
    score = content.score
    return Project(
        score=msgspec.structs.replace(
            score,
            warnings=tuple(map(sayable, score.warnings)),
            unplayed=tuple(msgspec.structs.replace(part, reason=sayable(part.reason)) for part in score.unplayed),
        ),
        players=tuple(
            _dancing(player, _full_choreography(player.parameters.choreography, folder)) for player in content.players
        ),
        corrections=corrections,
        seed=content.seed,
        preroll_beats=content.preroll_beats,
        section_intensity=content.section_intensity,
        conductor=content.conductor,
        felt_beat_quarters=content.felt_beat_quarters,
        fps=fps,
        audio=_moved(content.audio, _full_path, folder),
        video=_moved(content.video, _full_path, folder),
        expressions=content.expressions,
        source=_full_path(content.source, folder),
        read_notes=_read_notes(content.edited_notes, score),
        takes=content.takes,
        read_curves=_read_curves(content, score),
        read_timing=content.read_timing,
        imported=content.imported,
        dancers=tuple(
            msgspec.structs.replace(dancer, choreography=_full_choreography(dancer.choreography, folder))
            for dancer in content.dancers
        ),
        dance_corrections=dance_corrections,
    )


def _edited_notes(project: Project) -> dict[str, tuple[Note, ...]]:
    """What the MIDI file held of notes that are other here, or gone, or were drawn here before they were read there."""
    here = {part.id: {note.id: note for note in part.notes} for part in project.score.parts}
    return {
        part_id: tuple(
            sorted(
                (note for id, note in notes.items() if is_made_here(id) or here.get(part_id, {}).get(id) != note),
                key=_place,
            )
        )
        for part_id, notes in project.read_notes.items()
    }


def _place(note: Note) -> tuple[int, int, str]:
    return note.onset_tick, note.pitch, note.id


def _read_notes(edited: dict[str, tuple[Note, ...]], score: Score) -> dict[str, dict[str, Note]]:
    """What the MIDI file held: the notes that are here and were not drawn here, with its version of the edited ones."""
    parts = {part.id: part.notes for part in score.parts}
    return {
        part_id: {note.id: note for note in parts.get(part_id, ()) if not is_made_here(note.id)}
        | {note.id: note for note in notes}
        for part_id, notes in edited.items()
    }


def _edited_curves(project: Project) -> dict[str, tuple[ControllerCurve, ...]]:
    """The MIDI file's controllers of parts that have other ones here."""
    here = {part.id: part.curves for part in project.score.parts}
    return {part_id: curves for part_id, curves in project.read_curves.items() if here.get(part_id) != curves}


def _read_curves(content: _Content, score: Score) -> dict[str, tuple[ControllerCurve, ...]]:
    """The MIDI file's controllers, of each part that was read from it."""
    here = {part.id: part.curves for part in score.parts}
    return {part_id: here.get(part_id, ()) for part_id in content.edited_notes} | content.edited_curves


def _converted(raw: Any, type_: Any, prefix: str, file: str) -> Any:
    try:
        return msgspec.convert(raw, type_)
    except msgspec.ValidationError as error:
        found = _PLACE.match(str(error))
        detail, place = (found.group(1), found.group(3) or "") if found else (str(error), "")
        where = shortened(f"{prefix}{place}" if prefix else place)
        raise FileError("project.invalid", file=file, place=where or "$", detail=shortened(detail)) from error
    except RecursionError as error:
        raise FileError("project.damaged", file=file, detail=shortened(error)) from error


def _unknown(raw: Any, known: Any, place: str) -> Iterator[str]:
    """Key paths that were in the file and are not in what was made of it."""
    if isinstance(raw, dict) and isinstance(known, dict):
        for key, value in raw.items():
            if key not in known:
                yield f"{place}.{key}"
            elif isinstance(value, dict | list):
                yield from _unknown(value, known[key], f"{place}.{key}")
    elif isinstance(raw, list) and isinstance(known, list | tuple):
        for index, (value, kept) in enumerate(zip(raw, known, strict=True)):
            if isinstance(value, dict | list):
                yield from _unknown(value, kept, f"{place}[{index}]")


# Paths


def _stored_path(path: str, folder: Path) -> str:
    """As the file has it: relative, with slashes, where both lie in one tree below the root."""
    if path and Path(path).is_absolute():
        try:
            shared = Path(os.path.commonpath([path, folder]))
        except ValueError:  # two drives
            return stored(path)
        if shared != Path(shared.anchor):
            path = Path(os.path.relpath(path, folder)).as_posix()
    return stored(path)


def _full_path(path: str, folder: Path) -> str:
    """Absolute; a path that is absolute on another system only stays what it is."""
    path = restored(path)
    if not path or path.startswith(PREFIX) or PurePosixPath(path).is_absolute() or PureWindowsPath(path).is_absolute():
        return path
    return os.path.normpath(folder / path)


def _stored_choreography(choreography: str, folder: Path) -> str:
    """Nothing and the name of a bundled one stay what they are."""
    return _stored_path(choreography, folder) if choreography and not is_bundled_name(choreography) else choreography


def _full_choreography(choreography: str, folder: Path) -> str:
    return _full_path(choreography, folder) if choreography and not is_bundled_name(choreography) else choreography


def _dancing(player: Player, choreography: str) -> Player:
    """The player with another choreography."""
    if choreography == player.parameters.choreography:
        return player
    parameters = msgspec.structs.replace(player.parameters, choreography=choreography)
    return msgspec.structs.replace(player, parameters=parameters)


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
for _type in (_Content, tuple[Correction, ...], tuple[DanceCorrection, ...]):
    msgspec.json.Decoder(_type)
_ANY: Final[msgspec.json.Decoder[Any]] = msgspec.json.Decoder()
_FACTS: Final = msgspec.json.Decoder(_Facts)
