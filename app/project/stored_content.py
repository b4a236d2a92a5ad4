"""Typed content of a project's file, and conversion from and to a project."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import msgspec

from app.errors import FileError, Message, shortened
from app.messages import text
from app.plan.by_hand.corrections import Correction
from app.project.camera_bookmarks import CameraBookmark
from app.project.casting import ConductorPlace
from app.project.check import faults
from app.project.dance_corrections import DanceCorrection
from app.project.frame_rate import stored_rate
from app.project.ids import is_made_here
from app.project.ignored_problems import IgnoredProblem
from app.project.import_decisions import ImportDecisions, ReadTiming
from app.project.migrations import CURRENT, Raw
from app.project.model import PlayerTakes, Project
from app.project.performers import Dancer, Player
from app.project.recording import AudioTrack
from app.project.stored_paths import (
    full_choreography,
    full_path,
    moved_track,
    stored_choreography,
    stored_path,
    with_choreography,
)
from app.project.video import VideoTrack
from app.score.model import ControllerCurve, Note, Score
from metadata.model import Expression

_FORMER: Final = ".".join(("score", "instrument_from_file_name"))
_RENAMED: Final = {_FORMER: "score.instrument_from_title"}
"""Current message id for each obsolete id that has no text any more."""

_PLACE = re.compile(r"^(.*?)(?: - at (`key` in )?`\$?\.?(.*?)`)?$", re.DOTALL)
_CHECKED: Final = (
    *("audio", "video", "players", "dancers", "expressions", "score", "edited_notes", "takes"),
    *("edited_curves", "read_timing", "imported"),
)
"""Keys whose content must not contain unknown fields."""


class Content(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """Contents of a file of the current version; corrections are decoded player by player, so that errors can name the
    player.
    """

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
    """Original notes that were edited or deleted, by the part read from a MIDI file."""
    takes: dict[str, PlayerTakes]
    """Takes by player."""
    edited_curves: dict[str, tuple[ControllerCurve, ...]]
    """Original controllers that were edited, by the part read from a MIDI file."""
    read_timing: ReadTiming | None
    imported: ImportDecisions | None
    ignored_problems: dict[str, tuple[IgnoredProblem, ...]] = {}
    """Ignored problems by player or dancer; omitted if there are none, as in files of earlier versions."""
    cameras: tuple[CameraBookmark, ...] = ()
    """Camera bookmarks; omitted if there are none."""


def content_of(project: Project, path: Path) -> Content:
    for place, detail in faults(project):
        raise FileError("project.cannot_save", file=os.fspath(path), place=place, detail=detail)
    folder = path.absolute().parent
    return Content(
        schema_version=CURRENT,
        source=stored_path(project.source, folder),
        fps=str(project.fps),
        seed=project.seed,
        preroll_beats=project.preroll_beats,
        section_intensity=project.section_intensity,
        conductor=project.conductor,
        felt_beat_quarters=project.felt_beat_quarters,
        audio=moved_track(project.audio, stored_path, folder),
        video=moved_track(project.video, stored_path, folder),
        players=tuple(
            with_choreography(player, stored_choreography(player.parameters.choreography, folder))
            for player in project.players
        ),
        corrections={player: list(corrections) for player, corrections in project.corrections.items() if corrections},
        dancers=tuple(
            msgspec.structs.replace(dancer, choreography=stored_choreography(dancer.choreography, folder))
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
        ignored_problems={id: items for id, items in project.ignored_problems.items() if items},
        cameras=project.cameras,
    )


def project_of(raw: Raw, folder: Path, file: str) -> Project:
    """Decode the typed values of a file's content, without checking their meaning."""
    content = _converted(raw, Content, "", file)
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
    # Decoding ignores unknown keys, which saving would lose, so they are refused.
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
            with_choreography(player, full_choreography(player.parameters.choreography, folder))
            for player in content.players
        ),
        corrections=corrections,
        seed=content.seed,
        preroll_beats=content.preroll_beats,
        section_intensity=content.section_intensity,
        conductor=content.conductor,
        felt_beat_quarters=content.felt_beat_quarters,
        fps=fps,
        audio=moved_track(content.audio, full_path, folder),
        video=moved_track(content.video, full_path, folder),
        expressions=content.expressions,
        source=full_path(content.source, folder),
        read_notes=_read_notes(content.edited_notes, score),
        takes=content.takes,
        read_curves=_read_curves(content, score),
        read_timing=content.read_timing,
        imported=content.imported,
        dancers=tuple(
            msgspec.structs.replace(dancer, choreography=full_choreography(dancer.choreography, folder))
            for dancer in content.dancers
        ),
        dance_corrections=dance_corrections,
        ignored_problems=content.ignored_problems,
        cameras=content.cameras,
    )


def _edited_notes(project: Project) -> dict[str, tuple[Note, ...]]:
    """Return the notes as read from the MIDI file that were edited or deleted in the project, by part id, so that only
    these need be stored.
    """
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
    """Return all notes as read from the MIDI file by part and note id: the score's, with the file's version of edited
    ones.
    """
    parts = {part.id: part.notes for part in score.parts}
    return {
        part_id: {note.id: note for note in parts.get(part_id, ()) if not is_made_here(note.id)}
        | {note.id: note for note in notes}
        for part_id, notes in edited.items()
    }


def _edited_curves(project: Project) -> dict[str, tuple[ControllerCurve, ...]]:
    """Return the MIDI file's controllers of parts whose controllers were edited in the project, by part id."""
    here = {part.id: part.curves for part in project.score.parts}
    return {part_id: curves for part_id, curves in project.read_curves.items() if here.get(part_id) != curves}


def _read_curves(content: Content, score: Score) -> dict[str, tuple[ControllerCurve, ...]]:
    """Return the MIDI file's controllers by part id: the stored ones if they were edited, else the score's."""
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
    """Yield the key paths in the content ``raw`` of a file that this version does not support.

    ``known`` is the same content after decoding and encoding, ``place`` the key path of both.
    """
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


def sayable(message: Message) -> Message:
    """Return a message unchanged if its id has a text, else a general message that contains the id."""
    message = _placed(Message(_RENAMED.get(message.id, message.id), message.arguments))
    try:
        text(message)
    except (KeyError, IndexError, ValueError, TypeError, AttributeError):
        return Message("project.unknown_remark", {"remark": message.id})
    return message


def _placed(message: Message) -> Message:
    """Convert a message stored by versions that counted positions as bar and beat to the present form."""
    arguments = message.arguments
    bar, beat = arguments.get("bar"), arguments.get("beat")
    if "place" in arguments or not isinstance(bar, int) or not isinstance(beat, int | float):
        return message
    return Message(message.id, {**arguments, "place": f"{bar}.{int(beat)}"})
