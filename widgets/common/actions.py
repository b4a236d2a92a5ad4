"""Actions of the shell's table, for panels that offer them."""

from __future__ import annotations

from PySide6.QtGui import QAction

from app.editor.session import Session


def actions(session: Session) -> dict[str, QAction]:
    """Actions of the table by id; empty before the shell has made the table, which is a child of the session."""
    return {action.objectName(): action for action in session.findChildren(QAction)}
