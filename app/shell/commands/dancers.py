"""Dancers: who dances, and what they may dance."""

from __future__ import annotations

import os
from pathlib import Path

from app.choreography.library import bundled_choreographies
from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Message
from app.project.edit.dancers import set_choreography
from app.shell.action import Action
from app.shell.editor import editor_of
from widgets.players import newcomers


def add(session: Session) -> None:
    """Add a dancer of the first choreography that comes with the program."""
    newcomers.add_dancer(session, bundled_choreographies()[0], tr("action.dancer"))


def rename(session: Session) -> None:
    """Type another name for the selected dancer."""
    editor_of(session).window.rename_dancer()


def duplicate(session: Session) -> None:
    """Let another one dance the same as the selected dancer."""
    newcomers.duplicate_dancer(session)


def remove(session: Session) -> None:
    """Send the selected dancer away."""
    newcomers.remove_dancer(session)


def show_choreography(session: Session) -> None:
    """See what the choreography of the selected dancer has learned."""
    editor_of(session).window.show_choreography()


def learn_choreography(session: Session) -> None:
    """Learn a choreography from motion and music, in a dialog; once."""
    editor = editor_of(session)
    from widgets.dialogs.learn_choreography import LearnDialog  # it brings the readers of motion with it

    dialog = editor.window.findChild(LearnDialog)
    if dialog is None:
        dialog = LearnDialog(session, Path(editor.files.folder), editor.window)
        dialog.used.connect(lambda path: _dance(session, path))
    dialog.show()
    dialog.raise_()
    dialog.activateWindow()


def _dance(session: Session, path: Path) -> None:
    """Let the selected dancer dance a choreography, or a new one where there is none."""
    dancer, choreography = session.dancer, os.fspath(path.absolute())
    if dancer is None:
        newcomers.add_dancer(session, choreography, tr("action.dancer"))
        return
    session.attempt(
        Message("edit.dancer_choreography", {"dancer": dancer.name}),
        lambda project: set_choreography(project, (dancer.id,), choreography),
    )


def _has_choreographies(session: Session) -> bool:
    return bool(bundled_choreographies())


def _has_dancer(session: Session) -> bool:
    return session.dancer is not None


ACTIONS: tuple[Action, ...] = (
    Action(
        "dancers.add",
        add,
        "Edit/Players",
        enabled=_has_choreographies,
        icon="add",
    ),
    Action(
        "dancers.rename",
        rename,
        "Edit/Players",
        "F2",
        "dancers",
        enabled=_has_dancer,
        icon="pencil",
    ),
    Action(
        "dancers.duplicate",
        duplicate,
        "Edit/Players",
        "Ctrl+D",
        "dancers",
        enabled=_has_dancer,
        icon="duplicate",
    ),
    Action(
        "dancers.remove",
        remove,
        "Edit/Players",
        "Del",
        "dancers",
        enabled=_has_dancer,
        icon="delete",
    ),
    Action(
        "dancers.choreography",
        show_choreography,
        "Edit/Players",
        enabled=_has_dancer,
        icon="information",
    ),
    Action(
        "dancers.learn",
        learn_choreography,
        "Edit/Players",
    ),
)
