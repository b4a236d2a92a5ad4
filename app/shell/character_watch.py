"""A person's own characters, read again as soon as their files change."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QObject, QTimer

from app.errors import Message
from app.rig.character_library import (
    CharacterLibrary,
    begin_characters,
    character_library,
    own_folder,
    reload_characters,
)
from app.rig.read_figure import SUFFIXES
from app.shell.folder_watch import FolderWatch
from widgets.common.session import Session, Severity
from widgets.common.tasks import Progress, StopWanted


class CharacterWatch(QObject):
    """Watches the folder of a person's own characters for a session.

    What is wrong is told, and its last good version stays in use; everybody whose character is another one hears
    `Session.characters_changed`.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._known = begin_characters()
        self._watch = FolderWatch(self, own_folder, (".toml", *SUFFIXES))
        self._watch.changed.connect(self.read)
        session.characters_saved.connect(self.take)
        for told in self._known.problems.values():
            QTimer.singleShot(0, self, partial(session.notice, told, Severity.ERROR))
        QTimer.singleShot(0, self, self.read)

    def read(self) -> None:
        """Read the folder again now."""
        self._watch.look()

        def work(progress: Progress, stop_wanted: StopWanted) -> CharacterLibrary:
            return reload_characters()

        self._session.tasks.run(Message("work.characters"), work, lambda now: self.take(), key="characters")

    def take(self) -> None:
        """Tell everybody of what was read last."""
        self._watch.look()
        before, self._known = self._known, character_library()
        if self._known is before:
            return
        self._session.characters_changed.emit()
        for path, told in self._known.problems.items():
            if before.problems.get(path) != told:
                self._session.notice(told, Severity.ERROR)
