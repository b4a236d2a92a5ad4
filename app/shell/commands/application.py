"""Commands of the editor itself: palette, panels, theme, language, how pitches and times are written."""

from __future__ import annotations

from functools import partial

from app.editor.session import Session
from app.editor.tokens import THEMES
from app.shell.action import Action
from app.shell.editor import Editor, EditorAction


def preferences(editor: Editor, page: str = "general") -> None:
    """Show a page of the preferences."""
    from app.shell.preferences import show_preferences

    show_preferences(editor, page)


def instruments(editor: Editor) -> None:
    """Show the instruments and their fingerings; once."""
    from widgets.dialogs.instrument_map import InstrumentsDialog

    editor.show_once(InstrumentsDialog, lambda: InstrumentsDialog(editor.session, editor.window))


def about(editor: Editor) -> None:
    """Say which program this is."""
    from app.shell.about import AboutDialog

    AboutDialog(editor.settings.path, editor.window).open()


def theme(name: str, session: Session, on: bool) -> None:
    """Dress the editor."""
    session.set_tokens(THEMES[name])


def written_pitch(written: bool, session: Session, on: bool) -> None:
    """Pitches as written, or as they sound."""
    session.pitch_display.set(written=written)


def middle_c(octave: int, session: Session, on: bool) -> None:
    """The octave that middle C is in."""
    session.pitch_display.set(middle_c_octave=octave)


def syllables(on_syllables: bool, session: Session, on: bool) -> None:
    """Do re mi, or letters."""
    session.pitch_display.set(syllables=on_syllables)


def _is_open(editor: Editor) -> bool:
    return editor.files.is_open


def _panel(name: str, key: str) -> EditorAction:
    return EditorAction(
        f"panel.{name}",
        lambda editor, shown: editor.window.show_panel(name, shown),
        "view/panels",
        key,
        enabled=_is_open,
        checked=lambda editor: editor.window.is_panel_shown(name),
    )


def _language(code: str) -> EditorAction:
    return EditorAction(
        f"language.{code}",
        lambda editor, on: editor.speak(code),
        "view/language",
        checked=lambda editor: editor.language.code == code,
    )


ACTIONS: tuple[Action | EditorAction, ...] = (
    EditorAction(
        "application.palette",
        lambda editor: editor.window.show_palette(),
        "help",
        "Ctrl+Shift+P",
        icon="search",
    ),
    EditorAction(
        "application.full_screen",
        lambda editor, on: editor.window.set_full_screen(on),
        "view",
        "F11",
        enabled=_is_open,
        checked=lambda editor: editor.window.is_full_screen,
        icon="full_screen",
    ),
    _panel("players", "Ctrl+1"),
    _panel("inspector", "Ctrl+2"),
    _panel("timeline", "Ctrl+3"),
    EditorAction(
        "application.reset_layout",
        lambda editor: editor.window.reset_layout(),
        "view/panels",
        enabled=_is_open,
        icon="layout",
    ),
    Action(
        "pitch.concert",
        partial(written_pitch, False),
        "view/pitch",
        checked=lambda session: not session.pitch_display.written,
    ),
    Action(
        "pitch.written",
        partial(written_pitch, True),
        "view/pitch",
        checked=lambda session: session.pitch_display.written,
    ),
    Action(
        "pitch_octave.c4",
        partial(middle_c, 4),
        "view/pitch",
        checked=lambda session: session.pitch_display.middle_c_octave == 4,
    ),
    Action(
        "pitch_octave.c3",
        partial(middle_c, 3),
        "view/pitch",
        checked=lambda session: session.pitch_display.middle_c_octave == 3,
    ),
    Action(
        "pitch_names.letters",
        partial(syllables, False),
        "view/pitch",
        checked=lambda session: not session.pitch_display.syllables,
    ),
    Action(
        "pitch_names.syllables",
        partial(syllables, True),
        "view/pitch",
        checked=lambda session: session.pitch_display.syllables,
    ),
    Action(
        "theme.dark",
        partial(theme, "dark"),
        "view/theme",
        checked=lambda session: session.tokens.name == "dark",
        icon="dark",
    ),
    Action(
        "theme.light",
        partial(theme, "light"),
        "view/theme",
        checked=lambda session: session.tokens.name == "light",
        icon="light",
    ),
    _language("en"),
    _language("ja"),
    EditorAction(
        "application.instruments",
        instruments,
        "edit",
        "Ctrl+Alt+I",
    ),
    EditorAction(
        "application.preferences",
        preferences,
        "edit",
        "Ctrl+,",
        icon="settings",
    ),
    EditorAction(
        "application.shortcuts",
        lambda editor: preferences(editor, "shortcuts"),
        "help",
        icon="keyboard",
    ),
    EditorAction("application.about", about, "help", icon="information"),
)
