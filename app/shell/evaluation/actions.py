"""Actions for evaluations: making clips and a questionnaire for viewers, and showing the viewers' answers."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Final

from app.shell.commands.exchange import can_draw
from app.shell.editor import Editor, EditorAction

WORKER: Final = "app.cli.evaluation.worker"
"""Module that makes an evaluation in a process of its own, so that the window stays responsive."""


def make(editor: Editor) -> None:
    """Open the dialog for an evaluation, and make its clips and questionnaire."""
    session = editor.session
    from app.evaluation.process import made_by_process
    from widgets.dialogs.evaluation.make import EvaluationDialog

    dialog = EvaluationDialog(
        session,
        partial(made_by_process, WORKER),
        Path(editor.files.folder) / f"{editor.files.stem}-evaluation",
        session.project.score.title or editor.files.stem,
        editor.window,
    )
    dialog.show()


def show_results(editor: Editor) -> None:
    """Open the dialog with the viewers' answers."""
    from app.evaluation.viewer_files import gather
    from widgets.dialogs.evaluation.results import EvaluationResultsDialog

    EvaluationResultsDialog(gather, Path(editor.files.folder), editor.window).show()


ACTIONS: Final[tuple[EditorAction, ...]] = (
    EditorAction("file.evaluation", make, "file", enabled=can_draw),
    EditorAction("file.evaluation_results", show_results, "file"),
)
