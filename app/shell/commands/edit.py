"""Commands for undo and redo, and for the felt beat (the note value in which breaths, cues and sway count)."""

from __future__ import annotations

from app.editor.session import Session
from app.errors import Message
from app.project.edit.piece import set_felt_beat
from app.shell.action import Action


def _last_done(session: Session) -> Message | None:
    done = session.document.done
    return done[-1].name if done else None


def _last_undone(session: Session) -> Message | None:
    undone = session.document.undone
    return undone[-1].name if undone else None


ACTIONS: tuple[Action, ...] = (
    Action(
        "edit.undo",
        lambda session: session.document.undo(),
        "edit",
        "Ctrl+Z",
        enabled=lambda session: bool(session.document.done),
        icon="undo",
        step=_last_done,
    ),
    Action(
        "edit.redo",
        lambda session: session.document.redo(),
        "edit",
        "Ctrl+Shift+Z;Ctrl+Y",
        enabled=lambda session: bool(session.document.undone),
        icon="redo",
        step=_last_undone,
    ),
)


def _felt(name: str, quarters: float | None) -> Action:
    def run(session: Session, on: bool) -> None:
        session.attempt(Message("edit.set_felt_beat"), lambda project: set_felt_beat(project, quarters))

    return Action(
        f"beat.{name}", run, "edit/felt_beat", checked=lambda session: session.project.felt_beat_quarters == quarters
    )


FELT_BEATS: tuple[Action, ...] = (
    _felt("automatic", None),
    _felt("eighth", 0.5),
    _felt("quarter", 1.0),
    _felt("dotted_quarter", 1.5),
    _felt("half", 2.0),
    _felt("dotted_half", 3.0),
)
