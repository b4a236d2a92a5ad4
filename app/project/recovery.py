"""Recovery after a crash: unsaved work is found, described, and restored or discarded.

Which work is newer, and whether the file has what it holds, is known by what both say and hold, never by the times of
the files: clocks are set back.
"""

from __future__ import annotations

import contextlib
import os
from dataclasses import dataclass
from pathlib import Path

import platformdirs

from app.encoding import shown
from app.errors import FileError
from app.formats.atomic import sweep
from app.project.autosave import autosave_path
from app.project.model import Project
from app.project.running_editors import NOTE, editors, forget, note_of, remove
from app.project.storage import AUTOSAVE, SUFFIX, Autosaved, autosave_facts, content_hash, decode, file_hash, load, read


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
        When it was written as the clock of that day had it, seconds since 1970 (UTC); only to be shown.
    token : str
        Of the editor; empty where it left no trace but the file.
    facts : Autosaved or None
        None: an older version of the program wrote it.
    is_file_missing : bool
        The project has a file, and it is not there.
    is_file_changed : bool
        The file is not what it was when this work on it began.
    source : str
        The MIDI file or score that it came from; may be empty.
    """

    autosave: Path
    document: Path | None
    name: str
    changed_s: float
    note_count: int
    token: str = ""
    facts: Autosaved | None = None
    is_file_missing: bool = False
    is_file_changed: bool = False
    source: str = ""


def recovery_folder() -> Path:
    """Folder on this machine for unsaved work of projects without a file, and for notes of running editors."""
    return platformdirs.user_state_path("suisou", appauthor=False) / "recovery"


def recoverable(folder: Path) -> tuple[Recoverable, ...]:
    """All unsaved work of editors that are gone, the newest first; their other traces are cleared away. May take long:
    every file of unsaved work is read, and the project's own.

    Parameters
    ----------
    folder : Path
        `recovery_folder`.
    """
    left = _left_behind(folder)
    found = _described(left, folder)
    kept = {token for path, token in left.items() if os.path.lexists(path)}
    for token, alive in editors(folder):
        if not alive and token not in kept:
            forget(folder, token)
    return found


def recoverable_of(document: Path, folder: Path, own_token: str = "") -> tuple[Recoverable, ...]:
    """Unsaved work on a project's file, beside it or in the folder, what is based on the file as it is in front; empty
    where there is none or another living editor has the file open."""
    beside, real = autosave_path(document), os.path.realpath(document)
    sweep(Path(real).parent)
    left = {beside: "", **_left_behind(folder)}
    found = (item for item in _described(left, folder, real, own_token))
    return tuple(sorted(found, key=lambda item: item.is_file_changed))


def never_saved(folder: Path, source: Path | None = None) -> tuple[Recoverable, ...]:
    """Unsaved work of editors that are gone on projects without a file, the newest first.

    Parameters
    ----------
    source : Path, optional
        Only work that came from this MIDI file or score.
    """
    found = (item for item in recoverable(folder) if item.document is None)
    return tuple(item for item in found if source is None or _plain(item.source) == _plain(os.fspath(source)))


def _plain(path: str) -> str:
    """A path as paths are compared without a look at the disk."""
    return os.path.normcase(os.path.normpath(path)) if path else ""


def load_work(item: Recoverable) -> tuple[Project, str]:
    """Unsaved work, and the `content_hash` of the file that it began from. Raises FileError."""
    project = load(item.autosave)
    if item.facts is not None:
        return project, item.facts.base
    return project, "" if item.document is None else file_hash(item.document)


def discard(item: Recoverable) -> None:
    """Throw unsaved work away. Raises FileError where the system keeps it."""
    try:
        item.autosave.unlink(missing_ok=True)
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileError("file.cannot_write", file=os.fspath(item.autosave), reason=reason) from error


def _left_behind(folder: Path) -> dict[Path, str]:
    """Files that may hold unsaved work of editors that are gone, and their tokens; half-written files are removed."""
    known = dict(editors(folder))
    left: dict[Path, str] = {}
    for token, alive in known.items():
        if alive:
            continue
        note = note_of(folder, token)
        if note.document:
            sweep(Path(os.path.realpath(note.document)).parent)
            left[autosave_path(Path(note.document))] = token
        if note.autosave:
            left[Path(note.autosave)] = token
        left[folder / f"{token}{SUFFIX}"] = token
    sweep(folder)
    with contextlib.suppress(OSError):
        for path in sorted(folder.iterdir()):
            if path.suffix == SUFFIX and path.stem not in known:
                left[path] = ""
            elif path.suffix == NOTE and path.stem not in known:
                remove(path)
    return left


def _described(
    left: dict[Path, str], folder: Path, real_document: str | None = None, own_token: str = ""
) -> tuple[Recoverable, ...]:
    """Files to offer for recovery, the newest first; those in the project's file, or of an older generation, are
    removed.

    Parameters
    ----------
    real_document : str, optional
        Only work on this file.
    """
    living = {token: note_of(folder, token) for token, alive in editors(folder) if alive}
    claimed = {note.autosave for note in living.values()}
    opened = {os.path.realpath(note.document) for token, note in living.items() if note.document and token != own_token}
    newest: dict[str, Recoverable] = {}
    for path, token in left.items():
        if str(path) in claimed:
            continue
        try:
            content = read(path)
            facts = autosave_facts(content)
            document = _document(path, folder, token, facts)
            real = "" if document is None else os.path.realpath(document)
            is_other = real_document is not None and real != real_document
            if is_other or real in opened or (facts is not None and facts.editor in living):
                continue
            item = _item(path, document, token, facts, decode(content, Path(os.path.realpath(path))))
        except (FileError, OSError):
            # It stays: another version of the program may know what to do with it.
            continue
        if item is None:
            remove(path)
            continue
        # What an older version wrote is a work of its own.
        work = str(path) if facts is None else facts.work
        older, newer = sorted((newest.get(work, item), item), key=_generation)
        newest[work] = newer
        if older is not newer:
            remove(older.autosave)
    return tuple(sorted(newest.values(), key=lambda item: item.changed_s, reverse=True))


def _generation(item: Recoverable) -> int:
    return 0 if item.facts is None else item.facts.generation


def _document(path: Path, folder: Path, token: str, facts: Autosaved | None) -> Path | None:
    """The file of the project that an autosave holds."""
    if path.name.endswith(AUTOSAVE):
        # Both may have been moved since.
        return path.with_name(path.name.removesuffix(AUTOSAVE))
    text = note_of(folder, token).document if facts is None else facts.document
    return Path(text) if text else None


def _item(
    path: Path, document: Path | None, token: str, facts: Autosaved | None, project: Project
) -> Recoverable | None:
    """Recoverable unsaved work; None where the project's file holds the same."""
    written_s, missing, changed = path.stat().st_mtime, False, False
    if document is not None:
        try:
            saved = read(document)
            changed = facts.base != content_hash(saved) if facts is not None else document.stat().st_mtime > written_s
            if decode(saved, Path(os.path.realpath(document))) == project:
                return None
        except (FileError, OSError):
            # Gone or damaged: the autosave is all there is.
            missing = not os.path.lexists(document)
    score = project.score
    return Recoverable(
        path,
        document,
        shown(document.name if document is not None else score.title or Path(project.source).stem),
        written_s,
        sum(len(part.notes) for part in score.parts),
        token if facts is None else facts.editor,
        facts,
        missing,
        changed,
        project.source,
    )
