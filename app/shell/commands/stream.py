"""Streaming to other programs while the performance plays."""

from __future__ import annotations

from app.editor.session import Session
from app.shell.action import Action
from app.shell.editor import Editor, EditorAction


def toggle(session: Session, on: bool = True) -> None:
    """Stream, or no more."""
    session.streaming.set(on=not session.streaming.on)


def settings(editor: Editor) -> None:
    """Choose what is streamed, and where; once."""
    from widgets.dialogs.stream import StreamDialog

    editor.show_once(StreamDialog, lambda: StreamDialog(editor.session, editor.window))


ACTIONS: tuple[Action | EditorAction, ...] = (
    Action(
        "stream.toggle",
        toggle,
        "export",
        "Ctrl+Alt+L",
        enabled=lambda session: bool(session.project.performers),
        checked=lambda session: session.streaming.on,
        icon="stream",
    ),
    EditorAction("stream.settings", settings, "export", icon="settings"),
)
