"""Undo and redo."""

from __future__ import annotations

from app.editor.session import Session
from app.errors import Message
from app.shell.action import Action


def _last_done(session: Session) -> Message | None:
    done = session.document.done
    return done[-1].name if done else None


def _last_undone(session: Session) -> Message | None:
    undone = session.document.undone
    return undone[-1].name if undone else None


ACTIONS: tuple[Action, ...] = (
    Action(
        "edit.undo",
        lambda session: session.document.undo(),
        "edit",
        "Ctrl+Z",
        enabled=lambda session: bool(session.document.done),
        icon="undo",
        step=_last_done,
    ),
    Action(
        "edit.redo",
        lambda session: session.document.redo(),
        "edit",
        "Ctrl+Shift+Z;Ctrl+Y",
        enabled=lambda session: bool(session.document.undone),
        icon="redo",
        step=_last_undone,
    ),
)
