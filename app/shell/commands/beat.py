"""Which beat is felt: breaths, cues and sway count in it."""

from __future__ import annotations

from app.errors import Message
from app.project.edit.piece import set_felt_beat
from app.shell.action import QT_TRANSLATE_NOOP, Action
from widgets.common.session import Session


def _felt(name: str, quarters: float | None, text: str) -> Action:
    def run(session: Session, on: bool) -> None:
        session.attempt(Message("edit.set_felt_beat"), lambda project: set_felt_beat(project, quarters))

    return Action(
        f"beat.{name}",
        text,
        run,
        "Edit/Beat",
        checked=lambda session: session.project.felt_beat_quarters == quarters,
    )


ACTIONS: tuple[Action, ...] = (
    _felt("automatic", None, QT_TRANSLATE_NOOP("Action", "Felt Beat from Metre and Tempo")),
    _felt("eighth", 0.5, QT_TRANSLATE_NOOP("Action", "Felt Beat: Eighth")),
    _felt("quarter", 1.0, QT_TRANSLATE_NOOP("Action", "Felt Beat: Quarter")),
    _felt("dotted_quarter", 1.5, QT_TRANSLATE_NOOP("Action", "Felt Beat: Dotted Quarter")),
    _felt("half", 2.0, QT_TRANSLATE_NOOP("Action", "Felt Beat: Half")),
    _felt("dotted_half", 3.0, QT_TRANSLATE_NOOP("Action", "Felt Beat: Dotted Half")),
)
