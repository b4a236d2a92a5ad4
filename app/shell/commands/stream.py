"""Streaming to other programs while the performance plays."""

from __future__ import annotations

from app.editor.session import Session
from app.editor.streamer import streamer_of
from app.shell.action import Action
from app.shell.editor import editor_of


def toggle(session: Session, on: bool = True) -> None:
    """Stream, or no more."""
    session.streaming.set(on=not session.streaming.on)


def settings(session: Session) -> None:
    """Choose what is streamed, and where."""
    editor_of(session).window.show_streaming()


def _can_stream(session: Session) -> bool:
    return streamer_of(session) is not None and bool(session.project.performers)


ACTIONS: tuple[Action, ...] = (
    Action(
        "stream.toggle",
        toggle,
        "Export",
        "Ctrl+Alt+L",
        enabled=_can_stream,
        checked=lambda session: session.streaming.on,
        icon="stream",
    ),
    Action(
        "stream.settings",
        settings,
        "Export",
        enabled=lambda session: streamer_of(session) is not None,
        icon="settings",
    ),
)
