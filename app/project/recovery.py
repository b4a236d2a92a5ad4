"""Recovery after a crash: finds, describes, restores and discards unsaved work.

Which version is newer is decided by their contents, never by file times, since clocks can be set back.
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
    """Unsaved work of an editor that ended abnormally.

    Attributes
    ----------
    autosave : Path
        File with the work.
    document : Path or None
        The project's own file; None if it was never saved.
    name : str
        The file's name, else the piece's title, else the name of its MIDI file; may be empty.
    changed_s : float
        Time of saving, seconds since 1970 (UTC), for display only.
    token : str
        Token of the editor; empty if there is only the autosave.
    facts : Autosaved or None
        Facts stored in the autosave; None in files of older versions.
    is_file_missing : bool
        Whether the project's own file no longer exists.
    is_file_changed : bool
        Whether the project's own file changed since the work began.
    source : str
        MIDI file or score it came from; may be empty.
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
    """Return the folder for unsaved work of projects without a file, and for records of running editors."""
    return platformdirs.user_state_path("suisou", appauthor=False) / "recovery"


def recoverable(folder: Path) -> tuple[Recoverable, ...]:
    """Return all unsaved work of ended editors, newest first, and delete their other files. May be slow, since every
    autosave and the project's own file are read.

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
    """Return unsaved work on a project's file found next to it or in the folder of autosaves; work based on the file's
    current content comes first. Empty if there is none or another running editor has the file open.
    """
    beside, real = autosave_path(document), os.path.realpath(document)
    sweep(Path(real).parent)
    left = {beside: "", **_left_behind(folder)}
    found = (item for item in _described(left, folder, real, own_token))
    return tuple(sorted(found, key=lambda item: item.is_file_changed))


def never_saved(folder: Path, source: Path | None = None) -> tuple[Recoverable, ...]:
    """Return unsaved work of ended editors on projects without a file, newest first.

    Parameters
    ----------
    source : Path, optional
        Only work that came from this MIDI file or score.
    """
    found = (item for item in recoverable(folder) if item.document is None)
    return tuple(item for item in found if source is None or _plain(item.source) == _plain(os.fspath(source)))


def _plain(path: str) -> str:
    """Return a path normalised for comparison, without access to the disk."""
    return os.path.normcase(os.path.normpath(path)) if path else ""


def load_work(item: Recoverable) -> tuple[Project, str]:
    """Load unsaved work, and the `content_hash` of the file it was based on. Raises FileError."""
    project = load(item.autosave)
    if item.facts is not None:
        return project, item.facts.base
    return project, "" if item.document is None else file_hash(item.document)


def discard(item: Recoverable) -> None:
    """Delete unsaved work. Raises FileError if the system refuses."""
    try:
        item.autosave.unlink(missing_ok=True)
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileError("file.cannot_write", file=os.fspath(item.autosave), reason=reason) from error


def _left_behind(folder: Path) -> dict[Path, str]:
    """Return files that may hold unsaved work of ended editors, with the editors' tokens; incomplete files
    are deleted.
    """
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
    """Return the files to offer for recovery, newest first. Those already contained in the project's file, and older
    generations, are deleted.

    Parameters
    ----------
    left : dict of Path to str
        Files with the tokens of their editors.
    real_document : str, optional
        If given, only work on this project file is returned.
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
            # The file is kept: another version of the program may be able to read it.
            continue
        if item is None:
            remove(path)
            continue
        # A file of an older version is a work of its own.
        work = str(path) if facts is None else facts.work
        older, newer = sorted((newest.get(work, item), item), key=_generation)
        newest[work] = newer
        if older is not newer:
            remove(older.autosave)
    return tuple(sorted(newest.values(), key=lambda item: item.changed_s, reverse=True))


def _generation(item: Recoverable) -> int:
    return 0 if item.facts is None else item.facts.generation


def _document(path: Path, folder: Path, token: str, facts: Autosaved | None) -> Path | None:
    """Return the project file that an autosave belongs to; None if it has none."""
    if path.name.endswith(AUTOSAVE):
        # Both files may have been moved since.
        return path.with_name(path.name.removesuffix(AUTOSAVE))
    text = note_of(folder, token).document if facts is None else facts.document
    return Path(text) if text else None


def _item(
    path: Path, document: Path | None, token: str, facts: Autosaved | None, project: Project
) -> Recoverable | None:
    """Describe an autosaved project that can be recovered; None if the project's file has the same content."""
    written_s, missing, changed = path.stat().st_mtime, False, False
    if document is not None:
        try:
            saved = read(document)
            changed = facts.base != content_hash(saved) if facts is not None else document.stat().st_mtime > written_s
            if decode(saved, Path(os.path.realpath(document))) == project:
                return None
        except (FileError, OSError):
            # Missing or damaged, so only the autosave remains.
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
