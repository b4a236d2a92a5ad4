"""A person's own instruments, read again as soon as their files change."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QObject, QTimer

from app.errors import Message
from app.shell.folder_watch import FolderWatch
from instrument_maps.library import Library, begin, own_folder, reload
from widgets.common.session import Session, Severity
from widgets.common.tasks import Progress, StopWanted


class InstrumentWatch(QObject):
    """Watches the folder of a person's own maps and models for a session.

    What became wrong is told with its place in the file, and its last good version stays in use; everybody whose
    instrument is another one hears `Session.instruments_changed`.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._known = begin()
        self._watch = FolderWatch(self, own_folder, (".toml", ".glb"))
        self._watch.changed.connect(self.read)
        session.instruments_saved.connect(self.read)
        self._is_first = True
        for problems in self._known.problems.values():
            QTimer.singleShot(0, self, partial(session.notice, problems[0], Severity.ERROR))
        QTimer.singleShot(0, self, self.read)

    def read(self) -> None:
        """Read the folder again now."""
        self._watch.look()

        def work(progress: Progress, stop_wanted: StopWanted) -> Library:
            return reload()

        self._session.tasks.run(Message("work.instruments"), work, self._took, key="instruments")

    def _took(self, now: Library) -> None:
        before, self._known = self._known, now
        is_first, self._is_first = self._is_first, False
        if now is before:
            return
        changed = [id for id in {**before.maps, **now.maps} if before.maps.get(id) is not now.maps.get(id)]
        self._session.instruments_changed.emit()
        wrong = [problems[0] for path, problems in now.problems.items() if before.problems.get(path) != problems]
        for problem in wrong:
            self._session.notice(problem, Severity.ERROR)
        if changed and not wrong and not is_first:
            self._session.notice(Message("instruments.read_again", {"maps": ", ".join(sorted(changed))}))
