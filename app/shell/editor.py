"""What the commands of the editor reach through a session: its files, settings, language, actions and window."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.editor.session import Session
from app.editor.setting_bindings import SettingBinding
from app.editor.settings import SETTINGS, Setting

if TYPE_CHECKING:
    from app.editor.files import Files
    from app.editor.questions import Questions
    from app.editor.settings import Settings
    from app.shell.actions import ActionTable
    from app.shell.language import Language
    from app.shell.window import Window


class Editor(QObject):
    """The running editor around one session; lives as long as it.

    Parameters
    ----------
    session : Session
    settings : Settings
    language : Language
    questions : Questions
        How the user is asked.
    """

    files: Files
    table: ActionTable
    window: Window

    def __init__(self, session: Session, settings: Settings, language: Language, questions: Questions) -> None:
        super().__init__(session)
        self.session = session
        self.settings = settings
        self.language = language
        self.questions = questions
        self._restore()
        for setting in SETTINGS:
            if setting.held is not None:
                setting.held.changed(session).connect(partial(self._remember, setting, setting.held))

    def _restore(self) -> None:
        for setting in SETTINGS:
            if setting.held is not None:
                setting.held.set(self.session, getattr(self.settings, setting.name))

    def _remember(self, setting: Setting[Any], held: SettingBinding) -> None:
        # Notified of much else, as of every phrase that is made: only what the user chose is written.
        value = held.get(self.session)
        if getattr(self.settings, setting.name) != value:
            setattr(self.settings, setting.name, value)

    def speak(self, code: str) -> None:
        """Show the editor in a language; empty: the system's."""
        self.settings.language = code
        self.language.set(code)


def editor_of(session: Session) -> Editor:
    """The editor that runs a session."""
    for child in session.children():
        if isinstance(child, Editor):
            return child
    raise LookupError("this session has no editor")
