"""Questions of the editor as dialogs: files to open, and unsaved work."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import QApplication, QDialog, QWidget

from app.editor.design_tokens import Tokens
from app.editor.questions import Answer, ReadAgain
from app.editor.tasks import Tasks
from app.editor.translated import tr
from app.encoding import shown
from app.errors import Message
from app.project.importing import ImportRequest
from app.score.contents import PieceContents
from instrument_maps.library import all_maps
from widgets.common.paths import ask_for_file, ask_where_to_save
from widgets.common.plain import Role, ask
from widgets.common.text import sentence


class DialogQuestions:
    """Asks the editor's questions in dialogs; implements `app.editor.questions.Questions`."""

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """Ask for an existing file, starting in ``folder``; return None if the user cancels."""
        return ask_for_file(_parent(), title, Path(folder), filters)

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """Ask for a file to write, and again before one is overwritten; return its path with one of the suffixes.

        None if the user cancels.
        """
        while True:
            chosen = ask_where_to_save(_parent(), title, Path(proposal), filters)
            if chosen is None:
                return None
            path = with_suffix(chosen, suffixes)
            # The system's dialog asked about the name as typed, before the suffix was added.
            if path == chosen or not os.path.exists(path) or _may_replace(title, path):
                return path
            proposal = str(path)

    def unsaved(self, name: str) -> Answer:
        """Ask whether to save the changes of the project ``name``, and return the answer."""
        role = ask(
            _parent(),
            "unsaved",
            tr("questions.unsaved_changes"),
            tr("questions.save_changes_to").format(name=name),
            tr("questions.they_are_lost_if_you"),
            {tr("questions.save"): Role.AcceptRole, tr("questions.dont_save"): Role.DestructiveRole} | _cancel(),
            usual=Role.AcceptRole,
        )
        return "save" if role == Role.AcceptRole else "discard" if role == Role.DestructiveRole else "cancel"

    def stop_writing(self, works: tuple[Message, ...]) -> bool:
        """Ask whether to stop the listed works, which are still writing files; return True if the user agrees."""
        role = ask(
            _parent(),
            "stop_writing",
            tr("questions.files_are_being_written"),
            tr("questions.stop_and_close"),
            "\n".join((*map(sentence, works), tr("questions.what_is_unfinished_is_lost"))),
            {
                tr("questions.stop_it"): Role.DestructiveRole,
                tr("questions.keep_window_open"): Role.RejectRole,
            },
        )
        return role == Role.DestructiveRole

    def import_midi(
        self, contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks
    ) -> ImportRequest | None:
        """Show the import dialog for the tracks of a MIDI file, and return the user's decisions; None if the user
        cancels.
        """
        from widgets.dialogs.import_midi import ImportDialog

        dialog = ImportDialog(contents, all_maps(), tokens, tasks, _parent(), read_again)
        try:
            return dialog.assignment if dialog.exec() == QDialog.DialogCode.Accepted else None
        finally:
            dialog.deleteLater()

    def remove_character(self, name: str, players: tuple[str, ...]) -> bool:
        """Ask whether to remove a character that the named players have; return True if the user agrees."""
        role = ask(
            _parent(),
            "remove_character",
            tr("questions.remove_character"),
            tr("questions.remove_and_its_file_for").format(name=name),
            tr("questions.these_players_are_this_character").format(players=", ".join(players)) if players else "",
            {tr("questions.remove"): Role.DestructiveRole} | _cancel(),
        )
        return role == Role.DestructiveRole


def with_suffix(path: Path, suffixes: Sequence[str]) -> Path:
    """Return a path with one of the suffixes; the first is appended if it has none of them."""
    return path if path.suffix.lower() in suffixes else path.with_name(path.name + suffixes[0])


def _may_replace(title: str, path: Path) -> bool:
    role = ask(
        _parent(),
        "replace",
        title,
        tr("questions.replace").format(name=shown(path.name)),
        tr("questions.folder_has_file_of_this"),
        {tr("questions.replace_2"): Role.DestructiveRole} | _cancel(),
    )
    return role == Role.DestructiveRole


def _cancel() -> dict[str, Role]:
    return {tr("questions.cancel"): Role.RejectRole}


def _parent() -> QWidget | None:
    return QApplication.activeWindow()
