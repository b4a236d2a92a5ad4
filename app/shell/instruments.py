"""A person's own instruments, read again as soon as their files change."""

from __future__ import annotations

from PySide6.QtCore import QFileSystemWatcher, QObject, QTimer

from app.errors import Message
from instrument_maps.library import Library, library, own_folder, reload
from widgets.common.session import Session, Severity
from widgets.common.tasks import Progress, StopWanted

QUIET_MS = 250
"""An editor that saves touches a file several times: it is read when nothing was heard of it for so long."""


class InstrumentWatch(QObject):
    """Watches the folder of a person's own maps and models for a session.

    What became wrong is told with its place in the file, and its last good version stays in use; everybody whose
    instrument is another one hears `Session.instruments_changed`.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._known = library()
        self._watcher = QFileSystemWatcher(self)
        self._watcher.directoryChanged.connect(self._touched)
        self._watcher.fileChanged.connect(self._touched)
        self._quiet = QTimer(self, interval=QUIET_MS, singleShot=True)
        self._quiet.timeout.connect(self.read)
        self._watch()
        session.instruments_saved.connect(self.read)
        QTimer.singleShot(0, self, self._tell_first)

    def read(self) -> None:
        """Read the folder again now."""
        self._watch()

        def work(progress: Progress, stop_wanted: StopWanted) -> Library:
            return reload()

        self._session.tasks.run(Message("work.instruments"), work, self._took, key="instruments")

    def _tell_first(self) -> None:
        """What was wrong when the program began."""
        for problems in self._known.problems.values():
            self._session.notice(problems[0], Severity.ERROR)

    def _took(self, now: Library) -> None:
        before, self._known = self._known, now
        if now is before:
            return
        changed = [id for id in {**before.maps, **now.maps} if before.maps.get(id) is not now.maps.get(id)]
        self._session.instruments_changed.emit()
        wrong = [problems[0] for path, problems in now.problems.items() if before.problems.get(path) != problems]
        if wrong:
            self._session.notice(wrong[0], Severity.ERROR)
        elif changed:
            self._session.notice(Message("instruments.read_again", {"maps": ", ".join(sorted(changed))}))

    def _touched(self) -> None:
        self._quiet.start()

    def _watch(self) -> None:
        """Watch the folder and its files; a folder that is not there yet, by the one it would be in."""
        folder = own_folder()
        wanted = {str(next(place for place in (folder, *folder.parents) if place.is_dir()))}
        if folder.is_dir():
            wanted |= {str(path) for path in folder.iterdir() if path.suffix in (".toml", ".glb")}
        watched = {*self._watcher.directories(), *self._watcher.files()}
        if gone := watched - wanted:
            self._watcher.removePaths(sorted(gone))
        if new := wanted - watched:
            self._watcher.addPaths(sorted(new))
