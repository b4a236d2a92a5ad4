"""Watches a folder of user files for changes."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Collection
from pathlib import Path

from PySide6.QtCore import QFileSystemWatcher, QObject, QTimer, Signal

from app.encoding import is_text
from app.errors import FileError
from app.formats.files import files_in

QUIET_MS = 250
"""Milliseconds without further changes after which a changed file is reported, since programs write a file in several
steps.
"""


class FolderWatch(QObject):
    """Watches a folder, and emits a signal when a file in it changes.

    Parameters
    ----------
    folder : callable
        Function that returns the folder, which need not exist yet.
    suffixes : collection of str
        Suffixes of the files to watch; others are ignored.
    """

    changed = Signal()

    def __init__(self, parent: QObject, folder: Callable[[], Path], suffixes: Collection[str]) -> None:
        super().__init__(parent)
        self._folder, self._suffixes = folder, frozenset(suffixes)
        self._quiet = QTimer(self, interval=QUIET_MS, singleShot=True)
        self._quiet.timeout.connect(self.changed)
        self._watcher = QFileSystemWatcher(self)
        self._watcher.directoryChanged.connect(self._touched)
        self._watcher.fileChanged.connect(self._touched)
        self.look()

    def look(self) -> None:
        """Watch the folder and its files; if the folder does not exist, watch its parent."""
        folder = self._folder()
        requested = {str(next(place for place in (folder, *folder.parents) if os.path.isdir(place)))}
        with contextlib.suppress(FileError):  # reading the folder reports the error
            requested |= {str(path) for path in files_in(folder, *self._suffixes) if os.path.exists(path)}
        # Qt would watch another folder if the path is not valid UTF-8.
        requested = set(filter(is_text, requested))
        watched = {*self._watcher.directories(), *self._watcher.files()}
        if gone := watched - requested:
            self._watcher.removePaths(sorted(gone))
        if new := requested - watched:
            self._watcher.addPaths(sorted(new))

    def _touched(self) -> None:
        self._quiet.start()
