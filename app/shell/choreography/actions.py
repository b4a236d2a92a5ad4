"""Actions for dancers: adding one, and choosing or learning a choreography."""

from __future__ import annotations

import os
from pathlib import Path

from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Message
from app.project.choreography_files import bundled_choreographies
from app.project.edit.dancers import set_choreography
from app.shell.action import Action
from app.shell.editor import Editor, EditorAction
from widgets.players import performer_edits
from widgets.players.choreography.dancers import DancersSection


def add(session: Session) -> None:
    """Add a dancer with the first of the bundled choreographies."""
    performer_edits.add_dancer(session, bundled_choreographies()[0], tr("action.dancer"))


def rename(editor: Editor) -> None:
    """Open the field for the name of the selected dancer."""
    editor.window.show_panel("players", True)
    section = editor.window.players.findChild(DancersSection)
    assert section is not None
    section.rename_selected()


def show_choreography(editor: Editor) -> None:
    """Open the dialog about the choreography of the selected dancer, or bring it to the front."""
    from widgets.dialogs.choreography.show import ChoreographyDialog

    editor.show_once(ChoreographyDialog, lambda: ChoreographyDialog(editor.session, editor.window))


def learn_choreography(editor: Editor) -> None:
    """Open the dialog that learns a choreography from motion and music, or bring it to the front."""
    from widgets.dialogs.choreography.learn import LearnDialog  # imports the readers of motion files

    def make() -> LearnDialog:
        dialog = LearnDialog(editor.session, Path(editor.files.folder), editor.window)
        dialog.used.connect(lambda path: _dance(editor.session, path))
        return dialog

    editor.show_once(LearnDialog, make)


def _dance(session: Session, path: Path) -> None:
    """Give the selected dancer a choreography; add a dancer if none is selected."""
    dancer, choreography = session.dancer, os.fspath(path.absolute())
    if dancer is None:
        performer_edits.add_dancer(session, choreography, tr("action.dancer"))
        return
    session.attempt(
        Message("edit.dancer_choreography", {"dancer": dancer.name}),
        lambda project: set_choreography(project, (dancer.id,), choreography),
    )


def _has_dancer(session: Session) -> bool:
    return session.dancer is not None


ACTIONS: tuple[Action | EditorAction, ...] = (
    Action("dancers.add", add, "edit/players", enabled=lambda session: bool(bundled_choreographies()), icon="add"),
    EditorAction(
        "dancers.rename",
        rename,
        "edit/players",
        "F2",
        "dancers",
        enabled=lambda editor: _has_dancer(editor.session),
        icon="pencil",
    ),
    Action(
        "dancers.duplicate",
        performer_edits.duplicate_dancer,
        "edit/players",
        "Ctrl+D",
        "dancers",
        enabled=_has_dancer,
        icon="duplicate",
    ),
    Action(
        "dancers.remove",
        performer_edits.remove_dancer,
        "edit/players",
        "Del",
        "dancers",
        enabled=_has_dancer,
        icon="delete",
    ),
    EditorAction(
        "dancers.choreography",
        show_choreography,
        "edit/players",
        enabled=lambda editor: _has_dancer(editor.session),
        icon="information",
    ),
    EditorAction("dancers.learn", learn_choreography, "edit/players"),
)
