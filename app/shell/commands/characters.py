"""Commands for the user's own characters."""

from __future__ import annotations

from pathlib import Path

from app.shell.editor import Editor, EditorAction


def add(editor: Editor) -> None:
    """Ask for a character's file, and add the character."""
    from app.shell.characters import ask_for_character

    ask_for_character(editor)


def bring(editor: Editor, path: Path) -> None:
    """Add the character in a file to the user's characters."""
    from app.shell.characters import bring_character

    bring_character(editor, path)


def show(editor: Editor) -> None:
    """Open the list in which the user's own characters are changed and removed."""
    from app.shell.characters import show_characters

    show_characters(editor)


ACTIONS: tuple[EditorAction, ...] = (
    EditorAction("file.add_character", add, "file", icon="player"),
    EditorAction("application.characters", show, "edit", icon="players"),
)
