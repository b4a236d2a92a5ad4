"""Access to the shell's table of actions for panels."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction

from app.editor.session import Session
from app.editor.translated import tr

TABLE = "action_table"
"""Object name of the table, a child of the session."""


def actions(session: Session) -> Mapping[str, QAction]:
    """Return the actions by id; empty before the shell has made the table, which is a child of the session."""
    table = session.findChild(QObject, TABLE, Qt.FindChildOption.FindDirectChildrenOnly)
    found: Mapping[str, QAction] = getattr(table, "actions", {})
    return found


def with_keys(session: Session, action_id: str, text_id: str) -> Callable[[], str]:
    """Return a function that returns a tool tip: a text and the present shortcut of an action."""

    def text() -> str:
        action = actions(session).get(action_id)
        keys = action.shortcut().toString() if action is not None else ""
        return f"{tr(text_id)} ({keys})" if keys else tr(text_id)

    return text
