"""Commands that save, load and compare a piece's acting metadata, and open the folder of the user's tables."""

from __future__ import annotations

from pathlib import Path

from app.editor.session import Severity
from app.editor.translated import tr
from app.errors import AppError, Message
from app.project.model import Project
from app.project.piece_metadata import (
    SUFFIX,
    PieceMetadata,
    differences,
    load_metadata,
    metadata_of,
    save_metadata,
    with_metadata,
)
from app.shell.editor import Editor, EditorAction, is_open
from metadata.library import FOLDERS, metadata_library
from widgets.common.paths import show_folder


def save(editor: Editor) -> None:
    """Ask for a file, and write the piece's metadata to it."""
    session = editor.session
    proposal = Path(editor.files.folder) / f"{editor.files.stem}{SUFFIX}"
    path = editor.questions.save_file(tr("files.save_metadata"), str(proposal), _kinds(), (SUFFIX,))
    if path is None:
        return
    try:
        save_metadata(metadata_of(session.project), path)
    except AppError as error:
        session.notice(error.message, Severity.ERROR)
    else:
        session.notice(Message("metadata.written", {"file": path.name, "path": str(path)}))


def load(editor: Editor) -> None:
    """Ask for a file, and apply its acting metadata to the piece."""
    session, found = editor.session, _read(editor)
    if found is None:
        return
    path, metadata = found
    problems: list[Message] = []

    def edit(project: Project) -> Project:
        loaded = with_metadata(project, metadata)
        problems[:] = loaded.problems
        return loaded.project

    if session.attempt(Message("edit.load_metadata", {"file": path.name}), edit):
        for problem in problems:
            session.notice(problem, Severity.WARNING)


def compare(editor: Editor) -> None:
    """Ask for a file, and show the differences between its acting metadata and the piece's."""
    from widgets.dialogs.metadata_differences import MetadataDifferencesDialog

    session, found = editor.session, _read(editor)
    if found is None:
        return
    path, metadata = found
    differing = differences(metadata_of(session.project), metadata)
    if differing:
        MetadataDifferencesDialog(differing, path.name, editor.window).open()
    else:
        session.notice(Message("metadata.same", {"file": path.name}))


def show_rules(editor: Editor) -> None:
    """Open the dialog of the rules that players act by."""
    from widgets.dialogs.rules import RulesDialog

    for there in editor.window.findChildren(RulesDialog):
        if there.isVisible():
            there.raise_()
            there.activateWindow()
            return
    # Beside the window, in which the preview is shown.
    RulesDialog(editor.session, editor.window).show()


def open_folder(editor: Editor) -> None:
    """Open the folder of the user's own tables in the file manager, with a folder for each kind, and report faults in
    the tables again.
    """
    for folder in FOLDERS:
        folder.folder().mkdir(parents=True, exist_ok=True)
    for problems in metadata_library().problems.values():
        editor.session.notice(problems[0], Severity.ERROR)
    show_folder(FOLDERS[0].folder().parent)


def _read(editor: Editor) -> tuple[Path, PieceMetadata] | None:
    path = editor.questions.open_file(tr("files.load_metadata"), editor.files.folder, _kinds())
    if path is None:
        return None
    try:
        return path, load_metadata(path)
    except AppError as error:
        editor.session.notice(error.message, Severity.ERROR)
        return None


def _kinds() -> str:
    return f"{tr('files.metadata')} (*{SUFFIX})"


ACTIONS: tuple[EditorAction, ...] = (
    EditorAction("file.save_metadata", save, "file/metadata", enabled=is_open),
    EditorAction("file.load_metadata", load, "file/metadata", enabled=is_open),
    EditorAction("file.compare_metadata", compare, "file/metadata", enabled=is_open),
    EditorAction("file.rules", show_rules, "file/metadata"),
    EditorAction("file.metadata_folder", open_folder, "file/metadata"),
)
