"""The open project with its undo history: every edit is applied here, with a name.

Edits are pure functions from project to project (`app.project.edit`); the document only stores values, so a failing
edit has no effect, and history is cheap because unchanged parts are shared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from app.errors import Message
from app.project.check import require_sound
from app.project.model import Project

MOST_STEPS = 1000
"""Greatest number of undo steps; the oldest are discarded first."""


@dataclass(frozen=True, eq=False)
class UndoStep:
    """An applied edit that can be undone: its name, and the project before and after it.

    ``gesture`` is the token of the drag or slider, None for a single edit.
    """

    name: Message
    before: Project
    after: Project
    gesture: object | None = None


@dataclass(frozen=True, eq=False)
class Change:
    """Notification for observers, which should compare values by identity (``is``) and must not edit while notified.

    ``origin`` is the object that requested the edit, so that it can ignore its own change; None for undo, redo and
    opening. ``opened`` is True if another project was opened.
    """

    before: Project
    after: Project
    origin: object | None = None
    opened: bool = False


Observer = Callable[[Change], None]


class Document:
    """A project with its undo history; edits replace the immutable project."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._undone: list[UndoStep] = []
        self._done: list[UndoStep] = []
        self._saved = project
        self._observers: list[Observer] = []
        self._telling = False

    @property
    def project(self) -> Project:
        """The project after the last edit or undo."""
        return self._project

    @property
    def is_saved(self) -> bool:
        """True if the current project is the last saved one."""
        return self._project is self._saved

    @property
    def done(self) -> tuple[UndoStep, ...]:
        """Edits that can be undone, oldest first."""
        return tuple(self._done)

    @property
    def undone(self) -> tuple[UndoStep, ...]:
        """Edits that can be redone, the next one last."""
        return tuple(self._undone)

    def observe(self, observer: Observer) -> Callable[[], None]:
        """Register an observer of all changes; call the returned function to remove it."""
        self._observers.append(observer)
        return lambda: self._observers.remove(observer)

    def apply(
        self, name: Message, project: Project, gesture: object | None = None, origin: object | None = None
    ) -> None:
        """Make ``project`` the current project, as an undoable step; an equal project makes no step.

        Parameters
        ----------
        name : Message
            Name shown in the history.
        project : Project
            Result of an edit of `project`; the same object makes no step.
        gesture : object, optional
            Consecutive edits with the same token (a drag, a slider) form one step, which is dropped if it returns to
            its start.
        origin : object, optional
            Object that requested the edit, passed to the observers.

        Raises
        ------
        UsageError
            The project is invalid and could not be saved; nothing is changed.
        """
        before = self._project
        if project is before or project == before:
            return
        require_sound(project, before)
        last = self._done[-1] if self._done else None
        if gesture is not None and last is not None and last.gesture is gesture and last.after is before:
            self._done.pop()
            if project is not last.before and project != last.before:
                self._done.append(replace(last, name=name, after=project))
            else:
                project = last.before
        else:
            self._done.append(UndoStep(name, before, project, gesture))
            del self._done[:-MOST_STEPS]
        self._undone.clear()
        self._become(project, origin)

    def end_gesture(self) -> None:
        """End a drag: a following edit is a new step even with the same token."""
        if self._done and self._done[-1].gesture is not None:
            self._done[-1] = replace(self._done[-1], gesture=None)

    def cancel_gesture(self, gesture: object) -> bool:
        """Revert to the start of a drag; return whether the last step belonged to it."""
        last = self._done[-1] if self._done else None
        if last is None or last.gesture is not gesture:
            return False
        self._done.pop()
        self._become(last.before, None)
        return True

    def undo(self) -> Message | None:
        """Undo the last step; returns its name, or None without one."""
        if not self._done:
            return None
        step = self._done.pop()
        self._undone.append(step)
        self._become(step.before, None)
        return step.name

    def redo(self) -> Message | None:
        """Redo the step undone last; returns its name, or None without one."""
        if not self._undone:
            return None
        step = self._undone.pop()
        self._done.append(replace(step, gesture=None))
        self._become(step.after, None)
        return step.name

    def mark_saved(self, project: Project) -> None:
        """Record that ``project`` is the version saved in the file."""
        self._saved = project

    def mark_unsaved(self) -> None:
        """Mark the project as unsaved, e.g. after recovery from a crash."""
        self._saved = replace(self._project)

    def open(self, project: Project) -> None:
        """Replace the project by another one, with an empty history."""
        self._done.clear()
        self._undone.clear()
        self._saved = project
        self._become(project, None, opened=True)

    def _become(self, project: Project, origin: object | None, opened: bool = False) -> None:
        if self._telling:
            raise RuntimeError("an observer writes while it is notified of a change")
        before, self._project = self._project, project
        if before is project and not opened:
            return
        self._telling = True
        try:
            for observer in tuple(self._observers):
                observer(Change(before, project, origin, opened))
        finally:
            self._telling = False
