"""Records of running editors: each keeps a locked file, with a note about its open project.

The system releases a lock when its process ends, however it ends; so a file that can be locked belongs to an ended
editor. Process ids alone would not suffice, since they are reused.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Final

import msgspec

from app.encoding import stored
from app.errors import FileError
from app.formats.atomic import atomic_write, sweep
from app.formats.files import read_file
from app.formats.json_data import decode_json
from app.formats.locks import is_locked, is_same_file, lock
from app.project.storage import SUFFIX, file_named

LOCK: Final = ".lock"
NOTE: Final = ".json"
MOST_NOTE_BYTES: Final = 2**16


class PresenceNote(msgspec.Struct, frozen=True):
    """Record of the project that an editor has open, stored in a folder of records.

    Attributes
    ----------
    pid : int
        Process id, for information; the lock shows whether the editor is running.
    document : str
        Absolute path of the project's file; empty if it was never saved. Encoded with `app.encoding.stored`.
    autosave : str
        Absolute path of the autosave.
    """

    pid: int = 0
    document: str = ""
    autosave: str = ""


class Presence:
    """Record of this editor, valid until `leave` or the end of its process.

    If the folder cannot be written, the editor works without a record and tries again with every note.

    Parameters
    ----------
    folder : Path
        Folder of the records, `app.project.recovery.recovery_folder`; created if needed.

    Attributes
    ----------
    token : str
        Part of the names of this editor's files in the folder.
    note : PresenceNote
        Note about the open project, whether or not it could be written.
    refusal : FileError or None
        Error with the reason why the folder could not be used when the editor started.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.token = secrets.token_hex(8)
        self.note = PresenceNote(os.getpid())
        self.refusal: FileError | None = None
        self._on_disk = self.note
        self._stream: IO[bytes] | None = None
        try:
            self._enter()
        except FileError as error:
            self.refusal = error

    @property
    def own_path(self) -> Path:
        """Path of the file for this editor's unsaved work in the folder of records."""
        return self.folder / f"{self.token}{SUFFIX}"

    def report(self, document: Path | None, autosave: Path | None) -> None:
        """Write the note about the open project. Raises FileError if the folder cannot be written."""
        self.note = note = PresenceNote(os.getpid(), str(document or ""), str(autosave or ""))
        was_here = self._is_here()
        if not was_here:
            self._enter()
        if was_here and self.note == self._on_disk:
            return
        try:
            with atomic_write(self.folder / f"{self.token}{NOTE}") as stream:
                stream.write(msgspec.json.encode(PresenceNote(note.pid, stored(note.document), stored(note.autosave))))
        except FileError as error:
            raise FileError(
                "presence.refused", file=os.fspath(self.folder), reason=error.message.arguments["reason"]
            ) from error
        self._on_disk = self.note

    def leave(self) -> None:
        """Delete all files of this editor's record."""
        stream = self._stream
        if stream is None or stream.closed:
            return
        remove(self.folder / f"{self.token}{NOTE}")
        # Windows does not remove an open file.
        if sys.platform == "win32":
            stream.close()
            remove(self._lock_path)
        else:
            remove(self._lock_path)
            stream.close()

    @property
    def _lock_path(self) -> Path:
        return self.folder / f"{self.token}{LOCK}"

    def _is_here(self) -> bool:
        """Return whether the record still exists on disk; the folder may have been cleared."""
        stream = self._stream
        return stream is not None and not stream.closed and is_same_file(self._lock_path, stream)

    def _enter(self) -> None:
        if self._stream is not None:
            self._stream.close()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            sweep(self.folder)
            self._stream = _new_lock(self._lock_path)
        except OSError as error:
            reason = error.strerror or str(error)
            raise FileError("presence.refused", file=os.fspath(self.folder), reason=reason) from error


def editors(folder: Path) -> Iterator[tuple[str, bool]]:
    """Yield the token of every recorded editor, and whether it is running."""
    for path in sorted(folder.glob(f"*{LOCK}")):
        yield path.name.removesuffix(LOCK), is_locked(path)


def note_of(folder: Path, token: str) -> PresenceNote:
    """Return the note of an editor; an empty one if it has none."""
    path = folder / f"{token}{NOTE}"
    try:
        note = decode_json(read_file(path, MOST_NOTE_BYTES), PresenceNote, str(path))
    except FileError:
        return PresenceNote()
    return PresenceNote(note.pid, file_named(note.document), file_named(note.autosave))


def forget(folder: Path, token: str) -> None:
    """Delete the record of an ended editor, except its unsaved work."""
    remove(folder / f"{token}{NOTE}")
    remove(folder / f"{token}{LOCK}")


def is_open_elsewhere(document: Path, folder: Path, own_token: str = "") -> bool:
    """Return whether another running editor has this project file open.

    Parameters
    ----------
    document : Path
        The project file.
    folder : Path
        Folder with the records of running editors.
    own_token : str
        Token of this editor, which is not counted.
    """
    requested = os.path.realpath(document)
    return any(
        alive
        and token != own_token
        and (named := note_of(folder, token).document)
        and os.path.realpath(named) == requested
        for token, alive in editors(folder)
    )


def _new_lock(path: Path) -> IO[bytes]:
    while True:
        stream = path.open("xb")
        # Another editor that removes files of ended editors may have removed it before it was locked.
        if lock(stream) and is_same_file(path, stream):
            return stream
        stream.close()


def remove(path: Path) -> None:
    """Delete a file if it exists and the system allows it."""
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
msgspec.json.Decoder(PresenceNote)
