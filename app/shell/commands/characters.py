"""The user's own characters."""

from __future__ import annotations

from app.editor.session import Session
from app.shell.action import Action
from app.shell.editor import editor_of


def add(session: Session) -> None:
    """Bring a character from a file."""
    editor_of(session).window.add_character()


def show(session: Session) -> None:
    """See which there are, change and remove them."""
    editor_of(session).window.show_characters()


ACTIONS: tuple[Action, ...] = (
    Action("file.add_character", add, "File", icon="player"),
    Action("application.characters", show, "Edit", icon="players"),
)
