"""What the commands of the editor reach through a session: its files, settings, language, actions and window."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

from PySide6.QtCore import QObject

from widgets.common.listening import SOURCES
from widgets.common.session import Session, TimeDisplay
from widgets.common.tokens import THEMES

if TYPE_CHECKING:
    from app.shell.actions import ActionTable
    from app.shell.files import Files
    from app.shell.language import Language
    from app.shell.questions import Questions
    from app.shell.settings import Settings
    from app.shell.window import Window


class Editor(QObject):
    """The running editor around one session; lives as long as it.

    Parameters
    ----------
    session : Session
    settings : Settings
    language : Language
    questions : Questions
        How the person is asked.
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
        session.pitch_display.changed.connect(self._remember_pitch)
        session.time_display_changed.connect(self._remember_time)
        session.theme_changed.connect(self._remember_theme)
        session.folded_changed.connect(self._remember_folded)
        session.listening.changed.connect(self._remember_listening)

    def _restore(self) -> None:
        settings, session = self.settings, self.session
        session.set_tokens(THEMES.get(settings.theme, session.tokens))
        session.pitch_display.set(settings.written_pitch, settings.middle_c_octave, settings.syllables)
        for name, folded in settings.folded.items():
            session.set_folded(name, folded)
        display = settings.time_display
        for known in get_args(TimeDisplay):
            if display == known:
                session.set_time_display(known)

        listening = session.listening
        listening.set(volume=settings.volume, click=settings.click, scrub_sound=settings.scrub_sound)
        source = settings.source
        for heard in SOURCES:
            if source == heard:
                listening.set(source=heard)

    def _remember_pitch(self) -> None:
        pitch = self.session.pitch_display
        self.settings.written_pitch = pitch.written
        self.settings.middle_c_octave = pitch.middle_c_octave
        self.settings.syllables = pitch.syllables

    def _remember_time(self) -> None:
        self.settings.time_display = self.session.time_display

    def _remember_folded(self) -> None:
        self.settings.folded = dict(self.session.folded)

    def _remember_listening(self) -> None:
        listening, settings = self.session.listening, self.settings
        # Told of much else, as of every phrase that is made: only what the person chose is written.
        for name in ("volume", "click", "scrub_sound", "source"):
            value = getattr(listening, name)
            if getattr(settings, name) != value:
                setattr(settings, name, value)

    def _remember_theme(self) -> None:
        self.settings.theme = self.session.tokens.name

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
