"""Undo and redo."""

from __future__ import annotations

from app.editor.session import Session
from app.shell.action import Action


def undo(session: Session) -> None:
    """Take the last step back."""
    session.document.undo()


def redo(session: Session) -> None:
    """Make the step again that was taken back last."""
    session.document.redo()


def _can_undo(session: Session) -> bool:
    return bool(session.document.done)


def _can_redo(session: Session) -> bool:
    return bool(session.document.undone)


ACTIONS: tuple[Action, ...] = (
    Action("edit.undo", undo, "Edit", "Ctrl+Z", enabled=_can_undo, icon="undo"),
    Action(
        "edit.redo",
        redo,
        "Edit",
        "Ctrl+Shift+Z;Ctrl+Y",
        enabled=_can_redo,
        icon="redo",
    ),
)
