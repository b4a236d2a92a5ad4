"""Bindings of stored settings to values of the session, from which they are stored and to which they are restored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from PySide6.QtCore import SignalInstance

from app.editor.design_tokens import THEMES
from app.editor.session import Session


@dataclass(frozen=True)
class SettingBinding:
    """Functions that read and set the session's value of one stored setting, and the signal of its changes."""

    get: Callable[[Session], Any]
    set: Callable[[Session, Any], object]
    changed: Callable[[Session], SignalInstance]


def within(state: str, name: str) -> SettingBinding:
    """Return a binding to the attribute ``name`` of one of the session's states: ``"listening"``, ``"pitch_display"``,
    ``"video"`` or ``"viewport"``.
    """
    return SettingBinding(
        lambda session: getattr(getattr(session, state), name),
        lambda session, value: getattr(session, state).set(**{name: value}),
        lambda session: getattr(session, state).changed,
    )


def _fold(session: Session, folded: dict[str, bool]) -> None:
    for name, is_folded in folded.items():
        session.set_folded(name, is_folded)


FOLDED: Final = SettingBinding(lambda session: dict(session.folded), _fold, lambda session: session.folded_changed)
GROUPED: Final = SettingBinding(
    lambda session: session.groups_players,
    lambda session, grouped: session.set_groups_players(grouped),
    lambda session: session.groups_players_changed,
)
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
