"""The running editor: the session, its services and the window, as commands receive them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

from PySide6.QtWidgets import QDialog

from app.editor.exported_bars import ExportedBars
from app.editor.files import Files
from app.editor.questions import Questions
from app.editor.recorder import Recorder
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.sound import EditorSound
from app.editor.streamer import Streamer
from app.editor.video import ReferenceVideo
from app.shell.action import ActionRow
from app.shell.actions import ActionTable
from app.shell.language import Language
from app.shell.window import Window

D = TypeVar("D", bound=QDialog)


@dataclass(frozen=True, eq=False)
class Editor:
    """The parts of the running editor that commands use: session, files, recording, export and other services, and the
    window.

    Attributes
    ----------
    questions : Questions
        Dialogs that ask the user, or their substitute in tests.
    exported_bars : dict of str to ExportedBars
        Bars and files of the last export of each piece, by the path of the piece, kept until the program ends.
    """

    session: Session
    settings: Settings
    language: Language
    questions: Questions
    files: Files
    sound: EditorSound
    recorder: Recorder
    streamer: Streamer
    video: ReferenceVideo
    table: ActionTable
    window: Window
    exported_bars: dict[str, ExportedBars] = field(default_factory=dict)

    def speak(self, code: str) -> None:
        """Set the display language; empty for the system's."""
        self.settings.language = code
        self.language.set(code)

    def show_once(self, kind: type[D], make: Callable[[], D]) -> None:
        """Bring the window's dialog of a class to the front, creating it first if there is none."""
        dialog = self.window.findChild(kind) or make()
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()


class EditorAction(ActionRow[Editor]):
    """An action about files, devices or the window, whose functions take the editor."""

    about_editor = True


def is_open(editor: Editor) -> bool:
    """Return whether a project is open in the editor."""
    return editor.files.is_open
