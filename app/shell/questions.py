"""What the editor asks the user in a dialog: which file, and what becomes of unsaved work."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import QApplication, QDialog, QWidget

from app.editor.questions import Answer
from app.editor.tasks import Tasks
from app.editor.tokens import Tokens
from app.editor.translated import tr
from app.encoding import shown
from app.project.importing import ImportWish
from app.score.read import MidiContents
from instrument_maps.library import all_maps
from widgets.common.paths import ask_for_file, ask_where_to_save
from widgets.common.plain import MessageBox


class DialogQuestions:
    """`app.editor.questions.Questions` asked in dialogs."""

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """See `Questions.open_file`."""
        return ask_for_file(_parent(), title, Path(folder), filters)

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """See `Questions.save_file`."""
        while True:
            chosen = ask_where_to_save(_parent(), title, Path(proposal), filters)
            if chosen is None:
                return None
            path = with_suffix(chosen, suffixes)
            # The system's dialog has asked about the name as it was typed.
            if path == chosen or not os.path.exists(path) or _may_replace(title, path):
                return path
            proposal = str(path)

    def unsaved(self, name: str) -> Answer:
        """See `Questions.unsaved`."""
        box = MessageBox(_parent())
        box.setObjectName("unsaved")
        box.setIcon(MessageBox.Icon.NoIcon)
        box.setWindowTitle(tr("questions.unsaved_changes"))
        box.setText(tr("questions.save_changes_to").format(name=name))
        box.setInformativeText(tr("questions.they_are_lost_if_you"))
        save = box.addButton(tr("questions.save"), MessageBox.ButtonRole.AcceptRole)
        discard = box.addButton(tr("questions.dont_save"), MessageBox.ButtonRole.DestructiveRole)
        cancel = box.addButton(tr("questions.cancel"), MessageBox.ButtonRole.RejectRole)
        box.setDefaultButton(save)
        box.setEscapeButton(cancel)
        box.exec()
        clicked = box.clickedButton()
        box.deleteLater()
        return "save" if clicked is save else "discard" if clicked is discard else "cancel"

    def import_midi(self, contents: MidiContents, tokens: Tokens, tasks: Tasks) -> ImportWish | None:
        """See `Questions.import_midi`."""
        from widgets.dialogs.import_midi import ImportDialog

        dialog = ImportDialog(contents, all_maps(), tokens, tasks, _parent())
        try:
            return dialog.assignment if dialog.exec() == QDialog.DialogCode.Accepted else None
        finally:
            dialog.deleteLater()

    def remove_character(self, name: str, players: tuple[str, ...]) -> bool:
        """See `Questions.remove_character`."""
        box = MessageBox(_parent())
        box.setObjectName("remove_character")
        box.setIcon(MessageBox.Icon.NoIcon)
        box.setWindowTitle(tr("questions.remove_character"))
        box.setText(tr("questions.remove_and_its_file_for").format(name=name))
        if players:
            reported = tr("questions.these_players_are_this_character")
            box.setInformativeText(reported.format(players=", ".join(players)))
        remove = box.addButton(tr("questions.remove"), MessageBox.ButtonRole.DestructiveRole)
        cancel = box.addButton(tr("questions.cancel"), MessageBox.ButtonRole.RejectRole)
        box.setDefaultButton(cancel)
        box.setEscapeButton(cancel)
        box.exec()
        clicked = box.clickedButton()
        box.deleteLater()
        return clicked is remove


def with_suffix(path: Path, suffixes: Sequence[str]) -> Path:
    """A path whose name ends with one of the suffixes; where it has none of them it gets the first."""
    return path if path.suffix.lower() in suffixes else path.with_name(path.name + suffixes[0])


def _may_replace(title: str, path: Path) -> bool:
    box = MessageBox(_parent())
    box.setObjectName("replace")
    box.setIcon(MessageBox.Icon.NoIcon)
    box.setWindowTitle(title)
    box.setText(tr("questions.replace").format(name=shown(path.name)))
    box.setInformativeText(tr("questions.folder_has_file_of_this"))
    replace = box.addButton(tr("questions.replace_2"), MessageBox.ButtonRole.DestructiveRole)
    cancel = box.addButton(tr("questions.cancel"), MessageBox.ButtonRole.RejectRole)
    box.setDefaultButton(cancel)
    box.setEscapeButton(cancel)
    box.exec()
    clicked = box.clickedButton()
    box.deleteLater()
    return clicked is replace


def _parent() -> QWidget | None:
    return QApplication.activeWindow()
