"""Questions about files in the banner: unsaved work, missing media, other computers, and changes by other programs."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path, PureWindowsPath
from typing import Final

from PySide6.QtCore import QObject

from app.editor.files import AUDIO_SUFFIXES, VIDEO_SUFFIXES, Files
from app.editor.questions import Questions
from app.editor.session import Session
from app.encoding import is_text, shown
from app.errors import Message
from app.formats.other_computers import host_of
from app.project.recovery import Recoverable
from app.shell.actions import ActionTable
from app.shell.banner import Banner
from app.shell.start_page import unsaved_work
from widgets.common.text import message_text, sentence

_REASONS: Final = 4
"""Greatest number of reasons shown for an import without players."""


class FileQuestions(QObject):
    """Shows the questions of the editor's file services in the banner."""

    def __init__(
        self, banner: Banner, session: Session, files: Files, questions: Questions, table: ActionTable
    ) -> None:
        super().__init__(banner)
        self._banner, self._session, self._files = banner, session, files
        self._questions, self._table = questions, table
        files.found.connect(self.offer_recovery)
        files.missing.connect(self.ask_for_media)
        files.elsewhere.connect(self.ask_to_look_elsewhere)
        files.silent.connect(self.say_why_no_one_plays)
        files.overtaken.connect(self.ask_to_save_over)
        files.unsaveable.connect(self.say_what_cannot_be_saved)

    def offer_recovery(self, item: Recoverable) -> None:
        """Offer to recover unsaved work; a piece without a file is named by its title."""

        def found() -> str:
            if item.document is None:
                return unsaved_work(item)
            return self.tr("window.recovered_of_older_file" if item.is_file_changed else "window.recovered_changes")

        self._banner.ask(
            lambda: (found(), (self.tr("window.recover"), self.tr("window.discard"))),
            (partial(self._files.recover, item), partial(self._files.discard, item)),
        )

    def ask_for_media(self, path: Path) -> None:
        """Ask for the new place of a missing recording or video."""
        self._banner.ask(
            lambda: (
                self.tr("window.media_not_found").format(name=shown(path.name)),
                (self.tr("window.find_it"), self.tr("window.remove_it")),
            ),
            (partial(self._find_media, path), partial(self._files.locate, path, None)),
        )

    def ask_to_look_elsewhere(self, paths: tuple[str, ...]) -> None:
        """Ask whether media files that are on other computers may be read."""
        names = [*(shown(PureWindowsPath(path).name) for path in paths[:_REASONS]), *["…"] * (len(paths) > _REASONS)]
        hosts = ", ".join(dict.fromkeys(host_of(path) for path in paths))
        self._banner.ask(
            lambda: (
                self.tr("window.files_elsewhere").format(hosts=hosts, names=", ".join(names)),
                (self.tr("window.look_there"), self.tr("window.leave_out")),
            ),
            (partial(self._files.agree_to, paths), lambda: None),
        )

    def say_why_no_one_plays(self, path: Path) -> None:
        """Show the reasons why the notes of an imported file could not be given to players."""
        score = self._session.project.score

        def why() -> str:
            lines = [self.tr("window.has_no_players").format(name=shown(path.name))]
            lines += [sentence(message) for message in score.warnings[:_REASONS] if not score.unplayed]
            line = self.tr("import_dialog.is_not_played")
            lines += [
                line.format(name=part.name, reason=message_text(part.reason)) for part in score.unplayed[:_REASONS]
            ]
            return "\n".join([*lines, *["…"] * (len(score.unplayed) > _REASONS)])

        another = (self.tr("window.open_another_file"), self._table.actions["file.open"].trigger)
        again = (self.tr("window.assign_tracks"), partial(self._files.open, path))
        answers = (again, another) if score.unplayed else (another,)
        self._banner.ask(lambda: (why(), tuple(text for text, _ in answers)), tuple(run for _, run in answers))

    def ask_to_save_over(self, path: Path, then: Callable[[], None] | None) -> None:
        """Ask whether to save to another file or to overwrite a file that another program has changed.

        ``then`` is called after saving.
        """
        self._banner.ask(
            lambda: (
                self.tr("window.was_changed_outside").format(name=shown(path.name)),
                (self.tr("window.save_as"), self.tr("window.replace_it")),
            ),
            (partial(self._files.save_as, then), partial(self._files.save_over, then)),
        )

    def say_what_cannot_be_saved(self, message: Message) -> None:
        """Report that a project file cannot store some of the project's data, and offer to undo the last edit or to
        remove the data.
        """
        answers = {"window.undo_last_edit": self._table.actions["edit.undo"].trigger}
        if self._files.can_leave_out:
            answers["window.remove_it"] = self._files.leave_out
        self._banner.ask(
            lambda: (sentence(message, self._session), tuple(map(self.tr, answers))), tuple(answers.values())
        )

    def _find_media(self, path: Path) -> None:
        audio = self._session.project.audio
        suffixes = AUDIO_SUFFIXES if audio is not None and audio.path == os.fspath(path) else VIDEO_SUFFIXES
        kinds = f"({' '.join(f'*{suffix}' for suffix in suffixes)})"
        if is_text(path.name):
            kinds = f"{path.name} ({path.name});;{kinds}"
        title = self.tr("window.find").format(name=shown(path.name))
        found = self._questions.open_file(title, self._files.folder, kinds)
        if found is not None:
            self._files.locate(path, found)
