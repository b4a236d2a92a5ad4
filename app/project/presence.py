"""Which editors are alive: each keeps a locked file, and beside it a note of what it works on.

The system takes a lock away when its process ends, however it ends; so a file that can be locked belonged to an
editor that is gone. Process numbers alone would not do: they are given again.
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
import platformdirs

from app.errors import FileError
from app.formats.atomic import atomic_write, sweep
from app.formats.locks import is_locked, is_same_file, lock

LOCK: Final = ".lock"
NOTE: Final = ".json"


class Note(msgspec.Struct, frozen=True):
    """What an editor works on.

    Attributes
    ----------
    pid : int
        For people; the lock says whether the editor lives.
    document : str
        Absolute path of the project's file; empty for one that was never saved.
    autosave : str
        Absolute path of the file that holds its unsaved work.
    """

    pid: int = 0
    document: str = ""
    autosave: str = ""


def recovery_folder() -> Path:
    """Where the unsaved work of projects without a file is kept."""
    return platformdirs.user_state_path("suisou", appauthor=False) / "recovery"


class Presence:
    """This editor, alive until `leave` or the end of its process.

    Parameters
    ----------
    folder : Path
        `recovery_folder`; made if needed.

    Raises
    ------
    FileError
        ``file.cannot_write``: the folder cannot be used.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.note = Note(os.getpid())
        try:
            folder.mkdir(parents=True, exist_ok=True)
            sweep(folder)
            self.token, self._stream = _new_lock(folder)
        except OSError as error:
            reason = error.strerror or str(error)
            raise FileError("file.cannot_write", file=os.fspath(folder), reason=reason) from error

    def tell(self, document: Path | None, autosave: Path | None) -> None:
        """Note down what this editor works on. Raises FileError."""
        note = Note(os.getpid(), str(document or ""), str(autosave or ""))
        if note != self.note:
            with atomic_write(self.folder / f"{self.token}{NOTE}") as stream:
                stream.write(msgspec.json.encode(note))
            self.note = note

    def leave(self) -> None:
        """Nothing is left to recover: take every trace away."""
        if not self._stream.closed:
            remove(self.folder / f"{self.token}{NOTE}")
            # On Windows an open file cannot be removed.
            if sys.platform == "win32":
                self._stream.close()
                remove(self.folder / f"{self.token}{LOCK}")
            else:
                remove(self.folder / f"{self.token}{LOCK}")
                self._stream.close()


def editors(folder: Path) -> Iterator[tuple[str, bool]]:
    """The token of every editor that left a trace, and whether it lives."""
    for path in sorted(folder.glob(f"*{LOCK}")):
        yield path.name.removesuffix(LOCK), is_locked(path)


def note_of(folder: Path, token: str) -> Note:
    """What an editor works on; an empty note where it left none."""
    try:
        return msgspec.json.decode((folder / f"{token}{NOTE}").read_bytes(), type=Note)
    except (OSError, msgspec.MsgspecError):
        return Note()


def forget(folder: Path, token: str) -> None:
    """Take the traces of a dead editor away, its unsaved work excepted."""
    remove(folder / f"{token}{NOTE}")
    remove(folder / f"{token}{LOCK}")


def is_open_elsewhere(document: Path, folder: Path, own_token: str = "") -> bool:
    """Whether another living editor works on this project file."""
    wanted = os.path.realpath(document)
    return any(
        alive
        and token != own_token
        and (named := note_of(folder, token).document)
        and os.path.realpath(named) == wanted
        for token, alive in editors(folder)
    )


def _new_lock(folder: Path) -> tuple[str, IO[bytes]]:
    while True:
        token = secrets.token_hex(8)
        path = folder / f"{token}{LOCK}"
        stream = path.open("xb")
        # Somebody who looks for dead editors may have taken it for one between the two steps.
        if lock(stream) and is_same_file(path, stream):
            return token, stream
        stream.close()


def remove(path: Path) -> None:
    """Take a file away if it is there and the system lets it go."""
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)


# Worked out here, under the import's lock: two threads that use a type for the first time at once crash msgspec.
msgspec.json.Decoder(Note)
