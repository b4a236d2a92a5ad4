"""Actions of the shell's table, for panels that offer them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction

from app.editor.session import Session
from app.editor.translated import tr

TABLE = "action_table"
"""Object name of the table, a child of the session."""


def actions(session: Session) -> Mapping[str, QAction]:
    """Actions of the table by id; empty before the shell has made the table, which is a child of the session."""
    table = session.findChild(QObject, TABLE, Qt.FindChildOption.FindDirectChildrenOnly)
    found: Mapping[str, QAction] = getattr(table, "actions", {})
    return found


def with_keys(session: Session, action_id: str, text_id: str) -> Callable[[], str]:
    """Return what makes a tip: the text of an id and the shortcut that its action has now."""

    def text() -> str:
        action = actions(session).get(action_id)
        keys = action.shortcut().toString() if action is not None else ""
        return f"{tr(text_id)} ({keys})" if keys else tr(text_id)

    return text
