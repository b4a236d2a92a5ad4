"""Mute and solo buttons of players, for all lists and lanes."""

from __future__ import annotations

from typing import Literal, TypeAlias

from app.editor.edit_names import edit_of_players
from app.editor.session import Session
from app.project.edit import players

PlayerMark: TypeAlias = Literal["muted", "soloed"]


def mark_players(session: Session, field: PlayerMark, on: bool, chosen: tuple[str, ...]) -> None:
    """Set or clear the mark ``"muted"`` or ``"soloed"`` of the chosen players, as one undoable step."""
    ids = {"muted": ("edit.unmute", "edit.mute"), "soloed": ("edit.unsolo", "edit.solo")}
    name = edit_of_players(session.project, ids[field][on], chosen)
    session.attempt(name, lambda project: players.change(project, chosen, **{field: on}))
