"""What a crash left behind: found when the program starts or a file is opened, described, taken over or thrown away."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from app.errors import AppError
from app.formats.atomic import sweep
from app.project.autosave import Autosave, autosave_path
from app.project.model import Project
from app.project.presence import NOTE, editors, forget, is_open_elsewhere, note_of, remove
from app.project.storage import SUFFIX, decode, load


@dataclass(frozen=True)
class Recoverable:
    """Unsaved work of an editor that is gone.

    Attributes
    ----------
    autosave : Path
        The file that holds it.
    document : Path or None
        The project's own file; None for a project that was never saved.
    name : str
        The file's name, else the piece's title, else the name of the MIDI file it came from; may be empty.
    changed_s : float
        When it was written, seconds since 1970 (UTC).
    note_count : int
    token : str
        Of the editor; empty where it left no trace but the file.
    """

    autosave: Path
    document: Path | None
    name: str
    changed_s: float
    note_count: int
    token: str = ""


def recoverable(folder: Path) -> tuple[Recoverable, ...]:
    """All unsaved work of editors that are gone, the newest first; their other traces are cleared away.

    Parameters
    ----------
    folder : Path
        `app.project.presence.recovery_folder`.
    """
    found: dict[Path, Recoverable] = {}
    tokens = set()
    for token, alive in editors(folder):
        tokens.add(token)
        if alive:
            continue
        own = folder / f"{token}{SUFFIX}"
        note = note_of(folder, token)
        document = Path(note.document) if note.document else None
        if document is not None:
            sweep(Path(os.path.realpath(document)).parent)
        if document is None:
            work = [own]
        elif is_open_elsewhere(document, folder):
            continue
        else:
            work = [autosave_path(document), own]
        items = {path: item for path in work if (item := _described(path, document, token)) is not None}
        if not items:
            forget(folder, token)
            remove(own)
        found |= items
    for path in _without_editor(folder, tokens):
        item = _described(path, None, "")
        if item is not None:
            found[path] = item
    return tuple(sorted(found.values(), key=lambda item: item.changed_s, reverse=True))


def recoverable_of(document: Path, folder: Path) -> Recoverable | None:
    """Unsaved work on a project's file, beside it and newer than it; None where there is none or an editor that
    lives has the file open."""
    if is_open_elsewhere(document, folder):
        return None
    dead = (token for token, alive in editors(folder) if not alive)
    wanted = os.path.realpath(document)
    token = next((token for token in dead if os.path.realpath(note_of(folder, token).document) == wanted), "")
    return _described(autosave_path(document), document, token)


def recover(item: Recoverable, autosave: Autosave) -> Project:
    """Take unsaved work over: it is this editor's now, written down as such before the old trace goes.

    The document must be opened with the result and marked as not saved.

    Raises
    ------
    FileError
        It cannot be read (any more), or not be written down; everything is as it was.
    """
    project = load(item.autosave)
    autosave.opened(item.document)
    autosave.changed(project, 0.0)
    writing = autosave.take()
    if writing is not None:
        writing.run()
        autosave.written(writing)
        if writing.path != item.autosave:
            remove(item.autosave)
    if item.token:
        forget(autosave.presence.folder, item.token)
    return project


def discard(item: Recoverable, folder: Path) -> None:
    """Throw unsaved work away."""
    remove(item.autosave)
    if item.token:
        forget(folder, item.token)


def _described(path: Path, document: Path | None, token: str) -> Recoverable | None:
    """None where there is nothing, nothing that can be read, or nothing that the document's file does not have."""
    try:
        written = path.stat().st_mtime_ns
        content = path.read_bytes()
        project = decode(content, path)
    except (OSError, AppError):
        return None
    if document is not None and _has_all(document, written, project):
        return None
    score = project.score
    name = document.name if document is not None else score.title or Path(project.source).stem
    count = sum(len(part.notes) for part in score.parts)
    return Recoverable(path, document, name, written / 1e9, count, token)


def _has_all(document: Path, written_ns: int, project: Project) -> bool:
    """Whether a file is newer than the autosave, or holds the same."""
    try:
        if document.stat().st_mtime_ns > written_ns:
            return True
        return load(document) == project
    except (OSError, AppError):
        # The file itself is gone or damaged: the autosave is all there is.
        return False


def _without_editor(folder: Path, tokens: set[str]) -> list[Path]:
    """Unsaved work whose editor's lock is gone; half-written files are removed on the way."""
    paths = []
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return []
    alive = any(is_alive for _, is_alive in editors(folder))
    for path in entries:
        if path.suffix == SUFFIX and path.stem not in tokens:
            paths.append(path)
        elif (path.suffix == NOTE and path.stem not in tokens) or (path.suffix == ".partial" and not alive):
            remove(path)
    return paths
