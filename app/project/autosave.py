"""Saves unsaved work automatically next to the project's file, never over it.

Times are arguments, so that tests need not wait; the editor asks when a save is due. A save is a value (`Writing`) that
runs in the background.

Unsaved work goes to the user's state folder, separately for each running editor, in these cases: the project has no
file yet; a second editor has the file open (two editors must not share an autosave); there is an undecided recovery
file next to it; or the project's folder cannot be written (read-only, full, gone, not responding).

If a project cannot be saved, which no edit should cause, it is saved without the offending value.
"""

from __future__ import annotations

import os
import secrets
import threading
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from app.encoding import stored
from app.errors import Argument, FileError, Message
from app.formats.atomic import atomic_write
from app.project.model import Project
from app.project.running_editors import Presence, is_open_elsewhere, remove
from app.project.salvage import salvaged
from app.project.storage import AUTOSAVE, Autosaved, encode_autosave, load

DELAY_S: Final = 4.0
"""Seconds from the first unsaved change to an autosave; including the writing, a crash loses at most five seconds of
work.
"""
PATIENCE_S: Final = 5.0
"""Longest wait in seconds for a disk, such as a network disk."""
MOST_PENDING: Final = 2
"""Greatest number of pending autosaves: one for the project's disk, one for the state folder's."""


def autosave_path(document: Path) -> Path:
    """Return the path of the autosave for a project file."""
    return document.with_name(document.name + AUTOSAVE)


@dataclass(frozen=True)
class AutosaveResult:
    """Result of one autosave.

    Attributes
    ----------
    path : Path or None
        Path of the autosave; None if a newer one exists already.
    held : frozenset of Path
        All files that hold a current or earlier state of this work.
    warning : Message or None
        Warning if it was not saved next to the project's file.
    without : Message or None
        Message about content that was left out because it cannot be saved.
    project : Project or None
        The saved project.
    """

    path: Path | None
    held: frozenset[Path]
    warning: Message | None = None
    without: Message | None = None
    project: Project | None = None


class _OwnPlace:
    """Serialises writes to the state folder, so that a delayed autosave does not replace a newer one."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.generation = 0


@dataclass(frozen=True, eq=False)
class Writing:
    """A snapshot to be autosaved, which can run on another thread.

    Attributes
    ----------
    held : frozenset of Path
        Files with earlier generations of this work; they may be replaced, and are deleted once a newer one exists.
    asks_usual : bool
        Whether the place next to the project's file is tried first; False while another save there is still waiting.
    former : Project or None
        Previously saved state of the work.
    """

    project: Project
    facts: Autosaved
    document: Path | None
    presence: Presence
    held: frozenset[Path]
    asks_usual: bool
    own_place: _OwnPlace
    former: Project | None = None

    def run(self) -> AutosaveResult:
        """Save the snapshot atomically, without values that cannot be saved.

        Raises
        ------
        FileError
            No place can be written, or nothing of the project can be saved.
        """
        try:
            return self._run()
        except FileError as error:
            if error.message.id != "project.cannot_save":
                raise
            rest = salvaged(self.project, self.former if self.former is not None else self._saved())
            if rest is None:
                raise
            place, detail = (str(error.message.arguments[name]) for name in ("place", "detail"))
            without: dict[str, Argument] = {"place": place, "detail": detail, "count": max(len(rest.left_out), 1)}
            written = replace(self, project=rest.project)._run()
            return replace(written, without=Message("autosave.without", without))

    def _saved(self) -> Project | None:
        """Return the project as now stored in its own file; None if there is no file or it cannot be read."""
        try:
            return None if self.document is None else load(self.document)
        except FileError:
            # Missing or damaged, so there is no replacement for content that cannot be saved.
            return None

    def _run(self) -> AutosaveResult:
        beside, refusal = self._usual(), ""
        if beside is not None:
            try:
                self._write(beside)
                return self._written(beside)
            except FileError as error:
                if error.message.id != "file.cannot_write":
                    raise
                refusal = str(error.message.arguments["reason"])
        folder = self.presence.folder
        place = {"file": str(self.document or ""), "folder": os.fspath(folder)}
        with self.own_place.lock:
            if self.own_place.generation > self.facts.generation:
                return AutosaveResult(None, self.held)
            try:
                folder.mkdir(parents=True, exist_ok=True)
                self._write(self.presence.own_path)
            except (FileError, OSError) as error:
                reason = _reason(error)
                if refusal:
                    place |= {"reason": refusal, "folder_reason": reason}
                    raise FileError("autosave.refused", **place) from error
                raise FileError("autosave.nowhere", **place, reason=reason) from error
            self.own_place.generation = self.facts.generation
        warning = Message("autosave.elsewhere", {**place, "reason": refusal}) if refusal else None
        return self._written(self.presence.own_path, warning)

    def _usual(self) -> Path | None:
        """Return the path of the autosave next to the project's file; None if this editor may not use it."""
        document, presence = self.document, self.presence
        if document is None or not self.asks_usual or is_open_elsewhere(document, presence.folder, presence.token):
            return None
        beside = autosave_path(document)
        # Files left by a crash stay until the user decides about them.
        return beside if beside in self.held or not os.path.lexists(beside) else None

    def _write(self, path: Path) -> None:
        # The actual folder, resolving links, since the project may come from elsewhere.
        place = Path(os.path.realpath(path.parent)) / path.name
        content = encode_autosave(self.project, place, self.facts)
        with atomic_write(place, follow_link=False) as stream:
            stream.write(content)

    def _written(self, path: Path, warning: Message | None = None) -> AutosaveResult:
        former = self.held - {path}
        if self.asks_usual:
            for one in former:
                remove(one)
            former = frozenset(filter(os.path.lexists, former))
        return AutosaveResult(path, former | {path}, warning, project=self.project)


def _reason(error: FileError | OSError) -> str:
    if isinstance(error, OSError):
        return error.strerror or str(error)
    if error.message.id != "file.cannot_write":
        raise error
    return str(error.message.arguments["reason"])


class Autosave:
    """Schedule and files of one editor's autosaves.

    Parameters
    ----------
    presence : Presence
        This editor's record of open files.
    """

    def __init__(self, presence: Presence, delay_s: float = DELAY_S) -> None:
        self.presence = presence
        self.delay_s = delay_s
        self._document: Path | None = None
        self._begin("", None)

    def _begin(self, base: str, former: Autosaved | None) -> None:
        """Start tracking another project, and discard the state of the previous one."""
        self._project: Project | None = None
        self._written: Project | None = None
        self._former: Project | None = None
        self._changed_s: float | None = None
        self._base = base
        self._work = secrets.token_hex(8) if former is None else former.work
        self._generation = self._newest = 0 if former is None else former.generation
        self._held: frozenset[Path] = frozenset()
        self._pending: dict[Writing, float] = {}
        self._own_place = _OwnPlace()

    @property
    def document(self) -> Path | None:
        """Path of the project's file; None before it has one."""
        return self._document

    @property
    def is_shared(self) -> bool:
        """True if another living editor works on the same file."""
        return self._document is not None and is_open_elsewhere(
            self._document, self.presence.folder, self.presence.token
        )

    @property
    def due_s(self) -> float | None:
        """Return the time in seconds at which the next autosave is due; None if everything is saved or being saved."""
        if self._changed_s is None or len(self._pending) >= MOST_PENDING:
            return None
        # A request that is not answered is not waited for.
        return max([self._changed_s + self.delay_s, *(taken_s + PATIENCE_S for taken_s in self._pending.values())])

    def has(self, project: Project) -> bool:
        """Return whether a state of the project is saved, in its file or an autosave."""
        return project is self._written

    @property
    def has_work(self) -> bool:
        """Return whether the project has changes that are not in its file."""
        return self._project is not None or bool(self._held)

    def is_current(self, writing: Writing) -> bool:
        """Return whether a save belongs to the open project."""
        return writing.own_place is self._own_place

    def opened(
        self, document: Path | None, base: str = "", former: Autosaved | None = None, held: Path | None = None
    ) -> None:
        """Begin with a project that was just read from or saved to a file, or is new (None). Earlier unsaved work was
        saved or discarded, so its recovery files are removed.

        Parameters
        ----------
        base : str
            `app.project.storage.content_hash` of that file.
        former : Autosaved, optional
            The autosave from which the project was recovered.
        held : Path, optional
            File of the recovered work. It belongs to this editor from now on, and is deleted after the next autosave.

        Raises
        ------
        FileError
            The record of open files cannot be written.
        """
        self._drop()
        self._begin(base, former)
        self._document = document
        if held is not None:
            self._held = frozenset((held,))
        self._report(held)

    def changed(self, project: Project, now_s: float) -> None:
        """Report a change of the project that is not in its file."""
        self._project = project
        if project is self._written:
            # Undo led back to the saved state.
            self._changed_s = None
        elif self._changed_s is None:
            self._changed_s = now_s

    def due(self, now_s: float) -> Writing | None:
        """Return the autosave to be made now, or None. Run it directly or in the background, then call `ended`, and
        `written` if it succeeded.
        """
        if self.due_s is None or now_s < self.due_s:
            return None
        return self.take(now_s)

    def take(self, now_s: float) -> Writing | None:
        """Return the next autosave immediately; None if everything is saved."""
        if self._project is None or self._changed_s is None:
            return None
        self._changed_s = None
        self._generation += 1
        facts = Autosaved(self._work, self._generation, self.presence.token, stored(self._document or ""), self._base)
        asks_usual = not self._pending
        own = self._own_place
        writing = Writing(
            self._project, facts, self._document, self.presence, self._held, asks_usual, own, self._former
        )
        self._pending[writing] = now_s
        return writing

    def ended(self, writing: Writing, now_s: float) -> None:
        """Report that a save has finished, successfully or not. Work that was not saved becomes due again after the
        delay.
        """
        if self._pending.pop(writing, None) is not None and self._changed_s is None:
            self._changed_s = now_s

    def written(self, writing: Writing, written: AutosaveResult) -> None:
        """Record that an autosave was written. Raises FileError if the record of open files cannot be written."""
        path = written.path
        if path is None:
            return
        if not self.is_current(writing) or writing.facts.generation < self._newest:
            # The project was saved or closed meanwhile, or a newer copy was written elsewhere.
            remove(path)
            if path in self._held and self._project is not None:
                # The new file replaced the recovered one.
                self._held -= {path}
                self._written, self._changed_s = None, 0.0
            return
        self._newest, self._written, self._held = writing.facts.generation, writing.project, written.held
        self._former = written.project
        if self._project is writing.project:
            self._changed_s = None
        self._report(path)

    def closed(self) -> None:
        """End orderly: delete this editor's autosaves, since nothing is left to recover."""
        self._drop()
        self.presence.leave()

    def _drop(self) -> None:
        for path in self._held:
            remove(path)
        self._held = frozenset()

    def _report(self, autosave: Path | None = None) -> None:
        self.presence.report(self._document, autosave)
