"""Commands of the editor itself: palette, panels, theme, language, how pitches and times are written."""

from __future__ import annotations

from functools import partial

from app.editor.session import Session
from app.editor.tokens import THEMES
from app.shell.action import Action
from app.shell.editor import editor_of


def palette(session: Session) -> None:
    """Search everything that can be done."""
    editor_of(session).window.show_palette()


def preferences(session: Session) -> None:
    """Show the preferences."""
    editor_of(session).window.show_preferences("general")


def instruments(session: Session) -> None:
    """Show the instruments and their fingerings."""
    editor_of(session).window.show_instruments()


def shortcuts(session: Session) -> None:
    """Show the keyboard shortcuts."""
    editor_of(session).window.show_preferences("shortcuts")


def about(session: Session) -> None:
    """Say which program this is."""
    editor_of(session).window.show_about()


def full_screen(session: Session, on: bool) -> None:
    """The viewport alone on the whole screen, or not."""
    editor_of(session).window.set_full_screen(on)


def reset_layout(session: Session) -> None:
    """Every panel back to its place."""
    editor_of(session).window.reset_layout()


def show_panel(name: str, session: Session, shown: bool) -> None:
    """Show or hide a panel."""
    editor_of(session).window.show_panel(name, shown)


def theme(name: str, session: Session, on: bool) -> None:
    """Dress the editor."""
    session.set_tokens(THEMES[name])


def language(code: str, session: Session, on: bool) -> None:
    """Speak a language."""
    editor_of(session).speak(code)


def written_pitch(written: bool, session: Session, on: bool) -> None:
    """Pitches as written, or as they sound."""
    session.pitch_display.set(written=written)


def middle_c(octave: int, session: Session, on: bool) -> None:
    """The octave that middle C is in."""
    session.pitch_display.set(middle_c_octave=octave)


def syllables(on_syllables: bool, session: Session, on: bool) -> None:
    """Do re mi, or letters."""
    session.pitch_display.set(syllables=on_syllables)


def _is_full_screen(session: Session) -> bool:
    return editor_of(session).window.is_full_screen


def _is_open(session: Session) -> bool:
    return editor_of(session).files.is_open


def _panel_shown(name: str, session: Session) -> bool:
    return editor_of(session).window.is_panel_shown(name)


def _panel(name: str, key: str) -> Action:
    return Action(
        f"panel.{name}",
        partial(show_panel, name),
        "View/Panels",
        key,
        enabled=_is_open,
        checked=partial(_panel_shown, name),
    )


ACTIONS: tuple[Action, ...] = (
    Action(
        "application.palette",
        palette,
        "Help",
        "Ctrl+Shift+P",
        icon="search",
    ),
    Action(
        "application.full_screen",
        full_screen,
        "View",
        "F11",
        enabled=_is_open,
        checked=_is_full_screen,
        icon="full_screen",
    ),
    _panel("players", "Ctrl+1"),
    _panel("inspector", "Ctrl+2"),
    _panel("timeline", "Ctrl+3"),
    Action(
        "application.reset_layout",
        reset_layout,
        "View/Panels",
        enabled=_is_open,
        icon="layout",
    ),
    Action(
        "pitch.concert",
        partial(written_pitch, False),
        "View/Pitch",
        checked=lambda session: not session.pitch_display.written,
    ),
    Action(
        "pitch.written",
        partial(written_pitch, True),
        "View/Pitch",
        checked=lambda session: session.pitch_display.written,
    ),
    Action(
        "pitch_octave.c4",
        partial(middle_c, 4),
        "View/Pitch",
        checked=lambda session: session.pitch_display.middle_c_octave == 4,
    ),
    Action(
        "pitch_octave.c3",
        partial(middle_c, 3),
        "View/Pitch",
        checked=lambda session: session.pitch_display.middle_c_octave == 3,
    ),
    Action(
        "pitch_names.letters",
        partial(syllables, False),
        "View/Pitch",
        checked=lambda session: not session.pitch_display.syllables,
    ),
    Action(
        "pitch_names.syllables",
        partial(syllables, True),
        "View/Pitch",
        checked=lambda session: session.pitch_display.syllables,
    ),
    Action(
        "theme.dark",
        partial(theme, "dark"),
        "View/Theme",
        checked=lambda session: session.tokens.name == "dark",
        icon="dark",
    ),
    Action(
        "theme.light",
        partial(theme, "light"),
        "View/Theme",
        checked=lambda session: session.tokens.name == "light",
        icon="light",
    ),
    Action(
        "language.en",
        partial(language, "en"),
        "View/Language",
        checked=lambda session: editor_of(session).language.code == "en",
    ),
    Action(
        "language.ja",
        partial(language, "ja"),
        "View/Language",
        checked=lambda session: editor_of(session).language.code == "ja",
    ),
    Action(
        "application.instruments",
        instruments,
        "Edit",
        "Ctrl+Alt+I",
    ),
    Action(
        "application.preferences",
        preferences,
        "Edit",
        "Ctrl+,",
        icon="settings",
    ),
    Action(
        "application.shortcuts",
        shortcuts,
        "Help",
        icon="keyboard",
    ),
    Action("application.about", about, "Help", icon="information"),
)
