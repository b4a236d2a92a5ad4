"""A person's own characters, read again as soon as their files change."""

from __future__ import annotations

from PySide6.QtCore import QFileSystemWatcher, QObject, QTimer

from app.errors import Message
from app.rig.character_library import CharacterLibrary, character_library, own_folder, reload_characters
from app.rig.read_figure import SUFFIXES
from widgets.common.session import Session, Severity
from widgets.common.tasks import Progress, StopWanted

QUIET_MS = 250
"""A program that writes a file touches it several times: it is read when nothing was heard of it for so long."""


class CharacterWatch(QObject):
    """Watches the folder of a person's own characters for a session.

    What is wrong is told, and its last good version stays in use; everybody whose character is another one hears
    `Session.characters_changed`.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._known = character_library()
        self._watcher = QFileSystemWatcher(self)
        self._watcher.directoryChanged.connect(self._touched)
        self._watcher.fileChanged.connect(self._touched)
        self._quiet = QTimer(self, interval=QUIET_MS, singleShot=True)
        self._quiet.timeout.connect(self.read)
        self._watch()
        session.characters_saved.connect(self.take)
        QTimer.singleShot(0, self, self._tell_first)

    def read(self) -> None:
        """Read the folder again now."""
        self._watch()

        def work(progress: Progress, stop_wanted: StopWanted) -> CharacterLibrary:
            return reload_characters()

        self._session.tasks.run(Message("work.characters"), work, lambda now: self.take(), key="characters")

    def take(self) -> None:
        """Tell everybody of what was read last."""
        self._watch()
        before, self._known = self._known, character_library()
        if self._known is before:
            return
        self._session.characters_changed.emit()
        wrong = [told for path, told in self._known.problems.items() if before.problems.get(path) != told]
        if wrong:
            self._session.notice(wrong[0], Severity.ERROR)

    def _tell_first(self) -> None:
        """What was wrong when the program began."""
        for told in self._known.problems.values():
            self._session.notice(told, Severity.ERROR)

    def _touched(self) -> None:
        self._quiet.start()

    def _watch(self) -> None:
        """Watch the folder and its files; a folder that is not there yet, by the one it would be in."""
        folder = own_folder()
        wanted = {str(next(place for place in (folder, *folder.parents) if place.is_dir()))}
        if folder.is_dir():
            wanted |= {str(path) for path in folder.iterdir() if path.suffix in (".toml", *SUFFIXES)}
        watched = {*self._watcher.directories(), *self._watcher.files()}
        if gone := watched - wanted:
            self._watcher.removePaths(sorted(gone))
        if new := wanted - watched:
            self._watcher.addPaths(sorted(new))
