"""The running editor: what commands have at hand."""

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
    """The services around one session, and the window they are seen in.

    Attributes
    ----------
    questions : Questions
        How the user is asked.
    exported_bars : dict of str to ExportedBars
        What the last export of a piece wrote, by its source, until the program ends.
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
        """Show the editor in a language; empty: the system's."""
        self.settings.language = code
        self.language.set(code)

    def show_once(self, kind: type[D], make: Callable[[], D]) -> None:
        """Bring the window's dialog of a kind to the front, made if it is not there."""
        dialog = self.window.findChild(kind) or make()
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()


class EditorAction(ActionRow[Editor]):
    """A row about files, devices or the window: its functions take the editor."""

    about_editor = True


def is_open(editor: Editor) -> bool:
    """Return whether a project is open."""
    return editor.files.is_open
