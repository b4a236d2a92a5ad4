"""Reloads user libraries as soon as files in their folders change."""

from __future__ import annotations

from functools import partial
from typing import Any

from PySide6.QtCore import QObject, QTimer

from app.editor.folder_watch import FolderWatch
from app.editor.session import Session, Severity
from app.errors import Message, Progress, StopRequested
from app.formats.user_folder import Shelf, UserFolder
from app.rig.characters.character_library import LIBRARY as CHARACTERS
from instrument_maps.library import LIBRARY as INSTRUMENTS
from metadata.library import FOLDERS


class LibraryWatch(QObject):
    """Watches one library's folder for a session.

    An invalid file is reported with the place of the error, and its last valid version stays in use. The session emits
    ``{name}_changed``, and ``{name}_saved`` if the program itself wrote into the folder.

    Parameters
    ----------
    read_again : str, optional
        Id of the message shown after reloading changed files.
    family : str, optional
        The ``name`` in these signals, if it differs from the library's name.
    """

    def __init__(self, session: Session, library: UserFolder[Any, Any], read_again: str = "", family: str = "") -> None:
        super().__init__(session)
        self._session, self._library, self._read_again = session, library, read_again
        self._family = family or library.name
        self._changed = getattr(session, f"{self._family}_changed")
        self._known: Shelf[Any] = library.begin()
        self._watch = FolderWatch(self, library.folder, library.suffixes)
        self._watch.changed.connect(self.read)
        getattr(session, f"{self._family}_saved").connect(self._saved)
        self._is_first = True
        for problems in self._known.problems.values():
            QTimer.singleShot(0, self, partial(session.notice, problems[0], Severity.ERROR))
        QTimer.singleShot(0, self, self.read)

    def read(self) -> None:
        """Reload the folder now."""
        self._watch.look()

        def work(progress: Progress, stop_requested: StopRequested) -> Shelf[Any]:
            now: Shelf[Any] = self._library.reload()
            return now

        said = Message(f"work.{self._family}")
        self._session.tasks.run(said, work, self._took, key=self._library.name)

    def _saved(self) -> None:
        """Reload the library after the program itself wrote into its folder, without waiting for the watcher."""
        self._take(self._library.now())
        self.read()

    def _took(self, now: Shelf[Any]) -> None:
        self._take(now)
        self._is_first = False

    def _take(self, now: Shelf[Any]) -> None:
        before, self._known = self._known, now
        if now is before:
            return
        changed = [id for id in {**before.items, **now.items} if before.items.get(id) is not now.items.get(id)]
        self._changed.emit()
        wrong = [problems[0] for path, problems in now.problems.items() if before.problems.get(path) != problems]
        for problem in wrong:
            self._session.notice(problem, Severity.ERROR)
        if self._read_again and changed and not wrong and not self._is_first:
            self._session.notice(Message(self._read_again, {"maps": ", ".join(sorted(changed))}))


def watch_instruments(session: Session) -> LibraryWatch:
    """Watch the folder of the user's instruments, so that changed files are read again."""
    return LibraryWatch(session, INSTRUMENTS, "instruments.read_again")


def watch_characters(session: Session) -> LibraryWatch:
    """Watch the folder of the user's characters, so that changed files are read again."""
    return LibraryWatch(session, CHARACTERS)


def watch_metadata(session: Session) -> tuple[LibraryWatch, ...]:
    """Watch the user's folders of styles, habits, expressions and other metadata; their files are read again when they
    change."""
    return tuple(LibraryWatch(session, folder, "metadata.read_again", "metadata") for folder in FOLDERS)
