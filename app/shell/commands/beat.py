"""Commands for the felt beat, in which breaths, cues and sway count."""

from __future__ import annotations

from app.editor.session import Session
from app.errors import Message
from app.project.edit.piece import set_felt_beat
from app.shell.action import Action


def _felt(name: str, quarters: float | None) -> Action:
    def run(session: Session, on: bool) -> None:
        session.attempt(Message("edit.set_felt_beat"), lambda project: set_felt_beat(project, quarters))

    return Action(
        f"beat.{name}", run, "edit/felt_beat", checked=lambda session: session.project.felt_beat_quarters == quarters
    )


ACTIONS: tuple[Action, ...] = (
    _felt("automatic", None),
    _felt("eighth", 0.5),
    _felt("quarter", 1.0),
    _felt("dotted_quarter", 1.5),
    _felt("half", 2.0),
    _felt("dotted_half", 3.0),
)
