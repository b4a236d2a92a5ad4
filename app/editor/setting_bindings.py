"""Bindings between settings and the session that they are restored to and remembered from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from PySide6.QtCore import SignalInstance

from app.editor.session import Session
from app.editor.tokens import THEMES


@dataclass(frozen=True)
class SettingBinding:
    """Place of a setting in a running session."""

    get: Callable[[Session], Any]
    set: Callable[[Session, Any], object]
    changed: Callable[[Session], SignalInstance]


def in_pitches(name: str) -> SettingBinding:
    """Return how pitches are named."""
    return SettingBinding(
        lambda session: getattr(session.pitch_display, name),
        lambda session, value: session.pitch_display.set(**{name: value}),
        lambda session: session.pitch_display.changed,
    )


def in_listening(name: str) -> SettingBinding:
    """Binding to a listening setting."""
    return SettingBinding(
        lambda session: getattr(session.listening, name),
        lambda session, value: session.listening.set(**{name: value}),
        lambda session: session.listening.changed,
    )


def in_video(name: str) -> SettingBinding:
    """Binding to a display setting of the reference video."""
    return SettingBinding(
        lambda session: getattr(session.video, name),
        lambda session, value: session.video.set(**{name: value}),
        lambda session: session.video.changed,
    )


def _fold(session: Session, folded: dict[str, bool]) -> None:
    for name, is_folded in folded.items():
        session.set_folded(name, is_folded)


FOLDED: Final = SettingBinding(lambda session: dict(session.folded), _fold, lambda session: session.folded_changed)
THEME: Final = SettingBinding(
    lambda session: session.tokens.name,
    lambda session, name: session.set_tokens(THEMES[name]),
    lambda session: session.theme_changed,
)
TIME: Final = SettingBinding(
    lambda session: session.time_display,
    lambda session, display: session.set_time_display(display),
    lambda session: session.time_display_changed,
)
