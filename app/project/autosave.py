"""Unsaved work is written down by itself, beside the project's file and never over it.

When to write is decided here from times that are handed in, so that a test never sleeps; the shell asks every second
or so. Writing is a value (`Writing`) that can be done in the background.

A project that has no file yet is kept in the user's state folder, each running editor its own; so is one whose file a
second editor has open, because two editors must not write one autosave, and one beside whose file a crash left work
that nobody has decided about.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from app.formats.atomic import atomic_write, sweep
from app.project.model import Project
from app.project.presence import Presence, is_open_elsewhere, remove
from app.project.storage import AUTOSAVE, SUFFIX, encode

DELAY_S: Final = 30.0
"""From the first change that is not written down yet."""


def autosave_path(document: Path) -> Path:
    """Where the unsaved work on a project's file is kept."""
    return document.with_name(document.name + AUTOSAVE)


@dataclass(frozen=True, eq=False)
class Writing:
    """An autosave to be made: a snapshot, so that it can be made on another thread."""

    project: Project
    path: Path
    period: object
    """Stands for the time between two savings: what was taken in one is nothing in the next."""

    def run(self) -> None:
        """Write it; what was there is replaced only when the new one is whole. Raises FileError."""
        content = encode(self.project, self.path)
        with atomic_write(self.path) as stream:
            stream.write(content)


class Autosave:
    """When one editor's unsaved work is written, and where.

    Parameters
    ----------
    presence : Presence
        This editor's.
    delay_s : float
    """

    def __init__(self, presence: Presence, delay_s: float = DELAY_S) -> None:
        self.presence = presence
        self.delay_s = delay_s
        self._document: Path | None = None
        self._project: Project | None = None
        self._changed_s: float | None = None
        self._written: Project | None = None
        self._period = object()

    @property
    def document(self) -> Path | None:
        """The project's file; None before it has one."""
        return self._document

    @property
    def is_shared(self) -> bool:
        """Whether another living editor works on the same file."""
        return self._document is not None and is_open_elsewhere(
            self._document, self.presence.folder, self.presence.token
        )

    @property
    def path(self) -> Path:
        """Where the unsaved work goes."""
        own = self.presence.folder / f"{self.presence.token}{SUFFIX}"
        if self._document is None or self.is_shared:
            return own
        beside = autosave_path(self._document)
        # What a crash left there stays until the person has decided about it.
        return own if beside.exists() and str(beside) != self.presence.note.autosave else beside

    @property
    def due_s(self) -> float | None:
        """When the next autosave is to be made; None: everything is written down."""
        return None if self._changed_s is None else self._changed_s + self.delay_s

    def has(self, project: Project) -> bool:
        """Whether this project is written down."""
        return project is self._written

    def opened(self, document: Path | None) -> None:
        """Another project is open now, from this file or without one; the one before was saved or given up.

        Raises
        ------
        FileError
            The note of what this editor works on cannot be written.
        """
        self._drop()
        self._document = document
        if document is not None:
            sweep(Path(os.path.realpath(document)).parent)
        self._tell()

    def changed(self, project: Project, now_s: float) -> None:
        """The project is this now and is not in its file."""
        self._project = project
        if project is self._written:
            # Undone to what is written down already.
            self._changed_s = None
        elif self._changed_s is None:
            self._changed_s = now_s

    def due(self, now_s: float) -> Writing | None:
        """The autosave to be made now; None where there is none. To be done at once or in the background, and
        reported with `written`, or with `failed`."""
        if self.due_s is None or now_s < self.due_s:
            return None
        return self.take()

    def take(self) -> Writing | None:
        """The autosave that would be due next, now; None where everything is written down."""
        if self._project is None or self._changed_s is None:
            return None
        self._changed_s = None
        return Writing(self._project, self.path, self._period)

    def written(self, writing: Writing) -> None:
        """It was done. Raises FileError where the note of it cannot be written."""
        before = self.presence.note.autosave
        if writing.period is not self._period:
            # Meanwhile the project was saved or closed: what was written is nobody's.
            if str(writing.path) != before:
                remove(writing.path)
            return
        self._written = writing.project
        self._tell(writing.path)
        if before and before != str(writing.path):
            remove(Path(before))

    def failed(self, writing: Writing, now_s: float) -> None:
        """It could not be done; it is tried again after the delay."""
        if writing.period is self._period and self._changed_s is None:
            self._changed_s = now_s

    def saved(self, document: Path) -> None:
        """The project, as it is, was saved to this file: there is nothing to recover any more. Raises FileError."""
        self._drop()
        if not is_open_elsewhere(document, self.presence.folder, self.presence.token):
            remove(autosave_path(document))
        self._document = document
        self._tell()

    def closed(self) -> None:
        """The editor ends in an orderly way: nothing is left to recover."""
        self._drop()
        self.presence.leave()

    def _drop(self) -> None:
        written = self.presence.note.autosave
        if written:
            remove(Path(written))
        self._project = self._written = self._changed_s = None
        self._period = object()

    def _tell(self, autosave: Path | None = None) -> None:
        self.presence.tell(self._document, autosave)
